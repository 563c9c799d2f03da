//! Reliability of solutions of the generated elimination.

use crate::number::{Real, power_of_epsilon};
use crate::system::Solution;
use crate::vector::StaticLength;

/// Smallest acceptable pivot, ε^(1/3): the elimination then loses at most a third of the digits.
pub(crate) fn least_pivot<T: Real>() -> T {
    power_of_epsilon(1.0 / 3.0)
}

/// True if, by its smallest pivot, the elimination lost at most a third of the digits, and all entries are
/// finite.
pub(crate) fn is_trustworthy<T: Real, N: StaticLength, M: StaticLength>(s: &Solution<T, N, M>) -> bool {
    // A fold without branches, so the compiler can test several entries at once.
    let all_finite = |x: &[T]| x.iter().fold(true, |all, x| all & x.is_finite());
    s.pivot > least_pivot() && all_finite(s.accelerations.as_slice()) && all_finite(s.multipliers.as_slice())
}
