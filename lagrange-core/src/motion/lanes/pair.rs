//! Steps of an embedded Runge–Kutta pair on SIMD lanes.

use super::contract::{LaneMethod, LaneMotions, unpacked_phase};
use super::motion::LaneOutcome;
use super::reliability::LaneReliability;
use crate::error::Error;
use crate::motion::method::pair::{Slopes, TableauRow, advance, check, last};
use crate::motion::method::pair_memory::PairMemory;
use crate::motion::{Adaptive, Interpolant, Pair};
use crate::number::{Lanes, Scalar};
use crate::room::Room;
use crate::solution::consistent::BOTH;
use crate::solution::interpolant::{evaluate, hermite};
use crate::solution::near::{self, Corrections};
use crate::solution::vector_field::{LagrangianVectorField, StagePoint, VectorField};
use crate::statistics::Statistics;
use crate::system::{Lagrangian, Pack, Packed, State, StateOf};
use crate::vector::{Array, Entrywise, PhaseVector, SpareVectors, StaticLength, array, from_fn, vector};

/// Motions in lock-step, with the working arrays of a step.
#[derive(Debug)]
pub struct PairLanes<S, P: Pair, N: StaticLength> {
    system: S,
    y: PhaseVector<Lanes, N>,
    /// Slopes of the step; the first is the slope at `y`.
    slopes: Room<Slopes<Lanes, N>>,
    /// Start, length and end of the step tried, per lane.
    now: [f64; Lanes::COUNT],
    h: [f64; Lanes::COUNT],
    end: [f64; Lanes::COUNT],
    /// Coordinates and velocities at the end of the step tried.
    next: PhaseVector<Lanes, N>,
    /// Coefficients of the dense output, valid in the lanes that need it.
    coefficients: P::Coefficients<PhaseVector<Lanes, N>>,
}

/// Error and reliability of a step in each lane, before it is accepted or rejected.
struct LaneErrors {
    error: [f64; Lanes::COUNT],
    /// True for lanes whose result is reliable.
    sound: [bool; Lanes::COUNT],
}

impl<P, L> LaneMethod<L> for Adaptive<P>
where
    P: Pair,
    L: Lagrangian<Scalar = f64> + Pack<Lanes, Packed: Lagrangian<N = L::N, M = L::M, Scalar = Lanes>>,
{
    type LaneMemory = PairLanes<L::Packed, P, L::N>;

    fn now(memory: &PairMemory<f64, L::N, L::M>) -> f64 {
        memory.clock.now
    }

    fn state(memory: &PairMemory<f64, L::N, L::M>) -> StateOf<L> {
        let [q, v] = memory.y.arrays().map(vector);
        State { t: memory.clock.now, q, v }
    }

    fn is_at_end(memory: &PairMemory<f64, L::N, L::M>) -> bool {
        memory.clock.is_at_end()
    }

    fn prepare(
        &self,
        system: &L,
        memory: &mut PairMemory<f64, L::N, L::M>,
        end: f64,
        statistics: &mut Statistics,
    ) -> Result<(), Error> {
        self.aim::<L, LagrangianVectorField>(system, memory, end, statistics);
        // The lane needs the slope only if a step follows.
        if memory.clock.is_at_end() {
            return Ok(());
        }
        memory.ensure_slope::<L, LagrangianVectorField>(system, statistics)
    }

    fn lane_memory(&self, system: &L, memory: &PairMemory<f64, L::N, L::M>) -> Self::LaneMemory {
        let zero = PhaseVector::filled(Lanes::constant(0.0));
        let mut slopes = Room::<Slopes<Lanes, L::N>>::filled(zero);
        slopes[0] = Packed::splat(&memory.slope);
        let (system, y) = (system.pack(), Packed::splat(&memory.y));
        let [now, h, end] = [[0.0; Lanes::COUNT]; 3];
        PairLanes { system, y, slopes, now, h, end, next: zero, coefficients: P::coefficients(zero) }
    }

    fn place(lane_memory: &mut Self::LaneMemory, lane: usize, system: &L) -> bool {
        system.place(&mut lane_memory.system, lane)
    }

    fn load(lane_memory: &mut Self::LaneMemory, lane: usize, memory: &PairMemory<f64, L::N, L::M>) {
        lane_memory.y.place(lane, &memory.y);
        lane_memory.slopes[0].place(lane, &memory.slope);
    }

    fn unload(lane_memory: &Self::LaneMemory, lane: usize, memory: &mut PairMemory<f64, L::N, L::M>) {
        [memory.y, memory.slope] =
            [&lane_memory.y, &lane_memory.slopes[0]].map(|packed| unpacked_phase(packed, lane));
        memory.multipliers = Array::filled(f64::NAN);
    }

    fn phase(lane_memory: &Self::LaneMemory, lane: usize) -> PhaseVector<f64, L::N> {
        unpacked_phase(&lane_memory.y, lane)
    }

    fn reached(lane_memory: &Self::LaneMemory, lane: usize) -> PhaseVector<f64, L::N> {
        unpacked_phase(&lane_memory.next, lane)
    }

    #[inline(always)]
    fn attempt<const HAS_DENSE_OUTPUT: bool>(
        &self,
        lane_memory: &mut Self::LaneMemory,
        motions: &mut LaneMotions<'_, L, Self>,
    ) -> [Option<LaneOutcome>; Lanes::COUNT] {
        // A free lane makes steps of length zero.
        let plan: [_; Lanes::COUNT] =
            from_fn(|lane| motions[lane].as_ref().map_or((0.0, 0.0), |motion| motion.memory.next()));
        lane_memory.now =
            from_fn(|lane| motions[lane].as_ref().map_or(0.0, |motion| motion.memory.clock.now));
        (lane_memory.h, lane_memory.end) = (plan.map(|(h, _)| h), plan.map(|(_, end)| end));
        let mut tried = lane_memory.attempt(self, motions);
        let looked = match const { HAS_DENSE_OUTPUT } {
            true => lane_memory.look_within(self, motions, &mut tried),
            false => [false; Lanes::COUNT],
        };
        from_fn(|lane| {
            let motion = motions[lane].as_mut().filter(|_| tried.sound[lane])?;
            let outcome = decide(self, &mut motion.memory, plan[lane], tried.error[lane])?;
            count(self, &mut motion.memory, &mut motion.statistics, outcome, looked[lane]);
            Some(outcome)
        })
    }

    fn commit(lane_memory: &mut Self::LaneMemory, chosen: Lanes) {
        let PairLanes { y, slopes, next, .. } = lane_memory;
        for half in 0..2 {
            for i in 0..<L::N>::COUNT {
                let (y, slope) = (&mut y[half][i], slopes[last::<P>()][half][i]);
                *y = next[half][i].select(chosen, *y);
                slopes[0][half][i] = slope.select(chosen, slopes[0][half][i]);
            }
        }
    }

    fn within(lane_memory: &Self::LaneMemory, lane: usize) -> impl Interpolant<f64, L::N> {
        let (start, length, coefficients) =
            (lane_memory.now[lane], lane_memory.h[lane], &lane_memory.coefficients);
        LaneOf { lane, start, length, coefficients }
    }
}

impl<S: Lagrangian<Scalar = Lanes>, P: Pair> PairLanes<S, P, S::N> {
    /// Computes stages, error, projection, and the slopes at the end of the step in all lanes.
    fn attempt<L: Lagrangian<N = S::N, M = S::M, Scalar = f64>>(
        &mut self,
        method: &Adaptive<P>,
        motions: &LaneMotions<'_, L, Adaptive<P>>,
    ) -> LaneErrors {
        const { check::<P>() };
        let (h, end) = (Lanes::from(self.h), Lanes::from(self.end));
        let mut reliability = LaneReliability::new();
        self.stages((1, P::STAGES), &mut reliability);
        let mut next = self.y;
        advance(&self.y, h, &self.slopes, P::WEIGHTS, &mut next);
        reliability.numbers(next.flat());
        if method.error_needs_last() {
            self.slope(last::<P>(), end, &next, &mut reliability);
        }
        let tolerance = method.tolerance::<f64>();
        let error = tolerance
            .error::<P, _, S::N>(&self.slopes, h, [&self.y, &next], &mut SpareVectors::default())
            .to_array();
        let projected = match <S::M>::COUNT {
            0 => [true; Lanes::COUNT],
            _ => self.project(&mut next, method, motions, &error),
        };
        if <S::M>::COUNT > 0 || !method.error_needs_last() {
            self.slope(last::<P>(), end, &next, &mut reliability);
        }
        self.next = next;
        let trusted = reliability.lanes();
        LaneErrors { error, sound: from_fn(|lane| trusted[lane] && projected[lane]) }
    }

    /// Computes the slopes of consecutive stages; `first` is the index of the first one.
    #[inline]
    fn stages(&mut self, (first, rows): (usize, &[TableauRow]), reliability: &mut LaneReliability) {
        let (now, h) = (Lanes::from(self.now), Lanes::from(self.h));
        let mut y = self.y;
        for (number, row) in (first..).zip(rows) {
            advance(&self.y, h, &self.slopes, row, &mut y);
            self.slope(number, now + h * Lanes::constant(P::NODES[number]), &y, reliability);
        }
    }

    /// Evaluates the slope with index `number`.
    #[inline(always)]
    fn slope(
        &mut self,
        number: usize,
        t: Lanes,
        y: &PhaseVector<Lanes, S::N>,
        reliability: &mut LaneReliability,
    ) {
        let solution =
            self.system.accelerations_unchecked(&State { t, q: vector(y.half(0)), v: vector(y.half(1)) });
        reliability.solution(&solution);
        self.slopes[number].set(0, y.half(1));
        self.slopes[number].set(1, array(solution.accelerations));
    }

    /// Projects all lanes onto the constraints at once. A lane for which that fails is projected alone if its step is
    /// accurate. Returns true for each lane that is projected or rejected anyway.
    fn project<L: Lagrangian<N = S::N, M = S::M, Scalar = f64>>(
        &self,
        next: &mut PhaseVector<Lanes, S::N>,
        method: &Adaptive<P>,
        motions: &LaneMotions<'_, L, Adaptive<P>>,
        error: &[f64; Lanes::COUNT],
    ) -> [bool; Lanes::COUNT] {
        let state = State { t: self.end.into(), q: vector(next.half(0)), v: vector(next.half(1)) };
        let rest = &mut [Array::filled(Lanes::constant(0.0)); 2];
        let (near, doubt) =
            near::project::<_, f64>(&self.system, &BOTH, Corrections::ToRoundOff, state, rest);
        let is_there = doubt.to_array().map(|doubt| doubt == 0.0);
        let chosen = Lanes::from(is_there.map(|is_there| if is_there { 1.0 } else { 0.0 }));
        let before = *next;
        *next = PhaseVector::of(near.q, near.v);
        for (x, before) in next.flat_mut().iter_mut().zip(before.flat()) {
            *x = x.select(chosen, *before);
        }
        from_fn(|lane| match &motions[lane] {
            Some(motion) if !is_there[lane] && method.accepts(error[lane]) => {
                let y = unpacked_phase(next, lane);
                let point = StagePoint::at(self.end[lane], y);
                let projected = <LagrangianVectorField as VectorField<L>>::project(&motion.system, &point);
                projected.map(|state| next.place(lane, &PhaseVector::of(state.q, state.v))).is_ok()
            }
            _ => true,
        })
    }

    /// Computes the dense output of steps that will be accepted, if a lane needs it. Returns these lanes. A lane with
    /// unreliable stages of the dense output is marked unsound, so that the scalar method repeats its step.
    fn look_within<L: Lagrangian<N = S::N, M = S::M, Scalar = f64>>(
        &mut self,
        method: &Adaptive<P>,
        motions: &LaneMotions<'_, L, Adaptive<P>>,
        tried: &mut LaneErrors,
    ) -> [bool; Lanes::COUNT] {
        let looked: [bool; Lanes::COUNT] = from_fn(|lane| {
            let motion = motions[lane].as_ref();
            motion.is_some_and(|motion| motion.record.looks_into(self.now[lane], self.end[lane]))
        });
        let is_asked_for: [bool; Lanes::COUNT] =
            from_fn(|lane| looked[lane] && tried.sound[lane] && method.accepts(tried.error[lane]));
        if is_asked_for.contains(&true) {
            let (h, mut reliability) = (Lanes::from(self.h), LaneReliability::new());
            self.stages((last::<P>() + 1, P::INTERPOLATION_STAGES), &mut reliability);
            let (start, end) = ((&self.y, &self.slopes[0]), (&self.next, &self.slopes[last::<P>()]));
            let (cubic, beyond) = self.coefficients.as_mut().split_at_mut(4);
            hermite(h, start, end, cubic);
            let zero = PhaseVector::filled(Lanes::constant(0.0));
            for (coefficient, row) in beyond.iter_mut().zip(P::INTERPOLATION) {
                advance(&zero, h, &self.slopes, row, coefficient);
            }
            let trusted = reliability.lanes();
            tried.sound = from_fn(|lane| tried.sound[lane] && (!is_asked_for[lane] || trusted[lane]));
        }
        looked
    }
}

/// Accepts or rejects a step computed on lanes. Returns `None` if the scalar method must take it.
fn decide<P: Pair, N: StaticLength, M: StaticLength>(
    method: &Adaptive<P>,
    memory: &mut PairMemory<f64, N, M>,
    (h, time): (f64, f64),
    error: f64,
) -> Option<LaneOutcome> {
    let PairMemory { clock, control, active, .. } = memory;
    if active.contains(&false) || !clock.is_ahead(time) {
        return None;
    }
    if method.accepts(error) {
        method.after_acceptance(control, clock, (h, time), error);
        return Some(LaneOutcome::Accepted);
    }
    let before = control.clone();
    control.refuse::<P>(h, error);
    if !clock.advances_by(control.step) {
        *control = before;
        return None;
    }
    Some(LaneOutcome::Rejected)
}

/// Counts the evaluations that the scalar method would need for the step, with or without dense output.
fn count<P: Pair, N: StaticLength, M: StaticLength>(
    method: &Adaptive<P>,
    PairMemory { has_slope, .. }: &mut PairMemory<f64, N, M>,
    statistics: &mut Statistics,
    outcome: LaneOutcome,
    is_looked_into: bool,
) {
    let (accepted, at_start, before) =
        (outcome == LaneOutcome::Accepted, !*has_slope, method.error_needs_last());
    statistics.evaluations += P::STAGES.len() + usize::from(at_start) + usize::from(before);
    statistics.evaluations += if accepted && is_looked_into { P::INTERPOLATION_STAGES.len() } else { 0 };
    if accepted {
        let at_end = is_looked_into || !method.ignores_error();
        statistics.evaluations += usize::from(at_end && (M::COUNT > 0 || !before));
        *has_slope = at_end;
    }
    statistics.accepted += usize::from(accepted);
    statistics.rejected += usize::from(!accepted);
}

/// Interpolant of one lane, with the same operations as a scalar one.
struct LaneOf<'c, C> {
    lane: usize,
    start: f64,
    length: f64,
    coefficients: &'c C,
}

impl<N: StaticLength, C: AsRef<[PhaseVector<Lanes, N>]>> Interpolant<f64, N> for LaneOf<'_, C> {
    #[inline(always)]
    fn at(&self, t: f64) -> StagePoint<f64, N> {
        let theta = Lanes::constant((t - self.start) / self.length);
        let (y, velocity) = evaluate(self.coefficients.as_ref(), theta);
        let velocity = velocity.each(|x| x.to_array()[self.lane] / self.length);
        StagePoint { t, y: unpacked_phase(&y, self.lane), velocity }
    }
}
