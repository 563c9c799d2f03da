//! Reliability of results computed on lanes.

use crate::number::{Lanes, Scalar, sum};
use crate::solution::pivot::least_pivot;
use crate::system::Solution;
use crate::vector::{StaticLength, from_fn};

/// Collects, during a step, the evidence whether the numbers of each lane are reliable.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LaneReliability {
    /// Smallest pivot of each lane.
    pivot: Lanes,
    /// Sum of all magnitudes, finite if and only if all numbers are.
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

    /// Records a pivot. `min` may ignore NaN, so the sum records it as well.
    #[inline(always)]
    fn pivot(&mut self, pivot: Lanes) {
        self.pivot = self.pivot.min(pivot);
        self.size = self.size + pivot * Lanes::constant(0.0);
    }

    #[inline(always)]
    pub(crate) fn solution<N: StaticLength, M: StaticLength>(&mut self, solution: &Solution<Lanes, N, M>) {
        self.numbers(solution.accelerations.as_slice());
        self.numbers(solution.multipliers.as_slice());
        self.pivot(solution.pivot);
    }

    /// True for reliable lanes, by the criterion of [`is_trustworthy`](crate::solution::pivot::is_trustworthy) for
    /// scalars.
    pub(crate) fn lanes(&self) -> [bool; Lanes::COUNT] {
        let (pivot, size) = (self.pivot.to_array(), self.size.to_array());
        from_fn(|lane| pivot[lane] > least_pivot::<f64>() && size[lane] < f64::INFINITY)
    }
}
