//! Whether what was computed on lanes can be relied on.

use core::array::from_fn;

use crate::number::{Lanes, Scalar, sum};
use crate::solution::pivot::least_pivot;
use crate::system::Solution;

/// Whether the numbers of each lane can be relied on, gathered in passing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LaneReliability {
    /// The smallest pivot.
    pivot: Lanes,
    /// The sum of all magnitudes, which is a number where each is.
    size: Lanes,
}

impl LaneReliability {
    pub(crate) fn new() -> Self {
        Self { pivot: Lanes::constant(1.0), size: Lanes::constant(0.0) }
    }

    #[inline(always)]
    pub(crate) fn numbers(&mut self, numbers: &[Lanes]) {
        self.size = self.size + sum(numbers.len(), |i| numbers[i].abs());
    }

    /// A minimum may pass over what is not a number; a sum does not.
    #[inline(always)]
    fn pivot(&mut self, pivot: Lanes) {
        self.pivot = self.pivot.min(pivot);
        self.size = self.size + pivot * Lanes::constant(0.0);
    }

    #[inline(always)]
    pub(crate) fn solution<const N: usize, const M: usize>(&mut self, solution: &Solution<Lanes, N, M>) {
        self.numbers(solution.accelerations.as_slice());
        self.numbers(solution.multipliers.as_slice());
        self.pivot(solution.pivot);
    }

    /// As [`is_trustworthy`](crate::solution::pivot::is_trustworthy) of a solution alone.
    pub(crate) fn lanes(&self) -> [bool; Lanes::COUNT] {
        let (pivot, size) = (self.pivot.to_array(), self.size.to_array());
        from_fn(|lane| pivot[lane] > least_pivot::<f64>() && size[lane] < f64::INFINITY)
    }
}
