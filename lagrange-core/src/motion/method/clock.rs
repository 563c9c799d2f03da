//! The times of a motion.
//!
//! Each is a number, and a step is as long as the way from one to the next: so the lengths add up to the whole,
//! however far from zero the time is, and a state belongs to the very time that it is given with. Rounded is the step
//! asked for, and always down.

use crate::number::{Real, Scalar, larger, smaller};

/// Where a motion is on its way to the end.
#[derive(Clone, Debug)]
pub(crate) struct Clock<T> {
    pub(crate) now: T,
    pub(crate) end: T,
    /// Where all steps are of one size: by how much the last may be longer, for the round-off of start, end and size.
    slack: Option<T>,
}

impl<T: Real> Clock<T> {
    pub(crate) fn new(start: T, end: T, fixed_step: Option<T>) -> Self {
        let farthest = larger(Scalar::abs(start), Scalar::abs(end));
        let round_off = T::constant(16.0 * T::EPSILON) * farthest;
        Self { now: start, end, slack: fixed_step.map(|step| smaller(round_off, step * T::constant(0.5))) }
    }

    /// The length of the next step and the time after it. It is not longer than `step`, and has no length where no
    /// time is that near. What is left for less than two steps is halved, so that no tiny one remains.
    pub(crate) fn next(&self, step: T) -> (T, T) {
        let (left, half) = (self.left(), T::constant(0.5));
        let time = match self.slack {
            _ if left <= step => self.goal(),
            Some(slack) if left - step <= slack => self.goal(),
            None if left * half < step => self.after(left * half),
            _ => self.after(step),
        };
        (time - self.now, time)
    }

    /// The way to the end, or as much of it as a number can hold.
    pub(crate) fn left(&self) -> T {
        self.goal() - self.now
    }

    /// The step, or the shortest that advances the time for sure where it is shorter than that.
    pub(crate) fn at_least(&self, step: T) -> T {
        larger(step, T::constant(T::EPSILON) * Scalar::abs(self.now))
    }

    /// Whether a step of this length leads to a later time.
    pub(crate) fn advances_by(&self, step: T) -> bool {
        self.next(step).1 > self.now
    }

    /// The end; or zero on the way, where the end is farther off than any number.
    fn goal(&self) -> T {
        if (self.end - self.now).is_finite() { self.end } else { T::constant(0.0) }
    }

    /// The last time that is not farther off than `step`.
    fn after(&self, step: T) -> T {
        let time = self.now + step;
        if time - self.now <= step {
            return time;
        }
        // From 0.6 to 1.2 of the way to the number before, and so that one.
        time - T::constant(0.6 * T::EPSILON) * Scalar::abs(time)
    }
}
