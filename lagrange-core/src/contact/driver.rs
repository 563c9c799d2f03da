//! Motion from transition to transition.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::ops::ControlFlow;

use super::bodies::{Bodies, States};
use super::instant::{Changed, Decided};
use super::trajectory::{ContactTrajectory, Transition};
use super::{Contact, Contacts, Friction, FrictionRows};
use crate::error::{Ending, Error};
use crate::motion::event::noise;
use crate::motion::run::check_end;
use crate::motion::{
    AllSteps, DynEvent, LagrangianVectorField, Method, MotionBuilder, OnProgress, Progress, Simulate, Start,
};
use crate::names::name;
use crate::number::{Real, Scalar, larger};
use crate::solution::Sample;
use crate::system::{Lagrangian, StateOf};
use crate::trajectory::{HybridTrajectory, Trajectory};

/// Largest number of legs unless [`max_transitions`](MotionBuilder::max_transitions) sets another.
const LEGS: usize = 100_000;

/// Marks a motion across contacts: `to` returns a [`ContactTrajectory`].
#[derive(Clone, Copy, Debug)]
pub struct AcrossContacts {
    legs: usize,
}

/// Settings of a motion from a state.
type Builder<'a, 'w, L, P, K> = MotionBuilder<
    'a,
    'w,
    L,
    Start<<L as Lagrangian>::Scalar, <L as Lagrangian>::N, LagrangianVectorField>,
    P,
    (),
    K,
>;

impl<'a, 'w, L: Contacts + Clone, P> Builder<'a, 'w, L, P, AllSteps> {
    /// Moves across the [contacts](crate::contact) of the system: gaps close and open, and velocities jump at impacts.
    pub fn with_contacts(self) -> Builder<'a, 'w, L, P, AcrossContacts> {
        self.keeping(|AllSteps| AcrossContacts { legs: LEGS })
    }
}

impl<L, P> Builder<'_, '_, L, P, AcrossContacts>
where
    L: Contacts<Scalar: Real> + Clone + Send + Sync + 'static,
    P: Method<L> + Clone,
{
    /// Sets the largest number of legs, 100,000 if it is not set.
    pub fn max_transitions(self, count: usize) -> Self {
        self.keeping(|_| AcrossContacts { legs: count })
    }

    /// Moves to the time `end`.
    ///
    /// # Errors
    /// Those of [`towards`](Self::towards), and [`Error::Unfinished`] if the motion stops before.
    pub fn to(self, end: L::Scalar) -> Result<ContactTrajectory<L>, Error> {
        self.towards(end)?.finished()
    }

    /// Moves towards the time `end`. If the motion fails on the way, the result holds what was computed until then, and its
    /// [`ending`](ContactTrajectory::ending) the reason.
    ///
    /// # Errors
    /// Those of [`integrate`](Simulate::integrate) before the first step; [`Error::Penetration`] if a gap is negative at the
    /// start; [`Error::MotionBackwards`] if `end` lies before the start.
    pub fn towards(self, end: L::Scalar) -> Result<ContactTrajectory<L>, Error> {
        let Self { system, start, method, on_progress, kept, .. } = self;
        let state = start.into_state()?;
        check_end(end)?;
        if end < state.t {
            let [start, end] = [state.t, end].map(Real::to_f64);
            return Err(Error::MotionBackwards { start, end });
        }
        Journey::begin(system, state, end, on_progress)?.run(&method, end, kept.legs)
    }
}

/// A motion under way.
struct Journey<'w, L: Lagrangian> {
    bodies: Bodies<L>,
    decided: Decided<L::Scalar>,
    state: StateOf<L>,
    legs: HybridTrajectory<L::Scalar>,
    transitions: Vec<Transition<L::Scalar>>,
    on_progress: Option<OnProgress<'w>>,
}

impl<'w, L: Contacts<Scalar: Real> + Clone + Send + Sync + 'static> Journey<'w, L> {
    fn begin(
        system: &L,
        mut state: StateOf<L>,
        end: L::Scalar,
        on_progress: Option<OnProgress<'w>>,
    ) -> Result<Self, Error> {
        let (mut bodies, mut transitions) = (Bodies::new(system), Vec::new());
        bodies.passes(&state);
        let is_closed: Vec<bool> =
            (0..L::CONTACTS.len()).map(|k| system.contact(k) != Some(Contact::Open)).collect();
        // Velocities say whether friction sticks or slides.
        bodies.without_friction(&is_closed).check_consistent(&state)?;
        bodies.reaches(&state, end - state.t)?;
        bodies.crossed(&is_closed, &state).map_or(Ok(()), Err)?;
        let was = States { is_closed, frictions: Vec::new() };
        let decided = bodies.settle(&mut state, (&was, &Changed::default()), &mut transitions)?;
        Ok(Self { bodies, decided, state, legs: HybridTrajectory::new(), transitions, on_progress })
    }

    fn run<P: Method<L> + Clone>(
        mut self,
        method: &P,
        end: L::Scalar,
        legs: usize,
    ) -> Result<ContactTrajectory<L>, Error> {
        let mut ending = Ok(None);
        for leg in 0..legs {
            ending = match self.leg(method, end) {
                Err(error) if leg == 0 => return Err(error),
                Err(error) => Err(error),
                Ok(path) => self.goes_on(path, end),
            };
            if !matches!(ending, Ok(None)) {
                break;
            }
        }
        let time = self.state.t.to_f64();
        let ending = ending.unwrap_or_else(|error| Some(Ending::of(error, time)));
        Ok(self.ended(ending.unwrap_or(Ending::TransitionLimit { time, transitions: legs })))
    }

    fn ended(self, ending: Ending) -> ContactTrajectory<L> {
        let Self { bodies, decided, state, legs, transitions, .. } = self;
        let system = bodies.with(&decided.states);
        ContactTrajectory { legs, transitions, system, end: state, ending }
    }

    /// Moves until the next gap closes, the next multiplier becomes zero, or friction begins to slide or stops.
    fn leg<P: Method<L> + Clone>(&mut self, method: &P, end: L::Scalar) -> Result<Trajectory<L>, Error> {
        let Self { bodies, decided, state, on_progress, .. } = self;
        let system = bodies.with(&decided.states);
        let mut events: Vec<Box<DynEvent<'_, L>>> = Vec::new();
        let zero = L::Scalar::constant(0.0);
        for (k, &row) in L::CONTACTS.iter().enumerate().filter(|(k, _)| !decided.is_implied[*k]) {
            let (name, bodies) = (name(L::CONSTRAINTS, row), &*bodies);
            let force = move |sample: &Sample<&L>| Ok(sample.solution()?.multipliers[row]);
            let gap = move |sample: &Sample<&L>| Ok(bodies.gap(k, sample.state()));
            let is_resting = decided.is_resting[k];
            events.push(match decided.states.is_closed[k] {
                true => watched(&system, state, name, is_resting.then_some(zero), force)?,
                false => watched(&system, state, name, is_resting.then(|| bodies.touching(k, state)), gap)?,
            });
        }
        events.extend(of_friction(&system, bodies, decided, state)?);
        let mut motion = system.motion(*state).by(method.clone()).events(events);
        if let Some(look) = on_progress {
            motion = motion.on_progress(|progress: Progress| -> ControlFlow<()> { look(progress) });
        }
        // A bounce is searched for within its own time: a step as long as that of a flight would be halved many times.
        let bounce = decided.bounce.take().map(|bounce| state.t + bounce);
        let end = bounce.filter(|&bounce| state.t < bounce && bounce < end).unwrap_or(end);
        Ok(motion.with_contacts_as_they_are(end)?.into_owned())
    }

    /// Keeps a leg, and decides what follows at its end. Returns the ending if it is the last one.
    fn goes_on(&mut self, path: Trajectory<L>, end: L::Scalar) -> Result<Option<Ending>, Error> {
        let crossed = path.steps().find_map(|step| {
            self.bodies.passes(step.state());
            self.bodies.crossed(&self.decided.states.is_closed, step.state())
        });
        self.state = *path.end().state();
        let ending = path.ending().clone();
        self.legs.push(path)?;
        if let Some(error) = crossed {
            return Err(error);
        }
        let event = match ending {
            Ending::Event { event, .. } => event,
            Ending::Complete { .. } if self.state.t < end => return Ok(None),
            other => return Ok(Some(other)),
        };
        let changed = self.changed(event)?;
        let was = &self.decided.states;
        self.decided = self.bodies.settle(&mut self.state, (was, &changed), &mut self.transitions)?;
        Ok(None)
    }

    /// What an event says about the contact or the friction of its name.
    fn changed(&self, event: &str) -> Result<Changed, Error> {
        let Self { bodies, decided, state, .. } = self;
        let mut changed = Changed::default();
        if let Some(k) = L::CONTACTS.iter().position(|&row| L::CONSTRAINTS[row] == event) {
            let is = |closed| (decided.states.is_closed[k] == closed).then_some(k);
            (changed.closes, changed.opens) = (is(false), is(true));
        }
        let Some(f) = L::FRICTIONS.iter().position(|friction| L::CONSTRAINTS[friction.row] == event) else {
            return Ok(changed);
        };
        match decided.states.frictions[f] {
            // The velocity may only have turned.
            Friction::Slides(_) => changed.stops = bodies.is_stopped(f, state).then_some(f),
            Friction::Sticks => {
                let FrictionRows { row, count, .. } = L::FRICTIONS[f];
                let solution = bodies.with(&decided.states).solve(state)?;
                let force = |c: usize| if c < count { solution.multipliers[row + c].to_f64() } else { 0.0 };
                let (x, y) = (force(0), force(1));
                let size = Scalar::sqrt(x * x + y * y);
                changed.slips = (size > 0.0).then(|| (f, [-x / size, -y / size]));
            }
        }
        Ok(changed)
    }
}

/// The events that friction reaches its limit, or stops the bodies.
fn of_friction<'w, L>(
    system: &L,
    bodies: &'w Bodies<L>,
    decided: &Decided<L::Scalar>,
    state: &StateOf<L>,
) -> Result<Vec<Box<DynEvent<'w, L>>>, Error>
where
    L: Contacts<Scalar: Real> + Clone + 'w,
{
    let zero = L::Scalar::constant(0.0);
    let mut events: Vec<Box<DynEvent<'w, L>>> = Vec::new();
    for (f, &FrictionRows { row, count, contact }) in L::FRICTIONS.iter().enumerate() {
        if contact.is_some_and(|k| !decided.states.is_closed[k]) || decided.slip_is_implied[f] {
            continue;
        }
        let name = name(L::CONSTRAINTS, row);
        events.push(match decided.states.frictions[f] {
            Friction::Sticks => {
                let left = move |sample: &Sample<&L>| {
                    let multipliers = &sample.solution()?.multipliers;
                    let limit = bodies.closed.friction_limit(f, sample.state()).unwrap_or(zero);
                    let press = contact.map_or(L::Scalar::constant(1.0), |k| multipliers[L::CONTACTS[k]]);
                    let force = match count {
                        1 => Scalar::abs(multipliers[row]),
                        _ => {
                            let [x, y] = [multipliers[row], multipliers[row + 1]];
                            Scalar::sqrt(x * x + y * y)
                        }
                    };
                    Ok(limit * press - force)
                };
                watched(system, state, name, Some(zero), left)?
            }
            Friction::Slides(direction) => {
                let direction = direction.map(L::Scalar::constant);
                let along = move |sample: &Sample<&L>| {
                    let rates = bodies.closed.constraint_rate(sample.state());
                    Ok((0..count).fold(zero, |sum, c| sum + direction[c] * rates[row + c]))
                };
                watched(system, state, name, decided.slips_from_rest[f].then_some(zero), along)?
            }
        });
    }
    Ok(events)
}

/// The event that a gap or a multiplier becomes negative. If it rests at zero, it may do so at once, without a sign before: it
/// is then watched for exceeding four times its round-off, and the least that `rest` gives.
fn watched<'w, L>(
    system: &L,
    state: &StateOf<L>,
    name: &'static str,
    rest: Option<L::Scalar>,
    function: impl Fn(&Sample<&L>) -> Result<L::Scalar, Error> + Copy + 'w,
) -> Result<Box<DynEvent<'w, L>>, Error>
where
    L: Lagrangian<Scalar: Real> + 'w,
{
    let zero = L::Scalar::constant(0.0);
    let mut margin = zero;
    if let Some(least) = rest {
        let noise = noise(&system.event(name, function), system, state)?;
        let allowed = larger(L::Scalar::constant(4.0) * noise, least);
        let value = function(&system.sample(*state))?;
        if value <= allowed {
            margin = allowed + larger(-value, zero);
        }
    }
    let event = system.event(name, move |sample| Ok(function(sample)? + margin));
    Ok(Box::new(event.falling().terminal()))
}
