//! The method of Störmer and Verlet; with holonomic constraints, RATTLE.
//!
//! Half a step of the forces, a step of the coordinates, half a step of the forces. The multipliers of the first half
//! lead to coordinates on the constraints, those of the second half to velocities along them (Andersen, *Journal of
//! Computational Physics* 52, 1983; Hairer, Lubich and Wanner, *Geometric Numerical Integration*, VII.1.3).

use core::convert::Infallible;
use core::fmt::{self, Debug};

use super::fixed_step::FixedStep;
use super::scheme::{
    Compensated, CompensatedState, Scheme, SymmetricScheme, magnitudes, terms_of_positions, terms_of_rates,
};
use super::settle::{NotSettled, Residuals, have_hardly_turned};
use crate::number::{Parts, Scalar};
use crate::solution::acceleration_field::Stated;
use crate::solution::near::compensated;
use crate::solution::vector_field::LagrangianVectorField;
use crate::structure::{ConstantMassMatrix, HolonomicConstraints, VelocityFreeForces};
use crate::system::{Lagrangian, State, StateOf, System, unit};
use crate::vector::{
    Array, Element, Entrywise, Length, Numbers, PhaseVector, StaticLength, Vector, VectorOf, ViewOf, array,
    vector, view_of, zeros,
};

/// The method of Störmer and Verlet, symplectic and of order 2; with holonomic constraints it is RATTLE.
///
/// A step takes one evaluation of the forces, and its dense output none, for orders above 4 four. The method applies if the
/// mass matrix is constant and the forces depend on coordinates and time alone, which the derive macro finds out
/// ([`structure`](crate::structure)): for other systems it does not compile. [`composed`](FixedStep::composed) makes it a
/// method of order 4, 6 or 8.
///
/// ```
/// use lagrange_core::motion::Composition;
/// use lagrange_core::prelude::*;
///
/// #[derive(Lagrangian)]
/// #[coordinates(x, y)]
/// #[lagrangian((x_dot^2 + y_dot^2)/2 + 1/sqrt(x^2 + y^2))]
/// struct Kepler;
///
/// // A thousand turns on an ellipse of eccentricity 0.5.
/// let start = State::new([0.5, 0.0], [0.0, 3.0_f64.sqrt()]);
/// let method = Verlet::with_step(0.02).composed(Composition::KahanLi8).max_steps(1_000_000);
/// let mut motion = Motion::new(Kepler, start, method)?;
/// motion.advance_to(1000.0 * core::f64::consts::TAU)?;
/// assert!((Kepler.energy(motion.state()) / Kepler.energy(&start) - 1.0).abs() < 1e-13);
/// # Ok::<(), Error>(())
/// ```
///
/// Coordinates and velocities carry their rounding errors (compensated summation). On constraints, every step ends with
/// Φ and F q̇ + b at round-off.
pub type Verlet = FixedStep<StormerVerlet>;

/// The scheme of [`Verlet`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StormerVerlet;

impl SymmetricScheme for StormerVerlet {}

/// Forces at a state.
#[derive(Clone, Debug)]
pub struct Forces<F, T: Element, N: Length> {
    /// Factorization of the equations; `None` without constraints.
    factor: Option<F>,
    /// Accelerations at the last two states, in turns; with constraints h in their place.
    pushes: PhaseVector<T, N>,
    /// Index of the last state in `pushes`.
    last: usize,
}

/// Equations of motion whose forces depend on coordinates and time alone.
pub trait PositionForces<L: System<Scalar: Parts>> {
    /// Factorization of the equations with constraints.
    type Factor: Clone + Debug + Send + Sync;

    /// Writes the accelerations at a state to `push`. With constraints it writes h, and returns the factorization.
    #[doc(hidden)]
    fn evaluate(
        system: &L,
        state: &StateOf<L>,
        push: &mut ViewOf<L::Scalar, L::Length>,
    ) -> Option<Self::Factor>;

    /// Moves a point by a step (h, t) of RATTLE, along its constraints.
    #[doc(hidden)]
    fn advance(
        system: &L,
        point: &mut CompensatedState<L::Scalar, L::Length>,
        forces: &mut Forces<Self::Factor, L::Scalar, L::Length>,
        step: (L::Scalar, L::Scalar),
    ) -> Result<usize, NotSettled>;

    /// Returns the accelerations at the end of a step of RATTLE.
    #[doc(hidden)]
    fn accelerations(
        system: &L,
        end: &StateOf<L>,
        forces: &Forces<Self::Factor, L::Scalar, L::Length>,
    ) -> Option<VectorOf<L::Scalar, L::Length>>;
}

impl<L> Scheme<L> for StormerVerlet
where
    L: System<Scalar: Parts, Field: PositionForces<L>>,
{
    type Carried = Forces<<L::Field as PositionForces<L>>::Factor, L::Scalar, L::Length>;

    const ORDER: usize = 2;

    fn identify(to: &mut dyn fmt::Write) -> fmt::Result {
        to.write_str("Verlet")
    }

    #[inline]
    fn start(system: &L, state: &StateOf<L>) -> Self::Carried {
        let mut pushes = PhaseVector::joined(&state.q, &state.v);
        let factor = L::Field::evaluate(system, state, pushes.view_mut(0));
        Forces { factor, pushes, last: 0 }
    }

    #[inline]
    fn advance(
        system: &L,
        point: &mut CompensatedState<L::Scalar, L::Length>,
        forces: &mut Self::Carried,
        (h, to): (L::Scalar, L::Scalar),
    ) -> Result<usize, NotSettled> {
        if forces.factor.is_some() {
            return L::Field::advance(system, point, forces, (h, to));
        }
        let half = h * L::Scalar::constant(0.5);
        let Forces { pushes, last, .. } = forces;
        let (before, after) = (*last, 1 - *last);
        point.move_by(&pushes[before], |v, a| h * (v + half * a));
        point.state.t = to;
        L::Field::evaluate(system, &point.state, pushes.view_mut(after));
        point.push_by([&pushes[before], &pushes[after]], |a, b| half * (a + b));
        *last = after;
        Ok(1)
    }

    #[inline]
    fn accelerations(
        system: &L,
        end: &StateOf<L>,
        forces: &Self::Carried,
    ) -> Option<VectorOf<L::Scalar, L::Length>> {
        match &forces.factor {
            None => Some(VectorOf::<_, L::Length>::from_entries(&forces.pushes[forces.last])),
            Some(_) => L::Field::accelerations(system, end, forces),
        }
    }
}

impl<L: System<Scalar: Parts> + VelocityFreeForces, K> PositionForces<L> for Stated<K> {
    type Factor = Infallible;

    #[inline(always)]
    fn evaluate(
        system: &L,
        state: &StateOf<L>,
        push: &mut ViewOf<L::Scalar, L::Length>,
    ) -> Option<Infallible> {
        system.accelerations(
            state.t,
            view_of::<_, L::Length>(&state.q),
            view_of::<_, L::Length>(&state.v),
            push,
        );
        None
    }

    fn advance(
        _: &L,
        _: &mut CompensatedState<L::Scalar, L::Length>,
        _: &mut Forces<Infallible, L::Scalar, L::Length>,
        _: (L::Scalar, L::Scalar),
    ) -> Result<usize, NotSettled> {
        Err(NotSettled)
    }

    fn accelerations(
        _: &L,
        _: &StateOf<L>,
        _: &Forces<Infallible, L::Scalar, L::Length>,
    ) -> Option<VectorOf<L::Scalar, L::Length>> {
        None
    }
}

impl<L> PositionForces<L> for LagrangianVectorField
where
    L: Lagrangian<Scalar: Parts> + ConstantMassMatrix + VelocityFreeForces + HolonomicConstraints,
{
    type Factor = L::Factor;

    #[inline(always)]
    fn evaluate(system: &L, state: &StateOf<L>, push: &mut ViewOf<L::Scalar, L::N>) -> Option<L::Factor> {
        if const { <L::M>::COUNT == 0 } {
            system.accelerations(
                state.t,
                view_of::<_, L::Length>(&state.q),
                view_of::<_, L::Length>(&state.v),
                push,
            );
            return None;
        }
        *push = L::N::entries(system.forcing(state));
        Some(system.factor(state))
    }

    #[inline]
    fn advance(
        system: &L,
        point: &mut CompensatedState<L::Scalar, L::N>,
        forces: &mut Forces<L::Factor, L::Scalar, L::N>,
        (h, to): (L::Scalar, L::Scalar),
    ) -> Result<usize, NotSettled> {
        let Some(factor) = forces.factor else { return Err(NotSettled) };
        let half = h * L::Scalar::constant(0.5);
        let kick = onto_constraints(system, point, (&factor, &forces.push()), (h, to))?;
        let q = point.moved(&Array::from_fn(|i| h * (point.state.v[i] + kick[i])));
        let state = State { t: to, q: vector(q[0]), v: point.state.v.plus(&kick) };
        *forces = StormerVerlet::start(system, &state);
        let v = along_constraints(system, point, &kick, forces, (half, &state))?;
        point.set(to, q, v);
        Ok(1)
    }

    #[inline]
    fn accelerations(
        system: &L,
        end: &StateOf<L>,
        forces: &Forces<L::Factor, L::Scalar, L::N>,
    ) -> Option<Vector<L::Scalar, L::N>> {
        let bias = system.constraint_bias(end);
        forces.factor.as_ref().map(|factor| system.solve_with(factor, &forces.push(), &bias).accelerations)
    }
}

impl<F, T: Element, N: StaticLength> Forces<F, T, N> {
    /// Forces at the last state.
    fn push(&self) -> Vector<T, N> {
        vector(self.pushes.half(self.last))
    }
}

/// Returns the change of the velocities over the first half of a step, with the multipliers that lead to coordinates on
/// the constraints.
#[inline]
fn onto_constraints<L: Lagrangian<Scalar: Parts>>(
    system: &L,
    point: &CompensatedState<L::Scalar, L::N>,
    (factor, h_vector): (&L::Factor, &Vector<L::Scalar, L::N>),
    (h, to): (L::Scalar, L::Scalar),
) -> Result<Vector<L::Scalar, L::N>, NotSettled> {
    let (half, none) = (h * L::Scalar::constant(0.5), zeros());
    let bias = system.constraint_bias(&point.state).each(|x| half * x);
    let mut kick = system.solve_with(factor, &h_vector.each(|x| half * x), &bias).accelerations;
    let mut residuals = Residuals::new();
    loop {
        let q = point.moved(&Array::from_fn(|i| h * (point.state.v[i] + kick[i])));
        let there = State { t: to, q: vector(q[0]), v: point.state.v };
        let residual = system.constraint_residual(&there);
        let terms = terms_of_positions(system, &there);
        let wider = || {
            let rate = terms_of_rates(system, &there);
            Array::from_fn(|a| terms[a] + h.magnitude() * rate[a])
        };
        let is_noise = || {
            have_hardly_turned(&system.constraint_jacobian(&there), |a| {
                array(system.solve_with(factor, &none, &unit(a)).accelerations)
            })
        };
        let is_last = residuals.settle(&magnitudes(&residual), &terms, [&wider; 2], is_noise)?;
        let correction = system.solve_with(factor, &none, &residual.each(|x| x / h));
        kick = kick.plus(&correction.accelerations);
        if is_last {
            return Ok(kick);
        }
    }
}

/// Returns the velocities at the end of a step, with the multipliers that lead to velocities on the constraints.
#[inline]
fn along_constraints<L: Lagrangian<Scalar: Parts>>(
    system: &L,
    point: &CompensatedState<L::Scalar, L::N>,
    kick: &Vector<L::Scalar, L::N>,
    forces: &Forces<L::Factor, L::Scalar, L::N>,
    (half, state): (L::Scalar, &StateOf<L>),
) -> Result<Compensated<L::Scalar, L::N>, NotSettled> {
    let Some(factor) = &forces.factor else { return Err(NotSettled) };
    let push = forces.push().each(|x| half * x);
    let second = system.solve_with(factor, &push, &system.constraint_rate(state));
    let [mut v, mut rest] = point.pushed(&array(kick.plus(&second.accelerations)));
    let mut residuals = Residuals::new();
    let none = zeros();
    loop {
        let state = State { v: vector(v), ..*state };
        let rate = system.constraint_rate(&state);
        let terms = terms_of_rates(system, &state);
        let wider = || {
            let residual = terms_of_positions(system, &state);
            Array::from_fn(|a| terms[a] + residual[a] / half.magnitude())
        };
        // The equations are linear, and factorized at this state.
        let is_last = residuals.settle(&magnitudes(&rate), &terms, [&wider; 2], || true)?;
        // Added to the velocities, which may be smaller than their change.
        let correction = system.solve_with(factor, &none, &rate).accelerations;
        (v, rest) = compensated(&v, &array(correction), &rest);
        if is_last {
            return Ok([v, rest]);
        }
    }
}
