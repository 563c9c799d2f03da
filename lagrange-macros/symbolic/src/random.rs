//! Reproducible pseudorandom numbers.

use super::graph::Symbol;

/// Random value of `symbol` in the given range, the same for each use within one draw.
pub fn drawn(symbol: Symbol, (low, high): (f64, f64), draw: u64) -> f64 {
    low + (high - low) * random(u64::from(symbol.family), u64::from(symbol.index), draw)
}

/// Pseudorandom number in [0, 1), determined by the arguments alone (Steele, Lea and Flood's SplitMix64).
pub fn random(family: u64, index: u64, draw: u64) -> f64 {
    let mut z = (family << 56) ^ (index << 16) ^ draw;
    for _ in 0..2 {
        z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
    }
    (z >> 11) as f64 / (1_u64 << 53) as f64
}
