//! Motions in lock-step on SIMD lanes, each with its own time, step length and ending.

use core::marker::PhantomData;
use core::ops::ControlFlow;

use super::contract::{LaneMethod, LaneMotions};
use super::motion::{LaneMotion, LaneOutcome};
use crate::error::Ending;
use crate::motion::event::DenseStep;
use crate::number::Lanes;
use crate::solution::vector_field::LagrangianVectorField;
use crate::system::{Lagrangian, State};
use crate::vector::{PhaseVector, StaticLength, from_fn, vector};

/// Motions in lock-step, at most one per lane.
pub(crate) struct Batch<'o, L: Lagrangian<Scalar = f64>, P: LaneMethod<L>> {
    method: &'o P,
    lane_memory: P::LaneMemory,
    motions: LaneMotions<'o, L, P>,
}

impl<'o, L: Lagrangian<Scalar = f64>, P: LaneMethod<L>> Batch<'o, L, P> {
    /// Creates a batch with a first motion; the other lanes are free.
    pub(crate) fn new(method: &'o P, motion: LaneMotion<'o, L, P>) -> Self {
        let lane_memory = method.lane_memory(&motion.system, &motion.memory);
        let mut motions = [const { None }; Lanes::COUNT];
        motions[0] = Some(motion.begin(method));
        Self { method, lane_memory, motions }
    }

    pub(crate) fn has_free_lane(&self) -> bool {
        self.motions.iter().any(Option::is_none)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.motions.iter().all(Option::is_none)
    }

    /// Assigns a free lane to the motion. Returns the motion if no lane is free, or if it differs in a field that lanes
    /// share.
    pub(crate) fn join(&mut self, motion: LaneMotion<'o, L, P>) -> Option<LaneMotion<'o, L, P>> {
        let lane = self.motions.iter().position(Option::is_none);
        match lane.filter(|&lane| P::place(&mut self.lane_memory, lane, &motion.system)) {
            None => Some(motion),
            Some(lane) => {
                self.motions[lane] = Some(motion.begin(self.method));
                self.load(lane);
                None
            }
        }
    }

    /// Tries one step in every lane. Calls `accept` with each new state, and `leave` with each motion that has ended.
    /// If `HAS_DENSE_OUTPUT` is false, no samples, events or controller exist, and their code is not compiled.
    pub(crate) fn step<const HAS_DENSE_OUTPUT: bool>(
        &mut self,
        mut accept: impl FnMut(usize, &State<f64, L::N>) -> ControlFlow<()>,
        mut leave: impl FnMut(LaneMotion<'o, L, P>, State<f64, L::N>, Ending),
    ) {
        let starts = self.motions.each_ref().map(|motion| motion.as_ref().map_or(0.0, LaneMotion::now));
        let outcomes = self.method.attempt::<HAS_DENSE_OUTPUT>(&mut self.lane_memory, &mut self.motions);
        let outcomes =
            from_fn(|lane| outcomes[lane].unwrap_or_else(|| self.step_alone::<HAS_DENSE_OUTPUT>(lane)));
        let before: [_; Lanes::COUNT] = from_fn(|lane| {
            if const { HAS_DENSE_OUTPUT } {
                Some(state(P::phase(&self.lane_memory, lane), starts[lane]))
            } else {
                None
            }
        });
        self.commit(&outcomes);
        for (lane, outcome) in outcomes.into_iter().enumerate() {
            let Some(now) = self.motions[lane].as_ref().map(LaneMotion::now) else { continue };
            let mut state = match outcome {
                LaneOutcome::Accepted => state(P::reached(&self.lane_memory, lane), now),
                _ => state(P::phase(&self.lane_memory, lane), now),
            };
            let is_accepted = outcome != LaneOutcome::Rejected;
            let before = before[lane].as_ref().filter(|_| is_accepted);
            let stopped = before.and_then(|before| self.keep(lane, before, &mut state));
            let Some(motion) = &self.motions[lane] else { continue };
            let mut is_cancelled = || is_accepted && accept(motion.index, &state).is_break();
            let mut ending = match stopped {
                None if is_cancelled() => Some(Ending::Cancelled { time: state.t }),
                stopped => stopped,
            };
            if const { HAS_DENSE_OUTPUT } && ending.is_none() {
                ending = self.control(lane, &state);
            }
            if let Some(ending) = ending.or_else(|| self.ending(lane))
                && let Some(motion) = self.motions[lane].take()
            {
                leave(motion, state, ending);
            }
        }
    }

    /// Takes the step of one lane by the scalar method. A free lane takes no step.
    #[cold]
    fn step_alone<const HAS_DENSE_OUTPUT: bool>(&mut self, lane: usize) -> LaneOutcome {
        let Some(motion) = &mut self.motions[lane] else { return LaneOutcome::Rejected };
        P::unload(&self.lane_memory, lane, &mut motion.memory);
        motion.step_alone::<HAS_DENSE_OUTPUT>(self.method)
    }

    /// Moves the lanes with accepted steps to the ends of these steps.
    fn commit(&mut self, outcomes: &[LaneOutcome; Lanes::COUNT]) {
        let chosen = outcomes.map(|outcome| if outcome == LaneOutcome::Accepted { 1.0 } else { 0.0 });
        P::commit(&mut self.lane_memory, chosen.into());
        for lane in (0..Lanes::COUNT).filter(|lane| outcomes[*lane] == LaneOutcome::AcceptedAlone) {
            self.load(lane);
        }
    }

    /// Records the samples and crossings in an accepted step. If the motion stops within the step, moves `end` there
    /// and returns the ending.
    fn keep(&mut self, lane: usize, before: &State<f64, L::N>, end: &mut State<f64, L::N>) -> Option<Ending> {
        let LaneMotion { record, system, within, .. } = self.motions[lane].as_mut()?;
        if !record.looks_into(before.t, end.t) {
            return None;
        }
        let (after, field) = (&{ *end }, PhantomData::<LagrangianVectorField>);
        match within.take() {
            Some(interpolant) => {
                let interpolant = &interpolant;
                record.keep(&DenseStep { system, before, after, interpolant, field }, end)
            }
            None => {
                let interpolant = &P::within(&self.lane_memory, lane);
                record.keep(&DenseStep { system, before, after, interpolant, field }, end)
            }
        }
    }

    /// Calls the controller of a member if its call is due. Returns the ending if it fails.
    fn control(&mut self, lane: usize, state: &State<f64, L::N>) -> Option<Ending> {
        let motion = self.motions[lane].as_mut().filter(|motion| motion.record.is_due(state.t))?;
        if let Err(ending) = motion.control(state, self.method) {
            return Some(ending);
        }
        if !P::place(&mut self.lane_memory, lane, &motion.system) {
            let said = "it changes a field that is no number, which all lanes share".into();
            return Some(Ending::ControllerFailed { time: state.t, said });
        }
        self.load(lane);
        None
    }

    /// Returns the reason why a lane takes no further step.
    fn ending(&mut self, lane: usize) -> Option<Ending> {
        let lane_memory = &self.lane_memory;
        self.motions[lane].as_mut()?.ending(self.method, |memory| P::unload(lane_memory, lane, memory))
    }

    /// Copies the current state of its motion into a lane.
    fn load(&mut self, lane: usize) {
        if let Some(motion) = &self.motions[lane] {
            P::load(&mut self.lane_memory, lane, &motion.memory);
        }
    }
}

fn state<N: StaticLength>(y: PhaseVector<f64, N>, t: f64) -> State<f64, N> {
    State { t, q: vector(y.half(0)), v: vector(y.half(1)) }
}
