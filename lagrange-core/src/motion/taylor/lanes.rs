//! Steps of Taylor's method on SIMD lanes.
//!
//! All motions are expanded at once, each in its own unit of time. After a rejected step, the scalar method takes over
//! until a step is accepted.

use core::convert::Infallible;

use super::defect::{part, round_off};
use super::expansion::Expansion;
use super::last::Last;
use super::memory::TaylorMemory;
use super::polynomial::TaylorPolynomial;
use super::sampling::{Sampling, few, parts, samples_of_steep};
use super::settings::Taylor;
use crate::error::Error;
use crate::motion::Interpolant;
use crate::motion::lanes::{LaneMethod, LaneMotions, LaneOutcome, LaneReliability, unpacked, unpacked_phase};
use crate::number::{Lanes, Scalar};
use crate::solution::consistent::BOTH;
use crate::solution::near::{self, Corrections, compensated};
use crate::statistics::Statistics;
use crate::system::{Pack, Packed, RightHandSides, Solution, State, StateOf, TaylorSeries};
use crate::vector::{Array, Entrywise, FixedArray, PhaseVector, StaticLength, from_fn, vector};

/// Motions in lock-step, with the working arrays of a step.
#[derive(Debug)]
pub struct TaylorLanes<S, U, N: StaticLength, M: StaticLength> {
    system: S,
    here: LaneState<N, M>,
    /// Series about the start of the last step tried.
    series: Expansion<U, Lanes, N>,
    /// End of the last step tried.
    next: LaneState<N, M>,
}

/// States of the motions, their compensation terms, and the solution of the equations at these states.
#[derive(Clone, Copy, Debug)]
struct LaneState<N: StaticLength, M: StaticLength> {
    y: PhaseVector<Lanes, N>,
    rest: [Array<Lanes, N>; 2],
    solution: Solution<Lanes, N, M>,
}

/// Step to try in a lane.
#[derive(Clone, Copy, Default)]
struct LaneStep {
    /// Length of the step before it is shortened to the time left.
    planned: f64,
    h: f64,
    end: f64,
}

impl<L> LaneMethod<L> for Taylor
where
    L: TaylorSeries<Scalar = f64> + Pack<Lanes, Packed: TaylorSeries<N = L::N, M = L::M, Scalar = Lanes>>,
{
    type LaneMemory = TaylorLanes<L::Packed, <L::Packed as TaylorSeries>::Sums, L::N, L::M>;

    fn now(memory: &Self::Memory) -> f64 {
        memory.clock.now
    }

    fn state(memory: &Self::Memory) -> StateOf<L> {
        memory.state
    }

    fn is_at_end(memory: &Self::Memory) -> bool {
        memory.clock.is_at_end()
    }

    fn prepare(&self, _: &L, memory: &mut Self::Memory, end: f64, _: &mut Statistics) -> Result<(), Error> {
        self.aim(memory, end);
        Ok(())
    }

    fn lane_memory(&self, system: &L, memory: &Self::Memory) -> Self::LaneMemory {
        let zero = [Array::filled(Lanes::constant(0.0)); 2];
        let solution = Solution {
            accelerations: memory.solved.solution.accelerations.each(Lanes::constant),
            multipliers: memory.solved.solution.multipliers.each(Lanes::constant),
            pivot: Packed::splat(&memory.solved.solution.pivot),
            rank: <L::M>::COUNT,
        };
        let y = Packed::splat(&PhaseVector::of(memory.state.q, memory.state.v));
        let here = LaneState { y, rest: zero, solution };
        let series = Expansion::new::<L::Packed>(self.order::<f64>());
        TaylorLanes { system: system.pack(), here, series, next: here }
    }

    fn place(lane_memory: &mut Self::LaneMemory, lane: usize, system: &L) -> bool {
        system.place(&mut lane_memory.system, lane)
    }

    fn load(TaylorLanes { here, .. }: &mut Self::LaneMemory, lane: usize, memory: &Self::Memory) {
        let (state, solution) = (&memory.state, &memory.solved.solution);
        here.y.place(lane, &PhaseVector::of(state.q, state.v));
        here.rest.place(lane, &memory.rest);
        let accelerations = here.solution.accelerations.iter_mut().zip(&solution.accelerations);
        accelerations.for_each(|(packed, x)| packed.place(lane, x));
        let multipliers = here.solution.multipliers.iter_mut().zip(&solution.multipliers);
        multipliers.for_each(|(packed, x)| packed.place(lane, x));
        here.solution.pivot.place(lane, &solution.pivot);
    }

    fn unload(TaylorLanes { here, .. }: &Self::LaneMemory, lane: usize, memory: &mut Self::Memory) {
        let (state, solution) = (&mut memory.state, &mut memory.solved.solution);
        let [q, v] = unpacked_phase(&here.y, lane).arrays();
        (state.t, state.q, state.v) = (memory.clock.now, vector(q), vector(v));
        memory.rest = here.rest.each_ref().map(|rest| unpacked(rest, lane));
        solution.accelerations = here.solution.accelerations.each(|x| x.to_array()[lane]);
        solution.multipliers = here.solution.multipliers.each(|x| x.to_array()[lane]);
        solution.pivot = here.solution.pivot.to_array()[lane];
    }

    fn phase(lane_memory: &Self::LaneMemory, lane: usize) -> PhaseVector<f64, L::N> {
        unpacked_phase(&lane_memory.here.y, lane)
    }

    fn reached(lane_memory: &Self::LaneMemory, lane: usize) -> PhaseVector<f64, L::N> {
        unpacked_phase(&lane_memory.next.y, lane)
    }

    #[inline(always)]
    fn attempt<const HAS_DENSE_OUTPUT: bool>(
        &self,
        lane_memory: &mut Self::LaneMemory,
        motions: &mut LaneMotions<'_, L, Self>,
    ) -> [Option<LaneOutcome>; Lanes::COUNT] {
        let mut reliability = LaneReliability::new();
        let time = |TaylorMemory { clock, planned, .. }: &Self::Memory| (clock.now, clock.directed(*planned));
        let times = motions
            .each_ref()
            .map(|motion| motion.as_ref().map_or((0.0, 1.0), |motion| time(&motion.memory)));
        lane_memory.expand(times, &mut reliability);
        let last = lane_memory.series.last_sizes(Lanes::constant(self.slack::<f64>()));
        let mut allowed = [0.0; Lanes::COUNT];
        for (lane, allowed) in allowed.iter_mut().enumerate() {
            *allowed = last.lane(lane).allowed();
        }
        // A free lane makes steps of length zero.
        let plan = from_fn(|lane| {
            motions[lane]
                .as_ref()
                .map_or(LaneStep::default(), |motion| self.plan::<L>(allowed[lane], &motion.memory))
        });
        let keeps = lane_memory.advance(self, &plan, self.defect_allowed::<L>(), &mut reliability);
        let trusted = reliability.lanes();
        from_fn(|lane| {
            let motion = motions[lane].as_mut()?;
            let TaylorMemory { clock, solved, is_expanded, planned, sampling, .. } = &mut motion.memory;
            let (length, few) = (plan[lane].h.abs(), few::<L>());
            // If the last coefficients are zero, or the step is much longer than the one before, samples
            // within the step are needed: the scalar method takes it.
            let can_go = !*is_expanded
                && solved.solution.multipliers_are_unique()
                && allowed[lane].is_finite()
                && sampling.count::<L>(length) == few;
            if !(can_go && trusted[lane] && keeps[lane] && clock.is_ahead(plan[lane].end)) {
                return None;
            }
            (*planned, clock.now) = (plan[lane].planned, plan[lane].end);
            *sampling = Sampling::after(length, few);
            motion.statistics.evaluations += last.order + 1 + few;
            motion.statistics.accepted += 1;
            Some(LaneOutcome::Accepted)
        })
    }

    fn commit(TaylorLanes { here, next, .. }: &mut Self::LaneMemory, chosen: Lanes) {
        *here = next.select(chosen, here);
    }

    fn within(TaylorLanes { series, .. }: &Self::LaneMemory, lane: usize) -> impl Interpolant<f64, L::N> {
        let [start, unit] = [series.start, series.unit].map(|x| x.to_array()[lane]);
        TaylorPolynomial::new(start, unit, series.q.iter().map(|q| q.map(|x| x.to_array()[lane])))
    }
}

impl Last<Lanes> {
    #[inline(always)]
    fn lane(&self, lane: usize) -> Last<f64> {
        let of_lane = |x: Lanes| x.to_array()[lane];
        Last { order: self.order, unit: of_lane(self.unit), sizes: self.sizes.map(of_lane) }
    }
}

impl Taylor {
    /// Step of a lane whose last coefficients allow the length `allowed`.
    fn plan<L: TaylorSeries<Scalar = f64>>(
        &self,
        allowed: f64,
        memory: &TaylorMemory<L::Sums, f64, L::N, L::M>,
    ) -> LaneStep {
        let longest = memory.sampling.longest::<L>(memory.planned);
        let planned = self.choose(allowed, longest, &memory.clock);
        let (h, end) = memory.clock.next(planned);
        LaneStep { planned, h, end }
    }
}

impl<S: TaylorSeries<Scalar = Lanes, Sums = U>, U: FixedArray<Lanes>> TaylorLanes<S, U, S::N, S::M> {
    /// Expands the motions. `times` holds the time and the unit of time of each lane.
    fn expand(&mut self, times: [(f64, f64); Lanes::COUNT], reliability: &mut LaneReliability) {
        let Self { system, here: LaneState { y, solution, .. }, series, .. } = self;
        let (t, unit) = (times.map(|(t, _)| t).into(), times.map(|(_, unit)| unit).into());
        let state = State { t, q: vector(y.half(0)), v: vector(y.half(1)) };
        let factor = system.factor(&state);
        let solve = |(forcing, bias): &RightHandSides<Lanes, S::N, S::M>| {
            Ok(system.solve_with(&factor, forcing, bias))
        };
        let Ok::<(), Infallible>(()) = series.orders(system, &state, solution, unit, solve);
        reliability.solution(solution);
        series.last().into_iter().for_each(|last| reliability.numbers(last));
    }

    /// Sums the series over the step, and projects onto the constraints. Returns true for each lane whose result agrees
    /// with the equations.
    fn advance(
        &mut self,
        method: &Taylor,
        plan: &[LaneStep; Lanes::COUNT],
        defect_allowed: f64,
        reliability: &mut LaneReliability,
    ) -> [bool; Lanes::COUNT] {
        let (h, t) = (plan.map(|plan| plan.h).into(), plan.map(|plan| plan.end).into());
        let LaneState { y, rest, .. } = &self.here;
        let [dq, dv, accelerations] = self.series.change(h);
        let (q, rest_q) = compensated(&y.half(0), &dq, &rest[0]);
        let (v, rest_v) = compensated(&y.half(1), &dv, &rest[1]);
        let (mut state, mut doubt) = (State { t, q: vector(q), v: vector(v) }, Lanes::constant(0.0));
        let mut rest = [rest_q, rest_v];
        if <S::M>::COUNT > 0 {
            let corrections = Corrections::OnceAfter(h);
            (state, doubt) = near::project::<_, f64>(&self.system, &BOTH, corrections, state, &mut rest);
        }
        let solution = self.system.accelerations_unchecked(&state);
        reliability.solution(&solution);
        [&q, &v, &accelerations].into_iter().for_each(|numbers| reliability.numbers(numbers));
        let slack = Lanes::constant(method.slack::<f64>());
        let off = |accelerations: &Array<Lanes, S::N>, solution: &Solution<Lanes, S::N, S::M>| {
            let off = |i: usize| (accelerations[i] - solution.accelerations[i]).abs();
            let parts = (0..<S::N>::COUNT).map(|i| part([y[1][i], state.v[i]], off(i), h, slack));
            parts.fold(Lanes::constant(0.0), |worst, part| worst.max(part))
        };
        let mut worst = off(&accelerations, &solution);
        for (accelerations, solution) in self.samples(h) {
            reliability.numbers(&accelerations);
            reliability.solution(&solution);
            worst = worst.max(off(&accelerations, &solution));
        }
        let [doubt, worst, pivot] = [doubt, worst, solution.pivot].map(Lanes::to_array);
        let y = PhaseVector::of(state.q, state.v);
        self.next = LaneState { y, rest, solution };
        let (keeps_roots, is_steep) = (self.keeps_roots(h), self.is_steep(h));
        from_fn(|lane| {
            !is_steep[lane]
                && doubt[lane] == 0.0
                && worst[lane] <= defect_allowed.max(round_off(pivot[lane]))
                && keeps_roots[lane]
        })
    }

    /// Accelerations of the series, and the solution of the equations, at the samples within a step.
    fn samples(&self, h: Lanes) -> impl Iterator<Item = (Array<Lanes, S::N>, Solution<Lanes, S::N, S::M>)> {
        let (parts, y, start) = (parts(few::<S>()), &self.here.y, self.series.start);
        parts.map(move |part| {
            let length = h * Lanes::constant(part);
            let [dq, dv, accelerations] = self.series.change(length);
            let [q, v] = [(&y[0], dq), (&y[1], dv)].map(|(x, change)| vector(from_fn(|i| x[i] + change[i])));
            let there = State { t: start + length, q, v };
            (accelerations, self.system.accelerations_unchecked(&there))
        })
    }

    /// True for each lane in which steep functions need samples.
    fn is_steep(&self, h: Lanes) -> [bool; Lanes::COUNT] {
        self.series.steep::<S>(h).fold([false; Lanes::COUNT], |is_steep, (numbers, exponent)| {
            let [value, change] = numbers.map(Lanes::to_array);
            from_fn(|lane| {
                is_steep[lane] || samples_of_steep([value[lane], change[lane]], exponent) > few::<S>()
            })
        })
    }

    /// True for each lane in which no root can reach zero in a step of this length.
    fn keeps_roots(&self, h: Lanes) -> [bool; Lanes::COUNT] {
        let theta = h / self.series.unit;
        self.series.series_of_roots::<S>().fold([true; Lanes::COUNT], |keeps, root| {
            let [value, change] = root.value_and_change(theta).map(Lanes::to_array);
            from_fn(|lane| keeps[lane] && change[lane] < value[lane])
        })
    }
}

impl<N: StaticLength, M: StaticLength> LaneState<N, M> {
    /// Returns the lanes of `self` where `chosen` is positive, else those of `other`.
    fn select(&self, chosen: Lanes, other: &Self) -> Self {
        let select = |x: Lanes, y: Lanes| x.select(chosen, y);
        let y = from_fn(|half| from_fn(|i| select(self.y[half][i], other.y[half][i])));
        let rest = from_fn(|half| from_fn(|i| select(self.rest[half][i], other.rest[half][i])));
        let (a, b) = (&self.solution, &other.solution);
        let solution = Solution {
            accelerations: a.accelerations.each_with(&b.accelerations, select),
            multipliers: a.multipliers.each_with(&b.multipliers, select),
            pivot: select(a.pivot, b.pivot),
            rank: a.rank,
        };
        Self { y, rest, solution }
    }
}
