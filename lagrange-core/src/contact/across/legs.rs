//! What a motion across contacts keeps of its legs: all steps, or samples alone.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::marker::PhantomData;

use super::Contacts;
use super::bodies::Bodies;
use super::condition::LegCondition;
use super::lifting::Lifting;
use super::states::LegStates;
use crate::error::{Ending, Error};
use crate::motion::event::{AnyEvent, DenseStep, EventSearch};
use crate::motion::integration::record::{Record, forget_beyond};
use crate::motion::integration::store::Stored;
use crate::motion::run::{Observer, Run, Watchdog};
use crate::motion::{DynEvent, Interpolant, LagrangianVectorField, Method, MultiplierBounds};
use crate::number::Real;
use crate::solution::crossing::Crossing;
use crate::statistics::Statistics;
use crate::system::{Lagrangian, StateOf};
use crate::trajectory::Leg;

/// Callback with the state and the number of steps after each step; it may cancel the motion.
pub(super) type Accept<'w, L> = Box<dyn FnMut(&StateOf<L>, usize) -> Result<(), Ending> + 'w>;

/// A leg before its first step.
pub(super) struct StartedLeg<'l, 'e, 'w, L: Contacts<Scalar: Real>, P: Method<L>> {
    pub(super) system: &'l L,
    pub(super) run: Run<L, P>,
    /// Events of the user, then those of contacts.
    pub(super) events: &'l mut [Box<DynEvent<'e, L>>],
    pub(super) goal: L::Scalar,
    /// Number of transitions before the leg.
    pub(super) transitions: usize,
    pub(super) method: &'l P,
    pub(super) limits: &'l Watchdog,
    pub(super) watch: LegWatch<'l, 'w, L>,
}

/// A leg after its last step.
pub(super) struct Driven<L: Lagrangian> {
    pub(super) state: StateOf<L>,
    pub(super) crossings: Vec<Crossing<L::Scalar, L::N>>,
    /// Reason why the leg ends before its goal.
    pub(super) ending: Result<(), Ending>,
    pub(super) statistics: Statistics,
}

/// Keeps what a motion across contacts stores of its legs: all their steps, or samples.
pub(super) trait KeepsLegs<L: Contacts<Scalar: Real>> {
    /// Time up to which the next leg may run, before the end of the motion.
    fn goal(&self) -> Option<L::Scalar> {
        None
    }

    /// Takes note of the state between two legs.
    fn arrives(&mut self, _system: &L, _state: &StateOf<L>) -> Result<(), Error> {
        Ok(())
    }

    /// Calls the controller, if it is due. Returns true if it has been called.
    fn control(&mut self, _system: &mut L, _state: &StateOf<L>) -> Result<bool, Ending> {
        Ok(false)
    }

    /// Runs a leg to its end.
    fn drive<P: Method<L>>(&mut self, leg: StartedLeg<'_, '_, '_, L, P>) -> Result<Driven<L>, Error>;
}

/// An observer that searches steps for events.
trait Searches<L: Lagrangian> {
    /// Passes the next step, of this width, without a search for this event, if its function has one sign there.
    fn stay_away(&mut self, event: usize, is_away: bool, width: L::Scalar);
}

impl<L, W, I> Searches<L> for Stored<'_, '_, L, W, I, true>
where
    L: Lagrangian<Scalar: Real>,
    W: AnyEvent<L>,
    I: Interpolant<L::Scalar, L::N> + Send + Sync + 'static,
{
    fn stay_away(&mut self, event: usize, is_away: bool, width: L::Scalar) {
        self.search.stay_away(event, is_away, width);
    }
}

/// Looks at each step of a leg: at conditions of contacts, at its entries, at gaps that are crossed, and for the progress callback.
pub(super) struct LegWatch<'l, 'w, L: Lagrangian> {
    pub(super) bodies: &'l mut Bodies<L>,
    pub(super) states: &'l LegStates,
    pub(super) lifting: &'l Lifting<L::Scalar>,
    pub(super) accept: &'l mut Accept<'w, L>,
    /// Number of the events before those of contacts.
    pub(super) first: usize,
    /// Conditions that the events of contacts watch.
    pub(super) conditions: &'l [LegCondition<L::Scalar>],
}

impl<L: Contacts<Scalar: Real> + Clone> LegWatch<'_, '_, L> {
    /// Searches the next step only for the events that its multipliers do not exclude.
    #[inline]
    fn exclude(
        &self,
        within: Option<&MultiplierBounds<L::Scalar, L::M>>,
        width: L::Scalar,
        observer: &mut impl Searches<L>,
    ) {
        for (event, condition) in (self.first..).zip(self.conditions) {
            let is_away = within.is_some_and(|within| condition.holds_within(within));
            observer.stay_away(event, is_away, width);
        }
    }

    /// Bounds on the multipliers within the last step, if a condition is one on forces.
    #[inline]
    fn bounds<P: Method<L>>(
        &self,
        system: &L,
        method: &P,
        run: &mut Run<L, P>,
    ) -> Option<MultiplierBounds<L::Scalar, L::M>> {
        let is_on_forces = self.conditions.iter().any(LegCondition::is_on_forces);
        is_on_forces.then(|| method.multiplier_bounds(system, &run.memory, &mut run.statistics))?
    }

    fn look(&mut self, state: &StateOf<L>, steps: usize) -> Result<(), Ending> {
        self.bodies.passes(state);
        self.lifting.pass(|k| self.bodies.gap(k, state) > self.bodies.touching(k, state));
        let of = |k: usize| self.states.contacts[k];
        let is_kept = |k| of(k).is_closed || of(k).is_implied || self.lifting.is_at_rest(k);
        match self.bodies.crossed(is_kept, state) {
            Some(error) => Err(Ending::of(error, state.t.to_f64())),
            None => (self.accept)(state, steps),
        }
    }
}

/// An observer whose steps are watched.
struct WatchedLeg<'l, 'w, O, L: Lagrangian> {
    observer: O,
    watch: LegWatch<'l, 'w, L>,
}

impl<L, P, O> Observer<L, P> for WatchedLeg<'_, '_, O, L>
where
    L: Contacts<Scalar: Real> + Clone,
    P: Method<L>,
    O: Observer<L, P> + Searches<L>,
{
    fn system(&self) -> &L {
        self.observer.system()
    }

    #[inline(always)]
    fn goal(&mut self, method: &P, run: &mut Run<L, P>) -> Result<Option<L::Scalar>, Ending> {
        self.observer.goal(method, run)
    }

    #[inline(always)]
    fn follow(&mut self, method: &P, run: &mut Run<L, P>) -> Result<(), Ending> {
        self.observer.follow(method, run)
    }

    #[inline(always)]
    fn keep(&mut self, method: &P, run: &mut Run<L, P>) -> Result<(), Ending> {
        let within = self.watch.bounds(self.observer.system(), method, run);
        self.watch.exclude(within.as_ref(), run.state.t - run.before.t, &mut self.observer);
        self.observer.keep(method, run)?;
        self.watch.look(&run.state, run.statistics.accepted)
    }
}

/// All steps of all legs.
pub(super) struct AllLegs<L: Lagrangian> {
    pub(super) legs: Vec<Leg<L>>,
}

impl<L: Lagrangian> AllLegs<L> {
    pub(super) fn none() -> Self {
        Self { legs: Vec::new() }
    }
}

impl<L: Contacts<Scalar: Real> + Clone> KeepsLegs<L> for AllLegs<L> {
    fn drive<P: Method<L>>(&mut self, leg: StartedLeg<'_, '_, '_, L, P>) -> Result<Driven<L>, Error> {
        let StartedLeg { system, mut run, events, goal, transitions, method, limits, watch } = leg;
        let stored = Stored::<_, _, _, true>::begin(system, &run.state, goal, events, None)?;
        let mut watched = WatchedLeg { observer: stored, watch };
        let ending = run.drive(method, limits, &mut watched);
        let (leg, crossings) = watched.observer.into_leg(ending.as_ref().err());
        let (state, statistics) = (*leg.last(), run.statistics);
        self.legs.push(leg.into_owned().after(transitions));
        Ok(Driven { state, crossings, ending, statistics })
    }
}

/// Samples of all legs. Without a record, nothing of the legs is kept.
pub(super) struct SampledLegs<'w, L: Lagrangian> {
    pub(super) record: Option<Record<'w, L>>,
}

impl<L: Contacts<Scalar: Real> + Clone> KeepsLegs<L> for SampledLegs<'_, L> {
    fn goal(&self) -> Option<L::Scalar> {
        self.record.as_ref().map(|record| record.goal)
    }

    fn arrives(&mut self, system: &L, state: &StateOf<L>) -> Result<(), Error> {
        self.record.as_mut().map_or(Ok(()), |record| record.take_due(system, state))
    }

    fn control(&mut self, system: &mut L, state: &StateOf<L>) -> Result<bool, Ending> {
        let due = self.record.as_mut().filter(|record| record.is_due(state.t));
        due.map_or(Ok(false), |record| record.control::<L::Field>(system, state).map(|()| true))
    }

    fn drive<P: Method<L>>(&mut self, leg: StartedLeg<'_, '_, '_, L, P>) -> Result<Driven<L>, Error> {
        let StartedLeg { system, mut run, events, goal, method, limits, watch, .. } = leg;
        let mut crossings = Vec::new();
        let mut search = EventSearch::begin(events, system, &run.state)?;
        let stopped = search.record_due(&run.state, &mut crossings);
        let (record, within) = (self.record.as_mut(), None);
        let observer = SampledLeg { system, search, crossings, stopped, record, goal, within };
        let mut watched = WatchedLeg { observer, watch };
        let ending = run.drive(method, limits, &mut watched);
        let Run { state, statistics, .. } = run;
        Ok(Driven { state, crossings: watched.observer.crossings, ending, statistics })
    }
}

/// Observer that records the samples of a leg, up to its end.
struct SampledLeg<'l, 'e, 'w, L: Lagrangian, I> {
    system: &'l L,
    search: EventSearch<'l, Box<DynEvent<'e, L>>, L>,
    crossings: Vec<Crossing<L::Scalar, L::N>>,
    /// Ending at the start, if an event that is due there ends the leg.
    stopped: Option<Ending>,
    record: Option<&'l mut Record<'w, L>>,
    goal: L::Scalar,
    /// Interpolant of the last step.
    within: Option<I>,
}

impl<L: Lagrangian<Scalar: Real>, I> Searches<L> for SampledLeg<'_, '_, '_, L, I> {
    fn stay_away(&mut self, event: usize, is_away: bool, width: L::Scalar) {
        self.search.stay_away(event, is_away, width);
    }
}

impl<L, P> Observer<L, P> for SampledLeg<'_, '_, '_, L, P::Interpolant>
where
    L: Lagrangian<Scalar: Real>,
    P: Method<L>,
{
    fn system(&self) -> &L {
        self.system
    }

    fn goal(&mut self, _: &P, run: &mut Run<L, P>) -> Result<Option<L::Scalar>, Ending> {
        match self.stopped.take() {
            Some(ending) => Err(ending),
            None => Ok((run.state.t != self.goal).then_some(self.goal)),
        }
    }

    fn follow(&mut self, method: &P, run: &mut Run<L, P>) -> Result<(), Ending> {
        let Run { memory, state, before, statistics } = run;
        let within = method.interpolant(self.system, memory, [before, state], statistics);
        self.within = Some(within.map_err(|error| Ending::of(error, before.t.to_f64()))?);
        Ok(())
    }

    /// The sample at the end of the leg is left for the state after the transition there.
    fn keep(&mut self, _: &P, run: &mut Run<L, P>) -> Result<(), Ending> {
        let Some(interpolant) = &self.within else { return Ok(()) };
        let (system, before, after) = (self.system, &run.before, &{ run.state });
        let step =
            DenseStep { system, before, after, interpolant, field: PhantomData::<LagrangianVectorField> };
        let stopped = self.search.record(&step, &mut self.crossings).map(|(state, ending)| {
            run.state = state;
            ending
        });
        let goes_on = stopped.is_none() && run.state.t != self.goal;
        let record = self.record.as_mut();
        let failed = record.and_then(|record| record.keep_samples(&step, &mut run.state, goes_on));
        if failed.is_some() {
            forget_beyond(&mut self.crossings, [run.state.t, after.t]);
        }
        failed.or(stopped).map_or(Ok(()), Err)
    }
}
