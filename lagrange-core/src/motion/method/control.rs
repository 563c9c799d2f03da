//! The choice of the step size (Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, II.4).

use core::array::from_fn;

use super::adaptive::Adaptive;
use super::clock::Clock;
#[cfg(feature = "std")]
use super::pair::error_needs_last;
use super::pair::{Pair, Slopes, combine};
#[cfg(feature = "alloc")]
#[cfg(feature = "alloc")]
use crate::number::Broadcast;
use crate::number::{Real, Scalar, entries, exceeds, larger, smaller, sum};
use crate::solution::vector_field::PhaseVector;

/// The step to try next, and what its choice remembers.
#[derive(Clone, Debug)]
pub(crate) struct Control<T> {
    pub(crate) step: T,
    pub(super) previous_error: T,
    was_refused: bool,
}

impl<T: Real> Control<T> {
    pub(crate) fn new(step: T) -> Self {
        Self { step, previous_error: T::constant(1e-4), was_refused: false }
    }

    /// After a step h, signed, with an error of this part of the tolerance: the PI controller, and no growth after a
    /// refusal.
    pub(crate) fn accept<P: Pair>(&mut self, h: T, error: T) {
        let growth = T::constant(if self.was_refused { 1.0 } else { P::GROWTH });
        let damping = Scalar::powf(self.previous_error, T::constant(P::DAMPING));
        let factor = T::constant(SAFETY) * damping / larger(reduction::<P, T>(error), T::constant(1e-30));
        self.step = Scalar::abs(h) * larger(T::constant(P::SHRINK), smaller(factor, growth));
        self.previous_error = larger(error, T::constant(1e-4));
        self.was_refused = false;
    }

    /// After a step h with too large an error.
    pub(crate) fn refuse<P: Pair>(&mut self, h: T, error: T) {
        let factor = T::constant(SAFETY) / reduction::<P, T>(error);
        self.step = Scalar::abs(h) * larger(T::constant(P::SHRINK), factor);
        self.was_refused = true;
    }

    /// After a step h into a region where the equations have no solution.
    pub(crate) fn halve(&mut self, h: T) {
        self.step = Scalar::abs(h) * T::constant(0.5);
        self.was_refused = true;
    }
}

/// A first step is at most so many times the first guess.
pub(crate) const FIRST: f64 = 100.0;

/// The part of the predicted step that is taken, so that few are refused.
const SAFETY: f64 = 0.9;

fn reduction<P: Pair, T: Real>(error: T) -> T {
    let exponent = 1.0 / P::ORDER - 0.75 * P::DAMPING;
    if exponent == 0.125 {
        // Three roots take a third of the time of a power.
        return Scalar::sqrt(Scalar::sqrt(Scalar::sqrt(error)));
    }
    Scalar::powf(error, T::constant(exponent))
}

/// The place of an entry: half 0 the coordinates, 1 the velocities, and the index.
pub(crate) type StateEntry = (usize, usize);

/// The error allowed in each entry: `absolute + relative · |x|`.
#[derive(Clone, Copy)]
pub(crate) struct Tolerance {
    pub(crate) relative: f64,
    pub(crate) absolute: f64,
}

impl Tolerance {
    /// The error of a step as a part of the tolerance.
    #[inline]
    pub(crate) fn error<P: Pair, T: Scalar, const N: usize>(
        self,
        slopes: &Slopes<T, N>,
        h: T,
        before: &PhaseVector<T, N>,
        after: &PhaseVector<T, N>,
    ) -> T {
        estimate::<P, T, N>(slopes, h, &self.scale(before, after))
    }

    /// The error of variations over a step from one place to another: as a part of the relative tolerance of the largest
    /// entry among their coordinates, and among their velocities, and of what the place itself is allowed, in units of
    /// the variations.
    #[cfg(feature = "alloc")]
    pub(crate) fn error_of_variations<P: Pair, T: Scalar, W: Broadcast<T>, const N: usize>(
        self,
        slopes: &Slopes<W, N>,
        h: T,
        [before, after]: [&PhaseVector<W, N>; 2],
        places: [&PhaseVector<T, N>; 2],
        unit: W,
    ) -> W {
        let largest = |half: usize| {
            let sizes = (0..N).map(|i| before[half][i].abs().max(after[half][i].abs()));
            sizes.fold(W::constant(0.0), |most, size| size.max(most))
        };
        let own = self.scale(places[0], places[1]);
        let [relative, slack] = [self.relative, SLACK].map(W::constant);
        let scale = [0, 1].map(|half| {
            let largest = relative * largest(half);
            entries(|i| slack * (largest + W::of(own[half][i]) * unit))
        });
        estimate::<P, W, N>(slopes, W::of(h), &scale)
    }

    /// What a step of this length makes of rates, as a part of the error allowed at a place.
    pub(crate) fn part<T: Real, const N: usize>(
        self,
        h: T,
        rates: &PhaseVector<T, N>,
        place: &PhaseVector<T, N>,
    ) -> T {
        norm(h, rates, &self.scale(place, place))
    }

    /// A first guess at the first step: one that moves the state by a hundredth of its size.
    pub(crate) fn guess_step<T: Real, const N: usize>(
        self,
        y: &PhaseVector<T, N>,
        slope: &PhaseVector<T, N>,
        span: T,
    ) -> T {
        let (scale, one) = (self.scale(y, y), T::constant(1.0));
        let (size, speed) = (norm(one, y, &scale), norm(one, slope, &scale));
        let least = T::constant(1e-5);
        let usable = size > least && speed > least && speed.is_finite();
        smaller(if usable { T::constant(0.01) * size / speed } else { span * T::constant(1e-6) }, span)
    }

    /// The entry with the largest error.
    pub(crate) fn worst<P: Pair, T: Real, const N: usize>(
        self,
        slopes: &Slopes<T, N>,
        before: &PhaseVector<T, N>,
        after: &PhaseVector<T, N>,
    ) -> StateEntry {
        let (error, scale) = (combine(slopes, P::ERROR), self.scale(before, after));
        let part = |(half, i): StateEntry| Scalar::abs(error[half][i]) / scale[half][i];
        let places = (0..2).flat_map(|half| (0..N).map(move |i| (half, i)));
        places.fold((0, 0), |worst, place| if part(place) > part(worst) { place } else { worst })
    }

    /// The error allowed in each entry between two places.
    #[inline]
    fn scale<T: Scalar, const N: usize>(
        self,
        a: &PhaseVector<T, N>,
        b: &PhaseVector<T, N>,
    ) -> PhaseVector<T, N> {
        let relative = T::constant(self.relative);
        let absolute = T::constant(self.absolute);
        let size = |half: usize, i: usize| a[half][i].abs().max(b[half][i].abs());
        from_fn(|half| entries(|i| absolute + relative * size(half, i)))
    }
}

/// The estimate of the error of a step, as a part of the errors allowed.
#[inline]
fn estimate<P: Pair, T: Scalar, const N: usize>(slopes: &Slopes<T, N>, h: T, scale: &PhaseVector<T, N>) -> T {
    // Times h before they are squared: slopes depend on the unit of time, and their squares leave the numbers.
    let first = norm(h, &combine(slopes, P::ERROR), scale);
    if P::LOWER_ERROR.is_empty() {
        return first;
    }
    let second = norm(h, &combine(slopes, P::LOWER_ERROR), scale);
    let both = (first * first + T::constant(0.01) * second * second).sqrt();
    // Lanes cannot branch where both vanish; so small an error is none.
    first * first / both.max(T::constant(1e-30))
}

impl<P: Pair> Adaptive<P> {
    /// What is asked for, as far as the numbers go.
    pub(crate) fn tolerance<T: Real>(&self) -> Tolerance {
        Tolerance { relative: self.relative.max(16.0 * T::EPSILON), absolute: self.absolute }
    }

    /// Whether nobody looks at the error of a step, because all are of one size. What the rates at its end are is then left
    /// to those who need them, the next step or what lies within: to nobody, where the system changes first.
    #[inline]
    pub(crate) fn ignores_error(&self) -> bool {
        self.fixed_step.is_some()
    }

    /// Whether the error can be had only with the slope at the end of the step, and is looked at.
    #[cfg(feature = "std")]
    #[inline]
    pub(crate) fn error_needs_last(&self) -> bool {
        !self.ignores_error() && error_needs_last::<P>()
    }

    /// Whether a step with this part of the tolerance as its error will do; nothing refuses a fixed step.
    pub(crate) fn accepts<T: Real>(&self, error: T) -> bool {
        self.ignores_error() || !exceeds(error, T::constant(1.0))
    }

    /// After an accepted step of this length to this time: moves the clock, and chooses the next step.
    pub(crate) fn after_acceptance<T: Real>(
        &self,
        control: &mut Control<T>,
        clock: &mut Clock<T>,
        (h, time): (T, T),
        error: T,
    ) {
        if let Some(size) = self.fixed_step {
            control.step = clock.tick((h, time), control.step, T::constant(size));
            return;
        }
        clock.now = time;
        let planned = control.step;
        control.accept::<P>(h, error);
        // A step that the end has cut says nothing against the one planned, should the motion go on.
        let step = if clock.is_at_end() { larger(control.step, planned) } else { control.step };
        control.step = self.fit(step, clock);
    }

    /// The step made long enough to advance the time, and cut to the longest allowed.
    pub(super) fn fit<T: Real>(&self, step: T, clock: &Clock<T>) -> T {
        if self.fixed_step.is_some() {
            return step;
        }
        let step = clock.at_least(step);
        // Not a number, or nothing where the numbers end.
        let step = if step > T::constant(0.0) { step } else { clock.left() };
        self.max_step.map_or(step, |longest| smaller(step, T::constant(longest)))
    }

    /// The first step from that guess and the slopes before and after it: the error of a step of Euler's method of
    /// this size would be a hundredth.
    pub(crate) fn first_step_from<T: Real, const N: usize>(
        &self,
        guess: T,
        y: &PhaseVector<T, N>,
        before: &PhaseVector<T, N>,
        after: &PhaseVector<T, N>,
    ) -> T {
        let scale = self.tolerance::<T>().scale(y, y);
        let change = from_fn(|half| entries(|i| after[half][i] - before[half][i]));
        let one = T::constant(1.0);
        let fastest = larger(norm(one, &change, &scale) / guess, norm(one, before, &scale));
        let step = if fastest > T::constant(1e-15) && fastest.is_finite() {
            Scalar::powf(T::constant(0.01) / fastest, T::constant(1.0 / P::ORDER))
        } else {
            guess
        };
        smaller(step, guess * T::constant(FIRST))
    }
}

/// So many times the tolerance variations are allowed: their errors are about as much larger than those of the motion, as a
/// rule, and are to shorten its steps only where it is no guide.
#[cfg(feature = "alloc")]
pub(crate) const SLACK: f64 = 10.0;

/// √(mean (h x/scale)²).
#[inline]
fn norm<T: Scalar, const N: usize>(h: T, x: &PhaseVector<T, N>, scale: &PhaseVector<T, N>) -> T {
    let (x, scale) = (x.as_flattened(), scale.as_flattened());
    let squares = sum(2 * N, |i| {
        let part = h * x[i] / scale[i];
        part * part
    });
    (squares / T::constant((2 * N) as f64)).sqrt()
}
