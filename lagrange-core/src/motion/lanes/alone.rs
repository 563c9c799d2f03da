//! Scalar operations of a motion that has a lane: its start, its controller, steps that lanes cannot take, and its
//! ending.

use super::contract::LaneMethod;
use super::motion::{LaneMotion, LaneOutcome};
use crate::error::{Ending, Error};
use crate::motion::Step;
use crate::motion::integration::record::Record;
use crate::motion::run::{Run, Watchdog, resume};
use crate::solution::vector_field::LagrangianVectorField;
use crate::system::{Lagrangian, State, StateOf};

impl<'o, L: Lagrangian<Scalar = f64>, P: LaneMethod<L>> LaneMotion<'o, L, P> {
    /// Makes the start consistent, and prepares the first step. Returns the motion and its consistent start.
    pub(crate) fn new<const HAS_DENSE_OUTPUT: bool>(
        (index, start): (usize, u32),
        system: L,
        state: &State<f64, L::N>,
        end: f64,
        method: &P,
        record: impl FnOnce(&L, &State<f64, L::N>) -> Result<Record<'o, L>, Error>,
    ) -> Result<(Self, State<f64, L::N>), Error> {
        let (run, _) = Run::<L, _>::begin(&system, state, method)?;
        let record = record(&system, &run.state)?;
        let Run { memory, state, statistics, .. } = run;
        let limits = Watchdog::new(method.limits(), &statistics);
        let (within, failure) = (None, None);
        let mut motion =
            Self { index, start, record, system, memory, within, end, statistics, limits, failure };
        if const { HAS_DENSE_OUTPUT } && motion.record.is_due(state.t) {
            motion.failure = motion.control(&state, method).err();
        }
        let prepared = motion.prepare(method).err();
        motion.failure = motion.failure.or(prepared);
        Ok((motion, state))
    }

    pub(crate) fn now(&self) -> f64 {
        P::now(&self.memory)
    }

    fn prepare(&mut self, method: &P) -> Result<(), Ending> {
        let Self { system, memory, end, statistics, .. } = self;
        let prepared = method.prepare(system, memory, *end, statistics);
        prepared.map_err(|error| Ending::of(error, self.now()))
    }

    /// Calls the controller, and continues from this state with the changed parameters.
    pub(super) fn control(&mut self, state: &State<f64, L::N>, method: &P) -> Result<(), Ending> {
        let Self { record, system, memory, statistics, .. } = self;
        record.control::<L::Field>(system, state)?;
        resume::<_, LagrangianVectorField, _>(system, method, memory, state, statistics)
            .map_err(|error| Ending::of(error, state.t))?;
        self.end = self.record.goal;
        self.prepare(method)
    }

    /// Starts the wall-clock limit when the motion gets a lane.
    pub(super) fn begin(mut self, method: &P) -> Self {
        self.limits = Watchdog::new(method.limits(), &self.statistics);
        self
    }

    /// Returns the reason why the first step cannot be taken.
    pub(crate) fn ending_at_start(&mut self, method: &P) -> Option<Ending> {
        self.ending(method, |_| ())
    }

    /// Returns the reason why no further step is taken. `unload` copies the lane's data into the memory.
    pub(super) fn ending(&mut self, method: &P, unload: impl FnOnce(&mut P::Memory)) -> Option<Ending> {
        let Self { system, memory, end, statistics, limits, failure, .. } = self;
        let time = P::now(memory);
        if P::is_at_end(memory) {
            return Some(Ending::Complete { time });
        }
        let pace = || {
            unload(memory);
            method.pace(system, memory, *end)
        };
        failure.clone().or_else(|| limits.exceeded(statistics, time, pace))
    }

    /// Takes the step from the state in the memory by the scalar method. Computes its dense output if samples or events
    /// need it, and undoes the step if that fails.
    #[cold]
    pub(super) fn step_alone<const HAS_DENSE_OUTPUT: bool>(&mut self, method: &P) -> LaneOutcome {
        let (now, before) = (self.now(), P::state(&self.memory));
        let Self { system, memory, end, statistics, .. } = self;
        let mut state = before;
        self.failure = match method.step(system, memory, *end, &before, &mut state, statistics) {
            Step::Accepted => match self.look_within::<HAS_DENSE_OUTPUT>([&before, &state], method) {
                Ok(()) => {
                    self.statistics.accepted += 1;
                    self.failure = self.prepare(method).err();
                    return LaneOutcome::AcceptedAlone;
                }
                Err(error) => {
                    self.statistics.rejected += 1;
                    let is_taken_back = method.undo(&mut self.memory);
                    (!is_taken_back).then(|| Ending::of(error, now))
                }
            },
            Step::Rejected => {
                statistics.rejected += 1;
                None
            }
            Step::Failed(ending) => Some(ending),
        };
        LaneOutcome::Rejected
    }

    fn look_within<const HAS_DENSE_OUTPUT: bool>(
        &mut self,
        ends: [&StateOf<L>; 2],
        method: &P,
    ) -> Result<(), Error> {
        if const { HAS_DENSE_OUTPUT } && self.record.looks_into(ends[0].t, ends[1].t) {
            let Self { system, memory, statistics, .. } = self;
            self.within = Some(method.interpolant(system, memory, ends, statistics)?);
        }
        Ok(())
    }
}
