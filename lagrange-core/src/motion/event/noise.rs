//! The round-off of an event's function at a state.

use super::Watched;
use crate::number::{Real, Scalar, larger};
use crate::system::{Lagrangian, State};

/// So many states nearby are looked at.
const NEIGHBOURS: u64 = 8;

/// By how much the function may be off for each that it moves from one such state to the next.
const SAFETY: f64 = 16.0;

/// What the function of an event cannot be told from zero by: 16 times the most by which it differs at eight states whose entries, and
/// time, are off by a unit of round-off each, up or down at random. An entry is not known better, and what the
/// function itself rounds moves along.
///
/// Of the sum of what each entry does by itself, eight random choices of signs miss a half with a chance of less than 1 in 250
/// (they would have to be all on the other side of the median of its size), the factor 16 covers the rest.
#[cold]
#[inline(never)]
pub(super) fn noise<L, const N: usize, const M: usize>(
    event: &impl Watched<L, N, M>,
    system: &L,
    state: &State<L::Scalar, N>,
) -> Result<L::Scalar, crate::error::Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    let value = event.value(system, state)?;
    let moved = |neighbour| event.value(system, &nearby(state, neighbour)).unwrap_or(value);
    let differences = (0..NEIGHBOURS).map(|neighbour| Scalar::abs(moved(neighbour) - value));
    Ok(differences.fold(L::Scalar::constant(0.0), larger) * L::Scalar::constant(SAFETY))
}

/// The state with each entry, and the time, moved by a unit of its round-off.
fn nearby<T: Real, const N: usize>(state: &State<T, N>, neighbour: u64) -> State<T, N> {
    let mut bits = neighbour;
    let mut moved = |x: T| {
        // Steele, Lea and Flood's SplitMix.
        bits = (bits ^ (bits >> 30)).wrapping_add(0x9e37_79b9_7f4a_7c15).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x + x * T::constant(if bits >> 63 == 0 { T::EPSILON } else { -T::EPSILON })
    };
    State { t: moved(state.t), q: state.q.map(&mut moved), v: state.v.map(&mut moved) }
}
