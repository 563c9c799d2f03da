//! Reproducible random numbers.

use std::ops::Range;

use lagrange_core::State;

/// SplitMix64 (Steele, Lea and Flood 2014).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// Uniform in `range`.
    pub(crate) fn within(&mut self, range: Range<f64>) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        range.start + (range.end - range.start) * (z >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A mass, a length or another constant that is positive.
    pub(crate) fn positive(&mut self) -> f64 {
        self.within(0.5..2.0)
    }

    /// A number of either sign.
    pub(crate) fn signed(&mut self) -> f64 {
        self.within(-1.5..1.5)
    }

    pub(crate) fn array<const K: usize>(&mut self, number: fn(&mut Self) -> f64) -> [f64; K] {
        std::array::from_fn(|_| number(self))
    }

    pub(crate) fn state<const N: usize>(&mut self) -> State<f64, N> {
        let (q, v) = (self.array(Self::signed), self.array(Self::signed));
        State::new(q, v).at_time(self.within(0.0..3.0))
    }
}
