//! What an event is about, and what is known of it from step to step.

use super::chebyshev::{FINEST, Samples, Shape};
use crate::error::Ending;
use crate::motion::run::is_between;
use crate::number::{Real, Scalar, larger, smaller};

/// Which crossings an event is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CrossingDirection {
    Rising,
    Falling,
    Both,
}

/// What an event is about, and what is known of it from step to step.
#[derive(Clone, Debug)]
pub struct EventState<T> {
    pub(super) name: &'static str,
    pub(super) direction: CrossingDirection,
    /// How many subdivisions a step is looked at in, at least.
    pub(super) subdivisions: usize,
    /// The crossing at which a run ends.
    pub(super) terminal: Option<usize>,
    /// How many there were in this run, or in this motion where it is steered.
    pub(super) count: usize,
    /// The function on the side where the search is; zero where the motion starts at a zero, and has not left it.
    pub(super) value: T,
    /// The same at the end of the interval, where the search goes on from unless something crosses before.
    pub(super) next: T,
    /// The function on the interval, from its start.
    pub(super) samples: Samples<T>,
    /// What is to be known of the function on the interval.
    pub(super) view: View,
    /// What the function may be where the motion starts at a zero or has just crossed one, beside its noise, as long as it has not
    /// left that.
    pub(super) start: Option<T>,
    /// What counts as no change of side at the end of the interval.
    pub(super) noise: T,
    /// The degree that the function has taken for each unit of time.
    density: Option<T>,
    /// The same by the interval looked at last.
    needed: Option<T>,
    /// Crossed together with another event that was reported first: whether it rose.
    pub(super) due: Option<bool>,
    /// When the search began.
    begun: Option<T>,
    /// How far the motion has been searched.
    until: Option<T>,
    /// The time of the last crossing.
    last: Option<T>,
    /// The size of the function there.
    left: T,
    /// Whether the state or the system have been set since.
    is_new: bool,
    /// The longest interval between two, or up to the first.
    longest: T,
    /// How many intervals in a row were short, those between starts counted three times.
    short: usize,
}

/// An interval that is looked at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interval<T> {
    /// How long it is.
    pub(super) width: T,
    /// The round-off of the time, in halves of the width.
    pub(super) jitter: T,
    /// The highest degree to look at it with.
    pub(super) finest: usize,
    /// Whether it is as good as the step.
    pub(super) is_wide: bool,
}

/// What is to be known of a function on an interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum View {
    /// That it crosses zero once at most.
    Plain,
    /// That it may cross more often.
    Bent,
    /// That this degree is to be looked at.
    Open,
    /// The same, and that it may be all noise.
    Rough,
}

/// The degree with which a motion is looked at first, when nothing is known of the function.
const FIRST: usize = 16;

/// An interval is short that is this part of the longest: √ε of `f64`, 2⁻²⁶.
const SHORT: f64 = 1.0 / 67_108_864.0;

/// Crossings accumulate after so many short intervals in a row, or half of it where each begins at a new start: functions
/// have a few zeros close together, but no motion is changed again and again without a reason.
const ACCUMULATED: usize = 6;

impl<T: Real> EventState<T> {
    pub(super) fn new(name: &'static str) -> Self {
        let zero = T::constant(0.0);
        Self {
            name,
            direction: CrossingDirection::Both,
            subdivisions: 1,
            terminal: None,
            count: 0,
            value: zero,
            next: zero,
            samples: [zero; FINEST + 1],
            view: View::Open,
            start: None,
            noise: zero,
            density: None,
            needed: None,
            due: None,
            begun: None,
            until: None,
            last: None,
            left: zero,
            is_new: true,
            longest: zero,
            short: 0,
        }
    }

    /// What it is about, before the first crossing.
    pub(super) fn anew(&self) -> Self {
        let Self { name, direction, subdivisions, terminal, .. } = *self;
        Self { direction, subdivisions, terminal, ..Self::new(name) }
    }

    /// Counts the crossings of a run from 1.
    #[cfg(feature = "alloc")]
    pub(super) fn begin_run(&mut self) {
        self.count = 0;
    }

    /// Takes note of the function where a search begins. A start, where no step led to, is at a zero where the function is no
    /// more than its noise, or than what was left of it if it crossed just then. A motion that does not go on from the last
    /// crossing is another one, of which nothing is known.
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
            let noise = start.unwrap_or(T::constant(0.0));
            // Where it jumps or has a pole it is not near zero, however much of it is left.
            let left = smaller(self.left + self.left, noise * T::constant(16.0));
            let left = if self.last == Some(t) { left } else { T::constant(0.0) };
            let is_at_zero = start.is_some() && Scalar::abs(value) <= noise + left;
            self.start = is_at_zero.then_some(left);
            self.value = if is_at_zero { T::constant(0.0) } else { value };
        }
    }

    /// Before an interval is looked at, in one go where it is none; whether no degree tells enough on it.
    #[inline]
    pub(super) fn open(&mut self, interval: Option<&Interval<T>>) -> bool {
        (self.view, self.noise) = (View::Open, T::constant(0.0));
        if let Some(needed) = self.needed.take() {
            let before = self.density.map_or(needed, |density| density * T::constant(0.5));
            self.density = Some(larger(needed, before));
        }
        let is_too_wide = |interval: &Interval<T>| self.least(interval) > T::constant(FINEST as f64);
        interval.is_some_and(|interval| interval.is_wide && self.density.is_some() && is_too_wide(interval))
    }

    /// Whether its function is known well enough on this interval.
    #[inline]
    pub(super) fn is_known(&self) -> bool {
        self.view == View::Plain
    }

    /// Looks at the samples of this degree, unless it is known.
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
        self.view = match () {
            () if shape.is_plain(interval.jitter) => View::Plain,
            () if shape.is_rough() => View::Rough,
            () if shape.is_bent() => View::Bent,
            () => View::Open,
        };
        if interval.is_wide {
            self.learn(&shape, interval);
        }
        self.view
    }

    /// The least degree that tells anything on this interval: half of what the last steps have taken.
    #[inline]
    fn least(&self, interval: &Interval<T>) -> T {
        match self.density {
            None => T::constant(FIRST as f64),
            Some(density) => density * interval.width * T::constant(0.5),
        }
    }

    /// Takes note of the degree that the function takes. Of one that is far away beside what it moves by that is of no
    /// interest.
    #[inline]
    fn learn(&mut self, shape: &Shape<T>, interval: &Interval<T>) {
        let order = match self.view {
            View::Open | View::Rough => 2.0 * FINEST as f64,
            _ if shape.swing * T::constant(1024.0) < shape.most => 1.0,
            _ => shape.order as f64,
        };
        self.needed = Some(T::constant(order) / interval.width);
    }

    /// Looks at samples that may be all noise, given how much of it there is.
    pub(super) fn judge_noise(&mut self, degree: usize, noise: T) -> View {
        let shape = Shape::of(&self.samples, degree);
        let part = noise * T::constant(0.25);
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

    /// Takes note of the function at the end of the interval: it is on the side where it was unless it is beyond the noise.
    #[inline]
    pub(super) fn look(&mut self, value: T) {
        let is_noise =
            Scalar::abs(value) < self.noise || self.start.is_some() && Scalar::abs(value) <= self.noise;
        self.next = if is_noise { self.value } else { value };
        self.samples[FINEST] = value;
    }

    /// Goes on to the end of the interval, at this time.
    #[inline]
    pub(super) fn go_on(&mut self, t: T) {
        if Scalar::abs(self.samples[FINEST]) > self.noise {
            self.start = None;
        }
        (self.value, self.samples[0], self.until) = (self.next, self.samples[FINEST], Some(t));
    }

    /// Goes on to a place where some event crosses: this one if it `has_crossed`, whatever its function says when it is asked
    /// again, or if it says so.
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
            // It is on the side that it has come to until it is beyond its round-off.
            self.start = Some(T::constant(0.0));
        }
    }

    /// Whether the function crosses zero on the way to the end of the interval, the way that the event is about.
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

    /// Counts a crossing.
    pub(super) fn cross(&mut self, t: T) -> Result<(), Ending> {
        self.count += 1;
        if let Some(last) = self.last.or(self.begun) {
            let interval = Scalar::abs(t - last);
            let least =
                larger(self.longest * T::constant(SHORT), Scalar::abs(t) * T::constant(64.0 * T::EPSILON));
            let weight = if self.is_new { ACCUMULATED / 2 } else { 1 };
            self.short = if interval <= least { self.short + weight } else { 0 };
            self.longest = larger(self.longest, interval);
        }
        (self.last, self.is_new) = (Some(t), false);
        match self.short < ACCUMULATED {
            true => Ok(()),
            false => Err(Ending::EventsAccumulate { time: t.to_f64(), event: self.name }),
        }
    }

    /// Whether a run is to end with the last crossing.
    #[cfg(feature = "alloc")]
    pub(super) fn is_terminal(&self) -> bool {
        self.terminal.is_some_and(|count| self.count >= count)
    }
}
