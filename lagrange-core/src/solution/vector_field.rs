//! Vector fields that the methods integrate: Lagrange's equations in (q, q̇), Hamilton's in (q, p).

use super::consistent::{BOTH, project};
use super::solve::solve_near;
use crate::error::Error;
use crate::names::Entry;
use crate::number::Real;
use crate::system::{Lagrangian, State, StateOf};
use crate::vector::{Array, Element, Length, PhaseVector, array, vector};

/// First-order equations of motion for a [`PhaseVector`], whose first half is q.
pub trait VectorField<L: Lagrangian<Scalar: Real>> {
    /// True if the second half of a phase is the velocity, so that a state is known without evaluating its
    /// rates.
    const HOLDS_VELOCITY: bool;

    /// Returns the phase of a state.
    fn phase(system: &L, state: &StateOf<L>) -> PhaseVector<L::Scalar, L::N>;

    /// Writes the rates at `point` to `rates`. `active` marks the constraints to use; for `None` an independent
    /// set is chosen.
    ///
    /// # Errors
    /// Those of [`Simulate::solve`](crate::Simulate::solve), and of the search for the velocity.
    fn evaluate(
        system: &L,
        point: &StagePoint<L::Scalar, L::N>,
        active: Option<&Array<bool, L::M>>,
        rates: &mut PhaseVector<L::Scalar, L::N>,
    ) -> Result<ActiveConstraints<L::Scalar, L::M>, Error>;

    /// Returns the state at `point`. If the search for its velocity fails, uses the initial guess `point.velocity`.
    fn state(system: &L, point: &StagePoint<L::Scalar, L::N>) -> StateOf<L>;

    /// Returns the nearest state on the constraints.
    ///
    /// # Errors
    /// Those of [`Simulate::make_consistent`](crate::Simulate::make_consistent), and of the search for the
    /// velocity.
    fn project(system: &L, point: &StagePoint<L::Scalar, L::N>) -> Result<StateOf<L>, Error>;

    /// Returns the entry in the second half of the phase that belongs to a coordinate.
    fn entry(coordinate: &'static str) -> Entry;
}

/// A time and a point of the phase space, as at a stage of a method.
#[derive(Clone, Copy, Debug)]
pub struct StagePoint<T: Element, N: Length> {
    /// Time.
    pub t: T,
    /// Point of the phase space.
    pub y: PhaseVector<T, N>,
    /// A nearby velocity, the initial guess of the search for the velocity that belongs to the momenta.
    pub velocity: Array<T, N>,
}

/// The constraints that determine the rates of a phase.
#[derive(Clone, Copy, Debug)]
pub struct ActiveConstraints<T: Element, M: Length> {
    /// True for each constraint that determines the rates.
    pub active: Array<bool, M>,
    /// Multiplier of each constraint.
    pub multipliers: Array<T, M>,
    /// True if the constraints are independent.
    pub multipliers_are_unique: bool,
}

/// Lagrange's equations in coordinates and velocities.
#[derive(Clone, Copy, Debug)]
pub struct LagrangianVectorField;

impl<L: Lagrangian<Scalar: Real>> VectorField<L> for LagrangianVectorField {
    const HOLDS_VELOCITY: bool = true;

    #[inline]
    fn phase(_: &L, state: &StateOf<L>) -> PhaseVector<L::Scalar, L::N> {
        PhaseVector::<_, L::N>::of(state.q, state.v)
    }

    // Always inlined: otherwise every stage would copy the returned value and the result moved out of the
    // closure.
    #[inline(always)]
    fn evaluate(
        system: &L,
        point: &StagePoint<L::Scalar, L::N>,
        active: Option<&Array<bool, L::M>>,
        rates: &mut PhaseVector<L::Scalar, L::N>,
    ) -> Result<ActiveConstraints<L::Scalar, L::M>, Error> {
        rates.set(0, point.y.half(1));
        solve_near(system, &Self::state(system, point), active, |solution, &active| {
            rates.set(1, array(solution.accelerations));
            let multipliers = array(solution.multipliers);
            ActiveConstraints {
                active,
                multipliers,
                multipliers_are_unique: solution.multipliers_are_unique(),
            }
        })
    }

    #[inline]
    fn state(_: &L, point: &StagePoint<L::Scalar, L::N>) -> StateOf<L> {
        State { t: point.t, q: vector(point.y.half(0)), v: vector(point.y.half(1)) }
    }

    #[inline]
    fn project(system: &L, point: &StagePoint<L::Scalar, L::N>) -> Result<StateOf<L>, Error> {
        let mut state = Self::state(system, point);
        project(system, &BOTH, &mut state)?;
        Ok(state)
    }

    fn entry(coordinate: &'static str) -> Entry {
        Entry::Velocity(coordinate)
    }
}
