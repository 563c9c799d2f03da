//! A motion that has a SIMD lane, and what becomes of its steps.

use super::method::step::Memory;
use super::method::{Adaptive, Method, Pair, Step};
use super::record::{Orders, Record};
use super::run::{Run, Watchdog, resume};
use crate::ending::Ending;
use crate::error::Error;
use crate::solution::flow::{LagrangianFlow, Phase};
use crate::statistics::Statistics;
use crate::system::{Lagrangian, State};

/// A motion that has a lane, or waits for one.
pub(crate) struct Seat<'o, L: Lagrangian<N, M>, const N: usize, const M: usize> {
    /// Which member of the ensemble it is.
    pub(crate) index: usize,
    /// What tells its start and parameters from others.
    pub(crate) start: u32,
    pub(crate) statistics: Statistics,
    /// What is kept of it on the way.
    pub(crate) record: Record<'o, L, N, M>,
    pub(super) system: L,
    /// Its state and slopes are in the lane, and here only while a step is taken alone.
    pub(super) memory: Memory<f64, N, M>,
    end: f64,
    limits: Watchdog,
    /// Why no step will do.
    failure: Option<Ending>,
}

/// What became of a step in one lane.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Fate {
    Accepted,
    /// Taken alone: the lane is to be loaded with the result.
    AcceptedAlone,
    Rejected,
}

impl<'o, L: Lagrangian<N, M, Scalar = f64>, const N: usize, const M: usize> Seat<'o, L, N, M> {
    /// Before the first step, with the state made consistent.
    pub(crate) fn new<P: Pair, const IS_WATCHED: bool>(
        (index, start): (usize, u32),
        system: L,
        state: &State<f64, N>,
        end: f64,
        method: &Adaptive<P>,
        orders: &'o Orders<'o, L, N, M>,
    ) -> Result<(Self, State<f64, N>), Error> {
        let (run, _) = Run::begin::<L, LagrangianFlow, _, M>(&system, state, method)?;
        let record = Record::begin(orders, &system, &run.state, end)?;
        let Run { memory, state, statistics, .. } = run;
        let limits = Watchdog::new(method.limits(), &statistics);
        let mut seat = Self { index, start, record, system, memory, end, statistics, limits, failure: None };
        if const { IS_WATCHED } && seat.record.is_due(state.t) {
            seat.failure = seat.control(&state, method).err();
        }
        seat.aim(method);
        Ok((seat, state))
    }

    fn aim<P: Pair>(&mut self, method: &Adaptive<P>) {
        let Self { system, memory, end, statistics, .. } = self;
        method.aim::<L, LagrangianFlow, N, M>(system, memory, *end, statistics);
    }

    /// The lane is to have the slope, if there is a step to take.
    fn ensure_slope(&mut self) -> Result<(), Ending> {
        let Self { system, memory, statistics, .. } = self;
        if memory.clock.is_at_end() {
            return Ok(());
        }
        let slope = memory.ensure_slope::<L, LagrangianFlow>(system, statistics);
        slope.map_err(|error| Ending::of(error, memory.clock.now))
    }

    /// Calls the controller, and goes on from this state with what it has set.
    pub(super) fn control<P: Pair>(
        &mut self,
        state: &State<f64, N>,
        method: &Adaptive<P>,
    ) -> Result<(), Ending> {
        let Self { index, record, system, memory, statistics, .. } = self;
        record.control(*index, system, state)?;
        resume::<_, LagrangianFlow, _, N, M>(system, method, memory, state, statistics)
            .map_err(|error| Ending::of(error, state.t))?;
        self.end = self.record.goal;
        self.aim(method);
        Ok(())
    }

    /// The clock on the wall starts when it is given a lane.
    pub(super) fn begin<P>(mut self, method: &Adaptive<P>) -> Self {
        self.limits = Watchdog::new(method.limits(), &self.statistics);
        self
    }

    /// Why there is no step to take.
    pub(crate) fn ending_at_start<P: Pair>(&mut self, method: &Adaptive<P>) -> Option<Ending> {
        let here = [self.memory.y, self.memory.slope];
        self.ending(method, || here)
    }

    /// Why there is no further step to take; `here` gives the state and its rates.
    pub(super) fn ending<P: Pair>(
        &mut self,
        method: &Adaptive<P>,
        here: impl FnOnce() -> [Phase<f64, N>; 2],
    ) -> Option<Ending> {
        let Self { system, memory, end, statistics, limits, failure, .. } = self;
        let time = memory.clock.now;
        if memory.clock.is_at_end() {
            return Some(Ending::Complete { time });
        }
        let stiffness = || {
            [memory.y, memory.slope] = here();
            Method::<L, N, M>::stiffness(method, system, memory, *end)
        };
        failure.clone().or_else(|| limits.exceeded(statistics, time, stiffness))
    }

    /// Accepts or rejects a step computed on lanes, with an interpolant or without; `None` where it is to be taken alone.
    pub(super) fn decide<P: Pair>(
        &mut self,
        (h, time): (f64, f64),
        error: f64,
        method: &Adaptive<P>,
        is_looked_into: bool,
    ) -> Option<Fate> {
        let Memory { clock, control, active, .. } = &mut self.memory;
        if active.contains(&false) || !clock.is_ahead(time) {
            return None;
        }
        let accepted = method.accepts(error);
        if accepted {
            method.after_acceptance(control, clock, (h, time), error);
        } else {
            let before = control.clone();
            control.refuse::<P>(h, error);
            if !clock.advances_by(control.step) {
                *control = before;
                return None;
            }
        }
        self.count(method, accepted, is_looked_into);
        Some(if accepted { Fate::Accepted } else { Fate::Rejected })
    }

    /// As many evaluations as the step takes alone.
    fn count<P: Pair>(&mut self, method: &Adaptive<P>, accepted: bool, is_looked_into: bool) {
        let Self { statistics, memory: Memory { has_slope, .. }, .. } = self;
        let (at_start, before) = (!*has_slope, method.error_needs_last());
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

    /// The step from this state with this slope by the scalar method. `along` is what else belongs to it; where that fails
    /// the step is taken back.
    #[cold]
    pub(super) fn step_alone<P: Pair>(
        &mut self,
        y: Phase<f64, N>,
        slope: Phase<f64, N>,
        method: &Adaptive<P>,
        along: impl FnOnce(&mut Self) -> Result<(), Error>,
    ) -> Fate {
        let now = self.memory.clock.now;
        (self.memory.y, self.memory.slope) = (y, slope);
        let Self { system, memory, end, statistics, .. } = self;
        self.failure = match Method::<L, N, M>::step(method, system, memory, *end, statistics) {
            Step::Accepted(_) => match along(self) {
                Ok(()) => {
                    self.statistics.accepted += 1;
                    self.failure = self.ensure_slope().err();
                    return Fate::AcceptedAlone;
                }
                Err(error) => {
                    self.statistics.rejected += 1;
                    let is_taken_back = Method::<L, N, M>::take_back(method, &mut self.memory);
                    (!is_taken_back).then(|| Ending::of(error, now))
                }
            },
            Step::Rejected => {
                statistics.rejected += 1;
                None
            }
            Step::Failed(ending) => Some(ending),
        };
        Fate::Rejected
    }
}
