//! Plan of an ensemble: its members, its callbacks, and the data kept of each member.

use core::fmt::{self, Display, Write};
use core::ops::ControlFlow;
use std::sync::Arc;

use super::fingerprint::{Fingerprint, Hash};
use super::names::ColumnNames;
use super::outcome::Member;
use super::row::MemberRow;
use crate::error::{EnsembleError, Error};
use crate::generic::{Element, Length};
use crate::motion::event::DynEvent;
use crate::motion::integration::record::plan::Observed;
use crate::motion::integration::record::{
    CONTROLLER, Record, RecordPlan, SampleTimes, Steering, check_interval,
};
use crate::motion::{Event, EventFunction, Method, Simulate, SystemChecks};
use crate::number::Real;
use crate::solution::system_checks::ChecksOf;
use crate::{Sample, StateOf};

/// Settings of an ensemble, collected before it is integrated.
pub(super) struct Plan<'a, L: Simulate> {
    pub(super) count: usize,
    pub(super) make: Make<'a, L>,
    pub(super) shard: usize,
    pub(super) shards: usize,
    /// Indices of the members to integrate; all if `None`.
    pub(super) list: Option<Vec<usize>>,
    /// Rows of members taken over from earlier runs.
    pub(super) done: Vec<MemberRow<L::Scalar, L::Length>>,
    pub(super) observer: Option<MemberObserver<'a, L>>,
    pub(super) watch: Option<Watch<'a, L::Scalar, L::Length>>,
    pub(super) member_plan: MemberPlan<'a, L>,
    /// Name given by the user to the code that no fingerprint sees.
    pub(super) tag: Option<String>,
}

impl<L: Simulate> Plan<'_, L> {
    /// Fingerprint of the run, common to all members.
    pub(super) fn fingerprint<P: Method<L>>(
        &self,
        method: &P,
        end: L::Scalar,
        is_on_lanes: bool,
    ) -> Fingerprint {
        let mut run = Hash::new();
        if method.identify(&mut run).is_err() {
            run.text("not written to its end");
        }
        run.text(if is_on_lanes { " on lanes" } else { "" });
        run.number(end.to_f64());
        if self.member_plan.identify(&mut run).is_err() {
            run.text("not written to its end");
        }
        if let Some(tag) = self.tag.as_deref().filter(|tag| !tag.is_empty()) {
            run.text(tag);
        }
        Fingerprint { system: Fingerprint::of_system::<L>(), run: run.0, start: 0 }
    }

    /// Requires a tag if rows are taken over and code that no fingerprint sees can change results.
    pub(super) fn check_tag(&self) -> Result<(), Error> {
        match self.unseen() {
            Some(code) if self.tag.is_none() && !self.done.is_empty() => {
                Err(Error::Ensemble(EnsembleError::Untagged { code }))
            }
            _ => Ok(()),
        }
    }

    /// Description of the first piece of code, unseen by the fingerprint, that can change the results of members.
    fn unseen(&self) -> Option<String> {
        let of_system = match ChecksOf::<L>::SUPPLIED.first() {
            Some(name) => Some(format!("the function `{name}` of the system")),
            None => (ChecksOf::<L>::DIGEST == 0).then(|| "the equations, written by hand,".into()),
        };
        let observer = self.observer.as_ref().map(|_| "the observer".into());
        of_system.or_else(|| self.member_plan.unseen()).or(observer)
    }
}

pub(super) type Make<'a, L> = Box<dyn Fn(usize) -> (L, StateOf<L>) + Send + Sync + 'a>;
pub(super) type MemberObserver<'a, L> = Box<dyn Fn(usize, &StateOf<L>) -> ControlFlow<()> + Send + Sync + 'a>;
pub(super) type Watch<'a, T, N> = Box<dyn FnMut(EnsembleProgress<'_, T, N>) -> ControlFlow<()> + Send + 'a>;

/// Progress of an ensemble.
#[derive(Clone, Copy, Debug)]
pub struct EnsembleProgress<'m, T: Element, N: Length> {
    /// Number of finished members, including those taken over from an earlier run.
    pub done: usize,
    /// Number of members in this [part](crate::Ensemble::shard).
    pub of: usize,
    /// The member that finished last.
    pub member: &'m Member<T, N>,
}

/// Samples, events and controller that every member uses during its motion.
pub(super) struct MemberPlan<'a, L: Simulate> {
    pub(super) samples: RecordPlan<'a, L>,
    /// Events of the ensemble; each member starts with a fresh copy.
    events: Vec<Event<L, Box<Observed<'a, L>>>>,
    /// Interval between calls of the controller, in units of time, and the controller. The first call is at the start.
    controller: Option<(L::Scalar, Box<MemberController<'a, L>>)>,
}

/// Sets the parameters of the member with the given index; returns errors as text.
type MemberController<'a, L> = dyn Fn(usize, &mut L, &StateOf<L>) -> Result<(), String> + Send + Sync + 'a;

impl<L: Simulate> Default for MemberPlan<'_, L> {
    fn default() -> Self {
        let samples = RecordPlan::of(SampleTimes::At(Vec::new()));
        Self { samples, events: Vec::new(), controller: None }
    }
}

impl<'a, L: Simulate> MemberPlan<'a, L> {
    pub(super) fn event<G: EventFunction<L> + Send + Sync + 'a>(&mut self, event: Event<L, G>) {
        self.events.push(event.map(|function| {
            let value: Box<Observed<'a, L>> = Box::new(move |sample: &Sample<&L>| function.at(sample));
            value
        }));
    }

    pub(super) fn controller<E: Display>(
        &mut self,
        interval: L::Scalar,
        controller: impl Fn(usize, &mut L, &StateOf<L>) -> Result<(), E> + Send + Sync + 'a,
    ) {
        let in_words = move |index: usize, system: &mut L, state: &StateOf<L>| {
            controller(index, system, state).map_err(|error| error.to_string())
        };
        self.controller = Some((interval, Box::new(in_words)));
    }

    /// Names of the events.
    pub(super) fn events(&self) -> Vec<&'static str> {
        self.events.iter().map(Event::name).collect()
    }

    /// Names of the coordinates and quantities.
    pub(super) fn names(&self) -> Arc<ColumnNames> {
        let quantities = self.samples.quantities().map(String::from).collect();
        Arc::new(ColumnNames::new(ChecksOf::<L>::COORDINATES, quantities))
    }

    /// Checks the settings that are the same for all members.
    pub(super) fn check(&self) -> Result<(), Error> {
        self.names().check()?;
        self.samples.check()?;
        let interval = self.controller.as_ref().map(|(interval, _)| *interval);
        interval.map_or(Ok(()), |interval| check_interval(CONTROLLER, interval))
    }

    /// Description of the first function that can change the result of a member.
    fn unseen(&self) -> Option<String> {
        let event = self.events.first().map(|event| format!("the event `{}`", event.name()));
        let controller = self.controller.as_ref().map(|_| "the controller".into());
        let quantity = self.samples.quantities().next().map(|name| format!("the quantity `{name}`"));
        event.or(controller).or(quantity)
    }

    /// Writes the settings that distinguish this plan from others, for the fingerprint. Functions and the values they
    /// capture are not included.
    pub(super) fn identify(&self, to: &mut dyn Write) -> fmt::Result {
        self.samples.identify(to)?;
        self.events.iter().try_for_each(|event| write!(to, " with {:?}", event.anew(|_| ())))?;
        self.controller.iter().try_for_each(|(interval, _)| write!(to, " every {:?}", interval.to_f64()))
    }

    /// Record of a member's motion, before its first step.
    pub(super) fn record(
        &self,
        index: usize,
        system: &L,
        start: &StateOf<L>,
        end: L::Scalar,
    ) -> Result<Record<'_, L>, Error> {
        let start = Sample::of(system, start.clone());
        Record::begin(&self.samples, self.fresh_events(), self.steering(index), &start, end)
    }

    /// Events of a member, without a history.
    pub(super) fn fresh_events(&self) -> Vec<Box<DynEvent<'_, L>>> {
        let fresh = self
            .events
            .iter()
            .map(|event| -> Box<DynEvent<'_, L>> { Box::new(event.anew(|function| &**function)) });
        fresh.collect()
    }

    /// Controller of the member of this index.
    pub(super) fn steering(&self, index: usize) -> Option<Steering<'_, L>> {
        self.controller.as_ref().map(|(interval, controller)| Steering {
            interval: *interval,
            controller: Box::new(move |system, state| controller(index, system, state)),
        })
    }
}
