//! What is kept of a motion on its way, beside its end.

use core::fmt::{self, Display, Write};
use core::marker::PhantomData;
use core::ops::ControlFlow;

use nalgebra::ComplexField;

use super::event::{DenseStep, Event, EventFunction, EventSearch, EventValue};
use super::method::Method;
use super::run::{Observer, Run, is_between, resume};
use crate::error::{Ending, Error};
use crate::number::{Real, Scalar};
use crate::solution::Sample;
use crate::solution::crossing::Crossing;
use crate::solution::interpolant::Interpolant;
use crate::solution::vector_field::VectorField;
use crate::system::{Lagrangian, State};

/// What is to be kept of each of many motions.
pub(crate) struct RecordPlan<'a, L: Lagrangian<N, M>, const N: usize, const M: usize> {
    /// When states are, in the order of the motion.
    pub(crate) times: Vec<L::Scalar>,
    quantities: Vec<(&'static str, Box<Observed<'a, L, N, M>>)>,
    /// As they are before the first crossing.
    events: Vec<Event<L, Box<Observed<'a, L, N, M>>, N, M>>,
    /// Called at the start, and then as often as this.
    controller: Option<(L::Scalar, Box<Controller<'a, L, N, M>>)>,
}

/// Sets the parameters of the motion of this index; an error in words.
type Controller<'a, L, const N: usize, const M: usize> = dyn Fn(usize, &mut L, &State<<L as Lagrangian<N, M>>::Scalar, N>) -> Result<(), String>
    + Send
    + Sync
    + 'a;

/// A number that follows from a state.
type Observed<'a, L, const N: usize, const M: usize> =
    dyn Fn(&Sample<&L, N, M>) -> Result<<L as Lagrangian<N, M>>::Scalar, Error> + Send + Sync + 'a;

impl<L: Lagrangian<N, M>, const N: usize, const M: usize> Default for RecordPlan<'_, L, N, M> {
    fn default() -> Self {
        Self { times: Vec::new(), quantities: Vec::new(), events: Vec::new(), controller: None }
    }
}

impl<'a, L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize> RecordPlan<'a, L, N, M> {
    pub(crate) fn quantity<V: EventValue<L::Scalar>>(
        &mut self,
        name: &'static str,
        function: impl Fn(&Sample<&L, N, M>) -> V + Send + Sync + 'a,
    ) {
        self.quantities.push((name, Box::new(move |sample: &Sample<&L, N, M>| function(sample).value())));
    }

    pub(crate) fn event<G>(&mut self, event: Event<L, G, N, M>)
    where
        G: EventFunction<L, N, M> + Send + Sync + 'a,
    {
        self.events.push(event.map(|function| {
            let value: Box<Observed<'a, L, N, M>> =
                Box::new(move |sample: &Sample<&L, N, M>| function.at(sample.system, &sample.state));
            value
        }));
    }

    pub(crate) fn controller<E: Display>(
        &mut self,
        interval: L::Scalar,
        controller: impl Fn(usize, &mut L, &State<L::Scalar, N>) -> Result<(), E> + Send + Sync + 'a,
    ) {
        let in_words = move |index: usize, system: &mut L, state: &State<L::Scalar, N>| {
            controller(index, system, state).map_err(|error| error.to_string())
        };
        self.controller = Some((interval, Box::new(in_words)));
    }

    /// The names of the quantities.
    pub(crate) fn quantities(&self) -> Vec<&'static str> {
        self.quantities.iter().map(|(name, _)| *name).collect()
    }

    /// The names of the events.
    pub(crate) fn events(&self) -> Vec<&'static str> {
        self.events.iter().map(Event::name).collect()
    }

    /// Checks what is the same for all motions.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let times = &self.times;
        let goes_back = times.last() < times.first();
        let turns = |pair: &[L::Scalar]| if goes_back { pair[1] > pair[0] } else { pair[1] < pair[0] };
        let infinite = times.iter().position(|t| !ComplexField::is_finite(t));
        let wrong = infinite.or_else(|| times.windows(2).position(turns).map(|before| before + 1));
        if let Some(index) = wrong {
            return Err(Error::SampleTime { index, time: times[index].to_f64() });
        }
        match &self.controller {
            Some((interval, _))
                if !(ComplexField::is_finite(interval) && *interval > L::Scalar::constant(0.0)) =>
            {
                Err(Error::Setting { name: "interval of the controller", value: interval.to_f64() })
            }
            _ => Ok(()),
        }
    }

    /// The first function by which the end of a motion may change, in words. A quantity can only make a member fail.
    pub(crate) fn unseen(&self) -> Option<String> {
        let event = self.events.first().map(|event| format!("the event `{}`", event.name()));
        event.or_else(|| self.controller.as_ref().map(|_| "the controller".into()))
    }

    /// Writes what tells these record_plan from others; what their functions hold is not seen.
    pub(crate) fn identify(&self, to: &mut dyn Write) -> fmt::Result {
        self.times.iter().try_for_each(|t| write!(to, " at {:?}", t.to_f64()))?;
        self.quantities.iter().try_for_each(|(name, _)| write!(to, " of {name}"))?;
        self.events.iter().try_for_each(|event| write!(to, " with {:?}", event.anew(|_| ())))?;
        self.controller.iter().try_for_each(|(interval, _)| write!(to, " every {:?}", interval.to_f64()))
    }
}

/// What is kept of one.
pub(crate) struct Record<'o, L: Lagrangian<N, M>, const N: usize, const M: usize> {
    record_plan: &'o RecordPlan<'o, L, N, M>,
    pub(crate) samples: Vec<State<L::Scalar, N>>,
    /// The quantities of the first sample, those of the second, …
    pub(crate) values: Vec<L::Scalar>,
    pub(crate) crossings: Vec<Crossing<L::Scalar, N>>,
    events: Vec<Event<L, &'o Observed<'o, L, N, M>, N, M>>,
    /// How many subdivisions every step is looked at in, at least.
    subdivisions: usize,
    start: L::Scalar,
    end: L::Scalar,
    /// Next time to reach: the end, or an earlier call of the controller.
    pub(crate) goal: L::Scalar,
    /// How often it has been called.
    calls: usize,
}

impl<'o, L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize> Record<'o, L, N, M> {
    /// Before the first step, with what is due at the start.
    pub(crate) fn begin(
        record_plan: &'o RecordPlan<'o, L, N, M>,
        system: &L,
        start: &State<L::Scalar, N>,
        end: L::Scalar,
    ) -> Result<Self, Error> {
        let times = &record_plan.times;
        if let (Some(&first), Some(&last)) = (times.first(), times.last()) {
            let outside = |time: L::Scalar| {
                let [time, start, end] = [time, start.t, end].map(Real::to_f64);
                Err(Error::OutsideTrajectory { time, start, end })
            };
            if !is_between(start.t, first, end) {
                return outside(first);
            }
            if !is_between(first, last, end) {
                return outside(last);
            }
        }
        // A name that is not known is told before the first step.
        let sample = Sample { system, state: *start };
        record_plan.quantities.iter().try_for_each(|(_, value)| value(&sample).map(drop))?;
        let mut events: Vec<_> =
            record_plan.events.iter().map(|event| event.anew(|function| &**function)).collect();
        let EventSearch { subdivisions, .. } = EventSearch::begin(&mut events, system, start)?;
        let samples = Vec::with_capacity(times.len());
        let values = Vec::with_capacity(times.len() * record_plan.quantities.len());
        let goal = if record_plan.controller.is_some() { start.t } else { end };
        let (start_time, crossings) = (start.t, Vec::new());
        let mut record = Self {
            record_plan,
            samples,
            values,
            crossings,
            events,
            subdivisions,
            start: start_time,
            end,
            goal,
            calls: 0,
        };
        while record.next_time().is_some_and(|t| t == start.t) {
            record.push(system, *start)?;
        }
        Ok(record)
    }

    /// When the next sample is.
    fn next_time(&self) -> Option<L::Scalar> {
        self.record_plan.times.get(self.samples.len()).copied()
    }

    fn push(&mut self, system: &L, state: State<L::Scalar, N>) -> Result<(), Error> {
        let (sample, before) = (Sample { system, state }, self.values.len());
        for (_, value) in &self.record_plan.quantities {
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

    /// Whether there is something to be looked for in a step between these times.
    pub(crate) fn looks_into(&self, from: L::Scalar, to: L::Scalar) -> bool {
        !self.events.is_empty() || self.next_time().is_some_and(|t| is_between(from, t, to))
    }

    /// Keeps what is due in this step to `end`; where the motion stops before, that is then the end, and why.
    pub(crate) fn keep<F, I>(
        &mut self,
        step: &DenseStep<'_, L, F, I, N, M>,
        end: &mut State<L::Scalar, N>,
    ) -> Option<Ending>
    where
        F: VectorField<L, N, M>,
        I: Interpolant<L::Scalar, N>,
    {
        let (mut at, mut stopped) = (*step.before, None);
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
        while let Some(t) = self.next_time()
            && is_between(step.before.t, t, end.t)
        {
            let kept = step.at(t).and_then(|state| {
                at = state;
                self.push(step.system, state)
            });
            if let Err(error) = kept {
                *end = at;
                return Some(Ending::of(error, at.t.to_f64()));
            }
        }
        stopped
    }

    /// Whether the controller is to be called before the motion goes on.
    pub(crate) fn is_due(&self, t: L::Scalar) -> bool {
        t == self.goal && t != self.end
    }

    /// Calls the controller, and sets the next goal. The method is to be told.
    pub(crate) fn control(
        &mut self,
        index: usize,
        system: &mut L,
        state: &State<L::Scalar, N>,
    ) -> Result<(), Ending> {
        let Some((interval, controller)) = &self.record_plan.controller else { return Ok(()) };
        let time = state.t.to_f64();
        controller(index, system, state).map_err(|said| Ending::ControllerFailed { time, said })?;
        self.calls += 1;
        let passed = *interval * L::Scalar::constant(self.calls as f64);
        let next = if self.end < self.start { self.start - passed } else { self.start + passed };
        self.goal = if is_between(self.start, next, self.end) { next } else { self.end };
        if self.goal == state.t {
            return Err(Ending::TimeTooCoarse { time, step: interval.to_f64() });
        }
        EventSearch::from(&mut self.events, system, state, true).map_err(|error| Ending::of(error, time))?;
        Ok(())
    }
}

/// Records one motion on its way, and calls its controller. Where nothing lies within steps that is wanted, `HAS_DENSE_OUTPUT` is
/// false, and nothing of that is compiled.
pub(crate) struct Recorded<'o, 'r, L, I, A, const N: usize, const M: usize, const HAS_DENSE_OUTPUT: bool>
where
    L: Lagrangian<N, M>,
{
    /// Which motion it is.
    pub(crate) index: usize,
    pub(crate) system: &'r mut L,
    pub(crate) record: Record<'o, L, N, M>,
    /// What lies within the step taken last, where that is wanted.
    pub(crate) within: Option<I>,
    /// Looks at each state; it may cancel the motion.
    pub(crate) accept: A,
}

impl<L, F, P, A, const N: usize, const M: usize, const HAS_DENSE_OUTPUT: bool> Observer<L, F, P, N, M>
    for Recorded<'_, '_, L, P::Interpolant, A, N, M, HAS_DENSE_OUTPUT>
where
    L: Lagrangian<N, M, Scalar: Real>,
    F: VectorField<L, N, M>,
    P: Method<L, N, M, F>,
    A: FnMut(&State<L::Scalar, N>) -> ControlFlow<()>,
{
    fn system(&self) -> &L {
        self.system
    }

    #[inline(always)]
    fn goal(
        &mut self,
        method: &P,
        run: &mut Run<P::Memory, L::Scalar, N>,
    ) -> Result<Option<L::Scalar>, Ending> {
        let Self { index, system, record, .. } = self;
        let Run { memory, state, statistics, .. } = run;
        if const { HAS_DENSE_OUTPUT } && record.is_due(state.t) {
            record.control(*index, system, state)?;
            resume::<_, F, _, N, M>(system, method, memory, state, statistics)
                .map_err(|error| Ending::of(error, state.t.to_f64()))?;
        }
        Ok((state.t != record.end).then_some(record.goal))
    }

    #[inline(always)]
    fn follow(&mut self, method: &P, run: &mut Run<P::Memory, L::Scalar, N>) -> Result<(), Ending> {
        if const { HAS_DENSE_OUTPUT } {
            let Run { memory, statistics, before, state } = run;
            let is_wanted = self.record.looks_into(before.t, state.t);
            let within = is_wanted.then(|| method.interpolant(self.system, memory, statistics)).transpose();
            self.within = within.map_err(|error| Ending::of(error, before.t.to_f64()))?;
        }
        Ok(())
    }

    #[inline(always)]
    fn keep(&mut self, _: &P, run: &mut Run<P::Memory, L::Scalar, N>) -> Result<(), Ending> {
        if let (true, Some(interpolant)) = (const { HAS_DENSE_OUTPUT }, &self.within) {
            let (system, before, after, field) =
                (&*self.system, &run.before, &{ run.state }, PhantomData::<F>);
            let step = DenseStep { system, before, after, interpolant, field };
            self.record.keep(&step, &mut run.state).map_or(Ok(()), Err)?;
        }
        match (self.accept)(&run.state) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(Ending::Cancelled { time: run.state.t.to_f64() }),
        }
    }
}
