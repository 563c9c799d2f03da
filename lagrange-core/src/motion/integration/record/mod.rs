//! Record of a motion that keeps no steps: samples, quantities, crossings, and the end.

pub(crate) mod plan;

use alloc::boxed::Box;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::{self, Debug, Formatter};
use core::marker::PhantomData;
use core::ops::Deref;

pub(crate) use plan::{RecordPlan, SampleTimes, check_interval};

use crate::error::{Ending, Error};
use crate::motion::event::{DenseStep, DynEvent, EventSearch};
use crate::motion::method::Method;
use crate::motion::run::{Observer, Run, is_between, resume};
use crate::number::Real;
use crate::solution::Sample;
use crate::solution::crossing::Crossing;
use crate::solution::interpolant::Interpolant;
use crate::solution::system_checks::SystemChecks;
use crate::solution::vector_field::VectorField;
use crate::statistics::Statistics;
use crate::system::{SolutionOf, State, StateOf, System};
use crate::trajectory::Transition;
use crate::vector::{Element, Length};

/// End of the motion of a member of an [ensemble](crate::ensemble), with its samples, quantities and crossings.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(bound(serialize = "T: nalgebra::Scalar + serde::Serialize"))
)]
pub struct Arrival<T: Element, N: Length> {
    /// Last state.
    pub state: State<T, N>,
    /// Reason why the motion ended at this state.
    pub ending: Ending,
    /// Numbers of steps and evaluations.
    pub statistics: Statistics,
    /// States at the times of `samples_at` or `every`, up to the end of the motion.
    pub samples: Vec<State<T, N>>,
    /// Quantities of the samples: all of the first sample, all of the second, …
    pub values: Vec<T>,
    /// Crossings of events, in the order of the motion.
    pub crossings: Vec<Crossing<T, N>>,
    /// Transitions of a motion across [contacts](crate::contact), in the order in which they are decided. Those of the members of an
    /// ensemble are not kept.
    pub transitions: Vec<Transition<T>>,
}

/// Takes back the crossings of a step after the time at which the motion ends within it.
pub(crate) fn forget_beyond<T: Real, N: Length>(crossings: &mut Vec<Crossing<T, N>>, [end, after]: [T; 2]) {
    let is_beyond = |last: &mut Crossing<T, N>| last.state.t != end && is_between(end, last.state.t, after);
    while crossings.pop_if(is_beyond).is_some() {}
}

/// Returns one quantity of each sample, from all values of the quantities with the names `known`.
pub(crate) fn quantity<'v, T: Copy, N: AsRef<str>>(
    name: &str,
    known: &[N],
    values: &'v [T],
    hint: &str,
) -> Result<impl Iterator<Item = T> + use<'v, T, N>, Error> {
    let place = known.iter().position(|known| known.as_ref() == name).ok_or_else(|| {
        let hint = known.is_empty().then(|| hint.into());
        let known = known.iter().map(|known| known.as_ref().into()).collect();
        Error::UnknownName { name: name.into(), kind: "quantity", hint, known }
    })?;
    Ok(values.iter().skip(place).step_by(known.len()).copied())
}

/// Controller, which sets parameters of a system during its motion. Its error is a message.
pub(crate) type Controller<'o, L> = dyn FnMut(&mut L, &StateOf<L>) -> Result<(), String> + 'o;

/// Controller, with the interval of time between its calls.
pub struct Steering<'o, L: System> {
    pub(crate) interval: L::Scalar,
    pub(crate) controller: Box<Controller<'o, L>>,
}

impl<L: System> Debug for Steering<'_, L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Steering").field("interval", &self.interval).finish_non_exhaustive()
    }
}

impl<L: System<Scalar: Real>> Steering<'_, L> {
    /// Checks that the interval is positive and finite.
    pub(crate) fn check(&self) -> Result<(), Error> {
        check_interval(CONTROLLER, self.interval)
    }
}

/// Name of the setting in error messages.
pub(crate) const CONTROLLER: &str = "interval of the controller";

/// Record of one motion.
pub(crate) struct Record<'o, L: System> {
    plan: &'o RecordPlan<'o, L>,
    samples: Vec<StateOf<L>>,
    /// Quantities of the first sample, then of the second, …
    values: Vec<L::Scalar>,
    crossings: Vec<Crossing<L::Scalar, L::Length>>,
    events: Vec<Box<DynEvent<'o, L>>>,
    /// Minimum number of parts in which every step is searched for events.
    subdivisions: usize,
    /// Ending at the start, if an event that is due there ends the motion.
    stopped: Option<Ending>,
    steering: Option<Steering<'o, L>>,
    /// Accelerations and multipliers of samples, if they are not those of the equations.
    given: Option<SolutionOf<L>>,
    start: L::Scalar,
    end: L::Scalar,
    /// Next time to reach: the end, or an earlier call of the controller.
    pub(crate) goal: L::Scalar,
    /// Number of calls of the controller.
    calls: usize,
}

impl<'o, L: System<Scalar: Real>> Record<'o, L> {
    /// Begins the record: takes the samples and crossings that are due at the start.
    pub(crate) fn begin(
        plan: &'o RecordPlan<'o, L>,
        events: Vec<Box<DynEvent<'o, L>>>,
        steering: Option<Steering<'o, L>>,
        start: &Sample<&L>,
        end: L::Scalar,
    ) -> Result<Self, Error> {
        let mut record = Self::before_samples(plan, events, steering, start, end)?;
        record.take_due(start.system(), start.state())?;
        Ok(record)
    }

    /// Begins the record, without the samples at the start.
    pub(crate) fn before_samples(
        plan: &'o RecordPlan<'o, L>,
        mut events: Vec<Box<DynEvent<'o, L>>>,
        steering: Option<Steering<'o, L>>,
        sample: &Sample<&L>,
        end: L::Scalar,
    ) -> Result<Self, Error> {
        let (system, start) = (sample.system(), sample.state());
        plan.times.check_within([start.t, end])?;
        // Evaluate each quantity once, so that an unknown name is an error before the first step.
        plan.quantities.iter().try_for_each(|(_, value)| value(sample).map(drop))?;
        let mut crossings = Vec::new();
        let mut search = EventSearch::begin(&mut events, system, start)?;
        let (subdivisions, stopped) = (search.subdivisions, search.record_due(start, &mut crossings));
        let count = plan.times.capacity([start.t, end]);
        let (samples, values) =
            (Vec::with_capacity(count), Vec::with_capacity(count * plan.quantities.len()));
        let goal = if steering.is_some() { start.t } else { end };
        let (start_time, calls, given) = (start.t, 0, sample.given());
        Ok(Self {
            plan,
            samples,
            values,
            crossings,
            events,
            subdivisions,
            stopped,
            steering,
            given,
            start: start_time,
            end,
            goal,
            calls,
        })
    }

    /// Takes the samples at the time of this state.
    pub(crate) fn take_due(&mut self, system: &L, state: &StateOf<L>) -> Result<(), Error> {
        while self.next_time().is_some_and(|t| t == state.t) {
            self.push(system, state.clone())?;
        }
        Ok(())
    }

    /// Time of the next sample.
    fn next_time(&self) -> Option<L::Scalar> {
        self.plan.times.get(self.samples.len(), [self.start, self.end])
    }

    fn push(&mut self, system: &L, state: StateOf<L>) -> Result<(), Error> {
        let (sample, before) = (Sample::of(system, state.clone()).with(self.given), self.values.len());
        for (_, value) in &self.plan.quantities {
            match value(&sample) {
                Ok(value) => self.values.push(value),
                Err(error) => {
                    self.values.truncate(before);
                    return Err(error);
                }
            }
        }
        self.samples.push(state);
        Ok(())
    }

    /// True if samples or events may be due in a step between these times, so that its dense output is needed.
    pub(crate) fn looks_into(&self, from: L::Scalar, to: L::Scalar) -> bool {
        !self.events.is_empty() || self.next_time().is_some_and(|t| is_between(from, t, to))
    }

    /// Records the samples and crossings in this step. If the motion stops within the step, moves `end` there and
    /// returns the ending.
    pub(crate) fn keep<F: VectorField<L>, I: Interpolant<L::Scalar, L::Length>>(
        &mut self,
        step: &DenseStep<'_, L, F, I>,
        end: &mut StateOf<L>,
    ) -> Option<Ending> {
        let mut stopped = None;
        if !self.events.is_empty() {
            let mut search = EventSearch {
                events: &mut self.events,
                subdivisions: self.subdivisions,
                system: PhantomData,
            };
            if let Some((state, ending)) = search.record(step, &mut self.crossings) {
                (*end, stopped) = (state, Some(ending));
            }
        }
        let failed = self.keep_samples(step, end, true);
        if failed.is_some() {
            forget_beyond(&mut self.crossings, [end.t, step.after.t]);
        }
        failed.or(stopped)
    }

    /// Records the samples in this step up to `end`, and at its time if `has_end` is true. If one fails, moves `end` to the last
    /// sample and returns the ending.
    pub(crate) fn keep_samples<F: VectorField<L>, I: Interpolant<L::Scalar, L::Length>>(
        &mut self,
        step: &DenseStep<'_, L, F, I>,
        end: &mut StateOf<L>,
        has_end: bool,
    ) -> Option<Ending> {
        let mut at = step.before.clone();
        while let Some(t) = self.next_time()
            && is_between(step.before.t, t, end.t)
            && (has_end || t != end.t)
        {
            let kept = step.at(t).and_then(|state| {
                at.clone_from(&state);
                self.push(step.system, state)
            });
            if let Err(error) = kept {
                let time = at.t.to_f64();
                *end = at;
                return Some(Ending::of(error, time));
            }
        }
        None
    }

    /// True if the controller must be called before the next step.
    pub(crate) fn is_due(&self, t: L::Scalar) -> bool {
        t == self.goal && t != self.end
    }

    /// Calls the controller, and sets the next goal. The caller must then resume the method.
    pub(crate) fn control<F: VectorField<L>>(
        &mut self,
        system: &mut L,
        state: &StateOf<L>,
    ) -> Result<(), Ending> {
        let Some(Steering { interval, controller }) = &mut self.steering else { return Ok(()) };
        let time = state.t.to_f64();
        controller(system, state).map_err(|said| Ending::ControllerFailed { time, said })?;
        self.calls += 1;
        let times = SampleTimes::Every(*interval);
        self.goal = times.get(self.calls, [self.start, self.end]).unwrap_or(self.end);
        if self.goal == state.t {
            return Err(Ending::TimeTooCoarse { time, step: interval.to_f64() });
        }
        F::Checks::check_fit(system, state)
            .and_then(|()| EventSearch::from(&mut self.events, system, state, true))
            .map_err(|error| Ending::of(error, time))?;
        Ok(())
    }

    /// The samples so far.
    pub(crate) fn samples(&self) -> &[StateOf<L>] {
        &self.samples
    }

    /// Ending of a motion that ends at its start, else `None`.
    pub(crate) fn stopped(&mut self) -> Option<Ending> {
        self.stopped.take()
    }

    /// The samples, and their quantities.
    pub(crate) fn into_samples(self) -> (Vec<StateOf<L>>, Vec<L::Scalar>) {
        (self.samples, self.values)
    }

    /// Converts the record to the result, with the state at the end.
    pub(crate) fn arrive(
        self,
        state: StateOf<L>,
        ending: Ending,
        statistics: Statistics,
    ) -> Arrival<L::Scalar, L::Length> {
        let Self { samples, values, crossings, .. } = self;
        Arrival { state, ending, statistics, samples, values, crossings, transitions: Vec::new() }
    }
}

/// The system of a motion, which a controller may change.
pub(crate) enum Moving<'r, L> {
    Fixed(&'r L),
    Steered(&'r mut L),
}

impl<L> Deref for Moving<'_, L> {
    type Target = L;

    #[inline]
    fn deref(&self) -> &L {
        match self {
            Self::Fixed(system) => system,
            Self::Steered(system) => system,
        }
    }
}

/// Observer that records one motion, and calls its controller. If `HAS_DENSE_OUTPUT` is false, no samples, events or
/// controller exist, and their code is not compiled.
pub(crate) struct Recorded<'o, 'r, L: System, I, A, const HAS_DENSE_OUTPUT: bool> {
    system: Moving<'r, L>,
    pub(crate) record: Record<'o, L>,
    /// Interpolant of the last step, if samples or events need it.
    pub(crate) within: Option<I>,
    /// Callback with the state and the number of steps after each step; it may cancel the motion.
    accept: A,
}

impl<'o, 'r, L, I, A, const HAS_DENSE_OUTPUT: bool> Recorded<'o, 'r, L, I, A, HAS_DENSE_OUTPUT>
where
    L: System<Scalar: Real>,
{
    pub(crate) fn new(system: Moving<'r, L>, record: Record<'o, L>, accept: A) -> Self {
        Self { system, record, within: None, accept }
    }

    /// Ends the record, and returns the result.
    pub(crate) fn finish(
        self,
        driven: Result<(), Ending>,
        state: StateOf<L>,
        statistics: Statistics,
    ) -> Arrival<L::Scalar, L::Length> {
        let ending = driven.err().unwrap_or(Ending::Complete { time: self.record.end.to_f64() });
        self.record.arrive(state, ending, statistics)
    }
}

impl<L, F, P, A, const HAS_DENSE_OUTPUT: bool> Observer<L, P, F>
    for Recorded<'_, '_, L, P::Interpolant, A, HAS_DENSE_OUTPUT>
where
    L: System<Scalar: Real>,
    F: VectorField<L>,
    P: Method<L, F>,
    A: FnMut(&StateOf<L>, usize) -> Result<(), Ending>,
{
    fn system(&self) -> &L {
        &self.system
    }

    #[inline(always)]
    fn goal(&mut self, method: &P, run: &mut Run<L, P, F>) -> Result<Option<L::Scalar>, Ending> {
        let Self { system, record, .. } = self;
        let Run { memory, state, statistics, .. } = run;
        if const { HAS_DENSE_OUTPUT } {
            if let Some(ending) = record.stopped() {
                return Err(ending);
            }
            if let Moving::Steered(system) = system
                && record.is_due(state.t)
            {
                record.control::<F>(system, state)?;
                resume::<_, F, _>(system, method, memory, state, statistics)
                    .map_err(|error| Ending::of(error, state.t.to_f64()))?;
            }
        }
        Ok((state.t != record.end).then_some(record.goal))
    }

    #[inline(always)]
    fn follow(&mut self, method: &P, run: &mut Run<L, P, F>) -> Result<(), Ending> {
        if const { HAS_DENSE_OUTPUT } {
            let Run { memory, statistics, before, state } = run;
            let is_wanted = self.record.looks_into(before.t, state.t);
            let within = is_wanted
                .then(|| method.interpolant(&self.system, memory, [before, state], statistics))
                .transpose();
            self.within = within.map_err(|error| Ending::of(error, before.t.to_f64()))?;
        }
        Ok(())
    }

    #[inline(always)]
    fn keep(&mut self, method: &P, run: &mut Run<L, P, F>) -> Result<(), Ending> {
        if let (true, Some(interpolant)) = (const { HAS_DENSE_OUTPUT }, &self.within) {
            let (before, after, field) = (&run.before, &run.state.clone(), PhantomData::<F>);
            let step = DenseStep { system: &*self.system, before, after, interpolant, field };
            self.record.given = method.means(&run.memory);
            self.record.keep(&step, &mut run.state).map_or(Ok(()), Err)?;
        }
        (self.accept)(&run.state, run.statistics.accepted)
    }
}
