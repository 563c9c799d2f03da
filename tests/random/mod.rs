//! Numbers at random for tests, the same in every run.

use lagrange_core::State;

/// Steele, Lea and Flood's SplitMix64.
pub(crate) struct Random(pub(crate) u64);

#[allow(dead_code, reason = "not every test draws all of these")]
impl Random {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    pub(crate) fn below(&mut self, n: u64) -> usize {
        (self.bits() % n) as usize
    }

    /// Any number alike.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Between −1 and 1.
    pub(crate) fn number(&mut self) -> f64 {
        self.between(-1.0, 1.0)
    }

    pub(crate) fn vector<const K: usize>(&mut self) -> [f64; K] {
        std::array::from_fn(|_| self.number())
    }

    /// Any factor alike.
    pub(crate) fn size(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// A mass, a length or another constant that is positive.
    pub(crate) fn positive(&mut self) -> f64 {
        self.between(0.5, 2.0)
    }

    /// A number of either sign.
    pub(crate) fn signed(&mut self) -> f64 {
        self.between(-1.5, 1.5)
    }

    pub(crate) fn array<const K: usize>(&mut self, number: fn(&mut Self) -> f64) -> [f64; K] {
        std::array::from_fn(|_| number(self))
    }

    pub(crate) fn state<const N: usize>(&mut self) -> State<f64, N> {
        let (q, v) = (self.array(Self::signed), self.array(Self::signed));
        State::new(q, v).at_time(self.between(0.0, 3.0))
    }
}
