//! The order of the series and the length of a step.

use super::expansion::SolvedState;
use super::last::{LAST, STEP};
use super::settings::Taylor;
use crate::motion::method::clock::Clock;
use crate::motion::method::control::{FIRST, Tolerance};
use crate::number::{ROOM, Real, Scalar, larger, smaller};
use crate::system::State;

/// What is left out is e to minus this, as a part of the tolerance: errors are those of Jorba and Zou's order (3-11) with
/// their steps, or half of them.
const LEFT_OUT: f64 = 5.0;

impl Taylor {
    /// The tolerance, as far as the numbers go.
    pub(crate) fn tolerance<T: Real>(&self) -> f64 {
        self.relative.max(T::EPSILON)
    }

    /// The order with which the first term that is left out, by the length of a [step](STEP), is that part of the tolerance.
    pub(crate) fn order<T: Real>(&self) -> usize {
        let order = (LEFT_OUT - Scalar::ln(T::constant(self.tolerance::<T>())).to_f64()) / STEP;
        (larger(order, LAST as f64) as usize).min(ROOM - 2)
    }

    /// The longest first step, as of embedded pairs (Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, II.4):
    /// it moves the state by its size at most.
    pub(crate) fn first<T: Real, const N: usize, const M: usize>(
        &self,
        state: &State<T, N>,
        solved: &SolvedState<T, N, M>,
        span: T,
    ) -> T {
        let tolerance = Tolerance { relative: self.tolerance::<T>(), absolute: self.absolute };
        let y = [state.q.into(), state.v.into()];
        let slope = [state.v.into(), solved.solution.accelerations.into()];
        self.limited(smaller(T::constant(FIRST) * tolerance.guess_step(&y, &slope, span), span))
    }

    /// Absolute tolerance as a fraction of the relative one, added to the size of each entry.
    pub(crate) fn slack<T: Real>(&self) -> f64 {
        self.absolute / self.tolerance::<T>()
    }

    /// The length of the next step, by what the last coefficients allow, the longest that the step before allows, and the time
    /// that is left.
    pub(crate) fn choose<T: Real>(&self, allowed: T, longest: T, clock: &Clock<T>) -> T {
        let step = smaller(if allowed.is_finite() { allowed } else { clock.left() }, longest);
        let step = if step > T::constant(0.0) { clock.at_least(step) } else { clock.left() };
        self.limited(step)
    }

    /// No longer than the user allows.
    pub(crate) fn limited<T: Real>(&self, step: T) -> T {
        self.max_step.map_or(step, |longest| smaller(step, T::constant(longest)))
    }
}
