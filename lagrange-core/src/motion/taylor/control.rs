//! Order of the series and step length of Taylor's method.

use super::expansion::SolvedState;
use super::limits::{LAST, STEP};
use super::settings::Taylor;
use crate::motion::limits::FIRST;
use crate::motion::method::clock::Clock;
use crate::motion::method::control::Tolerance;
use crate::number::{ROOM, Real, Scalar, larger, smaller};
use crate::system::State;
use crate::vector::{PhaseVector, StaticLength};

impl Taylor {
    /// Requested relative tolerance, at least ε.
    pub(crate) fn tolerance<T: Real>(&self) -> f64 {
        self.relative.max(T::EPSILON)
    }

    /// Order of the series: each of the last coefficients, from order p + 1 − [`LAST`] on, makes a term of at most the
    /// tolerance over the length of a [step](STEP).
    pub(crate) fn order<T: Real>(&self) -> usize {
        let decay = -Scalar::ln(T::constant(self.tolerance::<T>())).to_f64() / STEP;
        (larger((LAST - 1) as f64 + decay, LAST as f64) as usize).min(ROOM - 2)
    }

    /// Largest first step, as for embedded pairs (Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations
    /// I*, II.4): it changes the state by at most its size.
    pub(crate) fn first<T: Real, N: StaticLength, M: StaticLength>(
        &self,
        state: &State<T, N>,
        solved: &SolvedState<T, N, M>,
        span: T,
    ) -> T {
        let tolerance = Tolerance { relative: self.tolerance::<T>(), absolute: self.absolute };
        let y = PhaseVector::of(state.q, state.v);
        let slope = PhaseVector::of(state.v, solved.solution.accelerations);
        self.limited(smaller(T::constant(FIRST) * tolerance.guess_step(&y, &slope, span), span))
    }

    /// Absolute tolerance as a fraction of the relative one, added to the size of each entry.
    pub(crate) fn slack<T: Real>(&self) -> f64 {
        self.absolute / self.tolerance::<T>()
    }

    /// Length of the next step, from the length `allowed` by the last coefficients, the limit `longest` set by the step
    /// before, and the time left.
    pub(crate) fn choose<T: Real>(&self, allowed: T, longest: T, clock: &Clock<T>) -> T {
        let step = smaller(if allowed.is_finite() { allowed } else { clock.left() }, longest);
        let step = if step > T::constant(0.0) { clock.at_least(step) } else { clock.left() };
        self.limited(step)
    }

    /// The step, at most `max_step`.
    pub(crate) fn limited<T: Real>(&self, step: T) -> T {
        self.max_step.map_or(step, |longest| smaller(step, T::constant(longest)))
    }
}
