//! Forwards the traits of a system through references and smart pointers.

#[cfg(feature = "alloc")]
use core::fmt;

#[cfg(feature = "alloc")]
use nalgebra::{DVector, Dyn};

use super::defect::Defect;
use super::direction::Direction;
use super::equations::Equations;
use super::facts::Facts;
use super::integrability::{Classification, Integrals};
use super::lagrangian::{ConstraintKind, Lagrangian};
#[cfg(feature = "alloc")]
use super::many_bodies::ManyBodies;
use super::moving::System;
use super::pack::Pack;
use super::state::{Solution, State};
use super::structure::{ConstantMassMatrix, HolonomicConstraints, Unconstrained, VelocityFreeForces};
use super::taylor_series::{RightHandSides, TaylorSeries};
use crate::number::{Broadcast, PowerSeries};
use crate::vector::{Matrix, Vector, ViewOf};
#[cfg(feature = "alloc")]
use crate::{
    error::Error,
    solution::many_constraints::{ConstraintRows, Correction},
};

/// Forwards every method and constant. Those with a default must be forwarded too, since the default would hide
/// the system's own.
macro_rules! forward {
    ($($pointer:ty),*) => {$(
        #[diagnostic::do_not_recommend]
        impl<L: System> System for $pointer {
            type Scalar = L::Scalar;
            type Length = L::Length;
            type M = L::M;
            type Field = L::Field;

            fn length(&self) -> L::Length {
                L::length(self)
            }

            fn accelerations(
                &self,
                t: L::Scalar,
                q: &ViewOf<L::Scalar, L::Length>,
                v: &ViewOf<L::Scalar, L::Length>,
                a: &mut ViewOf<L::Scalar, L::Length>,
            ) {
                L::accelerations(self, t, q, v, a);
            }
        }

        #[diagnostic::do_not_recommend]
        impl<L: Lagrangian> Lagrangian for $pointer {
            type Factor = L::Factor;
            type N = L::N;
            const NAME: &'static str = L::NAME;
            const COORDINATES: &'static [&'static str] = L::COORDINATES;
            const CONSTRAINTS: &'static [&'static str] = L::CONSTRAINTS;
            const CONSTRAINT_KINDS: &'static [ConstraintKind] = L::CONSTRAINT_KINDS;
            const CONSTRAINT_CLASSES: &'static [Classification] = L::CONSTRAINT_CLASSES;
            const INTEGRALS: Option<Integrals> = L::INTEGRALS;
            const HAS_CONTACTS: bool = L::HAS_CONTACTS;
            const HAS_FRICTION: bool = L::HAS_FRICTION;
            const HAS_PLANAR_FRICTION: bool = L::HAS_PLANAR_FRICTION;
            const DEPENDS_ON_TIME: bool = L::DEPENDS_ON_TIME;
            const QUATERNIONS: &'static [usize] = L::QUATERNIONS;
            const MOMENTA_ARE_LINEAR: bool = L::MOMENTA_ARE_LINEAR;
            const OBSERVABLES: &'static [&'static str] = L::OBSERVABLES;
            const DIGEST: u32 = L::DIGEST;
            const SUPPLIED: &'static [&'static str] = L::SUPPLIED;
            const FACTS: Facts = L::FACTS;
            const EQUATIONS: Equations = L::EQUATIONS;

            fn visit_parameters(&self, visit: &mut dyn FnMut(&'static str, Self::Scalar)) {
                L::visit_parameters(self, visit);
            }

            fn visit_defects(&self, visit: &mut dyn FnMut(&'static str, Defect<Self::Scalar>)) {
                L::visit_defects(self, visit);
            }

            forward! { @methods
                fn lagrangian(state: &State<Self::Scalar, L::N>) -> Self::Scalar;
                fn energy(state: &State<Self::Scalar, L::N>) -> Self::Scalar;
                fn momentum(state: &State<Self::Scalar, L::N>) -> Vector<Self::Scalar, L::N>;
                fn momentum_rate(state: &State<Self::Scalar, L::N>) -> Vector<Self::Scalar, L::N>;
                fn mass_matrix(state: &State<Self::Scalar, L::N>) -> Matrix<Self::Scalar, L::N, L::N>;
                fn completed_momentum(state: &State<Self::Scalar, L::N>) -> Vector<Self::Scalar, L::N>;
                fn completed_momentum_rate(state: &State<Self::Scalar, L::N>) -> Vector<Self::Scalar, L::N>;
                fn completed_mass_matrix(state: &State<Self::Scalar, L::N>) -> Matrix<Self::Scalar, L::N, L::N>;
                fn jacobian_round_off(state: &State<Self::Scalar, L::N>) -> Matrix<Self::Scalar, L::M, L::N>;
                fn compliance() -> Vector<Self::Scalar, L::M>;
                fn slides() -> Option<usize>;
                fn energy_rate(
                    state: &State<Self::Scalar, L::N>,
                    multipliers: &Vector<Self::Scalar, L::M>
                ) -> Self::Scalar;
                fn forcing(state: &State<Self::Scalar, L::N>) -> Vector<Self::Scalar, L::N>;
                fn constraint_residual(state: &State<Self::Scalar, L::N>) -> Vector<Self::Scalar, L::M>;
                fn constraint_integral(index: usize, state: &State<Self::Scalar, L::N>) -> Option<Self::Scalar>;
                fn constraint_rate(state: &State<Self::Scalar, L::N>) -> Vector<Self::Scalar, L::M>;
                fn residual_magnitude(state: &State<Self::Scalar, L::N>) -> Vector<Self::Scalar, L::M>;
                fn rate_magnitude(state: &State<Self::Scalar, L::N>) -> Vector<Self::Scalar, L::M>;
                fn constraint_jacobian(state: &State<Self::Scalar, L::N>) -> Matrix<Self::Scalar, L::M, L::N>;
                fn constraint_bias(state: &State<Self::Scalar, L::N>) -> Vector<Self::Scalar, L::M>;
                fn constraint_force(
                    state: &State<Self::Scalar, L::N>,
                    multipliers: &Vector<Self::Scalar, L::M>
                ) -> Vector<Self::Scalar, L::N>;
                fn inverse_dynamics(
                    state: &State<Self::Scalar, L::N>,
                    accelerations: &Vector<Self::Scalar, L::N>,
                    multipliers: &Vector<Self::Scalar, L::M>
                ) -> Vector<Self::Scalar, L::N>;
                fn accelerations_unchecked(state: &State<Self::Scalar, L::N>) -> Solution<Self::Scalar, L::N, L::M>;
                fn factor(state: &State<Self::Scalar, L::N>) -> Self::Factor;
                fn solve_with<S>(
                    factor: &Self::Factor,
                    forcing: &Vector<S, L::N>,
                    bias: &Vector<S, L::M>
                ) -> Solution<S, L::N, L::M>;
                fn observable(
                    index: usize,
                    state: &State<Self::Scalar, L::N>,
                    solution: &Solution<Self::Scalar, L::N, L::M>
                ) -> Option<Self::Scalar>;
                fn conserved(index: usize, state: &State<Self::Scalar, L::N>) -> Option<Self::Scalar>;
            }
        }

        #[cfg(feature = "alloc")]
        #[diagnostic::do_not_recommend]
        impl<L: ManyBodies> ManyBodies for $pointer {
            const ENERGY_IS_CONSERVED: bool = L::ENERGY_IS_CONSERVED;
            const HAS_CONSTRAINTS: bool = L::HAS_CONSTRAINTS;
            const DIGEST: u32 = L::DIGEST;

            fn free_accelerations(&self, t: L::Scalar, q: &[L::Scalar], v: &[L::Scalar], a: &mut [L::Scalar]) {
                L::free_accelerations(self, t, q, v, a);
            }

            fn divide_by_masses(&self, t: L::Scalar, q: &[L::Scalar], v: &[L::Scalar], forces: &mut [L::Scalar]) {
                L::divide_by_masses(self, t, q, v, forces);
            }

            fn constraints(
                &self,
                t: L::Scalar,
                q: &[L::Scalar],
                v: &[L::Scalar],
                rows: &mut ConstraintRows<L::Scalar>,
            ) {
                L::constraints(self, t, q, v, rows);
            }

            fn correct(
                &self,
                at: (L::Scalar, &[L::Scalar], &[L::Scalar]),
                target: Correction,
                results: (&mut [L::Scalar], &mut alloc::vec::Vec<L::Scalar>),
            ) -> L::Scalar {
                L::correct(self, at, target, results)
            }

            fn multipliers(&self, state: &State<L::Scalar, Dyn>) -> Result<DVector<L::Scalar>, Error>
            where
                L::Scalar: crate::number::Real,
            {
                L::multipliers(self, state)
            }

            fn write_constraint_name(&self, constraint: usize, to: &mut dyn fmt::Write) -> fmt::Result {
                L::write_constraint_name(self, constraint, to)
            }

            fn write_name(&self, coordinate: usize, to: &mut dyn fmt::Write) -> fmt::Result {
                L::write_name(self, coordinate, to)
            }

            fn visit_numbers(&self, visit: &mut dyn FnMut(L::Scalar)) {
                L::visit_numbers(self, visit);
            }

            forward! { @methods
                fn check() -> Result<(), Error>;
                fn lagrangian(state: &State<Self::Scalar, Dyn>) -> Self::Scalar;
                fn energy(state: &State<Self::Scalar, Dyn>) -> Self::Scalar;
                fn momenta(state: &State<Self::Scalar, Dyn>) -> DVector<Self::Scalar>;
            }
        }

        #[diagnostic::do_not_recommend]
        impl<L: TaylorSeries> TaylorSeries for $pointer {
            type SeriesSlopes = L::SeriesSlopes;
            type Sums = L::Sums;
            type SeriesTerms = L::SeriesTerms;
            const ROOTS: &'static [[usize; 2]] = L::ROOTS;
            const ARGUMENTS: &'static [[usize; 2]] = L::ARGUMENTS;
            const STEEP: &'static [[usize; 3]] = L::STEEP;

            fn series_functions(
                &self,
                order: usize,
                arguments: &[PowerSeries<Self::Scalar>],
                sums: &mut Self::Sums,
            ) {
                L::series_functions(self, order, arguments, sums);
            }

            forward! { @methods
                fn series_slopes(
                    state: &State<Self::Scalar, L::N>,
                    solution: &Solution<Self::Scalar, L::N, L::M>
                ) -> Self::SeriesSlopes;
                fn series_right_hand_sides(
                    slopes: &Self::SeriesSlopes,
                    sums: &Self::Sums,
                    order: &[Self::Scalar; 4],
                    direction: &Direction<Self::Scalar, L::N>
                ) -> (RightHandSides<Self::Scalar, L::N, L::M>, Self::SeriesTerms);
                fn series_factors(
                    slopes: &Self::SeriesSlopes,
                    terms: &Self::SeriesTerms,
                    order: &[Self::Scalar; 4],
                    direction: &Direction<Self::Scalar, L::N>,
                    accelerations: &Vector<Self::Scalar, L::N>,
                    multipliers: &Vector<Self::Scalar, L::M>
                ) -> [Self::Sums; 2];
            }
        }

        #[diagnostic::do_not_recommend]
        impl<V, L: Pack<V>> Pack<V> for $pointer {
            type Packed = L::Packed;

            forward! { @methods
                fn pack() -> Self::Packed;
                fn place(packed: &mut Self::Packed, lane: usize) -> bool;
            }
        }

        forward! { @markers $pointer; ConstantMassMatrix, VelocityFreeForces, HolonomicConstraints, Unconstrained }
    )*};
    (@methods $(fn $method:ident $(<$wide:ident>)?($($argument:ident: $type:ty),*) -> $result:ty;)*) => {$(
        #[inline]
        fn $method $(<$wide: Broadcast<Self::Scalar>>)?(&self, $($argument: $type),*) -> $result {
            L::$method(self, $($argument),*)
        }
    )*};
    (@markers $pointer:ty; $($marker:ident),*) => {$(
        #[diagnostic::do_not_recommend]
        impl<L: $marker> $marker for $pointer {}
    )*};
}

forward!(&L);
#[cfg(feature = "alloc")]
forward!(alloc::boxed::Box<L>, alloc::rc::Rc<L>);
#[cfg(all(feature = "alloc", target_has_atomic = "ptr"))]
forward!(alloc::sync::Arc<L>);

pub(crate) use forward;
