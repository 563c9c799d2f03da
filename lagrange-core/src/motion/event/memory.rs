//! Settings of an event, and the state of its search from step to step.

use super::chebyshev::{Samples, Shape};
use crate::error::Ending;
use crate::motion::limits::{CLOSE_CROSSINGS, COARSEST, FINEST, NOISE, RESOLVED};
use crate::motion::run::is_between;
use crate::number::limits::ACCUMULATED;
use crate::number::{Parts, Real, Scalar, larger, power_of_epsilon, smaller};
use crate::solution::limits::MARGIN;

/// Direction of the crossings to report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CrossingDirection {
    Rising,
    Falling,
    Both,
}

/// Settings of an event, and the state of its search from step to step.
#[derive(Clone, Debug)]
pub struct EventState<T> {
    pub(super) name: &'static str,
    pub(super) direction: CrossingDirection,
    /// Minimum number of parts in which a step is searched.
    pub(super) subdivisions: usize,
    /// Number of the crossing that ends a run.
    pub(super) terminal: Option<usize>,
    /// True if the function is that of a condition, positive at the start of a run, and a crossing the last state at which it is not
    /// negative.
    pub(super) is_condition: bool,
    /// Number of crossings in this run; in a steered motion, since its start.
    pub(super) count: usize,
    /// Crossings of earlier legs, from which the next run counts on, and its `round_off`.
    earlier: Option<(usize, T)>,
    /// Round-off of the function by the largest entries of the motion, where it is a leg of one; else zero.
    round_off: T,
    /// Value with the current sign of the function. Zero if the motion started at a zero and has not left it.
    pub(super) value: T,
    /// True if the function has one sign over the next step, which is then not searched for it.
    is_away: bool,
    /// True if steps have been passed without a search.
    is_behind: bool,
    /// New `value` for the search after the interval, if no event crosses within it.
    pub(super) next: T,
    /// Samples of the function on the interval, from its start.
    pub(super) samples: Samples<T>,
    /// Decision about the function on the interval.
    pub(super) view: View,
    /// Magnitude that the function may have at a zero, in addition to its noise. `Some` from a start at a zero or from
    /// a crossing on, until the function has left the zero.
    pub(super) start: Option<T>,
    /// Magnitude below which a value at the end of the interval does not count as a change of sign.
    pub(super) noise: T,
    /// Chebyshev degree that the function has needed per unit of time.
    density: Option<T>,
    /// Chebyshev degree per unit of time that the last interval needed.
    needed: Option<T>,
    /// Width of the interval that the degree is known of.
    searched: T,
    /// Direction of a crossing that coincides with one of another event reported first: true if rising.
    pub(super) due: Option<bool>,
    /// Time at which the search began.
    begun: Option<T>,
    /// Time up to which the motion has been searched.
    until: Option<T>,
    /// Time of the last crossing.
    last: Option<T>,
    /// Magnitude of the function at the last crossing.
    left: T,
    /// True if the function has changed its sign, counted or not, and has been within its round-off since.
    has_turned: bool,
    /// True if the state or the system has been set since the last crossing.
    is_new: bool,
    /// Longest interval of time between two crossings, or up to the first.
    longest: T,
    /// Number of short intervals in a row; an interval from a changed state or system counts three times.
    short: usize,
}

/// An interval to search.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interval<T> {
    /// Length of the interval, in units of time.
    pub(super) width: T,
    /// Round-off of the time, in halves of the width.
    pub(super) jitter: T,
    /// Highest Chebyshev degree to use.
    pub(super) finest: usize,
    /// True if the interval is at least an eighth of the step.
    pub(super) is_wide: bool,
}

/// Decision about a function on an interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum View {
    /// The function crosses zero at most once.
    Plain,
    /// The function may cross zero more than once.
    Bent,
    /// Undecided at this degree.
    Open,
    /// Undecided at this degree; the samples may be all noise.
    Rough,
}

impl<T> EventState<T> {
    /// True if the function crosses zero at most once on this interval.
    #[inline]
    pub(super) fn is_known(&self) -> bool {
        self.view == View::Plain
    }
}

impl<T: Real> EventState<T> {
    pub(super) fn new(name: &'static str) -> Self {
        let zero = T::constant(0.0);
        Self {
            name,
            direction: CrossingDirection::Both,
            subdivisions: 1,
            terminal: None,
            is_condition: false,
            count: 0,
            earlier: None,
            round_off: zero,
            value: zero,
            is_away: false,
            is_behind: false,
            next: zero,
            samples: [zero; FINEST + 1],
            view: View::Open,
            start: None,
            noise: zero,
            density: None,
            needed: None,
            searched: zero,
            due: None,
            begun: None,
            until: None,
            last: None,
            left: zero,
            has_turned: false,
            is_new: true,
            longest: zero,
            short: 0,
        }
    }

    /// Copy of the settings, without the history.
    pub(super) fn anew(&self) -> Self {
        let Self { name, direction, subdivisions, terminal, is_condition, .. } = *self;
        Self { direction, subdivisions, terminal, is_condition, ..Self::new(name) }
    }

    /// Restarts the count of crossings for a new run.
    pub(super) fn begin_run(&mut self) {
        (self.count, self.round_off) = self.earlier.take().unwrap_or((0, T::constant(0.0)));
    }

    /// Makes the next run a leg of a motion, with this round-off of the function. After the first leg, crossings are counted on;
    /// between legs that are limited in number, they may be as close as they like. A leg may be as short as the last bounce, and
    /// the next one long: the degree that the function needs is learnt anew.
    pub(super) fn begin_leg(&mut self, is_first: bool, round_off: T) {
        (self.earlier, self.short) = (Some((if is_first { 0 } else { self.count }, round_off)), 0);
        (self.density, self.needed) = (None, None);
    }

    /// Arrives at the end of a leg. The event crosses there if its function has come down, or up, to its round-off, and
    /// has not crossed just before.
    pub(super) fn arrive_at_end(&mut self, value: T, noise: T) {
        let zero = T::constant(0.0);
        if self.start.is_none() && !self.has_turned && Scalar::abs(value) <= noise {
            self.next = zero;
            if self.crosses() {
                (self.due, self.left) = (Some(self.value < zero), Scalar::abs(value));
            }
        }
    }

    /// Sets the function's value where a search begins. `start` is its noise if no step led here. The function then
    /// counts as zero if it exceeds neither its noise nor, after a crossing at this time, its magnitude there. A motion
    /// that does not continue from the last crossing is a different one, and the history is dropped.
    pub(super) fn begin(&mut self, value: T, t: T, start: Option<T>) {
        let last = self.last.or(Some(t));
        let is_another = !self.begun.zip(last).is_some_and(|(begun, last)| is_between(begun, last, t));
        if start.is_some() && is_another {
            *self = self.anew();
        }
        let goes_on = start.is_none() && self.until == Some(t);
        self.is_new = start.is_some();
        self.begun = self.begun.or(Some(t));
        self.until = Some(t);
        self.samples[0] = value;
        if !goes_on {
            let noise = larger(start.unwrap_or(T::constant(0.0)), self.round_off);
            // Limited by the noise: after a crossing at a jump or a pole, the recorded magnitude may be large, and a
            // value below it is no zero.
            let left = smaller(self.left + self.left, noise * T::constant(MARGIN));
            let left = if self.last == Some(t) { left } else { T::constant(0.0) };
            let is_at_zero = start.is_some() && !self.is_condition && Scalar::abs(value) <= noise + left;
            self.start = is_at_zero.then_some(left);
            self.value = if is_at_zero { T::constant(0.0) } else { value };
            if start.is_some() && self.is_condition {
                self.value = larger(value, T::constant(T::SMALLEST));
            }
        }
    }

    /// True if the search began at this time.
    pub(super) fn begins_at(&self, t: T) -> bool {
        self.begun == Some(t)
    }

    /// Passes the next step, of this width, without a search, if the function has one sign there, as `is_away` tells; if a
    /// search would be content with its lowest degree; and if the step is at most twice as wide as the last one searched: where
    /// no acceleration tells of a force, steps grow until they pass over all of it.
    #[inline]
    pub(crate) fn stay_away(&mut self, is_away: bool, width: T) {
        self.learn_density();
        let is_coarse = |density: T| density * width <= T::constant(2.0 * COARSEST as f64);
        let has_grown = width > T::constant(2.0) * self.searched;
        self.is_away = is_away && !has_grown && self.density.is_some_and(is_coarse);
        self.is_behind |= self.is_away;
    }

    pub(super) fn is_away(&self) -> bool {
        self.is_away
    }

    /// True, once, if the search of a step must begin anew after steps without one.
    pub(super) fn wakes(&mut self) -> bool {
        core::mem::take(&mut self.is_behind)
    }

    /// Begins the search of an interval; `None` if it may not be divided. Returns true if the interval is too wide for
    /// the highest degree.
    #[inline]
    pub(super) fn open(&mut self, interval: Option<&Interval<T>>) -> bool {
        (self.view, self.noise) = (View::Open, T::constant(0.0));
        self.learn_density();
        let is_too_wide = |interval: &Interval<T>| self.least(interval) > T::constant(FINEST as f64);
        interval.is_some_and(|interval| interval.is_wide && self.density.is_some() && is_too_wide(interval))
    }

    /// Takes note of the degree that the last interval needed.
    #[inline]
    fn learn_density(&mut self) {
        if let Some(needed) = self.needed.take() {
            let before = self.density.map_or(needed, |density| density * T::constant(0.5));
            self.density = Some(larger(needed, before));
        }
    }

    /// Decides on the function by its samples of this degree, unless it is already decided.
    #[inline]
    pub(super) fn judge(&mut self, degree: usize, interval: &Interval<T>) -> View {
        if self.is_known() {
            return View::Plain;
        }
        if T::constant(degree as f64) < self.least(interval) {
            self.view = View::Open;
            return View::Open;
        }
        let shape = Shape::of(&self.samples, degree);
        if self.round_off > T::constant(0.0) && shape.most <= self.round_off {
            (self.view, self.noise) = (View::Plain, self.round_off);
            return View::Plain;
        }
        self.view = match () {
            () if shape.is_plain(interval.jitter) || self.is_infinite(degree) => View::Plain,
            () if shape.is_rough() => View::Rough,
            () if shape.is_bent() => View::Bent,
            () => View::Open,
        };
        if interval.is_wide {
            self.learn(&shape, interval);
        }
        self.view
    }

    /// True if all samples of this degree are the same infinity: the function is as constant as these samples tell.
    #[inline]
    fn is_infinite(&self, degree: usize) -> bool {
        let first = self.samples[0];
        let mut samples = self.samples.iter().step_by(FINEST / degree);
        !Parts::is_finite(first) && samples.all(|sample| *sample == first)
    }

    /// Lowest degree worth evaluating on this interval: half the degree needed on the last steps.
    #[inline]
    fn least(&self, interval: &Interval<T>) -> T {
        match self.density {
            None => T::constant(interval.finest.min(FINEST / 2) as f64),
            Some(density) => density * interval.width * T::constant(0.5),
        }
    }

    /// Records the degree that the function needs. Degree 1 if the function is far from zero compared with its
    /// variation.
    #[inline]
    fn learn(&mut self, shape: &Shape<T>, interval: &Interval<T>) {
        let order = match self.view {
            View::Open | View::Rough => 2.0 * FINEST as f64,
            _ if shape.swing * T::constant(RESOLVED) < shape.most => 1.0,
            _ => shape.order as f64,
        };
        (self.needed, self.searched) = (Some(T::constant(order) / interval.width), interval.width);
    }

    /// Adds noise to that below which a value does not count as a change of sign.
    pub(super) fn add_noise(&mut self, noise: T) {
        self.noise = larger(self.noise, larger(noise, self.round_off));
    }

    /// Decides on samples that may be all noise, given the magnitude of the noise.
    pub(super) fn judge_noise(&mut self, degree: usize, noise: T) -> View {
        let (shape, noise) = (Shape::of(&self.samples, degree), larger(noise, self.round_off));
        let part = noise * T::constant(NOISE);
        self.view = match () {
            () if shape.most <= noise => View::Plain,
            () if shape.is_beyond(part) => View::Plain,
            () if shape.tail <= part => View::Bent,
            () => View::Open,
        };
        if shape.most <= noise {
            (self.noise, self.needed) = (noise, None);
        }
        self.view
    }

    /// Records the value of the event function at the end of the interval. A value within the noise does not
    /// count as a change of sign: the function keeps the sign that it had at the start. If it had none, it has that of the
    /// samples between, where it has left the zero of the start.
    #[inline]
    pub(super) fn look(&mut self, value: T) {
        let is_noise =
            Scalar::abs(value) < self.noise || self.start.is_some() && Scalar::abs(value) <= self.noise;
        self.next = match is_noise {
            true if self.value == T::constant(0.0) => self.sign_between(),
            true => self.value,
            false => value,
        };
        self.samples[FINEST] = value;
    }

    /// A sample between the ends that exceeds the noise; zero if there is none. On an interval where the function crosses
    /// zero at most once, and is zero at both ends, all of them have one sign.
    #[cold]
    fn sign_between(&self) -> T {
        let between = [1, 2, 3].map(|quarter| self.samples[quarter * FINEST / 4]);
        let exceeds = |sample: &T| self.is_known() && Scalar::abs(*sample) > self.noise;
        between.into_iter().find(exceeds).unwrap_or(T::constant(0.0))
    }

    /// Continues the search from the end of the interval, at time `t`.
    #[inline]
    pub(super) fn go_on(&mut self, t: T) {
        let (size, zero) = (Scalar::abs(self.samples[FINEST]), T::constant(0.0));
        if size > self.noise {
            self.start = None;
        }
        let turns = self.value < zero && self.next > zero || self.value > zero && self.next < zero;
        self.has_turned = turns || self.has_turned && size <= self.round_off;
        (self.value, self.samples[0], self.until) = (self.next, self.samples[FINEST], Some(t));
    }

    /// Moves to a crossing of some event. This event crosses there if `has_crossed`, whatever its function returns when
    /// it is evaluated again, or if its value there has changed sign.
    pub(super) fn arrive(&mut self, value: T, t: T, has_crossed: bool) {
        if has_crossed {
            self.noise = T::constant(0.0);
        }
        self.look(value);
        if has_crossed || self.crosses() {
            (self.due, self.left) = (Some(self.value < T::constant(0.0)), Scalar::abs(value));
        }
        self.go_on(t);
        if has_crossed {
            // The function keeps its new sign until its magnitude exceeds its round-off.
            self.start = Some(T::constant(0.0));
        }
    }

    /// True if the function crosses zero until the end of the interval, in the direction of the event.
    #[inline]
    pub(super) fn crosses(&self) -> bool {
        let zero = T::constant(0.0);
        let rises = self.value < zero && self.next >= zero;
        let falls = self.value > zero && self.next <= zero;
        match self.direction {
            CrossingDirection::Rising => rises,
            CrossingDirection::Falling => falls,
            CrossingDirection::Both => rises || falls,
        }
    }

    /// Counts a crossing, and detects accumulating ones.
    pub(super) fn cross(&mut self, t: T) -> Result<(), Ending> {
        self.count += 1;
        if let Some(last) = self.last.or(self.begun) {
            let interval = Scalar::abs(t - last);
            let round_off = Scalar::abs(t) * T::constant(ACCUMULATED * T::EPSILON);
            let least = larger(self.longest * power_of_epsilon(0.5), round_off);
            let weight = if self.is_new { CLOSE_CROSSINGS / 2 } else { 1 };
            self.short = if interval <= least { self.short + weight } else { 0 };
            self.longest = larger(self.longest, interval);
        }
        (self.last, self.is_new) = (Some(t), false);
        match self.short < CLOSE_CROSSINGS {
            true => Ok(()),
            false => Err(Ending::EventsAccumulate { time: t.to_f64(), event: self.name }),
        }
    }

    /// True if the last crossing ends the run.
    pub(super) fn is_terminal(&self) -> bool {
        self.terminal.is_some_and(|count| self.count >= count)
    }
}
