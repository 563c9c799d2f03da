//! One step of an embedded Runge–Kutta pair, projected onto the constraints.

#[cfg(feature = "alloc")]
use alloc::vec::Vec;
use core::fmt;

use super::adaptive::Adaptive;
use super::bounds::{self, MultiplierBounds};
use super::clock::Clock;
use super::contract::{Limits, Method, Step};
use super::control::{Control, StateEntry};
use super::pair::{
    Pair, Slopes, StageMultipliers, TableauRow, advance, advance_from, check, error_needs_last, is_carried,
    last,
};
use super::pair_memory::{PairMemory, StepStart, Taken};
use super::slope::{check_finite, entry, inlined_slope, slope};
use crate::error::{Ending, Error, Pace};
#[cfg(feature = "alloc")]
use crate::number::larger;
use crate::number::{Real, Scalar};
use crate::room::Room;
use crate::solution::interpolant::{Polynomial, hermite};
use crate::solution::vector_field::{StagePoint, VectorField};
use crate::statistics::Statistics;
use crate::system::{Lagrangian, State, StateOf};
use crate::vector::{Array, Element, Length, PhaseVector, from_fn, vector};

/// Reason to reject a step.
enum Refusal<T> {
    /// Error in units of the tolerance, and the entry with the largest error.
    Inaccurate(T, StateEntry),
    /// The equations or the constraints have no solution within the step.
    Unsolved(Error),
}

impl<T> From<Error> for Refusal<T> {
    fn from(error: Error) -> Self {
        Self::Unsolved(error)
    }
}

/// End of a step, its error in units of the tolerance, and the constraints that determine the slope there.
struct Reached<T: Element, N: Length, M: Length> {
    y: PhaseVector<T, N>,
    error: T,
    active: Array<bool, M>,
}

impl<P, L, F> Method<L, F> for Adaptive<P>
where
    P: Pair,
    L: Lagrangian<Scalar: Real>,
    F: VectorField<L>,
{
    type Memory = PairMemory<L::Scalar, L::N, L::M>;
    type Interpolant = Polynomial<L::Scalar, P::Coefficients<PhaseVector<L::Scalar, L::N>>>;

    fn limits(&self) -> Limits {
        self.limits()
    }

    fn identify(&self, to: &mut dyn fmt::Write) -> fmt::Result {
        self.identify(to)
    }

    fn accuracy(&self) -> f64 {
        self.relative
    }

    fn check(&self) -> Result<(), Error> {
        self.check()
    }

    fn begin(
        &self,
        system: &L,
        start: &StateOf<L>,
        statistics: &mut Statistics,
    ) -> Result<Self::Memory, Error> {
        let zero = PhaseVector::filled(L::Scalar::constant(0.0));
        let unknown = Array::filled(L::Scalar::constant(f64::NAN));
        let mut memory = PairMemory {
            clock: Clock::new(start.t, self.fixed_step.map(L::Scalar::constant)),
            control: Control::new(L::Scalar::constant(0.0)),
            is_planned: false,
            y: zero,
            has_slope: false,
            slope: zero,
            active: Array::filled(true),
            multipliers: unknown,
            slopes: Room::filled(zero),
            stage_multipliers: Room::filled(unknown),
            taken: None,
        };
        Method::<L, F>::resume(self, system, &mut memory, start, statistics)?;
        Ok(memory)
    }

    fn resume(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        state: &StateOf<L>,
        statistics: &mut Statistics,
    ) -> Result<(), Error> {
        memory.clock.set(state.t);
        // The velocity is the initial guess for the Legendre inversion of the first rate.
        memory.y = F::phase(system, state);
        memory.slope.set(0, state.v.into());
        (memory.has_slope, memory.taken) = (false, None);
        memory.ensure_slope::<L, F>(system, statistics)
    }

    fn step(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        end: L::Scalar,
        statistics: &mut Statistics,
    ) -> Step<L::Scalar, L::N> {
        self.aim::<L, F>(system, memory, end, statistics);
        let (h, time) = memory.next();
        let now = memory.clock.now.to_f64();
        if !memory.clock.is_ahead(time) {
            return Step::Failed(Ending::TimeTooCoarse { time: now, step: memory.control.step.to_f64() });
        }
        // Two compiled variants, so that an adaptive step contains no code for fixed steps.
        let attempt = match self.ignores_error() {
            true => self.attempt::<L, F, true>(system, memory, (h, time), statistics),
            false => self.attempt::<L, F, false>(system, memory, (h, time), statistics),
        };
        let ending = match attempt {
            Ok(reached) => return Step::Accepted(self.take::<L, F>(memory, (h, time), &reached)),
            Err(Refusal::Inaccurate(error, place)) => {
                memory.control.refuse::<P>(h, error);
                Ending::StepTooSmall { time: now, entry: entry::<L, F>(place) }
            }
            Err(Refusal::Unsolved(error)) => {
                memory.control.halve(h);
                Ending::of(error, now)
            }
        };
        if self.can_try_again(memory) { Step::Rejected } else { Step::Failed(ending) }
    }

    #[inline(always)]
    fn interpolant(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        statistics: &mut Statistics,
    ) -> Result<Self::Interpolant, Error> {
        let (start, length) = look_within::<P, L, F>(system, memory, statistics)?;
        // Build the coefficients in place: the only copy is into the trajectory.
        let mut coefficients = P::coefficients(PhaseVector::filled(L::Scalar::constant(0.0)));
        interpolate::<P, _, L::N, L::M>(memory, coefficients.as_mut());
        Ok(Polynomial::new(start, length, coefficients))
    }

    #[cfg(feature = "alloc")]
    #[inline(always)]
    fn push_interpolant(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        statistics: &mut Statistics,
        to: &mut Vec<Self::Interpolant>,
    ) -> Result<(), Error> {
        let (start, length) = look_within::<P, L, F>(system, memory, statistics)?;
        to.push(Polynomial::new(
            start,
            length,
            P::coefficients(PhaseVector::filled(L::Scalar::constant(0.0))),
        ));
        if let Some(last) = to.last_mut() {
            interpolate::<P, _, L::N, L::M>(memory, last.coefficients_mut());
        }
        Ok(())
    }

    #[inline]
    fn multiplier_bounds(
        &self,
        system: &L,
        memory: &Self::Memory,
        statistics: &mut Statistics,
    ) -> Option<MultiplierBounds<L::Scalar, L::M>> {
        bounds::multiplier_bounds::<P, L, F>(system, memory, statistics)
    }

    fn undo(&self, memory: &mut Self::Memory) -> bool {
        let Some(Taken { from, h, control }) = memory.taken.take() else { return false };
        (memory.clock.now, memory.y, memory.active) = (from.t, from.y, from.active);
        (memory.has_slope, memory.slope, memory.control) = (true, memory.slopes[0], control);
        memory.multipliers = memory.stage_multipliers[0];
        memory.control.halve(h);
        self.can_try_again(memory)
    }

    fn pace(&self, system: &L, memory: &Self::Memory, end: L::Scalar) -> Pace {
        // Fixed steps: no error limits their length.
        if self.fixed_step.is_some() {
            return Pace::default();
        }
        let step = Some(memory.control.step.to_f64());
        let stiffness = self.find_stiffness::<L, F>(system, memory, end);
        Pace { step, stiffness, time_apart: self.find_coarseness::<L, F>(system, memory) }
    }
}

impl<P: Pair> Adaptive<P> {
    /// Sets the end, and chooses the length of the first step if this is the first call.
    pub(crate) fn aim<L: Lagrangian<Scalar: Real>, F: VectorField<L>>(
        &self,
        system: &L,
        memory: &mut PairMemory<L::Scalar, L::N, L::M>,
        end: L::Scalar,
        statistics: &mut Statistics,
    ) {
        memory.clock.aim(end);
        if !memory.is_planned {
            let step = match self.fixed_step.or(self.first_step) {
                Some(step) => L::Scalar::constant(step),
                None => self.estimate_step::<L, F>(system, memory, statistics),
            };
            memory.control.step = self.fit(step, &memory.clock);
            memory.is_planned = true;
        }
    }

    /// Chooses the next step after a step on which another quantity was integrated as well, with `error` in units of
    /// its tolerance. The larger of both errors counts.
    #[cfg(feature = "alloc")]
    pub(crate) fn accept_with<T: Real, N: Length, M: Length>(
        &self,
        memory: &mut PairMemory<T, N, M>,
        error: T,
    ) {
        let Some(taken) = memory.taken.as_ref().filter(|_| self.fixed_step.is_none()) else { return };
        let (step, mut control) = ((taken.h, memory.clock.now), taken.control.clone());
        let error = larger(error, memory.control.previous_error);
        self.after_acceptance(&mut control, &mut memory.clock, step, error);
        memory.control = control;
    }

    /// True if a shorter step can be tried; never for fixed steps.
    fn can_try_again<T: Real, N: Length, M: Length>(&self, memory: &PairMemory<T, N, M>) -> bool {
        self.fixed_step.is_none() && memory.clock.advances_by(memory.control.step)
    }

    /// Accepts a step: moves to its end.
    fn take<L: Lagrangian<Scalar: Real>, F: VectorField<L>>(
        &self,
        memory: &mut PairMemory<L::Scalar, L::N, L::M>,
        (h, time): (L::Scalar, L::Scalar),
        reached: &Reached<L::Scalar, L::N, L::M>,
    ) -> StateOf<L> {
        memory.taken = Some(Taken { from: memory.origin(), h, control: memory.control.clone() });
        (memory.y, memory.active, memory.slope) = (reached.y, reached.active, memory.slopes[last::<P>()]);
        memory.multipliers = memory.stage_multipliers[last::<P>()];
        memory.has_slope = !(self.ignores_error() && F::HOLDS_VELOCITY);
        self.after_acceptance(&mut memory.control, &mut memory.clock, (h, time), reached.error);
        let velocity = if F::HOLDS_VELOCITY { memory.y.half(1) } else { memory.slope.half(0) };
        State { t: time, q: vector(memory.y.half(0)), v: vector(velocity) }
    }

    /// Computes stages, error and projection of a step; any failure rejects it.
    fn attempt<L: Lagrangian<Scalar: Real>, F: VectorField<L>, const IS_FIXED: bool>(
        &self,
        system: &L,
        memory: &mut PairMemory<L::Scalar, L::N, L::M>,
        (h, time): (L::Scalar, L::Scalar),
        statistics: &mut Statistics,
    ) -> Result<Reached<L::Scalar, L::N, L::M>, Refusal<L::Scalar>> {
        const { check::<P>() };
        if IS_FIXED {
            memory.ensure_slope::<L, F>(system, statistics)?;
        }
        let (from, slopes, multipliers) =
            (memory.origin(), &mut *memory.slopes, &mut *memory.stage_multipliers);
        (slopes[0], multipliers[0]) = (memory.slope, memory.multipliers);
        stages::<P, L, F>(system, &from, h, (slopes, multipliers), (1, P::STAGES), statistics)?;
        let mut next = StagePoint { t: time, y: from.y, velocity: slopes[0].half(0) };
        advance(&from.y, h, slopes, P::WEIGHTS, &mut next.y);
        check_finite::<L>(time, &next.y)?;
        let mut active = from.active;
        let needs_last = !IS_FIXED && error_needs_last::<P>();
        if needs_last {
            let found = slope::<L, F>(system, &next, Some(&active), &mut slopes[last::<P>()], statistics)?;
            (active, multipliers[last::<P>()]) = (found.active, found.multipliers);
        }
        let error =
            if IS_FIXED { L::Scalar::constant(0.0) } else { self.check_error(slopes, h, &from.y, &next.y)? };
        if <L::M>::COUNT > 0 {
            next.y = F::phase(system, &F::project(system, &next)?);
        }
        if !(IS_FIXED && F::HOLDS_VELOCITY) && (<L::M>::COUNT > 0 || !needs_last) {
            let found = slope::<L, F>(system, &next, None, &mut slopes[last::<P>()], statistics)?;
            (active, multipliers[last::<P>()]) = (found.active, found.multipliers);
        }
        Ok(Reached { y: next.y, error, active })
    }

    /// Error in units of the tolerance; an error above 1 rejects the step.
    fn check_error<T: Real, N: Length>(
        &self,
        slopes: &Slopes<T, N>,
        h: T,
        before: &PhaseVector<T, N>,
        after: &PhaseVector<T, N>,
    ) -> Result<T, Refusal<T>> {
        let tolerance = self.tolerance::<T>();
        let error = tolerance.error::<P, T, N>(slopes, h, before, after);
        if !self.accepts(error) {
            return Err(Refusal::Inaccurate(error, tolerance.worst::<P, T, N>(slopes, before, after)));
        }
        Ok(error)
    }

    /// Spacing of representable times near the current time; `None` if it is fine enough. Stages are
    /// evaluated at rounded times. The spacing is too coarse if the rates change so much over it that the
    /// error of a step is half the tolerance or more.
    #[cold]
    fn find_coarseness<L: Lagrangian<Scalar: Real>, F: VectorField<L>>(
        &self,
        system: &L,
        memory: &PairMemory<L::Scalar, L::N, L::M>,
    ) -> Option<f64> {
        let PairMemory { clock, control, y, slope: here, active, .. } = memory;
        // 0.75 to 1.5 of the distance to the next number: the sum rounds to that number.
        let next = clock.now + L::Scalar::constant(0.75 * L::Scalar::EPSILON) * Scalar::abs(clock.now);
        let point = StagePoint { t: next, y: *y, velocity: here.half(0) };
        let mut there = *here;
        let (active, mut statistics) = (memory.has_slope.then_some(active)?, Statistics::default());
        slope::<L, F>(system, &point, Some(active), &mut there, &mut statistics).ok()?;
        let change: PhaseVector<_, L::N> = from_fn(|half| Array::from_fn(|i| there[half][i] - here[half][i]));
        let lost = self.tolerance::<L::Scalar>().part(control.step, &change, y);
        (lost >= L::Scalar::constant(0.5)).then(|| (next - clock.now).to_f64())
    }

    fn estimate_step<L: Lagrangian<Scalar: Real>, F: VectorField<L>>(
        &self,
        system: &L,
        memory: &PairMemory<L::Scalar, L::N, L::M>,
        statistics: &mut Statistics,
    ) -> L::Scalar {
        let PairMemory { clock, y, slope: first, active, .. } = memory;
        let guess = self.tolerance::<L::Scalar>().guess_step(y, first, clock.left());
        let h = clock.directed(guess);
        let euler: PhaseVector<_, L::N> = from_fn(|half| Array::from_fn(|i| y[half][i] + h * first[half][i]));
        let point = StagePoint { t: clock.now + h, y: euler, velocity: first.half(0) };
        let mut second = *first;
        match slope::<L, F>(system, &point, Some(active), &mut second, statistics) {
            Ok(_) => self.first_step_from(guess, y, first, &second),
            Err(_) => guess,
        }
    }
}

/// Evaluates the remaining slopes for the dense output of the last accepted step. Returns the start and the length of
/// the step.
#[inline(always)]
fn look_within<P, L, F>(
    system: &L,
    memory: &mut PairMemory<L::Scalar, L::N, L::M>,
    statistics: &mut Statistics,
) -> Result<(L::Scalar, L::Scalar), Error>
where
    P: Pair,
    L: Lagrangian<Scalar: Real>,
    F: VectorField<L>,
{
    memory.ensure_slope::<L, F>(system, statistics)?;
    memory.slopes[last::<P>()] = memory.slope;
    memory.stage_multipliers[last::<P>()] = memory.multipliers;
    let now = memory.clock.now.to_f64();
    let no_step = Error::OutsideTrajectory { time: now, start: now, end: now };
    let Taken { from, h, .. } = memory.taken.as_ref().ok_or(no_step)?;
    let more = (last::<P>() + 1, P::INTERPOLATION_STAGES);
    let stage_memory = (&mut *memory.slopes, &mut *memory.stage_multipliers);
    stages::<P, L, F>(system, from, *h, stage_memory, more, statistics)?;
    Ok((from.t, *h))
}

/// Computes the coefficients of the dense output of the last accepted step from its slopes.
#[inline(always)]
fn interpolate<P: Pair, T: Real, N: Length, M: Length>(
    memory: &PairMemory<T, N, M>,
    coefficients: &mut [PhaseVector<T, N>],
) {
    let (slopes, zero) = (&*memory.slopes, PhaseVector::filled(T::constant(0.0)));
    let Some(Taken { from, h, .. }) = &memory.taken else { return };
    let (start, end) = ((&from.y, &slopes[0]), (&memory.y, &slopes[last::<P>()]));
    let (cubic, beyond) = coefficients.split_at_mut(4);
    hermite(*h, start, end, cubic);
    for (coefficient, row) in beyond.iter_mut().zip(P::INTERPOLATION) {
        advance(&zero, *h, slopes, row, coefficient);
    }
}

/// Evaluates the rates and multipliers of consecutive stages, beginning with stage `first`.
fn stages<P, L, F>(
    system: &L,
    from: &StepStart<L::Scalar, L::N, L::M>,
    h: L::Scalar,
    (slopes, multipliers): (&mut Slopes<L::Scalar, L::N>, &mut StageMultipliers<L::Scalar, L::M>),
    (first, rows): (usize, &[TableauRow]),
    statistics: &mut Statistics,
) -> Result<(), Error>
where
    P: Pair,
    L: Lagrangian<Scalar: Real>,
    F: VectorField<L>,
{
    let mut point = StagePoint { t: from.t, y: from.y, velocity: slopes[0].half(0) };
    let mut newest = slopes[first - 1];
    for (number, row) in rows.iter().enumerate().map(|(i, row)| (first + i, row)) {
        advance_from((number - 1, &newest), &from.y, h, slopes, row, &mut point.y);
        point.t = from.t + h * L::Scalar::constant(P::NODES[number]);
        let rates = if const { is_carried::<L::N>() } { &mut newest } else { &mut slopes[number] };
        let found = inlined_slope::<L, F>(system, &point, Some(&from.active), rates, statistics)?;
        multipliers[number] = found.multipliers;
        if const { is_carried::<L::N>() } {
            slopes[number] = newest;
        }
    }
    Ok(())
}
