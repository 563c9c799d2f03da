//! Vector fields that the methods integrate: Lagrange's equations in (q, q̇), Hamilton's in (q, p).

use super::consistent::{BOTH, project};
use super::named_field::NamedField;
use super::solve::solve_near;
use super::system_checks::SystemChecks;
use crate::error::Error;
use crate::names::Entry;
use crate::number::Real;
use crate::system::{Lagrangian, State, StateOf, System};
use crate::vector::{Array, Element, Length, PhaseVector, StaticLength, VectorOf, array, vector};

/// First-order equations of motion for a [`PhaseVector`], whose first half is q.
pub trait VectorField<L: System<Scalar: Real>> {
    /// True if the second half of a phase is the velocity, so that a state is known without evaluating its
    /// rates.
    const HOLDS_VELOCITY: bool;

    /// True if steps end off the constraints, and are projected onto them.
    const HAS_CONSTRAINTS: bool = <L::M as StaticLength>::COUNT > 0;

    /// Checks of states, and names for messages.
    type Checks: SystemChecks<L>;

    /// Returns the phase of a state.
    fn phase(system: &L, state: &StateOf<L>) -> PhaseVector<L::Scalar, L::Length>;

    /// Writes the rates at `point` to `rates`. `active` marks the constraints to use; for `None` an independent
    /// set is chosen.
    ///
    /// # Errors
    /// Those of [`Simulate::solve`](crate::Simulate::solve), and of the search for the velocity.
    fn evaluate(
        system: &L,
        point: &StagePoint<L::Scalar, L::Length>,
        active: Option<&Array<bool, L::M>>,
        rates: &mut PhaseVector<L::Scalar, L::Length>,
    ) -> Result<ActiveConstraints<L::Scalar, L::M>, Error>;

    /// Returns the state at `point`. If the search for its velocity fails, uses the initial guess `point.velocity`.
    fn state(system: &L, point: &StagePoint<L::Scalar, L::Length>) -> StateOf<L>;

    /// Returns the nearest state on the constraints.
    ///
    /// # Errors
    /// Those of [`Simulate::make_consistent`](crate::Simulate::make_consistent), and of the search for the
    /// velocity.
    fn project(system: &L, point: &StagePoint<L::Scalar, L::Length>) -> Result<StateOf<L>, Error>;

    /// Moves the phase at the end of a step to the nearest one on the constraints.
    ///
    /// # Errors
    /// Those of [`project`](Self::project).
    #[inline]
    fn settle(system: &L, point: &mut StagePoint<L::Scalar, L::Length>) -> Result<(), Error> {
        point.y = Self::phase(system, &Self::project(system, point)?);
        Ok(())
    }

    /// Returns the entry of the phase in this half, 0 or 1, that belongs to a coordinate.
    fn entry(system: &L, half: usize, coordinate: usize) -> Entry {
        Self::Checks::state_entry(system, half, coordinate)
    }
}

/// Equations of motion in coordinates and velocities.
#[diagnostic::on_unimplemented(
    message = "this method does not integrate the equations `{Self}` of `{L}`",
    label = "integrates coordinates and velocities",
    note = "motions in (q, p), `motion_in_momenta`, are integrated by `Dop853`, `Dopri5` and other pairs alone"
)]
pub trait VelocityField<L: System<Scalar: Real>>: VectorField<L> {}

/// A time and a point of the phase space, as at a stage of a method.
#[derive(Clone, Debug)]
pub struct StagePoint<T: Element, N: Length> {
    /// Time.
    pub t: T,
    /// Point of the phase space.
    pub y: PhaseVector<T, N>,
    /// A nearby velocity, the initial guess of the search for the velocity that belongs to the momenta. For a run-time length it
    /// has no entries, because there are no momenta.
    pub velocity: VectorOf<T, N>,
}

impl<T: Element, N: Length> StagePoint<T, N> {
    /// Returns the point of a state, with its velocities as the second half.
    pub fn of(state: &State<T, N>) -> Self {
        Self::at(state.t, PhaseVector::joined(&state.q, &state.v))
    }

    /// Returns the point of coordinates and velocities.
    #[inline(always)]
    pub fn at(t: T, y: PhaseVector<T, N>) -> Self {
        Self { t, velocity: y.half_if_constant(1), y }
    }
}

impl<T: Element, N: Length> Copy for StagePoint<T, N>
where
    PhaseVector<T, N>: Copy,
    VectorOf<T, N>: Copy,
{
}

/// The constraints that determine the rates of a phase.
#[derive(Clone, Copy, Debug)]
pub struct ActiveConstraints<T: Element, M: StaticLength> {
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

    type Checks = Self;

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
}

impl<L: Lagrangian<Scalar: Real>> VelocityField<L> for LagrangianVectorField {}
