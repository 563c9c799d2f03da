//! Which solutions of the emitted elimination are to be trusted.

use crate::number::{Real, power_of_epsilon};
use crate::system::Solution;

/// Where the smallest pivot exceeds it, at most a third of the digits are lost.
pub(crate) fn least_pivot<T: Real>() -> T {
    power_of_epsilon(1.0 / 3.0)
}

/// Whether the elimination lost at most a third of the digits, by its smallest pivot, and all is finite.
pub(crate) fn is_trustworthy<T: Real, const N: usize, const M: usize>(s: &Solution<T, N, M>) -> bool {
    // Without a branch for each, so that several are looked at at once.
    let all_finite = |x: &[T]| x.iter().fold(true, |all, x| all & x.is_finite());
    s.pivot > least_pivot() && all_finite(s.accelerations.as_slice()) && all_finite(s.multipliers.as_slice())
}
