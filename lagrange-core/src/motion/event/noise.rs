//! The round-off of an event's function at a state.

use super::definition::AnyEvent;
use crate::number::{Real, Scalar, larger};
use crate::solution::round_off::{SAFETY, neighbours};
use crate::system::{Lagrangian, State};

/// What the function of an event cannot be told from zero by: 16 times the most by which it differs at eight states whose entries, and
/// time, are off by a unit of round-off each, up or down at random. An entry is not known better, and what the
/// function itself rounds moves along.
#[cold]
#[inline(never)]
pub(super) fn noise<L, const N: usize, const M: usize>(
    event: &impl AnyEvent<L, N, M>,
    system: &L,
    state: &State<L::Scalar, N>,
) -> Result<L::Scalar, crate::error::Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    let value = event.value(system, state)?;
    let moved = |nearby| event.value(system, &nearby).unwrap_or(value);
    let differences = neighbours(state, L::Scalar::EPSILON).map(|nearby| Scalar::abs(moved(nearby) - value));
    Ok(differences.fold(L::Scalar::constant(0.0), larger) * L::Scalar::constant(SAFETY))
}
