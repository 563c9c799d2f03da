//! Motion from transition to transition.

use alloc::boxed::Box;
use alloc::vec::Vec;

use super::Transition;
use super::bodies::Bodies;
use super::instant::{Decided, LegEnd};
use super::legs::{Accept, Driven, KeepsLegs, LegWatch, StartedLeg};
use super::lifting::Lifting;
use super::states::LegStates;
use super::watched::{SharedValues, of_contacts, of_friction};
use super::{Contact, Contacts};
use crate::error::{Ending, Error};
use crate::motion::event::EventSearch;
use crate::motion::integration::progress::{OnProgress, report};
use crate::motion::run::{Run, Watchdog};
use crate::motion::{DynEvent, Method};
use crate::number::Real;
use crate::solution::crossing::Crossing;
use crate::solution::reason::parameter_not_finite;
use crate::solution::{Adjustment, Sample};
use crate::statistics::Statistics;
use crate::system::{Lagrangian, StateOf, System};

/// First state of the first leg, with the system before the controller is called, and what moved it onto the constraints.
type FirstState<L> = (Sample<L>, Option<Adjustment<<L as System>::Scalar, <L as Lagrangian>::N>>);

/// A motion under way, which keeps `K` of its legs.
pub(super) struct Journey<'w, L: Lagrangian, K> {
    pub(super) bodies: Bodies<L>,
    decided: Decided<L::Scalar>,
    pub(super) state: StateOf<L>,
    /// Times of start and end.
    times: [L::Scalar; 2],
    kept: K,
    pub(super) transitions: Vec<Transition<L::Scalar>>,
    pub(super) crossings: Vec<Crossing<L::Scalar, L::N>>,
    pub(super) statistics: Statistics,
    accept: Accept<'w, L>,
    first: Option<FirstState<L>>,
    /// State, contacts and number of transitions at the end of the last leg.
    arrived: Option<(StateOf<L>, LegStates, usize)>,
}

/// A motion that has ended.
pub(super) struct Ended<L: Lagrangian, K> {
    pub(super) kept: K,
    pub(super) transitions: Vec<Transition<L::Scalar>>,
    pub(super) crossings: Vec<Crossing<L::Scalar, L::N>>,
    pub(super) statistics: Statistics,
    pub(super) system: L,
    pub(super) start: Sample<L>,
    /// What moved the start onto the constraints.
    pub(super) adjustment: Adjustment<L::Scalar, L::N>,
    pub(super) state: StateOf<L>,
    pub(super) ending: Ending,
}

/// How a leg ends.
enum After {
    /// The motion goes on.
    Leg,
    /// The motion goes on after a transition.
    Transition,
    Ending(Ending),
}

impl<'w, L: Contacts<Scalar: Real> + Clone, K: KeepsLegs<L>> Journey<'w, L, K> {
    /// A motion before its start, whose steps err by this part of the velocities. Contacts are closed as the fields of the system say.
    pub(super) fn new((system, accuracy): (&L, f64), state: StateOf<L>, kept: K) -> Self {
        let (bodies, times) = (Bodies::new(system, accuracy), [state.t; 2]);
        let closed = LegStates::closed::<L>(|k| system.contact(k) != Some(Contact::Open));
        let decided = Decided { states: LegStates { frictions: Vec::new(), ..closed }, bounce: None };
        let (transitions, crossings, statistics) = (Vec::new(), Vec::new(), Statistics::default());
        let (accept, first, arrived) = (Box::new(|_: &_, _| Ok(())), None, None);
        Self {
            bodies,
            decided,
            state,
            times,
            kept,
            transitions,
            crossings,
            statistics,
            accept,
            first,
            arrived,
        }
    }

    /// Continues from another state, where nothing is known yet of contacts and friction.
    pub(super) fn restart(&mut self, state: StateOf<L>) {
        let open = LegStates { frictions: Vec::new(), ..LegStates::closed::<L>(|_| false) };
        (self.state, self.decided, self.arrived) = (state, Decided { states: open, bounce: None }, None);
    }

    /// Clears the transitions and crossings of the last advance.
    pub(super) fn forget(&mut self) {
        self.transitions.clear();
        self.crossings.clear();
    }

    /// The system with its contacts as they are now.
    pub(super) fn system(&self) -> L {
        self.bodies.with(&self.decided.states)
    }

    /// Sets the end of the next part of the motion, which starts at the current state.
    pub(super) fn head_for(&mut self, end: L::Scalar) -> Result<(), Error> {
        self.times = [self.state.t, end];
        self.bodies.passes(&self.state);
        self.bodies.reaches(&self.state, end - self.state.t)
    }

    /// Decides what contacts and friction do at the start of a motion to this time.
    pub(super) fn begin(mut self, end: L::Scalar) -> Result<Self, Error> {
        self.head_for(end)?;
        self.settle_anew()?;
        self.first = Some((Sample::of(self.system(), self.state), None));
        Ok(self)
    }

    /// Calls this after every step; it may end the motion.
    pub(super) fn accepting(self, accept: Accept<'w, L>) -> Self {
        Self { accept, ..self }
    }

    /// Reports the progress after every step.
    pub(super) fn reporting(self, mut on_progress: Option<OnProgress<'w>>) -> Self {
        let [start, end] = self.times;
        self.accepting(Box::new(move |state, steps| report(&mut on_progress, [start, state.t, end], steps)))
    }

    /// Moves to the end, with these events of the user and at most so many transitions.
    pub(super) fn run<P: Method<L>>(
        mut self,
        method: &P,
        mut events: Vec<Box<DynEvent<'w, L>>>,
        limit: usize,
    ) -> Result<Ended<L, K>, Error> {
        self.go_on(method, &mut events, limit).map(|ending| self.ended(ending))
    }

    /// Moves to the end or to a terminal event, and returns the reason why it stops there.
    pub(super) fn go_on<'e, P: Method<L>>(
        &mut self,
        method: &P,
        events: &mut [Box<DynEvent<'e, L>>],
        limit: usize,
    ) -> Result<Ending, Error> {
        let (watchdog, mut transitions) = (Watchdog::new(method.limits(), &self.statistics), 0);
        let mut is_first = true;
        loop {
            let time = self.state.t.to_f64();
            if transitions == limit {
                return Ok(Ending::TransitionLimit { time, transitions });
            }
            let after = match self.steer() {
                Err(ending) => return Ok(ending),
                Ok(()) => self.leg(method, (events, is_first), &watchdog),
            };
            let after = match after {
                Err(error) if is_first => return Err(error),
                after => after.and_then(|driven| self.goes_on(driven, events)),
            };
            is_first = false;
            match after {
                Err(error) => {
                    let ending = Ending::of(error, self.state.t.to_f64());
                    return Ok(self.retreat(ending));
                }
                Ok(After::Ending(ending)) => return Ok(ending),
                Ok(After::Transition) => transitions += 1,
                Ok(After::Leg) => {}
            }
        }
    }

    /// Ends the motion before a transition that cannot be decided, with the state and the contacts of the last leg.
    fn retreat(&mut self, ending: Ending) -> Ending {
        if let Some((state, states, transitions)) = self.arrived.take() {
            (self.state, self.decided.states) = (state, states);
            self.transitions.truncate(transitions);
        }
        ending
    }

    fn ended(mut self, ending: Ending) -> Ended<L, K> {
        let system = self.system();
        let noted = if ending.is_failure() { Ok(()) } else { self.kept.arrives(&system, &self.state) };
        let ending = noted.err().map_or(ending, |error| Ending::of(error, self.state.t.to_f64()));
        let Self { state, kept, transitions, crossings, statistics, first, .. } = self;
        let (start, adjustment) = first.unwrap_or_else(|| (Sample::of(system.clone(), state), None));
        let adjustment = adjustment.unwrap_or_else(|| Adjustment::none(system.length()));
        Ended { kept, transitions, crossings, statistics, system, start, adjustment, state, ending }
    }

    /// Takes note of the state after a transition, and calls the controller if it is due: what it sets may close and open
    /// contacts.
    fn steer(&mut self) -> Result<(), Ending> {
        let time = self.state.t.to_f64();
        let fails = |error| Ending::of(error, time);
        let mut system = self.system();
        self.kept.arrives(&system, &self.state).map_err(fails)?;
        if self.kept.control(&mut system, &self.state)? {
            self.bodies.take(&system);
            self.settle_anew().map_err(fails)?;
        }
        Ok(())
    }

    /// Decides which contacts are closed, and which friction sticks, at the start and after a change of parameters.
    pub(super) fn settle_anew(&mut self) -> Result<(), Error> {
        self.settle().map_err(|error| parameter_not_finite(&self.bodies.open).unwrap_or(error))
    }

    fn settle(&mut self) -> Result<(), Error> {
        let was = &self.decided.states;
        self.bodies.check_closed(|k| was.is_closed(k), &self.state)?;
        self.bodies.crossed(|k| was.is_closed(k), &self.state).map_or(Ok(()), Err)?;
        self.decided = self.bodies.settle(&mut self.state, (was, None), &mut self.transitions)?;
        Ok(())
    }

    /// Moves until the next gap closes, the next multiplier becomes zero, or friction begins to slide or stops.
    fn leg<'e, P: Method<L>>(
        &mut self,
        method: &P,
        (given, is_first): (&mut [Box<DynEvent<'e, L>>], bool),
        limits: &Watchdog,
    ) -> Result<Driven<L>, Error> {
        let Self { bodies, decided, .. } = self;
        let system = bodies.with(&decided.states);
        let closed = bodies.closed.clone();
        let (mut run, adjustment) = Run::begin(&system, &self.state, method).map_err(undecided)?;
        run.statistics = run.statistics.after(&self.statistics);
        let first = || (Sample::of(system.clone(), run.state), None);
        let (start, adjusted) = self.first.get_or_insert_with(first);
        if adjusted.is_none() {
            (*start, *adjusted) = (Sample::of(start.system().clone(), run.state), Some(adjustment));
        }
        // The projection may move gaps of open contacts. Conditions are watched from where it leads.
        let state = &{ run.state };
        let sizes = bodies.sizes(state);
        EventSearch::begin_leg(given, &system, [state, &sizes], is_first)?;
        let (shared, lifting) = (SharedValues::of(&closed), Lifting::of(&decided.states));
        let mut own = of_contacts((&system, bodies), (&shared, &lifting), decided, state)?;
        own.extend(of_friction(&system, &shared, decided, state)?);
        let (own, conditions): (Vec<_>, Vec<_>) = own.into_iter().unzip();
        let first = given.len();
        let given = given.iter_mut().map(|event| Box::new(event) as Box<DynEvent<'_, L>>);
        let mut events: Vec<Box<DynEvent<'_, L>>> = given.chain(own).collect();
        // A bounce is searched for within its own time: a step as long as that of a flight would be halved many times.
        let bounce = decided.bounce.take().map(|bounce| state.t + bounce);
        let goal = self.kept.goal().unwrap_or(self.times[1]);
        let goal = bounce.filter(|&bounce| state.t < bounce && bounce < goal).unwrap_or(goal);
        let states = &decided.states;
        let watch = LegWatch {
            bodies,
            states,
            lifting: &lifting,
            accept: &mut self.accept,
            first,
            conditions: &conditions,
        };
        let (system, events) = (&system, &mut events[..]);
        let transitions = self.transitions.len();
        let driven =
            self.kept.drive(StartedLeg { system, run, events, goal, transitions, method, limits, watch });
        lifting.end(&mut decided.states);
        driven
    }

    /// Decides what follows at the end of a leg.
    fn goes_on(&mut self, leg: Driven<L>, given: &mut [Box<DynEvent<'_, L>>]) -> Result<After, Error> {
        self.state = leg.state;
        self.arrived = Some((self.state, self.decided.states.clone(), self.transitions.len()));
        self.bodies.passes(&self.state);
        self.statistics = leg.statistics;
        let last = leg.crossings.last().filter(|last| last.index >= given.len()).map(|last| last.event);
        self.crossings.extend(leg.crossings.into_iter().filter(|crossing| crossing.index < given.len()));
        let event = match (leg.ending, last) {
            (Ok(()), _) => None,
            (Err(Ending::Event { .. }), Some(contact)) => Some(contact),
            (Err(ending), _) => return Ok(After::Ending(ending)),
        };
        let system = self.system();
        let here = [&self.state, &self.bodies.sizes(&self.state)];
        if let Some(ending) = EventSearch::record_at_end(given, &system, here, &mut self.crossings)? {
            return Ok(After::Ending(ending));
        }
        match event {
            Some(contact) => self.transition(contact).map(|()| After::Transition),
            None if self.state.t < self.times[1] => Ok(After::Leg),
            None => Ok(After::Ending(Ending::Complete { time: self.state.t.to_f64() })),
        }
    }

    /// Decides what follows at the event of this contact or friction.
    fn transition(&mut self, event: &str) -> Result<(), Error> {
        let end = self.leg_end(event);
        self.bodies.reaches(&self.state, self.bodies.span)?;
        let was = &self.decided.states;
        self.decided = self.bodies.settle(&mut self.state, (was, Some(end)), &mut self.transitions)?;
        Ok(())
    }

    /// What an event says about the contact or the friction of its name.
    fn leg_end(&self, event: &str) -> LegEnd {
        let Self { bodies, decided: Decided { states, .. }, state, .. } = self;
        if let Some(k) = L::CONTACTS.iter().position(|&row| L::CONSTRAINTS[row] == event) {
            return if states.is_closed(k) { LegEnd::Opens(k) } else { LegEnd::Closes(k) };
        }
        match L::FRICTIONS.iter().position(|friction| L::CONSTRAINTS[friction.row] == event) {
            Some(f) if states.frictions[f].friction.is_at_rest() => LegEnd::Leaves,
            Some(f) if bodies.is_stopped(f, state) => LegEnd::Stops(f),
            _ => LegEnd::Turns,
        }
    }
}

/// Forces that satisfy the law have been found before a leg starts. Where its closed and sliding contacts leave no solution all the
/// same, several choices satisfy the law, and this one cannot go on: that is undecided, not Painlevé's paradox.
fn undecided(error: Error) -> Error {
    match error {
        Error::FrictionJams { friction, time } => Error::FrictionUndecided { friction, time },
        other => other,
    }
}
