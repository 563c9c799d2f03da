//! Times of a motion.
//!
//! Each time is a floating-point number, and a step is as long as the difference of two of them. So the lengths add up
//! to the whole, however far the time is from zero, and each state belongs exactly to its time. Only the step length
//! asked for is rounded, always down.
//!
//! Backward integration mirrors forward integration with negated times, which are exact as well.

use crate::number::limits::CANCELLED;
use crate::number::{Real, Scalar, larger, smaller};

/// Current time and end of a motion.
#[derive(Clone, Debug)]
pub(crate) struct Clock<T> {
    pub(crate) now: T,
    pub(crate) end: T,
    /// 1 if the end is later than the start, −1 if it is earlier.
    direction: T,
    /// Largest magnitude of a time so far, including the end.
    farthest: T,
    /// Step length, if all steps have the same length.
    fixed_step: Option<T>,
    /// The last step may be longer than the fixed step length by this much: the round-off of the start, the end and
    /// the step length.
    slack: T,
}

impl<T: Real> Clock<T> {
    pub(crate) fn new(start: T, fixed_step: Option<T>) -> Self {
        let (zero, one) = (T::constant(0.0), T::constant(1.0));
        Self { now: start, end: start, direction: one, farthest: Scalar::abs(start), fixed_step, slack: zero }
    }

    /// Sets the end.
    pub(crate) fn aim(&mut self, end: T) {
        if end == self.end {
            return;
        }
        self.end = end;
        self.direction = T::constant(if end < self.now { -1.0 } else { 1.0 });
        self.farthest = larger(larger(self.farthest, Scalar::abs(self.now)), Scalar::abs(end));
        let round_off = T::constant(CANCELLED * T::EPSILON) * self.farthest;
        self.slack = self.fixed_step.map_or(round_off, |step| smaller(round_off, step * T::constant(0.5)));
    }

    /// Sets the current time, with the end at the same time.
    pub(crate) fn set(&mut self, now: T) {
        (self.now, self.end) = (now, now);
    }

    /// Gives a length the sign of the direction of time.
    pub(crate) fn directed(&self, length: T) -> T {
        self.direction * length
    }

    /// True if the current time is at the end or past it.
    pub(crate) fn is_at_end(&self) -> bool {
        self.directed(self.now) >= self.directed(self.end)
    }

    /// True if `time` lies ahead of the current time.
    pub(crate) fn is_ahead(&self, time: T) -> bool {
        self.directed(time) > self.directed(self.now)
    }

    /// Returns the next step, signed, and the time after it. The step is not longer than `step`; it is zero if no
    /// representable time is that near. A remainder shorter than two steps is halved, so that no tiny last step
    /// remains.
    pub(crate) fn next(&self, step: T) -> (T, T) {
        let (left, half) = (self.left(), T::constant(0.5));
        let is_fixed = self.fixed_step.is_some();
        let time = match left <= step || is_fixed && left - step <= self.slack {
            true => self.goal(),
            false if !is_fixed && left * half < step => self.after(left * half),
            false => self.after(step),
        };
        (time - self.now, time)
    }

    /// Advances the clock after a step of fixed size that was planned with length `planned`. Returns the length to plan
    /// for the next step: the size, plus the length that rounding has removed.
    pub(crate) fn tick(&mut self, (h, time): (T, T), planned: T, size: T) -> T {
        self.now = time;
        if self.is_at_end() { size } else { size + (planned - Scalar::abs(h)) }
    }

    /// Time left to the end, or to time zero if the difference overflows.
    pub(crate) fn left(&self) -> T {
        self.directed(self.goal() - self.now)
    }

    /// The larger of `step` and ε|t|, the shortest length that surely advances the time t.
    pub(crate) fn at_least(&self, step: T) -> T {
        larger(step, T::constant(T::EPSILON) * Scalar::abs(self.now))
    }

    /// True if a step of this length reaches another time.
    pub(crate) fn advances_by(&self, step: T) -> bool {
        self.is_ahead(self.next(step).1)
    }

    /// The end; time zero, which lies before it, if the distance to the end overflows.
    fn goal(&self) -> T {
        if (self.end - self.now).is_finite() { self.end } else { T::constant(0.0) }
    }

    /// The last representable time at most `step` ahead.
    fn after(&self, step: T) -> T {
        let now = self.directed(self.now);
        let time = now + step;
        if time - now <= step {
            return self.directed(time);
        }
        // 0.6 to 1.2 of the distance to the previous number: the difference rounds to that number.
        self.directed(time - T::constant(0.6 * T::EPSILON) * Scalar::abs(time))
    }
}
