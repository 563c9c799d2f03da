//! Hamilton's equations as a vector field, which the methods for Lagrange's equations integrate as well.

use super::legendre;
use super::phase::{PhaseState, equations};
use crate::error::Error;
use crate::names::{Entry, name};
use crate::number::Real;
use crate::solution::consistent::{Level, project};
use crate::solution::vector_field::{ActiveConstraints, LagrangianVectorField, StagePoint, VectorField};
use crate::system::{Lagrangian, State, StateOf};
use crate::vector::{Array, PhaseVector, StaticLength, array, vector};

/// Hamilton's equations, in coordinates and momenta.
///
/// At the end of a step, q is projected onto Φ = 0, and p is replaced by the momenta of its velocity. This
/// removes only the part of p along the constraints.
#[derive(Clone, Copy, Debug)]
pub struct HamiltonianVectorField;

impl<L: Lagrangian<Scalar: Real>> VectorField<L> for HamiltonianVectorField {
    const HOLDS_VELOCITY: bool = false;

    type Checks = LagrangianVectorField;

    fn phase(system: &L, state: &StateOf<L>) -> PhaseVector<L::Scalar, L::N> {
        PhaseVector::<_, L::N>::of(state.q, system.momentum(state))
    }

    fn evaluate(
        system: &L,
        point: &StagePoint<L::Scalar, L::N>,
        active: Option<&Array<bool, L::M>>,
        rates: &mut PhaseVector<L::Scalar, L::N>,
    ) -> Result<ActiveConstraints<L::Scalar, L::M>, Error> {
        let state = legendre::invert(system, &phase_state(point), &array(point.velocity), active)?;
        let (rate, rank, active) = equations(system, &state, active)?;
        *rates = PhaseVector::<_, L::N>::of(rate.q, rate.p);
        let multipliers = array(rate.multipliers);
        Ok(ActiveConstraints { active, multipliers, multipliers_are_unique: rank == <L::M>::COUNT })
    }

    fn state(system: &L, point: &StagePoint<L::Scalar, L::N>) -> StateOf<L> {
        legendre::invert(system, &phase_state(point), &array(point.velocity), None).unwrap_or(nearby(point))
    }

    fn project(system: &L, point: &StagePoint<L::Scalar, L::N>) -> Result<StateOf<L>, Error> {
        let mut state = nearby(point);
        project(system, &[Level::Position], &mut state)?;
        let phase = PhaseState { q: state.q, ..phase_state(point) };
        legendre::invert(system, &phase, &array(point.velocity), None)
    }

    fn entry(_: &L, half: usize, coordinate: usize) -> Entry {
        let name = name(L::COORDINATES, coordinate);
        if half == 0 { Entry::Coordinate(name) } else { Entry::Momentum(name) }
    }
}

fn phase_state<T: Real, N: StaticLength>(point: &StagePoint<T, N>) -> PhaseState<T, N> {
    PhaseState { t: point.t, q: vector(point.y.half(0)), p: vector(point.y.half(1)) }
}

/// Returns the state with the initial guess `point.velocity`, instead of the velocity that belongs to the
/// momenta.
fn nearby<T: Real, N: StaticLength>(point: &StagePoint<T, N>) -> State<T, N> {
    State { t: point.t, q: vector(point.y.half(0)), v: point.velocity }
}
