//! What a unit of round-off of a state changes: no more than that is known of any function of it.

use crate::number::Real;
use crate::system::State;

/// So many states nearby are looked at.
const NEIGHBOURS: u64 = 8;

/// By how much a function may be off for each that it differs by from one such state to the next.
///
/// Of the sum of what each entry does by itself, eight random choices of signs miss a half with a chance of less than 1 in 250
/// (they would have to be all on the other side of the median of its size), the factor 16 covers the rest.
pub(crate) const SAFETY: f64 = 16.0;

/// Eight states with each entry, and the time, moved by this part of itself, up or down at random.
pub(crate) fn neighbours<T: Real, const N: usize>(
    state: &State<T, N>,
    part: f64,
) -> impl Iterator<Item = State<T, N>> {
    (0..NEIGHBOURS).map(move |neighbour| {
        let mut bits = neighbour;
        let mut moved = |x: T| {
            // Steele, Lea and Flood's SplitMix.
            bits =
                (bits ^ (bits >> 30)).wrapping_add(0x9e37_79b9_7f4a_7c15).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            x + x * T::constant(if bits >> 63 == 0 { part } else { -part })
        };
        State { t: moved(state.t), q: state.q.map(&mut moved), v: state.v.map(&mut moved) }
    })
}
