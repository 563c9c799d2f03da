//! Steps across poses at which constraints become dependent.
//!
//! The motion is smooth there, but the nearer a state is to the pose, the more rounding error its
//! coefficients contain. At a distance τ in time, the rounding error of order k grows by 1/τᵏ, and steps
//! limited by all orders never reach the pose. The series truncated after a few orders is accurate over
//! several times τ, with an error far below its terms, if it is used early enough.

use super::expansion::{Expansion, SolvedState};
use super::last::log2_roughly;
use super::settings::Taylor;
use crate::number::{Real, Scalar, larger};
use crate::solution::pivot::is_trustworthy;
use crate::vector::{FixedArray, StaticLength};

/// Signs of a nearby singular pose: an independence of the constraints, from 0 to 1, below `NEAR`, or a ratio
/// of a step to the step before below `COLLAPSE`.
const NEAR: f64 = 0.3;
const COLLAPSE: f64 = 0.5;
/// Independence below which orthogonal factors solve for the series: products of two small numbers lose too many
/// digits.
const CLOSE: f64 = 0.02;
/// Independence below which no step ends: rounding errors of the velocities are as large as the difference between
/// branches of the motion.
const NEAREST: f64 = 1e-6;
/// Largest size of each of the last [`LAST`] terms of a truncated series: a number, or a multiple of the
/// tolerance, whichever is larger.
const ERROR: [f64; 2] = [1e-12, 10.0];
const LAST: usize = 3;
/// Conditions for a step by a truncated series, as ratios of step lengths. The step must be [`WORTH`] times
/// as long as the planned step. It must also be [`ROUNDING`] times as long as a step by the full series with
/// the same error, which shows that the last coefficients are rounding errors.
const WORTH: f64 = 1.5;
const ROUNDING: f64 = 1.2;
/// Number of longer attempts after a step by a truncated series is rejected.
const LONGER: usize = 2;

impl<T: Real, N: StaticLength, M: StaticLength> SolvedState<T, N, M> {
    /// Independence of the constraints, from 0 to 1.
    fn independence(&self) -> T {
        // The diagonal of the elimination holds squares.
        let pivot = self.solution.pivot;
        if is_trustworthy(&self.solution) { Scalar::sqrt(pivot) } else { pivot }
    }

    /// True if constraints may become dependent nearby: they nearly are, or the steps shrink quickly.
    pub(super) fn is_near_dependence(&self, planned: T, before: T) -> bool {
        self.is_hardly_independent() || M::COUNT > 0 && planned < before * T::constant(COLLAPSE)
    }

    /// True if the constraints are so dependent that accelerations have large rounding errors.
    pub(super) fn is_hardly_independent(&self) -> bool {
        M::COUNT > 0 && self.independence() < T::constant(NEAR)
    }

    /// True if the constraints are so dependent that products of two small numbers lose too many digits.
    pub(super) fn is_close_to_dependence(&self) -> bool {
        M::COUNT > 0 && self.independence() < T::constant(CLOSE)
    }

    /// True if no step from this state may end at `there`, because the constraints are nearly dependent there and not
    /// here.
    pub(super) fn avoids(&self, there: &Self) -> bool {
        let is_dependent =
            |at: &Self| at.solution.rank < self.solution.rank || at.independence() < T::constant(NEAREST);
        is_dependent(there) && !is_dependent(self)
    }
}

impl Taylor {
    /// Plans a step by a truncated series, if it is much longer than the planned step.
    #[cold]
    pub(super) fn cross<S: FixedArray<T>, T: Real, N: StaticLength>(
        &self,
        series: &mut Expansion<S, T, N>,
        planned: T,
    ) -> Option<SingularStep<T>> {
        let [least, times] = ERROR;
        let error = log2_roughly(larger(least, times * self.tolerance::<T>()));
        let scales = series.scales(T::constant(self.slack::<T>()));
        let reach = |k: usize| match series.size(k, &scales).to_f64() {
            0.0 => f64::INFINITY,
            size => (error - log2_roughly(size)) / k as f64,
        };
        let reach_of_sum = |order: usize| (order + 1 - LAST..=order).map(reach).fold(f64::INFINITY, f64::min);
        let (order, reach) = (LAST..series.order())
            .map(|order| (order, reach_of_sum(order)))
            .fold((0, f64::NEG_INFINITY), |best, one| if one.1 > best.1 { one } else { best });
        let length =
            |reach: f64| Scalar::abs(series.unit) * Scalar::exp(T::constant(core::f64::consts::LN_2 * reach));
        let [by_all, length] = [reach_of_sum(series.order()), reach].map(length);
        let is_rounding = length > by_all * T::constant(ROUNDING) && length.is_finite();
        let is_worth_it = is_rounding && length > planned * T::constant(WORTH);
        is_worth_it.then(|| {
            series.summed = order;
            SingularStep { length, left: LONGER, planned }
        })
    }
}

/// A step by a truncated series, across a pose where constraints become dependent.
#[derive(Clone, Copy, Debug)]
pub(super) struct SingularStep<T> {
    pub(super) length: T,
    /// Number of longer attempts left. After a rejection near the singular pose, a longer step may pass the pose.
    left: usize,
    /// Length of the step by the full series.
    planned: T,
}

impl<T: Real> SingularStep<T> {
    /// Returns the next, longer attempt after a rejection, or the length of the step by the full series if
    /// none is left.
    pub(super) fn longer(self) -> Result<Self, T> {
        let left = self.left.checked_sub(1).ok_or(self.planned)?;
        Ok(Self { length: self.length * T::constant(WORTH), left, ..self })
    }
}
