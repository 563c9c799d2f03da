//! Reproducible random numbers.

#[path = "../random/mod.rs"]
mod numbers;

use lagrange_core::State;
pub(crate) use numbers::Random;

impl Random {
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
