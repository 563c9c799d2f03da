//! Steps of an embedded Runge–Kutta pair on SIMD lanes: each lane a motion with its own time, step and error.
//!
//! The stages are computed for all lanes at once; what decides is done lane by lane, by the same controller as for a
//! motion alone. Where a lane meets what the lanes cannot do (an elimination that is not to be trusted, constraints
//! that depend on one another, numbers that are not finite, the end of all steps) its step is taken alone, by the
//! scalar method. Nothing in a lane depends on the others.

use core::array::from_fn;
use core::marker::PhantomData;
use core::ops::ControlFlow;

use super::event::Stride;
use super::method::Interpolant;
use super::method::interpolant::{evaluate, hermite};
use super::method::pair::{Combination, Pair, SLOPES, Slopes, advance, check, last};
use super::seat::{Fate, Seat};
use super::{Adaptive, Method};
use crate::ending::Ending;
use crate::error::Error;
use crate::number::{Lanes, Scalar, sum, vector};
use crate::solution::consistent::BOTH;
use crate::solution::flow::{Flow, LagrangianFlow, Phase, PhasePoint};
use crate::solution::near;
use crate::solution::solve::least_pivot;
use crate::system::{Lagrangian, Pack, Packed, State};

/// Motions in lock-step.
pub(crate) struct Batch<'o, L, P, const N: usize, const M: usize>
where
    L: Lagrangian<N, M> + Pack<Lanes>,
{
    method: Adaptive<P>,
    system: L::Packed,
    y: Phase<Lanes, N>,
    /// The first is that of `y`.
    slopes: Slopes<Lanes, N>,
    seats: [Option<Seat<'o, L, N, M>>; Lanes::COUNT],
}

/// What the lanes say about a step, before anyone decides.
struct Attempt<const N: usize> {
    next: Phase<Lanes, N>,
    error: [f64; Lanes::COUNT],
    /// Which lanes can be relied on.
    sound: [bool; Lanes::COUNT],
}

/// Whether the numbers of each lane can be relied on, gathered in passing.
struct Trust {
    /// The smallest pivot.
    pivot: Lanes,
    /// The sum of all magnitudes, which is a number where each is.
    size: Lanes,
}

impl Trust {
    fn new() -> Self {
        Self { pivot: Lanes::constant(1.0), size: Lanes::constant(0.0) }
    }

    #[inline(always)]
    fn numbers(&mut self, numbers: &[Lanes]) {
        self.size = self.size + sum(numbers.len(), |i| numbers[i].abs());
    }

    /// A minimum may pass over what is not a number; a sum does not.
    #[inline(always)]
    fn pivot(&mut self, pivot: Lanes) {
        self.pivot = self.pivot.min(pivot);
        self.size = self.size + pivot * Lanes::constant(0.0);
    }

    /// As [`is_trustworthy`](crate::solution::solve::is_trustworthy) of a solution alone.
    fn lanes(&self) -> [bool; Lanes::COUNT] {
        let (pivot, size) = (self.pivot.to_array(), self.size.to_array());
        from_fn(|lane| pivot[lane] > least_pivot::<f64>() && size[lane] < f64::INFINITY)
    }
}

impl<'o, L, P, const N: usize, const M: usize> Batch<'o, L, P, N, M>
where
    P: Pair,
    L: Lagrangian<N, M, Scalar = f64> + Pack<Lanes, Packed: Lagrangian<N, M, Scalar = Lanes>>,
{
    /// With a first motion, and the other lanes free.
    pub(crate) fn new(method: Adaptive<P>, seat: Seat<'o, L, N, M>) -> Self {
        let zero = [[Lanes::constant(0.0); N]; 2];
        let system = seat.system.pack();
        // Free lanes compute what the first does, to no purpose and no harm.
        let splat = |y: &Phase<f64, N>| y.map(|half| half.map(Lanes::constant));
        let mut slopes = [zero; SLOPES];
        slopes[0] = splat(&seat.memory.slope);
        let y = splat(&seat.memory.y);
        let seats = [Some(seat.begin(&method)), None, None, None];
        Self { method, system, y, slopes, seats }
    }

    pub(crate) fn has_free_lane(&self) -> bool {
        self.seats.iter().any(Option::is_none)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.seats.iter().all(Option::is_none)
    }

    /// Gives the motion a free lane; gives it back where there is none that it fits in.
    pub(crate) fn join(&mut self, seat: Seat<'o, L, N, M>) -> Option<Seat<'o, L, N, M>> {
        let lane = self.seats.iter().position(Option::is_none);
        match lane.filter(|&lane| seat.system.place(&mut self.system, lane)) {
            None => Some(seat),
            Some(lane) => {
                self.seats[lane] = Some(seat.begin(&self.method));
                self.load(lane);
                None
            }
        }
    }

    /// Tries one step in every lane. `accept` is told each new state; `leave` each motion that has ended.
    /// Where nothing is to be looked for within steps, and `IS_WATCHED` is false, nothing of that is compiled.
    pub(crate) fn step<const IS_WATCHED: bool>(
        &mut self,
        mut accept: impl FnMut(usize, &State<f64, N>) -> ControlFlow<()>,
        mut leave: impl FnMut(Seat<'o, L, N, M>, State<f64, N>, Ending),
    ) {
        // In a free lane time stands still.
        let plan = from_fn(|lane| self.seats[lane].as_ref().map_or((0.0, 0.0), |seat| seat.memory.next()));
        let mut attempt = self.attempt(&plan);
        let mut within = if const { IS_WATCHED } { self.within(&plan, &mut attempt) } else { None };
        let fates = from_fn(|lane| self.decide::<IS_WATCHED>(lane, plan[lane], &attempt, within.as_mut()));
        self.settle(&fates, &attempt.next);
        for (lane, fate) in fates.into_iter().enumerate() {
            let Some(now) = self.seats[lane].as_ref().map(|seat| seat.memory.clock.now) else { continue };
            let (mut state, mut stopped) = (self.state(lane, now), None);
            let Some(seat) = &mut self.seats[lane] else { continue };
            if let Some(within) = &within
                && const { IS_WATCHED }
                && within.lanes[lane]
                && fate != Fate::Rejected
            {
                stopped = within.keep(lane, plan[lane].0, seat, &mut state);
            }
            let mut is_cancelled = || fate != Fate::Rejected && accept(seat.index, &state).is_break();
            let mut ending = match stopped {
                None if is_cancelled() => Some(Ending::Cancelled { time: state.t }),
                stopped => stopped,
            };
            if const { IS_WATCHED } && ending.is_none() {
                ending = self.control(lane, &state);
            }
            if let Some(ending) = ending.or_else(|| self.ending(lane))
                && let Some(seat) = self.seats[lane].take()
            {
                leave(seat, state, ending);
            }
        }
    }

    /// Why there is no further step to take in a lane.
    fn ending(&mut self, lane: usize) -> Option<Ending> {
        let here = || [&self.y, &self.slopes[0]].map(|packed| unpacked(packed, lane));
        self.seats[lane].as_mut()?.ending(&self.method, here)
    }

    /// Calls the controller of a member, where it is due; the ending, where that is one.
    fn control(&mut self, lane: usize, state: &State<f64, N>) -> Option<Ending> {
        let seat = self.seats[lane].as_mut().filter(|seat| seat.record.is_due(state.t))?;
        if let Err(ending) = seat.control(state, &self.method) {
            return Some(ending);
        }
        if !seat.system.place(&mut self.system, lane) {
            let said = "it changes a field that is no number, which all lanes share".into();
            return Some(Ending::ControllerFailed { time: state.t, said });
        }
        self.load(lane);
        None
    }

    /// Stages, error and projection in all lanes, and the slopes at the end of the step.
    fn attempt(&mut self, plan: &[(f64, f64); Lanes::COUNT]) -> Attempt<N> {
        const { check::<P>() };
        let h = Lanes::from(plan.map(|(h, _)| h));
        let end = Lanes::from(plan.map(|(_, time)| time));
        let mut trust = Trust::new();
        self.stages(h, (1, P::STAGES), &mut trust);
        let mut next = self.y;
        advance(&self.y, h, &self.slopes, P::WEIGHTS, &mut next);
        trust.numbers(next.as_flattened());
        if self.method.error_needs_last() {
            self.slope(last::<P>(), end, &next, &mut trust);
        }
        let tolerance = self.method.tolerance::<f64>();
        let error = tolerance.error::<P, _, N>(&self.slopes, h, &self.y, &next).to_array();
        let projected = if M > 0 { self.project(&mut next, plan, &error) } else { [true; Lanes::COUNT] };
        if M > 0 || !self.method.error_needs_last() {
            self.slope(last::<P>(), end, &next, &mut trust);
        }
        let trusted = trust.lanes();
        Attempt { next, error, sound: from_fn(|lane| trusted[lane] && projected[lane]) }
    }

    /// The slopes of these stages, the first of which has the number given.
    #[inline]
    fn stages(&mut self, h: Lanes, (first, rows): (usize, &[Combination]), trust: &mut Trust) {
        let now =
            Lanes::from(from_fn(|lane| self.seats[lane].as_ref().map_or(0.0, |seat| seat.memory.clock.now)));
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
        trust.numbers(solution.accelerations.as_slice());
        trust.numbers(solution.multipliers.as_slice());
        trust.pivot(solution.pivot);
        self.slopes[number][0] = y[1];
        self.slopes[number][1] = solution.accelerations.data.0[0];
    }

    /// Projects the lanes onto the constraints, all at once; one where that does not lead there alone, if its step is
    /// accurate. Whether each is where it is to be.
    fn project(
        &self,
        next: &mut Phase<Lanes, N>,
        plan: &[(f64, f64); Lanes::COUNT],
        error: &[f64; Lanes::COUNT],
    ) -> [bool; Lanes::COUNT] {
        let end = Lanes::from(plan.map(|(_, time)| time));
        let state = State { t: end, q: vector(next[0]), v: vector(next[1]) };
        let (near, doubt) = near::project::<_, f64, N, M>(&self.system, &BOTH, near::TO_ROUND_OFF, state);
        let is_there = doubt.to_array().map(|doubt| doubt == 0.0);
        let chosen = Lanes::from(is_there.map(|is_there| if is_there { 1.0 } else { 0.0 }));
        let before = *next;
        *next = [near.q.into(), near.v.into()];
        for (x, before) in next.iter_mut().flatten().zip(before.iter().flatten()) {
            *x = x.select(chosen, *before);
        }
        from_fn(|lane| match &self.seats[lane] {
            Some(seat) if !is_there[lane] && self.method.accepts(error[lane]) => {
                let y = unpacked(next, lane);
                let point = PhasePoint { t: plan[lane].1, y, velocity: y[1] };
                let projected = <LagrangianFlow as Flow<L, N, M>>::project(&seat.system, &point);
                projected.map(|state| next.place(lane, &[state.q.into(), state.v.into()])).is_ok()
            }
            _ => true,
        })
    }

    /// What lies within the steps that will be accepted, where a lane is to be looked into. One whose stages there are not to
    /// be trusted is to take its step alone.
    fn within(
        &mut self,
        plan: &[(f64, f64); Lanes::COUNT],
        attempt: &mut Attempt<N>,
    ) -> Option<Within<P, N>> {
        let seats = &self.seats;
        let lanes = from_fn(|lane| {
            let looks =
                |seat: &Seat<'_, L, N, M>| seat.record.looks_into(seat.memory.clock.now, plan[lane].1);
            seats[lane].as_ref().is_some_and(looks)
        });
        if !lanes.contains(&true) {
            return None;
        }
        let times = from_fn(|lane| seats[lane].as_ref().map_or(0.0, |seat| seat.memory.clock.now));
        let zero = [[Lanes::constant(0.0); N]; 2];
        let mut within = Within::<P, N> { lanes, times, y: self.y, coefficients: P::coefficients(zero) };
        let is_asked_for: [bool; Lanes::COUNT] =
            from_fn(|lane| lanes[lane] && attempt.sound[lane] && self.method.accepts(attempt.error[lane]));
        if is_asked_for.contains(&true) {
            let (h, mut trust) = (Lanes::from(plan.map(|(h, _)| h)), Trust::new());
            self.stages(h, (last::<P>() + 1, P::INTERPOLATION_STAGES), &mut trust);
            let (start, end) = ((&self.y, &self.slopes[0]), (&attempt.next, &self.slopes[last::<P>()]));
            let (cubic, beyond) = within.coefficients.as_mut().split_at_mut(4);
            hermite(h, start, end, cubic);
            for (coefficient, row) in beyond.iter_mut().zip(P::INTERPOLATION) {
                advance(&zero, h, &self.slopes, row, coefficient);
            }
            let trusted = trust.lanes();
            attempt.sound = from_fn(|lane| attempt.sound[lane] && (!is_asked_for[lane] || trusted[lane]));
        }
        Some(within)
    }

    /// What becomes of the step in a lane. None is taken in a free one.
    fn decide<const IS_WATCHED: bool>(
        &mut self,
        lane: usize,
        plan: (f64, f64),
        attempt: &Attempt<N>,
        within: Option<&mut Within<P, N>>,
    ) -> Fate {
        let Some(seat) = &mut self.seats[lane] else { return Fate::Rejected };
        let (method, within) = (&self.method, within.filter(|within| within.lanes[lane]));
        let is_looked_into = within.is_some();
        let decided =
            attempt.sound[lane].then(|| seat.decide(plan, attempt.error[lane], method, is_looked_into));
        decided.flatten().unwrap_or_else(|| {
            let (y, slope) = (unpacked(&self.y, lane), unpacked(&self.slopes[0], lane));
            seat.step_alone(y, slope, method, |seat| match within {
                Some(within) if const { IS_WATCHED } => within.place(lane, seat, method),
                _ => Ok(()),
            })
        })
    }

    /// Moves the lanes whose steps are accepted.
    fn settle(&mut self, fates: &[Fate; Lanes::COUNT], next: &Phase<Lanes, N>) {
        let accepted = Lanes::from(fates.map(|fate| if fate == Fate::Accepted { 1.0 } else { 0.0 }));
        for half in 0..2 {
            for i in 0..N {
                let (y, slope) = (&mut self.y[half][i], self.slopes[last::<P>()][half][i]);
                *y = next[half][i].select(accepted, *y);
                self.slopes[0][half][i] = slope.select(accepted, self.slopes[0][half][i]);
            }
        }
        for lane in (0..Lanes::COUNT).filter(|lane| fates[*lane] == Fate::AcceptedAlone) {
            self.load(lane);
        }
    }

    /// Puts the state and the slope that its motion holds into a lane.
    fn load(&mut self, lane: usize) {
        if let Some(Seat { memory, .. }) = &self.seats[lane] {
            self.y.place(lane, &memory.y);
            self.slopes[0].place(lane, &memory.slope);
        }
    }

    fn state(&self, lane: usize, t: f64) -> State<f64, N> {
        let [q, v] = unpacked(&self.y, lane);
        State { t, q: vector(q), v: vector(v) }
    }
}

/// What lies within a step, of the lanes that are looked into.
struct Within<P: Pair, const N: usize> {
    lanes: [bool; Lanes::COUNT],
    /// Where the steps start.
    times: [f64; Lanes::COUNT],
    y: Phase<Lanes, N>,
    coefficients: P::Coefficients<Phase<Lanes, N>>,
}

impl<P: Pair, const N: usize> Within<P, N> {
    /// Puts what lies within a step that was taken alone into its lane.
    fn place<L: Lagrangian<N, M, Scalar = f64>, const M: usize>(
        &mut self,
        lane: usize,
        seat: &mut Seat<'_, L, N, M>,
        method: &Adaptive<P>,
    ) -> Result<(), Error> {
        let Seat { system, memory, statistics, .. } = seat;
        let polynomial = Method::<L, N, M>::interpolant(method, system, memory, statistics)?;
        let packed = self.coefficients.as_mut().iter_mut();
        packed.zip(polynomial.coefficients()).for_each(|(packed, one)| packed.place(lane, one));
        Ok(())
    }

    /// Keeps what is due in a step of this length to `end`; where the motion stops before, that is then the end, and why.
    fn keep<L: Lagrangian<N, M, Scalar = f64>, const M: usize>(
        &self,
        lane: usize,
        length: f64,
        seat: &mut Seat<'_, L, N, M>,
        end: &mut State<f64, N>,
    ) -> Option<Ending> {
        let Seat { record, system, .. } = seat;
        let (t, [q, v], coefficients) = (self.times[lane], unpacked(&self.y, lane), &self.coefficients);
        let interpolant = &LaneOf { lane, start: t, length, coefficients };
        let (before, after) = (&State { t, q: vector(q), v: vector(v) }, &{ *end });
        record.keep(&Stride { system, before, after, interpolant, flow: PhantomData::<LagrangianFlow> }, end)
    }
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

/// What lies in one lane.
fn unpacked<const N: usize>(packed: &Phase<Lanes, N>, lane: usize) -> Phase<f64, N> {
    packed.map(|half| half.map(|x| x.to_array()[lane]))
}
