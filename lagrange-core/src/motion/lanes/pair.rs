//! Steps of an embedded Runge–Kutta pair on SIMD lanes.

use core::array::from_fn;

use super::{Fate, LaneMethod, Seats, Trust, unpacked};
use crate::error::Error;
use crate::motion::method::interpolant::{evaluate, hermite};
use crate::motion::method::pair::{Combination, Slopes, advance, check, last};
use crate::motion::method::step::PairMemory;
use crate::motion::{Adaptive, Interpolant, Pair};
use crate::number::{Lanes, Scalar, vector};
use crate::room::Room;
use crate::solution::consistent::BOTH;
use crate::solution::flow::{Flow, LagrangianFlow, Phase, PhasePoint};
use crate::solution::near::{self, Corrections};
use crate::statistics::Statistics;
use crate::system::{Lagrangian, Pack, Packed, State};

/// Motions side by side, and what a step of them takes.
#[derive(Debug)]
pub struct PairLanes<S, P: Pair, const N: usize, const M: usize> {
    system: S,
    y: Phase<Lanes, N>,
    /// The first is that of `y`.
    slopes: Room<Slopes<Lanes, N>>,
    /// When the step tried starts, how long it is, and when it ends.
    now: [f64; Lanes::COUNT],
    h: [f64; Lanes::COUNT],
    end: [f64; Lanes::COUNT],
    /// Where it leads.
    next: Phase<Lanes, N>,
    /// What lies within, of the lanes that are looked into.
    coefficients: P::Coefficients<Phase<Lanes, N>>,
}

/// What the lanes say about a step, before anyone decides.
struct LaneErrors {
    error: [f64; Lanes::COUNT],
    /// Which lanes can be relied on.
    sound: [bool; Lanes::COUNT],
}

impl<P, L, const N: usize, const M: usize> LaneMethod<L, N, M> for Adaptive<P>
where
    P: Pair,
    L: Lagrangian<N, M, Scalar = f64> + Pack<Lanes, Packed: Lagrangian<N, M, Scalar = Lanes>>,
{
    type LaneMemory = PairLanes<L::Packed, P, N, M>;

    fn now(memory: &PairMemory<f64, N, M>) -> f64 {
        memory.clock.now
    }

    fn is_at_end(memory: &PairMemory<f64, N, M>) -> bool {
        memory.clock.is_at_end()
    }

    fn prepare(
        &self,
        system: &L,
        memory: &mut PairMemory<f64, N, M>,
        end: f64,
        statistics: &mut Statistics,
    ) -> Result<(), Error> {
        self.aim::<L, LagrangianFlow, N, M>(system, memory, end, statistics);
        // The lane is to have the slope, if there is a step to take.
        if memory.clock.is_at_end() {
            return Ok(());
        }
        memory.ensure_slope::<L, LagrangianFlow>(system, statistics)
    }

    fn abreast(&self, system: &L, memory: &PairMemory<f64, N, M>) -> Self::LaneMemory {
        let zero = [[Lanes::constant(0.0); N]; 2];
        let mut slopes = Room::<Slopes<Lanes, N>>::filled(zero);
        slopes[0] = Packed::splat(&memory.slope);
        let (system, y) = (system.pack(), Packed::splat(&memory.y));
        let [now, h, end] = [[0.0; Lanes::COUNT]; 3];
        PairLanes { system, y, slopes, now, h, end, next: zero, coefficients: P::coefficients(zero) }
    }

    fn place(abreast: &mut Self::LaneMemory, lane: usize, system: &L) -> bool {
        system.place(&mut abreast.system, lane)
    }

    fn load(abreast: &mut Self::LaneMemory, lane: usize, memory: &PairMemory<f64, N, M>) {
        abreast.y.place(lane, &memory.y);
        abreast.slopes[0].place(lane, &memory.slope);
    }

    fn unload(abreast: &Self::LaneMemory, lane: usize, memory: &mut PairMemory<f64, N, M>) {
        [memory.y, memory.slope] = [&abreast.y, &abreast.slopes[0]].map(|packed| unpacked(packed, lane));
    }

    fn phase(abreast: &Self::LaneMemory, lane: usize) -> Phase<f64, N> {
        unpacked(&abreast.y, lane)
    }

    fn reached(abreast: &Self::LaneMemory, lane: usize) -> Phase<f64, N> {
        unpacked(&abreast.next, lane)
    }

    #[inline(always)]
    fn attempt<const IS_WATCHED: bool>(
        &self,
        abreast: &mut Self::LaneMemory,
        seats: &mut Seats<'_, L, Self, N, M>,
    ) -> [Option<Fate>; Lanes::COUNT] {
        // In a free lane time stands still.
        let plan: [_; Lanes::COUNT] =
            from_fn(|lane| seats[lane].as_ref().map_or((0.0, 0.0), |seat| seat.memory.next()));
        abreast.now = from_fn(|lane| seats[lane].as_ref().map_or(0.0, |seat| seat.memory.clock.now));
        (abreast.h, abreast.end) = (plan.map(|(h, _)| h), plan.map(|(_, end)| end));
        let mut tried = abreast.attempt(self, seats);
        let looked = match const { IS_WATCHED } {
            true => abreast.look_within(self, seats, &mut tried),
            false => [false; Lanes::COUNT],
        };
        from_fn(|lane| {
            let seat = seats[lane].as_mut().filter(|_| tried.sound[lane])?;
            let fate = decide(self, &mut seat.memory, plan[lane], tried.error[lane])?;
            count(self, &mut seat.memory, &mut seat.statistics, fate, looked[lane]);
            Some(fate)
        })
    }

    fn settle(abreast: &mut Self::LaneMemory, chosen: Lanes) {
        let PairLanes { y, slopes, next, .. } = abreast;
        for half in 0..2 {
            for i in 0..N {
                let (y, slope) = (&mut y[half][i], slopes[last::<P>()][half][i]);
                *y = next[half][i].select(chosen, *y);
                slopes[0][half][i] = slope.select(chosen, slopes[0][half][i]);
            }
        }
    }

    fn within(abreast: &Self::LaneMemory, lane: usize) -> impl Interpolant<f64, N> {
        let (start, length, coefficients) = (abreast.now[lane], abreast.h[lane], &abreast.coefficients);
        LaneOf { lane, start, length, coefficients }
    }
}

impl<S, P, const N: usize, const M: usize> PairLanes<S, P, N, M>
where
    S: Lagrangian<N, M, Scalar = Lanes>,
    P: Pair,
{
    /// Stages, error and projection in all lanes, and the slopes at the end of the step.
    fn attempt<L>(&mut self, method: &Adaptive<P>, seats: &Seats<'_, L, Adaptive<P>, N, M>) -> LaneErrors
    where
        L: Lagrangian<N, M, Scalar = f64>,
    {
        const { check::<P>() };
        let (h, end) = (Lanes::from(self.h), Lanes::from(self.end));
        let mut trust = Trust::new();
        self.stages((1, P::STAGES), &mut trust);
        let mut next = self.y;
        advance(&self.y, h, &self.slopes, P::WEIGHTS, &mut next);
        trust.numbers(next.as_flattened());
        if method.error_needs_last() {
            self.slope(last::<P>(), end, &next, &mut trust);
        }
        let tolerance = method.tolerance::<f64>();
        let error = tolerance.error::<P, _, N>(&self.slopes, h, &self.y, &next).to_array();
        let projected = match M {
            0 => [true; Lanes::COUNT],
            _ => self.project(&mut next, method, seats, &error),
        };
        if M > 0 || !method.error_needs_last() {
            self.slope(last::<P>(), end, &next, &mut trust);
        }
        self.next = next;
        let trusted = trust.lanes();
        LaneErrors { error, sound: from_fn(|lane| trusted[lane] && projected[lane]) }
    }

    /// The slopes of these stages, the first of which has the number given.
    #[inline]
    fn stages(&mut self, (first, rows): (usize, &[Combination]), trust: &mut Trust) {
        let (now, h) = (Lanes::from(self.now), Lanes::from(self.h));
        let mut y = self.y;
        for (number, row) in (first..).zip(rows) {
            advance(&self.y, h, &self.slopes, row, &mut y);
            self.slope(number, now + h * Lanes::constant(P::NODES[number]), &y, trust);
        }
    }

    /// Evaluates the slope of this number.
    #[inline(always)]
    fn slope(&mut self, number: usize, t: Lanes, y: &Phase<Lanes, N>, trust: &mut Trust) {
        let solution = self.system.accelerations_unchecked(&State { t, q: vector(y[0]), v: vector(y[1]) });
        trust.solution(&solution);
        self.slopes[number][0] = y[1];
        self.slopes[number][1] = solution.accelerations.data.0[0];
    }

    /// Projects the lanes onto the constraints, all at once; one where that does not lead there alone, if its step is
    /// accurate. Whether each is where it is to be.
    fn project<L>(
        &self,
        next: &mut Phase<Lanes, N>,
        method: &Adaptive<P>,
        seats: &Seats<'_, L, Adaptive<P>, N, M>,
        error: &[f64; Lanes::COUNT],
    ) -> [bool; Lanes::COUNT]
    where
        L: Lagrangian<N, M, Scalar = f64>,
    {
        let state = State { t: self.end.into(), q: vector(next[0]), v: vector(next[1]) };
        let rest = &mut [[Lanes::constant(0.0); N]; 2];
        let (near, doubt) =
            near::project::<_, f64, N, M>(&self.system, &BOTH, Corrections::ToRoundOff, state, rest);
        let is_there = doubt.to_array().map(|doubt| doubt == 0.0);
        let chosen = Lanes::from(is_there.map(|is_there| if is_there { 1.0 } else { 0.0 }));
        let before = *next;
        *next = [near.q.into(), near.v.into()];
        for (x, before) in next.iter_mut().flatten().zip(before.iter().flatten()) {
            *x = x.select(chosen, *before);
        }
        from_fn(|lane| match &seats[lane] {
            Some(seat) if !is_there[lane] && method.accepts(error[lane]) => {
                let y = unpacked(next, lane);
                let point = PhasePoint { t: self.end[lane], y, velocity: y[1] };
                let projected = <LagrangianFlow as Flow<L, N, M>>::project(&seat.system, &point);
                projected.map(|state| next.place(lane, &[state.q.into(), state.v.into()])).is_ok()
            }
            _ => true,
        })
    }

    /// What lies within the steps that will be accepted, where a lane is to be looked into; which these are. One whose stages
    /// there are not to be trusted is to take its step alone.
    fn look_within<L>(
        &mut self,
        method: &Adaptive<P>,
        seats: &Seats<'_, L, Adaptive<P>, N, M>,
        tried: &mut LaneErrors,
    ) -> [bool; Lanes::COUNT]
    where
        L: Lagrangian<N, M, Scalar = f64>,
    {
        let looked = from_fn(|lane| {
            let seat = seats[lane].as_ref();
            seat.is_some_and(|seat| seat.record.looks_into(self.now[lane], self.end[lane]))
        });
        let is_asked_for: [bool; Lanes::COUNT] =
            from_fn(|lane| looked[lane] && tried.sound[lane] && method.accepts(tried.error[lane]));
        if is_asked_for.contains(&true) {
            let (h, mut trust) = (Lanes::from(self.h), Trust::new());
            self.stages((last::<P>() + 1, P::INTERPOLATION_STAGES), &mut trust);
            let (start, end) = ((&self.y, &self.slopes[0]), (&self.next, &self.slopes[last::<P>()]));
            let (cubic, beyond) = self.coefficients.as_mut().split_at_mut(4);
            hermite(h, start, end, cubic);
            let zero = [[Lanes::constant(0.0); N]; 2];
            for (coefficient, row) in beyond.iter_mut().zip(P::INTERPOLATION) {
                advance(&zero, h, &self.slopes, row, coefficient);
            }
            let trusted = trust.lanes();
            tried.sound = from_fn(|lane| tried.sound[lane] && (!is_asked_for[lane] || trusted[lane]));
        }
        looked
    }
}

/// Accepts or rejects a step computed on lanes; `None` where it is to be taken alone.
fn decide<P: Pair, const N: usize, const M: usize>(
    method: &Adaptive<P>,
    memory: &mut PairMemory<f64, N, M>,
    (h, time): (f64, f64),
    error: f64,
) -> Option<Fate> {
    let PairMemory { clock, control, active, .. } = memory;
    if active.contains(&false) || !clock.is_ahead(time) {
        return None;
    }
    if method.accepts(error) {
        method.after_acceptance(control, clock, (h, time), error);
        return Some(Fate::Accepted);
    }
    let before = control.clone();
    control.refuse::<P>(h, error);
    if !clock.advances_by(control.step) {
        *control = before;
        return None;
    }
    Some(Fate::Rejected)
}

/// As many evaluations as the step takes alone, with an interpolant or without.
fn count<P: Pair, const N: usize, const M: usize>(
    method: &Adaptive<P>,
    PairMemory { has_slope, .. }: &mut PairMemory<f64, N, M>,
    statistics: &mut Statistics,
    fate: Fate,
    is_looked_into: bool,
) {
    let (accepted, at_start, before) = (fate == Fate::Accepted, !*has_slope, method.error_needs_last());
    statistics.evaluations += P::STAGES.len() + usize::from(at_start) + usize::from(before);
    statistics.evaluations += if accepted && is_looked_into { P::INTERPOLATION_STAGES.len() } else { 0 };
    if accepted {
        let at_end = is_looked_into || !method.ignores_error();
        statistics.evaluations += usize::from(at_end && (M > 0 || !before));
        *has_slope = at_end;
    }
    statistics.accepted += usize::from(accepted);
    statistics.rejected += usize::from(!accepted);
}

/// The polynomial in one lane, with the operations of a polynomial alone.
struct LaneOf<'c, C> {
    lane: usize,
    start: f64,
    length: f64,
    coefficients: &'c C,
}

impl<const N: usize, C: AsRef<[Phase<Lanes, N>]>> Interpolant<f64, N> for LaneOf<'_, C> {
    #[inline(always)]
    fn at(&self, t: f64) -> PhasePoint<f64, N> {
        let theta = Lanes::constant((t - self.start) / self.length);
        let (y, velocity) = evaluate(self.coefficients.as_ref(), theta);
        let velocity = velocity.map(|x| x.to_array()[self.lane] / self.length);
        PhasePoint { t, y: unpacked(&y, self.lane), velocity }
    }
}
