//! One step of an embedded Runge–Kutta pair, projected onto the constraints.

use core::fmt;

use super::adaptive::Adaptive;
use super::bounds::{self, MultiplierBounds};
use super::clock::Clock;
use super::contract::{Limits, Method, Step};
use super::control::{Control, StateEntry};
use super::pair::{Pair, Slopes, advance, check, error_needs_last, last};
use super::pair_memory::{PairMemory, StepStart, Taken};
use super::pair_stages::{interpolate, look_within, stages};
use super::slope::{check_finite, slope};
use crate::error::{Ending, Error, Pace};
use crate::number::larger;
use crate::number::{Real, Scalar};
use crate::room::{Room, Within};
use crate::solution::interpolant::Polynomial;
use crate::solution::vector_field::{StagePoint, VectorField};
use crate::statistics::Statistics;
use crate::system::{StateOf, System};
use crate::vector::{Array, Element, Length, Numbers, PhaseVector, SpareVectors, StaticLength};

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
struct Reached<T: Element, N: Length, M: StaticLength> {
    y: PhaseVector<T, N>,
    error: T,
    active: Array<bool, M>,
}

impl<P, L, F> Method<L, F> for Adaptive<P>
where
    P: Pair,
    L: System<Scalar: Real>,
    F: VectorField<L>,
{
    type Memory = PairMemory<L::Scalar, L::Length, L::M>;
    type Interpolant = Polynomial<L::Scalar, P::Coefficients<PhaseVector<L::Scalar, L::Length>>>;

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
        let zero = PhaseVector::of_length(system.length(), L::Scalar::constant(0.0));
        let unknown = Array::filled(L::Scalar::constant(f64::NAN));
        let mut memory = PairMemory {
            clock: Clock::new(start.t, self.fixed_step.map(L::Scalar::constant)),
            control: Control::new(L::Scalar::constant(0.0)),
            is_planned: false,
            y: zero.clone(),
            has_slope: false,
            slope: zero.clone(),
            active: Array::filled(true),
            multipliers: unknown,
            slopes: Room::filled(zero),
            stage_multipliers: Room::filled(unknown),
            taken: None,
            spare: SpareVectors::default(),
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
        // After a failure the step may be too short to advance the time: it is chosen anew.
        memory.is_planned &= memory.control.step >= memory.clock.at_least(L::Scalar::constant(0.0));
        // The velocity is the initial guess for the Legendre inversion of the first rate.
        memory.y = F::phase(system, state);
        memory.slope[0].copy_from_slice(state.v.entries());
        (memory.has_slope, memory.taken) = (false, None);
        memory.ensure_slope::<L, F>(system, statistics)
    }

    fn step(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        end: L::Scalar,
        _: &StateOf<L>,
        to: &mut StateOf<L>,
        statistics: &mut Statistics,
    ) -> Step {
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
            Ok(reached) => {
                self.take::<L, F>(memory, (h, time), reached, to);
                return Step::Accepted;
            }
            Err(Refusal::Inaccurate(error, place)) => {
                memory.control.refuse::<P>(h, error);
                Ending::StepTooSmall { time: now, entry: F::entry(system, place.0, place.1) }
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
        _: [&StateOf<L>; 2],
        statistics: &mut Statistics,
    ) -> Result<Self::Interpolant, Error> {
        let (start, length) = look_within::<P, L, F>(system, memory, statistics)?;
        // Build the coefficients in place: the only copy is into the trajectory.
        let zero = PhaseVector::of_length(system.length(), L::Scalar::constant(0.0));
        let mut coefficients = P::coefficients(zero);
        interpolate::<P, _, L::Length, L::M>(memory, coefficients.as_mut());
        Ok(Polynomial::new(start, length, coefficients))
    }

    #[inline(always)]
    fn push_interpolant(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        _: [&StateOf<L>; 2],
        statistics: &mut Statistics,
        to: &mut Within<Self::Interpolant>,
    ) -> Result<(), Error> {
        let (start, length) = look_within::<P, L, F>(system, memory, statistics)?;
        let zero = PhaseVector::of_length(system.length(), L::Scalar::constant(0.0));
        to.push(Polynomial::new(start, length, P::coefficients(zero)));
        if let Some(last) = to.last_mut() {
            interpolate::<P, _, L::Length, L::M>(memory, last.coefficients_mut());
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
        (memory.clock.now, memory.active) = (from.t, from.active);
        (memory.has_slope, memory.control) = (true, control);
        memory.y.copy_from(&from.y);
        memory.spare.give_back(from.y);
        memory.slope.copy_from(&memory.slopes[0]);
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
    pub(crate) fn aim<L: System<Scalar: Real>, F: VectorField<L>>(
        &self,
        system: &L,
        memory: &mut PairMemory<L::Scalar, L::Length, L::M>,
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
    pub(crate) fn accept_with<T: Real, N: Length, M: StaticLength>(
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
    fn can_try_again<T: Real, N: Length, M: StaticLength>(&self, memory: &PairMemory<T, N, M>) -> bool {
        self.fixed_step.is_none() && memory.clock.advances_by(memory.control.step)
    }

    /// Accepts a step: moves to its end.
    fn take<L: System<Scalar: Real>, F: VectorField<L>>(
        &self,
        memory: &mut PairMemory<L::Scalar, L::Length, L::M>,
        (h, time): (L::Scalar, L::Scalar),
        Reached { y, error, active }: Reached<L::Scalar, L::Length, L::M>,
        state: &mut StateOf<L>,
    ) {
        let from = memory.origin();
        let earlier = memory.taken.replace(Taken { from, h, control: memory.control.clone() });
        if let Some(Taken { from, .. }) = earlier {
            memory.spare.give_back(from.y);
        }
        memory.y.copy_from(&y);
        memory.spare.give_back(y);
        memory.slope.copy_from(&memory.slopes[last::<P>()]);
        memory.active = active;
        memory.multipliers = memory.stage_multipliers[last::<P>()];
        memory.has_slope = !(self.ignores_error() && F::HOLDS_VELOCITY);
        self.after_acceptance(&mut memory.control, &mut memory.clock, (h, time), error);
        let velocity = if F::HOLDS_VELOCITY { &memory.y[1] } else { &memory.slope[0] };
        state.t = time;
        state.q.entries_mut().copy_from_slice(&memory.y[0]);
        state.v.entries_mut().copy_from_slice(velocity);
    }

    /// Computes stages, error and projection of a step; any failure rejects it.
    fn attempt<L: System<Scalar: Real>, F: VectorField<L>, const IS_FIXED: bool>(
        &self,
        system: &L,
        memory: &mut PairMemory<L::Scalar, L::Length, L::M>,
        step: (L::Scalar, L::Scalar),
        statistics: &mut Statistics,
    ) -> Result<Reached<L::Scalar, L::Length, L::M>, Refusal<L::Scalar>> {
        const { check::<P>() };
        if IS_FIXED {
            memory.ensure_slope::<L, F>(system, statistics)?;
        }
        memory.slopes[0].copy_from(&memory.slope);
        memory.stage_multipliers[0] = memory.multipliers;
        let from = memory.origin();
        let mut next = StagePoint {
            t: from.t,
            y: memory.spare.lend(&from.y),
            velocity: memory.slope.half_if_constant(0),
        };
        let reached = self.reach::<L, F, IS_FIXED>(system, memory, &from, &mut next, step, statistics);
        memory.spare.give_back(from.y);
        match reached {
            Ok((error, active)) => Ok(Reached { y: next.y, error, active }),
            Err(refusal) => {
                memory.spare.give_back(next.y);
                Err(refusal)
            }
        }
    }

    /// Moves `next` from the start of a step to its end. Returns the error, and the constraints that determine the slope there.
    #[inline(always)]
    fn reach<L: System<Scalar: Real>, F: VectorField<L>, const IS_FIXED: bool>(
        &self,
        system: &L,
        memory: &mut PairMemory<L::Scalar, L::Length, L::M>,
        from: &StepStart<L::Scalar, L::Length, L::M>,
        next: &mut StagePoint<L::Scalar, L::Length>,
        (h, time): (L::Scalar, L::Scalar),
        statistics: &mut Statistics,
    ) -> Result<(L::Scalar, Array<bool, L::M>), Refusal<L::Scalar>> {
        let has_constraints = const { F::HAS_CONSTRAINTS };
        let PairMemory { slopes, stage_multipliers: multipliers, spare, .. } = memory;
        let (slopes, multipliers) = (&mut **slopes, &mut **multipliers);
        stages::<P, L, F>(system, from, h, (slopes, multipliers, spare), (1, P::STAGES), statistics)?;
        advance(&from.y, h, slopes, P::WEIGHTS, &mut next.y);
        next.t = time;
        check_finite::<L, F>(system, time, &next.y)?;
        let mut active = from.active;
        let needs_last = !IS_FIXED && error_needs_last::<P>();
        if needs_last {
            let found = slope::<L, F>(system, next, Some(&active), &mut slopes[last::<P>()], statistics)?;
            (active, multipliers[last::<P>()]) = (found.active, found.multipliers);
        }
        let error = match IS_FIXED {
            true => L::Scalar::constant(0.0),
            false => self.check_error(slopes, h, [&from.y, &next.y], spare)?,
        };
        if has_constraints {
            F::settle(system, next)?;
        }
        if !(IS_FIXED && F::HOLDS_VELOCITY) && (has_constraints || !needs_last) {
            let found = slope::<L, F>(system, next, None, &mut slopes[last::<P>()], statistics)?;
            (active, multipliers[last::<P>()]) = (found.active, found.multipliers);
        }
        Ok((error, active))
    }

    /// Error in units of the tolerance; an error above 1 rejects the step.
    fn check_error<T: Real, N: Length>(
        &self,
        slopes: &Slopes<T, N>,
        h: T,
        [before, after]: [&PhaseVector<T, N>; 2],
        spare: &mut SpareVectors<T, N>,
    ) -> Result<T, Refusal<T>> {
        let (tolerance, ends) = (self.tolerance::<T>(), [before, after]);
        let error = tolerance.error::<P, T, N>(slopes, h, ends, spare);
        if !self.accepts(error) {
            return Err(Refusal::Inaccurate(error, tolerance.worst::<P, T, N>(slopes, ends, spare)));
        }
        Ok(error)
    }

    /// Spacing of representable times near the current time; `None` if it is fine enough. Stages are
    /// evaluated at rounded times. The spacing is too coarse if the rates change so much over it that the
    /// error of a step is half the tolerance or more.
    #[cold]
    fn find_coarseness<L: System<Scalar: Real>, F: VectorField<L>>(
        &self,
        system: &L,
        memory: &PairMemory<L::Scalar, L::Length, L::M>,
    ) -> Option<f64> {
        let PairMemory { clock, control, y, slope: here, active, .. } = memory;
        // 0.75 to 1.5 of the distance to the next number: the sum rounds to that number.
        let next = clock.now + L::Scalar::constant(0.75 * L::Scalar::EPSILON) * Scalar::abs(clock.now);
        let point = StagePoint { t: next, y: y.clone(), velocity: here.half_if_constant(0) };
        let mut there = here.clone();
        let (active, mut statistics) = (memory.has_slope.then_some(active)?, Statistics::default());
        slope::<L, F>(system, &point, Some(active), &mut there, &mut statistics).ok()?;
        let change = there.each_with(here, |there, here| there - here);
        let lost = self.tolerance::<L::Scalar>().part(control.step, &change, y);
        (lost >= L::Scalar::constant(0.5)).then(|| (next - clock.now).to_f64())
    }

    fn estimate_step<L: System<Scalar: Real>, F: VectorField<L>>(
        &self,
        system: &L,
        memory: &PairMemory<L::Scalar, L::Length, L::M>,
        statistics: &mut Statistics,
    ) -> L::Scalar {
        let PairMemory { clock, y, slope: first, active, .. } = memory;
        let guess = self.tolerance::<L::Scalar>().guess_step(y, first, clock.left());
        let h = clock.directed(guess);
        let euler = y.each_with(first, |y, slope| y + h * slope);
        let point = StagePoint { t: clock.now + h, y: euler, velocity: first.half_if_constant(0) };
        let mut second = first.clone();
        match slope::<L, F>(system, &point, Some(active), &mut second, statistics) {
            Ok(_) => self.first_step_from(guess, y, first, &second),
            Err(_) => guess,
        }
    }
}
