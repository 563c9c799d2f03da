//! Steps of an embedded Runge–Kutta pair on SIMD lanes: each lane a motion with its own time, step and error.
//!
//! The stages are computed for all lanes at once; what decides is done lane by lane, by the same controller as for a
//! motion alone. Where a lane meets what the lanes cannot do (an elimination that is not to be trusted, constraints
//! that depend on one another, numbers that are not finite, the end of all steps) its step is taken alone, by the
//! scalar method. Nothing in a lane depends on the others.

use core::array::from_fn;
use core::ops::ControlFlow;

use super::pair::{Pair, SLOPES, Slopes, advance};
use super::step::Memory;
use super::{
    Adaptive, Ending, Flow, LagrangianFlow, Method, Phase, Point, Statistics, Step, Watchdog, begin,
};
use crate::eliminate::vector;
use crate::numeric::{exceeds, power_of_epsilon};
use crate::{Error, Lagrangian, Lanes, Pack, Packed, Scalar, State};

/// A motion that has a lane.
pub(crate) struct Seat<L, const N: usize, const M: usize> {
    /// Which member of the ensemble it is.
    pub(crate) index: usize,
    pub(crate) statistics: Statistics,
    system: L,
    /// Its state and slopes are in the lane, and here only while a step is taken alone.
    memory: Memory<f64, N, M>,
    limits: Watchdog,
}

impl<L, const N: usize, const M: usize> Seat<L, N, M>
where
    L: Lagrangian<N, M, Scalar = f64>,
{
    /// Before the first step, with the state made consistent.
    pub(crate) fn new<P: Pair>(
        index: usize,
        system: L,
        state: &State<f64, N>,
        end: f64,
        method: &Adaptive<P>,
    ) -> Result<(Self, State<f64, N>), Error> {
        let mut statistics = Statistics::default();
        let ((start, _), memory) =
            begin::<L, LagrangianFlow, _, N, M>(&system, state, end, method, &mut statistics)?;
        let limits = Watchdog::new(method.limits());
        Ok((Self { index, system, memory, statistics, limits }, start))
    }

    /// Why there is no further step to take.
    pub(crate) fn ending(&self) -> Option<Ending> {
        let time = self.memory.t;
        let complete = (time >= self.memory.end).then_some(Ending::Complete { time });
        complete.or_else(|| self.limits.exceeded(&self.statistics, time))
    }
}

/// Motions in lock-step.
pub(crate) struct Batch<L: Pack<Lanes>, P, const N: usize, const M: usize> {
    method: Adaptive<P>,
    system: L::Packed,
    y: Phase<Lanes, N>,
    /// The first is that of `y`.
    slopes: Slopes<Lanes, N>,
    seats: [Option<Seat<L, N, M>>; Lanes::COUNT],
}

/// What the lanes say about a step, before anyone decides.
struct Attempt<const N: usize> {
    next: Phase<Lanes, N>,
    error: [f64; Lanes::COUNT],
    /// Which lanes can be relied on.
    sound: [bool; Lanes::COUNT],
}

/// What became of a step in one lane.
enum Fate {
    Accepted,
    Rejected,
    /// Taken alone: the lane is to be loaded with the result.
    AcceptedAlone,
    Failed(Ending),
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
    fn numbers<'x>(&mut self, numbers: impl IntoIterator<Item = &'x Lanes>) {
        self.size = numbers.into_iter().fold(self.size, |sum, x| sum + x.abs());
    }

    /// A minimum may pass over what is not a number; a sum does not.
    #[inline(always)]
    fn pivot(&mut self, pivot: Lanes) {
        self.pivot = self.pivot.min(pivot);
        self.size = self.size + pivot * Lanes::constant(0.0);
    }

    /// As [`is_trustworthy`](crate::solve::is_trustworthy) of a solution alone.
    fn lanes(&self) -> [bool; Lanes::COUNT] {
        let (pivot, size) = (self.pivot.to_array(), self.size.to_array());
        from_fn(|lane| pivot[lane] > power_of_epsilon(1.0 / 3.0) && size[lane] < f64::INFINITY)
    }
}

impl<L, P, const N: usize, const M: usize> Batch<L, P, N, M>
where
    P: Pair,
    L: Lagrangian<N, M, Scalar = f64> + Pack<Lanes, Packed: Lagrangian<N, M, Scalar = Lanes>>,
{
    const LAST: usize = P::STAGES.len() + 1;

    /// With a first motion, and the other lanes free.
    pub(crate) fn new(method: Adaptive<P>, seat: Seat<L, N, M>) -> Self {
        let zero = [[Lanes::constant(0.0); N]; 2];
        let system = seat.system.pack();
        let mut batch = Self { method, system, y: zero, slopes: [zero; SLOPES], seats: from_fn(|_| None) };
        // The free lanes compute the same, to no purpose and no harm.
        (0..Lanes::COUNT).for_each(|lane| batch.load(lane, &seat.memory));
        batch.seats[0] = Some(seat);
        batch
    }

    pub(crate) fn has_free_lane(&self) -> bool {
        self.seats.iter().any(Option::is_none)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.seats.iter().all(Option::is_none)
    }

    /// Gives the motion a free lane; gives it back where there is none that it fits in.
    pub(crate) fn join(&mut self, seat: Seat<L, N, M>) -> Option<Seat<L, N, M>> {
        let lane = self.seats.iter().position(Option::is_none);
        match lane.filter(|&lane| seat.system.place(&mut self.system, lane)) {
            None => Some(seat),
            Some(lane) => {
                self.load(lane, &seat.memory);
                self.seats[lane] = Some(seat);
                None
            }
        }
    }

    /// Tries one step in every lane. `accept` is told each new state; `leave` each motion that has ended.
    pub(crate) fn step(
        &mut self,
        mut accept: impl FnMut(usize, &State<f64, N>) -> ControlFlow<()>,
        mut leave: impl FnMut(Seat<L, N, M>, State<f64, N>, Ending),
    ) {
        // In a free lane time stands still.
        let plan = from_fn(|lane| self.seats[lane].as_ref().map_or((0.0, 0.0), |seat| seat.memory.next()));
        let attempt = self.attempt(&plan);
        let fates = from_fn(|lane| self.decide(lane, plan[lane], &attempt));
        self.settle(&fates, &attempt.next);
        for (lane, fate) in fates.into_iter().enumerate() {
            let Some((seat, fate)) = self.seats[lane].as_ref().zip(fate) else { continue };
            let state = self.state(lane, seat.memory.t);
            let ending = match fate {
                Fate::Failed(ending) => Some(ending),
                Fate::Rejected => seat.ending(),
                Fate::Accepted | Fate::AcceptedAlone => match accept(seat.index, &state) {
                    ControlFlow::Break(()) => Some(Ending::Cancelled { time: state.t }),
                    ControlFlow::Continue(()) => seat.ending(),
                },
            };
            if let Some((ending, seat)) = ending.and_then(|ending| Some((ending, self.seats[lane].take()?))) {
                leave(seat, state, ending);
            }
        }
    }

    /// Stages, error and projection in all lanes, and the slopes at the end of the step.
    fn attempt(&mut self, plan: &[(f64, f64); Lanes::COUNT]) -> Attempt<N> {
        let h = Lanes::from(plan.map(|(h, _)| h));
        let end = Lanes::from(plan.map(|(_, time)| time));
        let mut trust = Trust::new();
        self.stages(h, &mut trust);
        let mut next = advance(&self.y, h, &self.slopes, P::WEIGHTS);
        trust.numbers(next.iter().flatten());
        if Self::error_needs_last() {
            self.slope(Self::LAST, end, &next, &mut trust);
        }
        let tolerance = self.method.tolerance::<f64>();
        let error = tolerance.error::<P, _, N>(&self.slopes, h, &self.y, &next).to_array();
        let projected = if M > 0 { self.project(&mut next, plan, &error) } else { [true; Lanes::COUNT] };
        if M > 0 || !Self::error_needs_last() {
            self.slope(Self::LAST, end, &next, &mut trust);
        }
        let trusted = trust.lanes();
        Attempt { next, error, sound: from_fn(|lane| trusted[lane] && projected[lane]) }
    }

    fn error_needs_last() -> bool {
        P::ERROR.iter().any(|(slope, _)| *slope == Self::LAST)
    }

    /// The slopes of the stages after the first.
    #[inline]
    fn stages(&mut self, h: Lanes, trust: &mut Trust) {
        let now = Lanes::from(from_fn(|lane| self.seats[lane].as_ref().map_or(0.0, |seat| seat.memory.t)));
        for (number, row) in (1..).zip(P::STAGES) {
            let y = advance(&self.y, h, &self.slopes, row);
            self.slope(number, now + h * Lanes::constant(P::NODES[number]), &y, trust);
        }
    }

    /// Evaluates the slope of this number.
    #[inline(always)]
    fn slope(&mut self, number: usize, t: Lanes, y: &Phase<Lanes, N>, trust: &mut Trust) {
        let solution = self.system.accelerations(&State { t, q: vector(y[0]), v: vector(y[1]) });
        trust.numbers(solution.accelerations.iter().chain(&solution.multipliers));
        trust.pivot(solution.pivot);
        self.slopes[number] = [y[1], solution.accelerations.into()];
    }

    /// Projects the lanes that are accurate onto the constraints; whether each is where it is to be.
    fn project(
        &self,
        next: &mut Phase<Lanes, N>,
        plan: &[(f64, f64); Lanes::COUNT],
        error: &[f64; Lanes::COUNT],
    ) -> [bool; Lanes::COUNT] {
        from_fn(|lane| match &self.seats[lane] {
            Some(seat) if self.is_accurate(error[lane]) => {
                let y = unpacked(next, lane);
                let point = Point { t: plan[lane].1, y, velocity: y[1] };
                let projected = <LagrangianFlow as Flow<L, N, M>>::project(&seat.system, &point);
                projected.map(|state| next.place(lane, &[state.q.into(), state.v.into()])).is_ok()
            }
            _ => true,
        })
    }

    fn is_accurate(&self, error: f64) -> bool {
        self.method.fixed_step.is_some() || !exceeds(error, 1.0)
    }

    /// Accepts or rejects the step of a lane, by its own controller; `None` for a free lane.
    fn decide(&mut self, lane: usize, (h, time): (f64, f64), attempt: &Attempt<N>) -> Option<Fate> {
        let accurate = self.is_accurate(attempt.error[lane]);
        let seat = self.seats[lane].as_mut()?;
        let error = attempt.error[lane];
        let is_on_all_constraints = !seat.memory.active.contains(&false);
        if !attempt.sound[lane] || !is_on_all_constraints {
            return Some(self.step_alone(lane));
        }
        let before = seat.memory.control.clone();
        if accurate {
            seat.memory.t = time;
            if self.method.fixed_step.is_none() {
                seat.memory.control.accept::<P>(h, error);
                seat.memory.control.step = self.method.cut(seat.memory.control.step);
            }
        } else {
            seat.memory.control.refuse::<P>(h, error);
            if seat.memory.is_step_too_small() {
                seat.memory.control = before;
                return Some(self.step_alone(lane));
            }
        }
        seat.statistics.count::<P, M>(accurate);
        Some(if accurate { Fate::Accepted } else { Fate::Rejected })
    }

    /// The step of one lane by the scalar method.
    #[cold]
    fn step_alone(&mut self, lane: usize) -> Fate {
        let (y, slope) = (unpacked(&self.y, lane), unpacked(&self.slopes[0], lane));
        let Some(Seat { system, memory, statistics, .. }) = &mut self.seats[lane] else {
            return Fate::Rejected;
        };
        (memory.y, memory.slopes[0]) = (y, slope);
        match Method::<L, N, M>::step(&self.method, system, memory, statistics) {
            Step::Accepted { .. } => {
                statistics.accepted += 1;
                Fate::AcceptedAlone
            }
            Step::Rejected => {
                statistics.rejected += 1;
                Fate::Rejected
            }
            Step::Failed(ending) => Fate::Failed(ending),
        }
    }

    /// Moves the lanes whose steps are accepted.
    fn settle(&mut self, fates: &[Option<Fate>; Lanes::COUNT], next: &Phase<Lanes, N>) {
        let accepted = from_fn(|lane| f64::from(u8::from(matches!(fates[lane], Some(Fate::Accepted)))));
        let accepted = Lanes::from(accepted);
        for half in 0..2 {
            for i in 0..N {
                self.y[half][i] = next[half][i].select(accepted, self.y[half][i]);
                self.slopes[0][half][i] =
                    self.slopes[Self::LAST][half][i].select(accepted, self.slopes[0][half][i]);
            }
        }
        for lane in (0..Lanes::COUNT).filter(|lane| matches!(fates[*lane], Some(Fate::AcceptedAlone))) {
            if let Some(seat) = self.seats[lane].take() {
                self.load(lane, &seat.memory);
                self.seats[lane] = Some(seat);
            }
        }
    }

    /// Puts a state and its slope into a lane.
    fn load(&mut self, lane: usize, memory: &Memory<f64, N, M>) {
        self.y.place(lane, &memory.y);
        self.slopes[0].place(lane, &memory.slopes[0]);
    }

    fn state(&self, lane: usize, t: f64) -> State<f64, N> {
        let [q, v] = unpacked(&self.y, lane);
        State { t, q: vector(q), v: vector(v) }
    }
}

impl Statistics {
    /// A step on lanes, with as many evaluations as it takes alone.
    fn count<P: Pair, const M: usize>(&mut self, accepted: bool) {
        let error_needs_last = P::ERROR.iter().any(|(slope, _)| *slope == P::STAGES.len() + 1);
        self.evaluations += P::STAGES.len() + usize::from(error_needs_last);
        if accepted {
            self.evaluations += usize::from(M > 0 || !error_needs_last);
            self.accepted += 1;
        } else {
            self.rejected += 1;
        }
    }
}

/// What lies in one lane.
fn unpacked<const N: usize>(packed: &Phase<Lanes, N>, lane: usize) -> Phase<f64, N> {
    packed.map(|half| half.map(|x| x.to_array()[lane]))
}
