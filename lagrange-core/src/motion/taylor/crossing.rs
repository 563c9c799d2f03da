//! Steps across poses at which constraints become dependent.
//!
//! The motion is smooth there, but the nearer a state is to the pose, the more rounding error its
//! coefficients contain. At a distance τ in time, the rounding error of order k grows by 1/τᵏ, and steps
//! limited by all orders never reach the pose. The series truncated after a few orders is accurate over
//! several times τ, with an error far below its terms, if it is used early enough.

use super::expansion::{Expansion, SolvedState};
use super::last::log2_roughly;
use super::limits::LAST;
use super::settings::Taylor;
use crate::number::{Real, Scalar, power_of_epsilon};
use crate::solution::pivot::least_pivot;
use crate::vector::{FixedArray, StaticLength};

impl<T: Real, N: StaticLength, M: StaticLength> SolvedState<T, N, M> {
    /// True if no step from this state may end at `there`: the constraints are nearly dependent there and not here, so
    /// rounding errors of the velocities are as large as the difference between branches of the motion.
    pub(super) fn avoids(&self, there: &Self) -> bool {
        let is_dependent =
            |at: &Self| at.solution.rank < self.solution.rank || at.solution.pivot < least_pivot();
        is_dependent(there) && !is_dependent(self)
    }
}

impl<S: FixedArray<T>, T: Scalar, N: StaticLength> Expansion<S, T, N> {
    /// True if orders are left out because they are rounding errors.
    pub(super) fn is_truncated(&self) -> bool {
        self.summed < self.order()
    }
}

impl Taylor {
    /// Truncates a series after the order that makes the step longest, if that is longer than the planned step. Returns
    /// the length of the step. The last terms over it are at most the tolerance, or ε^¾: smaller ones are rounding
    /// errors themselves.
    #[cold]
    pub(super) fn truncate<S: FixedArray<T>, T: Real, N: StaticLength>(
        &self,
        series: &mut Expansion<S, T, N>,
        planned: T,
    ) -> T {
        let error = log2_roughly(self.tolerance::<T>().max(power_of_epsilon::<T>(0.75).to_f64()));
        let scales = series.scales(T::constant(self.slack::<T>()));
        let reach = |k: usize| match series.size(k, &scales).to_f64() {
            0.0 => f64::INFINITY,
            size => (error - log2_roughly(size)) / k as f64,
        };
        let reach_of_sum = |order: usize| (order + 1 - LAST..=order).map(reach).fold(f64::INFINITY, f64::min);
        let (order, reach) = (LAST..=series.order())
            .map(|order| (order, reach_of_sum(order)))
            .fold((0, f64::NEG_INFINITY), |best, one| if one.1 > best.1 { one } else { best });
        let length = Scalar::abs(series.unit) * Scalar::exp(T::constant(core::f64::consts::LN_2 * reach));
        if order == series.order() || !length.is_finite() || length < planned {
            return planned;
        }
        series.summed = order;
        length
    }
}
