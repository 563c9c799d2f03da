//! Sensitivity of functions to the round-off of a state, which bounds their accuracy.

use crate::number::Real;
use crate::system::State;
use crate::vector::Length;

/// Number of nearby states that are compared.
const NEIGHBOURS: u64 = 8;

/// Ratio of the possible error of a function to its change between the nearby states.
///
/// The eight states change all entries with random signs. They underestimate the sum of the effects of all
/// entries by more than a half with a probability of less than 1 in 250: all eight would have to lie below the
/// median of the magnitude. The factor 16 covers the rest.
pub(crate) const SAFETY: f64 = 16.0;

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
