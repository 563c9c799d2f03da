//! Numbers that are evenly distributed, without randomness.

/// Golden section: the fractional parts of its multiples are evenly distributed (Knuth, *The Art of Computer Programming*, 6.4).
const GOLDEN: f64 = 0.618_033_988_749_895;

/// Returns the `k`-th of evenly distributed numbers between −½ and ½.
pub(crate) fn spread(k: usize) -> f64 {
    GOLDEN * k as f64 % 1.0 - 0.5
}
