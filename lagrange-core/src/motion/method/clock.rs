//! The times of a motion.
//!
//! Each is a number, and a step is as long as the way from one to the next: so the lengths add up to the whole,
//! however far from zero the time is, and a state belongs to the very time that it is given with. Rounded is the step
//! asked for, and always down.
//!
//! Backwards everything is as forwards with the negatives of the times, which are numbers as well.

use crate::number::{Real, Scalar, larger, smaller};

/// Where a motion is on its way to the end.
#[derive(Clone, Debug)]
pub(crate) struct Clock<T> {
    pub(crate) now: T,
    pub(crate) end: T,
    /// 1 where the end is later, −1 where it is earlier.
    direction: T,
    /// The largest time so far, in magnitude, that of the end included.
    farthest: T,
    /// Where all steps are of one size, that.
    fixed_step: Option<T>,
    /// By how much the last of these may be longer, for the round-off of start, end and size.
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
        let round_off = T::constant(16.0 * T::EPSILON) * self.farthest;
        self.slack = self.fixed_step.map_or(round_off, |step| smaller(round_off, step * T::constant(0.5)));
    }

    /// Goes on from this time, with no way to go yet.
    pub(crate) fn set(&mut self, now: T) {
        (self.now, self.end) = (now, now);
    }

    /// A length in the direction of time.
    pub(crate) fn directed(&self, length: T) -> T {
        self.direction * length
    }

    /// Whether there is no way left.
    pub(crate) fn is_at_end(&self) -> bool {
        self.directed(self.now) >= self.directed(self.end)
    }

    /// Whether this time lies ahead.
    pub(crate) fn is_ahead(&self, time: T) -> bool {
        self.directed(time) > self.directed(self.now)
    }

    /// The next step, signed, and the time after it. It is not longer than `step`, and has no length where no
    /// time is that near. What is left for less than two steps is halved, so that no tiny one remains.
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

    /// After a step to this time where all are of one size, and this one was planned so long: the length to plan for the
    /// next, with what the rounding of the time has taken given back.
    pub(crate) fn tick(&mut self, (h, time): (T, T), planned: T, size: T) -> T {
        self.now = time;
        if self.is_at_end() { size } else { size + (planned - Scalar::abs(h)) }
    }

    /// The length of the way to the end, or as much of it as a number can hold.
    pub(crate) fn left(&self) -> T {
        self.directed(self.goal() - self.now)
    }

    /// The step, or the shortest that advances the time for sure where it is shorter than that.
    pub(crate) fn at_least(&self, step: T) -> T {
        larger(step, T::constant(T::EPSILON) * Scalar::abs(self.now))
    }

    /// Whether a step of this length leads to another time.
    pub(crate) fn advances_by(&self, step: T) -> bool {
        self.is_ahead(self.next(step).1)
    }

    /// The end; or zero on the way, where the end is farther off than any number.
    fn goal(&self) -> T {
        if (self.end - self.now).is_finite() { self.end } else { T::constant(0.0) }
    }

    /// The last time that is not farther off than `step`.
    fn after(&self, step: T) -> T {
        let now = self.directed(self.now);
        let time = now + step;
        if time - now <= step {
            return self.directed(time);
        }
        // From 0.6 to 1.2 of the way to the number before, and so that one.
        self.directed(time - T::constant(0.6 * T::EPSILON) * Scalar::abs(time))
    }
}
