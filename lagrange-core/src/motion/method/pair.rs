//! What distinguishes one embedded Runge–Kutta pair from another: coefficients.

use core::array::from_fn;

use crate::number::Scalar;
use crate::solution::flow::Phase;

/// The coefficients of a sum of slopes: (index of the slope, coefficient).
pub type Combination = &'static [(usize, f64)];

/// The coefficients of an explicit embedded pair with a continuous extension.
///
/// Slopes are numbered 0 at the start, then the stages, then [`LAST`](Self::LAST) at the end of the step, then the
/// stages of the interpolant.
pub trait Pair {
    /// The time of each slope as a fraction of the step.
    const NODES: &'static [f64];
    /// Each stage but the first as a sum of the slopes before it.
    const STAGES: &'static [Combination];
    /// The new state.
    const WEIGHTS: Combination;
    /// The error e that decides.
    const ERROR: Combination;
    /// A second error e′ of lower order, or nothing: the estimate is then |e|²/√(|e|² + 0.01 |e′|²) instead of |e|.
    const LOWER_ERROR: Combination;
    /// Stages that only the interpolant needs.
    const INTERPOLATION_STAGES: &'static [Combination];
    /// Coefficients of the interpolant beyond the fourth.
    const INTERPOLATION: &'static [Combination];
    /// The estimate behaves as this power of the step.
    const ORDER: f64;
    /// Weight of the previous error in the choice of the step (β of the PI controller).
    const DAMPING: f64;
    /// The slope at the end of the step.
    const LAST: usize = Self::STAGES.len() + 1;
    /// The new step is at least this times the old one …
    const SHRINK: f64;
    /// … and at most this times.
    const GROWTH: f64;

    /// Whether the error can be had only with the slope at the end of the step.
    #[inline]
    fn error_needs_last() -> bool {
        Self::ERROR.iter().any(|(slope, _)| *slope == Self::LAST)
    }
}

/// Room for the slopes of the longest method here.
pub(crate) const SLOPES: usize = 16;

/// The slopes (q̇, q̈) of a step.
pub(crate) type Slopes<T, const N: usize> = [Phase<T, N>; SLOPES];

/// start + h Σ cᵢ slopeᵢ.
#[inline]
pub(crate) fn advance<T: Scalar, const N: usize>(
    start: &Phase<T, N>,
    h: T,
    slopes: &Slopes<T, N>,
    row: &[(usize, f64)],
) -> Phase<T, N> {
    let sum = combine(slopes, row);
    from_fn(|half| from_fn(|i| start[half][i] + h * sum[half][i]))
}

#[inline]
pub(crate) fn combine<T: Scalar, const N: usize>(slopes: &Slopes<T, N>, row: &[(usize, f64)]) -> Phase<T, N> {
    let mut sum = [[T::constant(0.0); N]; 2];
    for (index, coefficient) in row {
        let coefficient = T::constant(*coefficient);
        for half in 0..2 {
            for i in 0..N {
                sum[half][i] = sum[half][i] + coefficient * slopes[*index][half][i];
            }
        }
    }
    sum
}
