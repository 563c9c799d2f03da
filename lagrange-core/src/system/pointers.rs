//! Forwards the traits of a system through references and smart pointers.

use nalgebra::{SMatrix, SVector};

use super::defect::Defect;
use super::direction::Direction;
use super::equations::Equations;
use super::facts::Facts;
use super::integrability::{Classification, Integrals};
use super::lagrangian::{ConstraintKind, Lagrangian};
use super::pack::Pack;
use super::state::{Solution, State};
use super::taylor_series::{RightHandSides, TaylorSeries};
use crate::number::{Broadcast, PowerSeries};

/// Forwards every method and constant. Those with a default must be forwarded too, since the default would hide
/// the system's own.
macro_rules! forward {
    ($($pointer:ty),*) => {$(
        #[diagnostic::do_not_recommend]
        impl<L: Lagrangian<N, M>, const N: usize, const M: usize> Lagrangian<N, M> for $pointer {
            type Scalar = L::Scalar;
            type Factor = L::Factor;
            const NAME: &'static str = L::NAME;
            const COORDINATES: [&'static str; N] = L::COORDINATES;
            const CONSTRAINTS: [&'static str; M] = L::CONSTRAINTS;
            const CONSTRAINT_KINDS: [ConstraintKind; M] = L::CONSTRAINT_KINDS;
            const CONSTRAINT_CLASSES: [Classification; M] = L::CONSTRAINT_CLASSES;
            const INTEGRALS: Option<Integrals> = L::INTEGRALS;
            const MOMENTA_ARE_LINEAR: bool = L::MOMENTA_ARE_LINEAR;
            const OBSERVABLES: &'static [&'static str] = L::OBSERVABLES;
            const DIGEST: u32 = L::DIGEST;
            const SUPPLIED: &'static [&'static str] = L::SUPPLIED;
            const FACTS: Facts = L::FACTS;
            const EQUATIONS: Equations = L::EQUATIONS;

            fn visit_parameters(&self, visit: &mut dyn FnMut(Self::Scalar)) {
                L::visit_parameters(self, visit);
            }

            fn visit_defects(&self, visit: &mut dyn FnMut(&'static str, Defect<Self::Scalar>)) {
                L::visit_defects(self, visit);
            }

            forward! { @methods
                fn lagrangian(state: &State<Self::Scalar, N>) -> Self::Scalar;
                fn energy(state: &State<Self::Scalar, N>) -> Self::Scalar;
                fn momentum(state: &State<Self::Scalar, N>) -> SVector<Self::Scalar, N>;
                fn momentum_rate(state: &State<Self::Scalar, N>) -> SVector<Self::Scalar, N>;
                fn mass_matrix(state: &State<Self::Scalar, N>) -> SMatrix<Self::Scalar, N, N>;
                fn forcing(state: &State<Self::Scalar, N>) -> SVector<Self::Scalar, N>;
                fn constraint_residual(state: &State<Self::Scalar, N>) -> SVector<Self::Scalar, M>;
                fn constraint_integral(index: usize, state: &State<Self::Scalar, N>) -> Option<Self::Scalar>;
                fn constraint_rate(state: &State<Self::Scalar, N>) -> SVector<Self::Scalar, M>;
                fn residual_magnitude(state: &State<Self::Scalar, N>) -> SVector<Self::Scalar, M>;
                fn rate_magnitude(state: &State<Self::Scalar, N>) -> SVector<Self::Scalar, M>;
                fn constraint_jacobian(state: &State<Self::Scalar, N>) -> SMatrix<Self::Scalar, M, N>;
                fn constraint_bias(state: &State<Self::Scalar, N>) -> SVector<Self::Scalar, M>;
                fn constraint_force(
                    state: &State<Self::Scalar, N>,
                    multipliers: &SVector<Self::Scalar, M>
                ) -> SVector<Self::Scalar, N>;
                fn inverse_dynamics(
                    state: &State<Self::Scalar, N>,
                    accelerations: &SVector<Self::Scalar, N>,
                    multipliers: &SVector<Self::Scalar, M>
                ) -> SVector<Self::Scalar, N>;
                fn accelerations_unchecked(state: &State<Self::Scalar, N>) -> Solution<Self::Scalar, N, M>;
                fn factor(state: &State<Self::Scalar, N>) -> Self::Factor;
                fn solve_with<S>(
                    factor: &Self::Factor,
                    forcing: &SVector<S, N>,
                    bias: &SVector<S, M>
                ) -> Solution<S, N, M>;
                fn observable(
                    index: usize,
                    state: &State<Self::Scalar, N>,
                    solution: &Solution<Self::Scalar, N, M>
                ) -> Option<Self::Scalar>;
                fn conserved(index: usize, state: &State<Self::Scalar, N>) -> Option<Self::Scalar>;
            }
        }

        #[diagnostic::do_not_recommend]
        impl<L: TaylorSeries<N, M>, const N: usize, const M: usize> TaylorSeries<N, M> for $pointer {
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
                    state: &State<Self::Scalar, N>,
                    solution: &Solution<Self::Scalar, N, M>
                ) -> Self::SeriesSlopes;
                fn series_right_hand_sides(
                    slopes: &Self::SeriesSlopes,
                    sums: &Self::Sums,
                    order: &[Self::Scalar; 4],
                    direction: &Direction<Self::Scalar, N>
                ) -> (RightHandSides<Self::Scalar, N, M>, Self::SeriesTerms);
                fn series_factors(
                    slopes: &Self::SeriesSlopes,
                    terms: &Self::SeriesTerms,
                    order: &[Self::Scalar; 4],
                    direction: &Direction<Self::Scalar, N>,
                    accelerations: &SVector<Self::Scalar, N>,
                    multipliers: &SVector<Self::Scalar, M>
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
    )*};
    (@methods $(fn $method:ident $(<$wide:ident>)?($($argument:ident: $type:ty),*) -> $result:ty;)*) => {$(
        #[inline]
        fn $method $(<$wide: Broadcast<Self::Scalar>>)?(&self, $($argument: $type),*) -> $result {
            L::$method(self, $($argument),*)
        }
    )*};
}

forward!(&L);
#[cfg(feature = "alloc")]
forward!(alloc::boxed::Box<L>, alloc::rc::Rc<L>);
#[cfg(all(feature = "alloc", target_has_atomic = "ptr"))]
forward!(alloc::sync::Arc<L>);

pub(crate) use forward;
