//! Numbers that are evenly distributed, without randomness.

/// Golden section: the fractional parts of its multiples are evenly distributed (Knuth, *The Art of Computer Programming*, 6.4).
const GOLDEN: f64 = 0.618_033_988_749_895;

/// Returns the `k`-th of evenly distributed numbers between −½ and ½.
pub(crate) fn spread(k: usize) -> f64 {
    GOLDEN * k as f64 % 1.0 - 0.5
}

/// Numbers from −1 to 1 without a pattern (SplitMix; Steele, Lea and Flood, *OOPSLA* 2014).
pub(crate) fn scattered(place: u64) -> f64 {
    let z = place.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) as i64 as f64 / i64::MAX as f64
}
