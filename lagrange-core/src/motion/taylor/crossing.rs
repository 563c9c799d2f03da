//! Steps across poses at which constraints become dependent.
//!
//! The motion is smooth there, but the nearer a state is, the more of its coefficients is rounding: those of order k grow by it
//! as 1/τᵏ, if the pose is τ ahead, and a step that heeds them all never gets there. Of few orders a sum is good for several
//! times τ, with an error that is far below the terms, if it is taken in time.

use super::expansion::{Expansion, SolvedState};
use super::last::log2_roughly;
use super::settings::Taylor;
use crate::number::{FixedArray, Real, Scalar, larger};
use crate::solution::pivot::is_trustworthy;

/// How independent constraints are, from 0 to 1, where a pose may be near, or steps may have become so much shorter.
const NEAR: f64 = 0.3;
const COLLAPSE: f64 = 0.5;
/// Below, the series is solved for by orthogonal factors: products of two small numbers lose too many digits.
const CLOSE: f64 = 0.02;
/// Below, no step ends: rounding errors of the velocities are as large as what tells one branch of the motion from another.
const NEAREST: f64 = 1e-6;
/// A sum of fewer orders may have this error, or so many times the tolerance, of each of its last terms.
const ERROR: [f64; 2] = [1e-12, 10.0];
const LAST: usize = 3;
/// It is taken where it reaches so many times as far as a step by all orders, and so many times as far as that with the same
/// error, which tells that the last coefficients are rounding.
const WORTH: f64 = 1.5;
const ROUNDING: f64 = 1.2;
/// So many times it is tried longer where it was refused.
const LONGER: usize = 2;

impl<T: Real, const N: usize, const M: usize> SolvedState<T, N, M> {
    /// How independent the constraints are, from 0 to 1.
    fn independence(&self) -> T {
        // The elimination has squares on its diagonal.
        let pivot = self.solution.pivot;
        if is_trustworthy(&self.solution) { Scalar::sqrt(pivot) } else { pivot }
    }

    /// Whether a pose may be near at which the constraints become dependent: they almost are, or steps become so much shorter.
    pub(super) fn is_near_dependence(&self, planned: T, before: T) -> bool {
        self.is_hardly_independent() || M > 0 && planned < before * T::constant(COLLAPSE)
    }

    /// Whether the constraints are so dependent that rounding errors of accelerations are many.
    pub(super) fn is_hardly_independent(&self) -> bool {
        M > 0 && self.independence() < T::constant(NEAR)
    }

    /// Whether it is so near that products of two small numbers lose too many digits.
    pub(super) fn is_close_to_dependence(&self) -> bool {
        M > 0 && self.independence() < T::constant(CLOSE)
    }

    /// Whether from here no step is to end there, because constraints are all but dependent there alone.
    pub(super) fn avoids(&self, there: &Self) -> bool {
        let is_dependent =
            |at: &Self| at.solution.rank < self.solution.rank || at.independence() < T::constant(NEAREST);
        is_dependent(there) && !is_dependent(self)
    }
}

impl Taylor {
    /// Sums fewer orders, if that leads much farther than this step.
    #[cold]
    pub(super) fn cross<S: FixedArray<T>, T: Real, const N: usize>(
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

/// A step by fewer orders.
#[derive(Clone, Copy, Debug)]
pub(super) struct SingularStep<T> {
    pub(super) length: T,
    /// So many times it may still be tried longer: where it was refused, it ended near the pose.
    left: usize,
    /// The step by all orders.
    planned: T,
}

impl<T: Real> SingularStep<T> {
    /// The next to try after this one was refused; the step by all orders where none is left.
    pub(super) fn longer(self) -> Result<Self, T> {
        let left = self.left.checked_sub(1).ok_or(self.planned)?;
        Ok(Self { length: self.length * T::constant(WORTH), left, ..self })
    }
}
