//! Hamilton's equations as a vector field, which the methods for Lagrange's equations integrate as well.

use super::legendre;
use super::phase::{PhaseState, equations};
use crate::error::Error;
use crate::names::Entry;
use crate::number::{Real, vector};
use crate::solution::consistent::{Level, project};
use crate::solution::vector_field::{ActiveConstraints, PhaseVector, StagePoint, VectorField};
use crate::system::{Lagrangian, State};

/// Hamilton's equations, in coordinates and momenta.
///
/// At the end of a step, q is projected onto Φ = 0, and p is replaced by the momenta of its velocity. This
/// removes only the part of p along the constraints.
#[derive(Clone, Copy, Debug)]
pub struct HamiltonianVectorField;

impl<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize> VectorField<L, N, M>
    for HamiltonianVectorField
{
    const HOLDS_VELOCITY: bool = false;

    fn phase(system: &L, state: &State<L::Scalar, N>) -> PhaseVector<L::Scalar, N> {
        [state.q.into(), system.momentum(state).into()]
    }

    fn evaluate(
        system: &L,
        point: &StagePoint<L::Scalar, N>,
        active: Option<&[bool; M]>,
        rates: &mut PhaseVector<L::Scalar, N>,
    ) -> Result<ActiveConstraints<M>, Error> {
        let state = legendre::invert(system, &phase_state(point), &point.velocity, active)?;
        let (rate, rank, active) = equations(system, &state, active)?;
        *rates = [rate.q.into(), rate.p.into()];
        Ok(ActiveConstraints { active, multipliers_are_unique: rank == M })
    }

    fn state(system: &L, point: &StagePoint<L::Scalar, N>) -> State<L::Scalar, N> {
        legendre::invert(system, &phase_state(point), &point.velocity, None).unwrap_or(nearby(point))
    }

    fn project(system: &L, point: &StagePoint<L::Scalar, N>) -> Result<State<L::Scalar, N>, Error> {
        let mut state = nearby(point);
        project(system, &[Level::Position], &mut state)?;
        let phase = PhaseState { q: state.q, ..phase_state(point) };
        legendre::invert(system, &phase, &point.velocity, None)
    }

    fn entry(coordinate: &'static str) -> Entry {
        Entry::Momentum(coordinate)
    }
}

fn phase_state<T: Real, const N: usize>(point: &StagePoint<T, N>) -> PhaseState<T, N> {
    PhaseState { t: point.t, q: vector(point.y[0]), p: vector(point.y[1]) }
}

/// Returns the state with the nearby velocity of `point`, instead of the one that belongs to the momenta.
fn nearby<T: Real, const N: usize>(point: &StagePoint<T, N>) -> State<T, N> {
    State { t: point.t, q: vector(point.y[0]), v: vector(point.velocity) }
}
