//! What is integrated: a motion in (q, q̇) or in (q, p). The methods are the same for both.

use super::consistent::{BOTH, project};
use super::solve::solve_near;
use crate::error::Error;
use crate::names::Entry;
use crate::number::{Real, vector};
use crate::system::{Lagrangian, State};

/// Coordinates and velocities, or coordinates and momenta, as arrays: what a one-step method adds up.
pub type PhaseVector<T, const N: usize> = [[T; N]; 2];

/// The equations that a method integrates, of the first order in a [`PhaseVector`] whose first half is q.
pub trait VectorField<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize> {
    /// Whether the second half of a phase is the velocity, so that a state is known where its rates are not.
    const HOLDS_VELOCITY: bool;

    /// Where a state is in the phase space.
    fn phase(system: &L, state: &State<L::Scalar, N>) -> PhaseVector<L::Scalar, N>;

    /// Puts the rates there into `rates`, resting on the constraints `active`, or on as many as are independent.
    ///
    /// # Errors
    /// As [`Simulate::solve`](crate::Simulate::solve), and what finding the velocity gives.
    fn evaluate(
        system: &L,
        point: &StagePoint<L::Scalar, N>,
        active: Option<&[bool; M]>,
        rates: &mut PhaseVector<L::Scalar, N>,
    ) -> Result<ActiveConstraints<M>, Error>;

    /// The state there; where no velocity can be found it has the one nearby.
    fn state(system: &L, point: &StagePoint<L::Scalar, N>) -> State<L::Scalar, N>;

    /// The state on the constraints that is nearest.
    ///
    /// # Errors
    /// As [`Simulate::make_consistent`](crate::Simulate::make_consistent), and what finding the velocity gives.
    fn project(system: &L, point: &StagePoint<L::Scalar, N>) -> Result<State<L::Scalar, N>, Error>;

    /// What the second half of the phase has for the coordinate of this name.
    fn entry(coordinate: &'static str) -> Entry;
}

/// A time and a place in the phase space.
#[derive(Clone, Copy, Debug)]
pub struct StagePoint<T, const N: usize> {
    /// The time.
    pub t: T,
    /// The place.
    pub y: PhaseVector<T, N>,
    /// A velocity nearby, where the search for the one that belongs to momenta starts.
    pub velocity: [T; N],
}

/// What the rates of a phase rest on.
#[derive(Clone, Copy, Debug)]
pub struct ActiveConstraints<const M: usize> {
    /// The constraints that they rest on.
    pub active: [bool; M],
    /// Whether the constraints are independent.
    pub multipliers_are_unique: bool,
}

/// Lagrange's equations, in coordinates and velocities.
#[derive(Clone, Copy, Debug)]
pub struct LagrangianVectorField;

impl<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize> VectorField<L, N, M>
    for LagrangianVectorField
{
    const HOLDS_VELOCITY: bool = true;

    #[inline]
    fn phase(_: &L, state: &State<L::Scalar, N>) -> PhaseVector<L::Scalar, N> {
        [state.q.into(), state.v.into()]
    }

    // Inlined for sure: of what a call returns, and of a result moved out of another, there would be copies in every stage.
    #[inline(always)]
    fn evaluate(
        system: &L,
        point: &StagePoint<L::Scalar, N>,
        active: Option<&[bool; M]>,
        rates: &mut PhaseVector<L::Scalar, N>,
    ) -> Result<ActiveConstraints<M>, Error> {
        rates[0] = point.y[1];
        solve_near(system, &Self::state(system, point), active, |solution, &active| {
            rates[1] = solution.accelerations.data.0[0];
            ActiveConstraints { active, multipliers_are_unique: solution.multipliers_are_unique() }
        })
    }

    #[inline]
    fn state(_: &L, point: &StagePoint<L::Scalar, N>) -> State<L::Scalar, N> {
        State { t: point.t, q: vector(point.y[0]), v: vector(point.y[1]) }
    }

    #[inline]
    fn project(system: &L, point: &StagePoint<L::Scalar, N>) -> Result<State<L::Scalar, N>, Error> {
        let mut state = Self::state(system, point);
        project(system, &BOTH, &mut state)?;
        Ok(state)
    }

    fn entry(coordinate: &'static str) -> Entry {
        Entry::Velocity(coordinate)
    }
}
