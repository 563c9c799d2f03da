//! Step-size control (Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, II.4).

use super::adaptive::Adaptive;
use super::clock::Clock;
use super::pair::error_needs_last;
use super::pair::{Pair, Slopes, combine};

use crate::motion::limits::{BLIND, FIRST, FIRST_CHANGE, LEAST_ERROR, SAFETY, SLACK, VANISHING};
use crate::number::Broadcast;
use crate::number::limits::CANCELLED;
use crate::number::{Real, Scalar, exceeds, larger, smaller, sum};
use crate::vector::{Array, StaticLength, from_fn};
use crate::vector::{Length, PhaseVector, SpareVectors};

/// Length of the next step, and the memory of the controller.
#[derive(Clone, Debug)]
pub(crate) struct Control<T> {
    pub(crate) step: T,
    pub(super) previous_error: T,
    was_refused: bool,
}

impl<T: Real> Control<T> {
    pub(crate) fn new(step: T) -> Self {
        Self { step, previous_error: T::constant(LEAST_ERROR), was_refused: false }
    }

    /// Chooses the next step after an accepted step `h`, signed, with `error` in units of the tolerance. This is the PI
    /// controller; after a rejected step the step does not grow.
    pub(crate) fn accept<P: Pair>(&mut self, h: T, error: T) {
        let growth = T::constant(if self.was_refused { 1.0 } else { P::GROWTH });
        let damping = Scalar::powf(self.previous_error, T::constant(P::DAMPING));
        let factor = T::constant(SAFETY) * damping / reduction::<P, T>(error);
        self.step = Scalar::abs(h) * larger(T::constant(P::SHRINK), smaller(factor, growth));
        self.previous_error = larger(error, T::constant(LEAST_ERROR));
        self.was_refused = false;
    }

    /// Chooses a shorter step after a step `h` with too large an error.
    pub(crate) fn refuse<P: Pair>(&mut self, h: T, error: T) {
        let factor = T::constant(SAFETY) / reduction::<P, T>(error);
        self.step = Scalar::abs(h) * larger(T::constant(P::SHRINK), factor);
        self.was_refused = true;
    }

    /// Halves the step after a step `h` into a region where the equations have no solution.
    pub(crate) fn halve(&mut self, h: T) {
        self.step = Scalar::abs(h) * T::constant(0.5);
        self.was_refused = true;
    }
}

fn reduction<P: Pair, T: Real>(error: T) -> T {
    let exponent = 1.0 / P::ORDER - 0.75 * P::DAMPING;
    if exponent == 0.125 {
        // Three square roots take a third of the time of `powf`.
        return Scalar::sqrt(Scalar::sqrt(Scalar::sqrt(error)));
    }
    Scalar::powf(error, T::constant(exponent))
}

/// Index of an entry of the state: half 0 for coordinates, 1 for velocities, then the index of the coordinate.
pub(crate) type StateEntry = (usize, usize);

/// Variations at both ends of a step, the states there, and the factor that converts changes of the state to the unit of the
/// variations.
pub(crate) struct VariedEnds<'a, T: Scalar, W: Scalar, N: StaticLength> {
    pub(crate) variations: [&'a PhaseVector<W, N>; 2],
    pub(crate) places: [&'a PhaseVector<T, N>; 2],
    pub(crate) unit: W,
}

/// Tolerances: the error allowed in entry x is `absolute + relative · |x|`.
#[derive(Clone, Copy)]
pub(crate) struct Tolerance {
    pub(crate) relative: f64,
    pub(crate) absolute: f64,
}

impl Tolerance {
    /// Error of a step, in units of the tolerance.
    #[inline]
    pub(crate) fn error<P: Pair, T: Scalar, N: Length>(
        self,
        slopes: &Slopes<T, N>,
        h: T,
        [before, after]: [&PhaseVector<T, N>; 2],
        spare: &mut SpareVectors<T, N>,
    ) -> T {
        let mut sum = spare.lend(before);
        let error = estimate::<P, T, N>(slopes, h, self.allowed(before, after), &mut sum);
        spare.give_back(sum);
        error
    }

    /// Error of variations over a step of a pair.
    pub(crate) fn error_of_variations<P: Pair, T: Scalar, W: Broadcast<T>, N: StaticLength>(
        self,
        slopes: &Slopes<W, N>,
        h: T,
        step: &VariedEnds<'_, T, W, N>,
    ) -> W {
        let scale = self.scale_of_variations(SLACK, step);
        let mut sum = scale;
        estimate::<P, W, N>(slopes, W::of(h), |i| scale.flat()[i], &mut sum)
    }

    /// Size of the `errors` of variations over a step, in units of the allowed ones.
    pub(crate) fn part_of_variations<T: Scalar, W: Broadcast<T>, N: StaticLength>(
        self,
        slack: f64,
        errors: &PhaseVector<W, N>,
        step: &VariedEnds<'_, T, W, N>,
    ) -> W {
        let scale = self.scale_of_variations(slack, step);
        norm(W::constant(1.0), errors, |i| scale.flat()[i])
    }

    /// Error allowed in variations, for their coordinates and for their velocities: `slack` times the relative tolerance of the
    /// largest entry of that half, plus the error allowed in the state itself in the unit of the variations.
    fn scale_of_variations<T: Scalar, W: Broadcast<T>, N: StaticLength>(
        self,
        slack: f64,
        VariedEnds { variations: [before, after], places, unit }: &VariedEnds<'_, T, W, N>,
    ) -> PhaseVector<W, N> {
        let largest = |half: usize| {
            let sizes = (0..N::COUNT).map(|i| before[half][i].abs().max(after[half][i].abs()));
            sizes.fold(W::constant(0.0), |most, size| size.max(most))
        };
        let own = self.allowed(places[0], places[1]);
        let [relative, slack] = [self.relative, slack].map(W::constant);
        from_fn(|half| {
            let largest = relative * largest(half);
            Array::from_fn(|i| slack * (largest + W::of(own(N::COUNT * half + i)) * *unit))
        })
    }

    /// Change that `rates` make over a step of length `h`, in units of the error allowed at the state `place`.
    pub(crate) fn part<T: Real, N: Length>(
        self,
        h: T,
        rates: &PhaseVector<T, N>,
        place: &PhaseVector<T, N>,
    ) -> T {
        norm(h, rates, self.allowed(place, place))
    }

    /// First guess of the first step: it changes the state by a hundredth of its size.
    pub(crate) fn guess_step<T: Real, N: Length>(
        self,
        y: &PhaseVector<T, N>,
        slope: &PhaseVector<T, N>,
        span: T,
    ) -> T {
        let (allowed, one) = (self.allowed(y, y), T::constant(1.0));
        let (size, speed) = (norm(one, y, &allowed), norm(one, slope, &allowed));
        let least = T::constant(VANISHING);
        let usable = size > least && speed > least && speed.is_finite();
        let guess = if usable { T::constant(FIRST_CHANGE) * size / speed } else { span * T::constant(BLIND) };
        smaller(guess, span)
    }

    /// Index of the entry with the largest error relative to its tolerance.
    pub(crate) fn worst<P: Pair, T: Real, N: Length>(
        self,
        slopes: &Slopes<T, N>,
        [before, after]: [&PhaseVector<T, N>; 2],
        spare: &mut SpareVectors<T, N>,
    ) -> StateEntry {
        let mut error = spare.lend(before);
        combine(slopes, P::ERROR, &mut error);
        let (allowed, count) = (self.allowed(before, after), before[0].len());
        let part = |(half, i): StateEntry| Scalar::abs(error[half][i]) / allowed(count * half + i);
        let places = (0..2).flat_map(|half| (0..count).map(move |i| (half, i)));
        let worst = places.fold((0, 0), |worst, place| if part(place) > part(worst) { place } else { worst });
        spare.give_back(error);
        worst
    }

    /// Error that a step between two states may have in each entry, as a function of the entry's index in the flat vectors.
    #[inline(always)]
    fn allowed<T: Scalar, N: Length>(
        self,
        a: &PhaseVector<T, N>,
        b: &PhaseVector<T, N>,
    ) -> impl Fn(usize) -> T {
        let [relative, absolute] = [self.relative, self.absolute].map(T::constant);
        let (a, b) = (a.flat(), b.flat());
        move |i| absolute + relative * a[i].abs().max(b[i].abs())
    }
}

/// Error estimate of a step, in units of the allowed errors; `sum` is memory for its sums of slopes.
#[inline(always)]
fn estimate<P: Pair, T: Scalar, N: Length>(
    slopes: &Slopes<T, N>,
    h: T,
    allowed: impl Fn(usize) -> T,
    sum: &mut PhaseVector<T, N>,
) -> T {
    // Multiply by h before squaring: slopes depend on the unit of time, and their squares could overflow or underflow.
    combine(slopes, P::ERROR, sum);
    let first = norm(h, sum, &allowed);
    if P::LOWER_ERROR.is_empty() {
        return first;
    }
    combine(slopes, P::LOWER_ERROR, sum);
    let second = norm(h, sum, &allowed);
    let both = (first * first + T::constant(0.01) * second * second).sqrt();
    // Lanes cannot branch if both vanish: the denominator is at least the smallest number of single precision.
    first * first / both.max(T::constant(f32::MIN_POSITIVE as f64))
}

impl<P: Pair> Adaptive<P> {
    /// Requested tolerances, with the relative one at least 16 ε.
    pub(crate) fn tolerance<T: Real>(&self) -> Tolerance {
        Tolerance { relative: self.relative.max(CANCELLED * T::EPSILON), absolute: self.absolute }
    }

    /// True for fixed steps: no error estimate is computed. The rates at the end of a step are then evaluated only when
    /// the next step or the dense output needs them; after a change of the system, never.
    #[inline]
    pub(crate) fn ignores_error(&self) -> bool {
        self.fixed_step.is_some()
    }

    /// True if the error is estimated, and the estimate needs the slope at the end of the step.
    #[inline]
    pub(crate) fn error_needs_last(&self) -> bool {
        !self.ignores_error() && error_needs_last::<P>()
    }

    /// True if a step with this error, in units of the tolerance, is accepted. A fixed step always is.
    pub(crate) fn accepts<T: Real>(&self, error: T) -> bool {
        self.ignores_error() || !exceeds(error, T::constant(1.0))
    }

    /// Advances the clock to `time` after an accepted step `h`, and chooses the next step.
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
        // If the end has shortened this step, keep the planned length for a continued motion.
        let step = if clock.is_at_end() { larger(control.step, planned) } else { control.step };
        control.step = self.fit(step, clock);
    }

    /// Makes the step long enough to advance the time, and no longer than `max_step`.
    pub(super) fn fit<T: Real>(&self, step: T, clock: &Clock<T>) -> T {
        if self.fixed_step.is_some() {
            return step;
        }
        let step = clock.at_least(step);
        // Replaces NaN, and zero where times underflow.
        let step = if step > T::constant(0.0) { step } else { clock.left() };
        self.max_step.map_or(step, |longest| smaller(step, T::constant(longest)))
    }

    /// First step, from a guess and the slopes before and after a step of that length: the error of Euler's method over
    /// the returned step would be a hundredth of the tolerance.
    pub(crate) fn first_step_from<T: Real, N: Length>(
        &self,
        guess: T,
        y: &PhaseVector<T, N>,
        before: &PhaseVector<T, N>,
        after: &PhaseVector<T, N>,
    ) -> T {
        let allowed = self.tolerance::<T>().allowed(y, y);
        let change = before.each_with(after, |before, after| after - before);
        let one = T::constant(1.0);
        let fastest = larger(norm(one, &change, &allowed) / guess, norm(one, before, &allowed));
        let step = Scalar::powf(T::constant(FIRST_CHANGE) / fastest, T::constant(1.0 / P::ORDER));
        if fastest.is_finite() { smaller(step, guess * T::constant(FIRST)) } else { guess }
    }
}

/// Root mean square of h xᵢ/aᵢ over the entries, where aᵢ = `allowed(i)` is the allowed error.
#[inline(always)]
fn norm<T: Scalar, N: Length>(h: T, x: &PhaseVector<T, N>, allowed: impl Fn(usize) -> T) -> T {
    let x = x.flat();
    let squares = sum(x.len(), |i| {
        let part = h * x[i] / allowed(i);
        part * part
    });
    (squares / T::constant(x.len().max(1) as f64)).sqrt()
}
