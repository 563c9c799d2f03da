//! Sensitivity of functions to the round-off of a state, which bounds their accuracy.

use super::limits::NEIGHBOURS;
use crate::number::Real;
use crate::system::State;
use crate::vector::Length;

/// Returns eight states in which the time and each entry are changed by ±`part` of those of `sizes`, with random
/// signs.
pub(crate) fn neighbours<T: Real, N: Length>(
    state: &State<T, N>,
    sizes: &State<T, N>,
    part: f64,
) -> impl Iterator<Item = State<T, N>> {
    (0..NEIGHBOURS).map(move |neighbour| {
        let mut bits = neighbour;
        let moved = |x: T, size: T| {
            // SplitMix of Steele, Lea and Flood.
            bits =
                (bits ^ (bits >> 30)).wrapping_add(0x9e37_79b9_7f4a_7c15).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            x + size * T::constant(if bits >> 63 == 0 { part } else { -part })
        };
        state.each_with(sizes, moved)
    })
}
