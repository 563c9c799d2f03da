//! What an event is about, and what is known of it from step to step.

use super::Direction;
use crate::ending::Ending;
use crate::motion::run::is_between;
use crate::number::{Real, Scalar, larger, smaller};

/// What an event is about, and what is known of it from step to step.
#[derive(Clone, Debug)]
pub struct Memory<T> {
    pub(super) name: &'static str,
    pub(super) direction: Direction,
    /// How many pieces a step is looked at in, if that has been asked for.
    pub(super) pieces: Option<usize>,
    /// The crossing at which a run ends.
    pub(super) terminal: Option<usize>,
    /// How many there were in this run, or in this motion where it is steered.
    pub(super) count: usize,
    /// The function where the search is; zero where the motion starts at a zero, and has not left it.
    pub(super) value: T,
    /// The same at the place looked at last, where the search goes on from unless something crosses before.
    pub(super) next: T,
    /// The same at the end of the step.
    end: T,
    /// What is nearer to zero than this at two places may turn back beyond zero in between.
    near: T,
    /// The function where the motion starts at a zero, as long as it has not been looked at elsewhere.
    start: Option<T>,
    /// What counts as zero as long as the motion has not left it.
    noise: T,
    /// Crossed together with another event that was reported first: whether it rose.
    pub(super) due: Option<bool>,
    /// When the search began.
    begun: Option<T>,
    /// The time of the last crossing.
    last: Option<T>,
    /// What the function was there.
    left: T,
    /// The longest interval between two, or up to the first.
    longest: T,
    /// How many intervals in a row were short.
    short: usize,
}

/// Where a function may turn back within a step it is looked at in so many pieces.
pub(super) const FINE: usize = 8;

/// An interval is short that is this part of the longest: √ε of `f64`, 2⁻²⁶.
const SHORT: f64 = 1.0 / 67_108_864.0;

impl<T: Real> Memory<T> {
    pub(super) fn new(name: &'static str) -> Self {
        let zero = T::constant(0.0);
        Self {
            name,
            direction: Direction::Both,
            pieces: None,
            terminal: None,
            count: 0,
            value: zero,
            next: zero,
            end: zero,
            near: zero,
            start: None,
            noise: zero,
            due: None,
            begun: None,
            last: None,
            left: zero,
            longest: zero,
            short: 0,
        }
    }

    /// What it is about, before the first crossing.
    pub(super) fn anew(&self) -> Self {
        let Self { name, direction, pieces, terminal, .. } = *self;
        Self { direction, pieces, terminal, ..Self::new(name) }
    }

    /// Takes note of the function where a search begins; whether that seems to be at a zero, where no step led there.
    /// A motion that does not go on from the last crossing is another one, of which nothing is known.
    pub(super) fn begin(&mut self, value: T, t: T, is_new: bool) -> bool {
        let zero = T::constant(0.0);
        let goes_on =
            self.begun.zip(self.last.or(Some(t))).is_some_and(|(begun, last)| is_between(begun, last, t));
        if is_new && !goes_on {
            *self = self.anew();
        }
        self.begun = self.begun.or(Some(t));
        let is_at_zero = is_new && (value == zero || self.last == Some(t));
        self.start = is_at_zero.then_some(value);
        (self.value, self.noise) = (if is_at_zero { zero } else { value }, zero);
        self.next = self.value;
        is_at_zero
    }

    /// Goes on to the place looked at last.
    #[inline]
    pub(super) fn go_on(&mut self) {
        self.value = self.next;
        if self.value != T::constant(0.0) {
            self.noise = T::constant(0.0);
        }
    }

    /// Takes note of the function at the next place. From a start at a zero it is zero until it leaves the noise there:
    /// four times what it has changed by at the first place, and twice what was left of it at the crossing.
    #[inline]
    pub(super) fn look(&mut self, value: T) {
        let zero = T::constant(0.0);
        if let Some(start) = self.start.take() {
            self.noise =
                Scalar::abs(value - start) * T::constant(4.0) + Scalar::abs(self.left) * T::constant(2.0);
            self.value = if Scalar::abs(start) <= self.noise { zero } else { start };
        }
        let is_noise = self.value == zero && Scalar::abs(value) <= self.noise;
        self.next = if is_noise { zero } else { value };
    }

    /// Takes note of the function at the end of a step, and says in how many pieces the step is to be looked at: none where
    /// it keeps away from zero, as far as the parabola through its values at the start, in the middle and at the end tells.
    #[inline]
    pub(super) fn plan(&mut self, middle: T, end: T) -> usize {
        self.go_on();
        self.end = end;
        let (start, zero) = (self.value, T::constant(0.0));
        let [rise, bend] = [end - start, (start - middle) + (end - middle)].map(Scalar::abs);
        let least = smaller(smaller(Scalar::abs(start), Scalar::abs(middle)), Scalar::abs(end));
        let values = [start, middle, end];
        let has_one_sign = values.iter().all(|x| *x > zero) || values.iter().all(|x| *x < zero);
        // The parabola turns back within the step only where it bends by half as much as it rises, and
        // comes nearer to zero than the least of the three by no more than an eighth of what it bends by.
        let turns_back = bend * T::constant(4.0) >= rise && bend >= least;
        // In an eighth it goes down by a 128th of what it bends by, if that is the same everywhere.
        self.near = if turns_back { bend / T::constant(16.0) } else { zero };
        match turns_back {
            true => FINE,
            false if has_one_sign => 0,
            false => 2,
        }
    }

    /// Whether the function, which has no other sign at the next place, may have it on the way there.
    #[inline]
    pub(super) fn may_turn_back(&self) -> bool {
        let zero = T::constant(0.0);
        let (value, next) = (self.value, self.next);
        let has_one_sign = value >= zero && next >= zero || value <= zero && next <= zero;
        let least = smaller(Scalar::abs(value), Scalar::abs(next));
        has_one_sign && least < self.near && self.noise == zero
    }

    /// Counts the crossings of a run from 1.
    #[cfg(feature = "alloc")]
    pub(super) fn begin_run(&mut self) {
        self.count = 0;
    }

    /// Goes on to the end of the step.
    #[inline]
    pub(super) fn skip_step(&mut self) {
        self.next = self.end;
    }

    /// Goes on to a place where some event crosses: this one if it `has_crossed`, whatever its function says when it is asked
    /// again, or if it says so.
    pub(super) fn arrive(&mut self, value: T, has_crossed: bool) {
        self.look(value);
        if has_crossed || self.crosses() {
            (self.due, self.left) = (Some(self.value < T::constant(0.0)), self.next);
        }
        self.go_on();
    }

    /// Whether the function crosses zero on the way to the next place, the way that the event is about.
    #[inline]
    pub(super) fn crosses(&self) -> bool {
        let zero = T::constant(0.0);
        let rises = self.value < zero && self.next >= zero;
        let falls = self.value > zero && self.next <= zero;
        match self.direction {
            Direction::Rising => rises,
            Direction::Falling => falls,
            Direction::Both => rises || falls,
        }
    }

    /// Counts a crossing.
    pub(super) fn cross(&mut self, t: T) -> Result<(), Ending> {
        self.count += 1;
        if let Some(last) = self.last.or(self.begun) {
            let interval = Scalar::abs(t - last);
            let least =
                larger(self.longest * T::constant(SHORT), Scalar::abs(t) * T::constant(64.0 * T::EPSILON));
            self.short = if interval <= least { self.short + 1 } else { 0 };
            self.longest = larger(self.longest, interval);
        }
        self.last = Some(t);
        match self.short {
            0 | 1 => Ok(()),
            _ => Err(Ending::EventsAccumulate { time: t.to_f64(), event: self.name }),
        }
    }

    /// Whether a run is to end with the last crossing.
    #[cfg(feature = "alloc")]
    pub(super) fn is_terminal(&self) -> bool {
        self.terminal.is_some_and(|count| self.count >= count)
    }
}
