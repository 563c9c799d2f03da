//! Hamilton's equations.

use super::phase::PhaseRate;
use crate::error::Error;
use crate::number::Real;
use crate::solution::solve::solve_near;
use crate::system::{Lagrangian, State};

/// Rates, how many constraints are independent, and which ones the rates rest on.
pub(super) type Rates<T, const N: usize, const M: usize> = (PhaseRate<T, N, M>, usize, [bool; M]);

/// Hamilton's equations at a state whose velocity belongs to its momenta.
pub(super) fn equations<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    active: Option<&[bool; M]>,
) -> Result<Rates<L::Scalar, N, M>, Error> {
    let (solution, active) = solve_near(system, state, active)?;
    let multipliers = solution.multipliers;
    let p = system.momentum_rate(state) + system.constraint_force(state, &multipliers);
    Ok((PhaseRate { q: state.v, p, multipliers }, solution.rank, active))
}
