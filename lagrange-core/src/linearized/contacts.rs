//! Derivatives of motions across contacts.
//!
//! The legs of a motion are integrated once more, with the derivatives of the motion in the tangent space of their closed
//! contacts. Where a gap g closes, at a time that depends on the arguments, and an impact follows, the derivatives jump by the
//! saltation matrix: Aizerman and Gantmacher, "On the stability of periodic motions", *Journal of Applied Mathematics and
//! Mechanics* 22, 1958; Leine and Nijmeijer, *Dynamics and Bifurcations of Non-Smooth Mechanical Systems*, 2004, chapter 7.
//! Where a contact opens, its multiplier is zero, so that accelerations and derivatives are continuous.

use alloc::vec::Vec;

use super::Linearized;
use super::argument::parameter;
use super::sensitivities::integrate;
use super::sensitivity::{StateSensitivity, at_event, impact_sensitivity, start};
use super::tangent::Tangent;
use super::variation::DifferentiableMethod;
use crate::contact::{Contact, ContactTrajectory, Contacts, Transition};
use crate::error::{Ending, Error};
use crate::names::{Entry, name};
use crate::number::{Real, Scalar, Wide, larger, power_of_epsilon};
use crate::solution::solve::solve;
use crate::system::{Direction, Solution, State, StateOf};
use crate::trajectory::Trajectory;
use crate::vector::{Array, Entrywise, Length, vector};

/// Step of the differences of a restitution, in units of its arguments. The formula of order six is off by h⁶/140 of the
/// seventh derivative, 2·10⁻¹⁷, and by some ε/h of the value, 6·10⁻¹⁴.
const STEP: f64 = 1.0 / 256.0;

impl<L: Linearized<Scalar: Real> + Contacts + Clone> ContactTrajectory<L> {
    /// Returns the last state with its derivatives by these arguments: entries of the start, and parameters of the equations, of
    /// gaps and of restitutions. The legs are integrated once more by `method`.
    ///
    /// The end is at a fixed time, at a terminal event that of the event; after an impact there. Derivatives by a start whose contacts are closed are
    /// projected onto them.
    ///
    /// ```
    /// use lagrange_core::contact::Contact;
    /// use lagrange_core::prelude::*;
    ///
    /// #[derive(Clone, Lagrangian)]
    /// #[coordinates(y)]
    /// #[lagrangian(y_dot^2/2 - g*y)]
    /// #[contact(floor: y >= 0, restitution: e)]
    /// struct Ball { g: f64, e: f64, floor: Contact }
    ///
    /// let (ball, method) = (Ball { g: 9.81, e: 0.8, floor: Contact::Open }, Dop853::with_tolerance(1e-12));
    /// let path = ball.motion(State::at_rest([1.0])).by(method).with_contacts().to(0.6)?;
    /// let end = path.sensitivity(&["y", "g", "e"], method)?;
    /// // y = e v τ − g τ²/2 with v = √(2gh), τ = t − v/g
    /// let (v, tau) = ((2.0 * 9.81_f64).sqrt(), 0.6 - (2.0 / 9.81_f64).sqrt());
    /// assert!((end.q[(0, 2)] - v * tau).abs() < 1e-11);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Grazing`], with the name of the contact, if a gap closes at a rate below √ε of its terms;
    /// [`Error::NoDerivativeAcross`] if a contact comes to rest by accumulating impacts, if several contacts are hit at one time,
    /// for an impact at the start, and for a system with friction; [`Error::UnknownName`] and [`Error::RepeatedName`]; [`Error::Unfinished`] if the motion
    /// failed; those of a [motion with derivatives](super::MotionDerivatives::motion_with_derivatives).
    pub fn sensitivity<D: DifferentiableMethod<L>>(
        &self,
        arguments: &[&str],
        method: D,
    ) -> Result<StateSensitivity<L::Scalar, L::N>, Error> {
        if self.ending().is_failure() {
            return Err(Error::from(self.ending().clone()));
        }
        if let Some(friction) = L::FRICTIONS.first() {
            let (contact, time) = (name(L::CONSTRAINTS, friction.row), self.end().t.to_f64());
            let reason = "friction, which may stick and slip, is not differentiated";
            return Err(Error::NoDerivativeAcross { contact, time, reason });
        }
        let first = self.legs().first().map_or(*self.end(), |leg| *leg.start().state());
        let mut at = start::<L>(&first, arguments)?;
        let mut before = None;
        for (leg, transitions) in self.legs().iter().zip(self.transitions_before_legs()) {
            at = cross(before, (leg.system(), *leg.start().state()), transitions, at)?;
            at.state = *leg.start().state();
            let end = *leg.end().state();
            if at.state.t != end.t {
                at = integrate(leg.system(), &at, end.t, &method, &mut [], None)?.finished()?.end()?.clone();
            }
            at.state = end;
            before = Some(leg);
        }
        // An impact at the very end.
        let after = (self.system(), *self.end());
        let mut at = cross(before, after, self.transitions_after_legs(), at)?;
        at.state = *self.end();
        let accelerations = solve(self.system(), &at.state)?.accelerations;
        (0..at.arguments().len()).for_each(|j| at.delay(j, -at.t[j], &accelerations));
        Ok(at)
    }
}

/// Derivatives of the state after the transitions between two legs. `before` is the leg that ends there.
fn cross<L: Linearized<Scalar: Real> + Contacts + Clone>(
    before: Option<&Trajectory<L>>,
    (system, state): (&L, StateOf<L>),
    transitions: &[Transition<L::Scalar>],
    at: StateSensitivity<L::Scalar, L::N>,
) -> Result<StateSensitivity<L::Scalar, L::N>, Error> {
    let time = state.t.to_f64();
    let fails = |contact, reason| Err(Error::NoDerivativeAcross { contact, time, reason });
    let impacts = |transition: &&Transition<L::Scalar>| matches!(transition, Transition::Impact { .. });
    let rest = transitions.iter().find_map(|transition| match *transition {
        Transition::Rests { contact, .. } => Some(contact),
        _ => None,
    });
    if let Some(contact) = rest {
        return fails(
            contact,
            "impacts accumulate there, each with a derivative of its own; end the motion before",
        );
    }
    let impacts: Vec<_> = transitions.iter().filter(impacts).collect();
    match (before, &impacts[..]) {
        (Some(leg), [Transition::Impact { impulses, .. }]) => {
            let hit = Hit::of(leg, impulses)?;
            let after = hit.after(leg, at)?;
            hit.check(&after.state, &state)?;
            Ok(after)
        }
        (Some(leg), []) => {
            check_continuous(leg, (system, &state), transitions)?;
            Ok(at)
        }
        (None, []) => Ok(at),
        (None, _) => fails(first_name(transitions), "the motion starts with an impact; start before it"),
        (Some(_), _) => fails(
            first_name(transitions),
            "several impacts at one time, whose order the arguments may change",
        ),
    }
}

/// Name of the first contact among these transitions.
fn first_name<T>(transitions: &[Transition<T>]) -> &'static str {
    let of = |transition: &Transition<T>| match transition {
        Transition::Impact { impulses, .. } => impulses.first().map(|&(contact, _)| contact),
        Transition::Rests { contact, .. }
        | Transition::Closes { contact, .. }
        | Transition::Opens { contact, .. } => Some(*contact),
        Transition::Sticks { friction, .. } | Transition::Slips { friction, .. } => Some(*friction),
    };
    transitions.iter().find_map(of).unwrap_or("")
}

/// Fails if a gap closes at the end of a leg without an impact, or if the accelerations jump there.
fn check_continuous<L: Linearized<Scalar: Real> + Contacts + Clone>(
    leg: &Trajectory<L>,
    (system, state): (&L, &StateOf<L>),
    transitions: &[Transition<L::Scalar>],
) -> Result<(), Error> {
    let time = state.t.to_f64();
    let closes = |&k: &usize| {
        let event = name(L::CONSTRAINTS, L::CONTACTS[k]);
        let is_open = leg.system().contact(k) == Some(Contact::Open);
        is_open && matches!(leg.ending(), Ending::Event { event: ended, .. } if *ended == event)
    };
    if let Some(k) = (0..L::CONTACTS.len()).find(closes) {
        return Err(Error::Grazing { event: name(L::CONSTRAINTS, L::CONTACTS[k]), time });
    }
    if transitions.is_empty() {
        return Ok(());
    }
    let [one, other] = [solve(leg.system(), leg.end().state())?, solve(system, state)?];
    let least = power_of_epsilon::<L::Scalar>(0.5);
    let zero = L::Scalar::constant(0.0);
    let largest = |entries: &[L::Scalar]| entries.iter().fold(zero, |most, x| larger(most, Scalar::abs(*x)));
    let jump = one.accelerations.minus(&other.accelerations);
    // At the multiplier's zero, its rate times the round-off of the time is left.
    match largest(jump.as_slice()) <= least * largest(one.accelerations.as_slice()) {
        true => Ok(()),
        false => Err(Error::Grazing { event: first_name(transitions), time }),
    }
}

/// An impact on one contact, at the end of a leg.
struct Hit<L> {
    /// Index of the contact.
    contact: usize,
    /// The system with the contacts closed that push.
    pushing: L,
}

impl<L: Linearized<Scalar: Real> + Contacts + Clone> Hit<L> {
    fn of(leg: &Trajectory<L>, impulses: &[(&'static str, L::Scalar)]) -> Result<Self, Error> {
        let time = leg.end().time().to_f64();
        let mut pushing = leg.system().clone();
        let mut hits = Vec::new();
        for k in 0..L::CONTACTS.len() {
            let pushes = impulses.iter().any(|&(contact, _)| contact == Self::name(k));
            if pushes && leg.system().contact(k) == Some(Contact::Open) {
                hits.push(k);
            }
            pushing.set_contact(k, if pushes { Contact::Closed } else { Contact::Open });
        }
        let of_leg =
            |k: usize| matches!(leg.ending(), Ending::Event { event, .. } if *event == Self::name(k));
        match hits[..] {
            [contact] if of_leg(contact) => Ok(Self { contact, pushing }),
            _ => Err(Error::NoDerivativeAcross {
                contact: hits.first().map_or("", |&k| Self::name(k)),
                time,
                reason: "several contacts are hit at one time, whose order the arguments may change",
            }),
        }
    }

    fn name(contact: usize) -> &'static str {
        name(L::CONSTRAINTS, L::CONTACTS[contact])
    }

    /// Derivatives after the impact, from those at a fixed time before it.
    fn after(
        &self,
        leg: &Trajectory<L>,
        at: StateSensitivity<L::Scalar, L::N>,
    ) -> Result<StateSensitivity<L::Scalar, L::N>, Error> {
        let gap = |state: &StateOf<L>, direction: &_, argument| Ok(self.gap(state, direction, argument));
        let steps = leg.statistics().accepted;
        let before = leg.states_of_steps().nth(steps.saturating_sub(1)).unwrap_or(at.state);
        let at = at_event(leg.system(), at, (Self::name(self.contact), &gap), &before)?;
        let restitution =
            self.pushing.restitution(self.contact, &at.state).unwrap_or(L::Scalar::constant(0.0));
        let slopes = (0..at.arguments().len())
            .map(|j| self.restitution(&at.state, &at.direction(j), at.arguments()[j]))
            .collect::<Result<Vec<_>, Error>>()?;
        let row = L::CONTACTS[self.contact];
        impact_sensitivity(&self.pushing, &at, row, (restitution, &|j| slopes[j]))
    }

    /// Derivative of the gap along a direction and by an argument.
    fn gap(
        &self,
        state: &StateOf<L>,
        direction: &Direction<L::Scalar, L::N>,
        argument: Option<Entry>,
    ) -> L::Scalar {
        let (zero, one) = (L::Scalar::constant(0.0), L::Scalar::constant(1.0));
        let (accelerations, multipliers) = (vector(Array::filled(zero)), vector(Array::filled(zero)));
        let none = Solution { accelerations, multipliers, pivot: one, rank: <L::M>::COUNT };
        let tangent = Tangent::of(&self.pushing, state, none);
        tangent.change_with(direction, argument.and_then(parameter::<L>)).position[L::CONTACTS[self.contact]]
            .lane(0)
    }

    /// Derivative of the restitution along a direction and by an argument, by differences of order six.
    fn restitution(
        &self,
        state: &StateOf<L>,
        direction: &Direction<L::Scalar, L::N>,
        argument: Entry,
    ) -> Result<L::Scalar, Error> {
        let parameter = parameter::<L>(argument).map(|k| (k, self.pushing.parameters()[k]));
        let step = Self::step(state, direction, parameter.map(|(_, value)| value));
        let at = |part: f64| {
            let along = step * L::Scalar::constant(part);
            let mut moved = self.pushing.clone();
            let is_set = parameter.is_none_or(|(k, value)| moved.set_parameter(k, value + along));
            let add = |x: L::Scalar, rate: L::Scalar| x + rate * along;
            let q = state.q.each_with(&direction.q, add);
            let state = State { t: add(state.t, direction.t), q, v: state.v.each_with(&direction.v, add) };
            let value = moved.restitution(self.contact, &state).unwrap_or(L::Scalar::constant(0.0));
            let contact = Self::name(self.contact);
            let reason = "the parameter cannot be set, on which the restitution may depend";
            let is_known = is_set || value == L::Scalar::constant(0.0);
            let time = state.t.to_f64();
            if is_known { Ok(value) } else { Err(Error::NoDerivativeAcross { contact, time, reason }) }
        };
        let mut sum = L::Scalar::constant(0.0);
        for (part, weight) in [(1.0, 45.0), (2.0, -9.0), (3.0, 1.0)] {
            sum += (at(part)? - at(-part)?) * L::Scalar::constant(weight / 60.0);
        }
        Ok(sum / step)
    }

    /// Step of the differences: [`STEP`] of the time, the largest coordinate, the largest velocity and the parameter, or of
    /// one if they are zero.
    fn step(
        state: &StateOf<L>,
        direction: &Direction<L::Scalar, L::N>,
        parameter: Option<L::Scalar>,
    ) -> L::Scalar {
        let (zero, one) = (L::Scalar::constant(0.0), L::Scalar::constant(1.0));
        let largest =
            |entries: &[L::Scalar]| entries.iter().fold(zero, |most, x| larger(most, Scalar::abs(*x)));
        let rate = |size: L::Scalar, change: L::Scalar| change / if size > zero { size } else { one };
        let rates = [
            rate(Scalar::abs(state.t), Scalar::abs(direction.t)),
            rate(largest(state.q.as_slice()), largest(direction.q.as_slice())),
            rate(largest(state.v.as_slice()), largest(direction.v.as_slice())),
            parameter.map_or(zero, |value| rate(Scalar::abs(value), one)),
        ];
        L::Scalar::constant(STEP) / rates.into_iter().fold(L::Scalar::constant(STEP), larger)
    }

    /// Fails if the velocities after the impact are not those of the motion.
    fn check(&self, found: &StateOf<L>, expected: &StateOf<L>) -> Result<(), Error> {
        let zero = L::Scalar::constant(0.0);
        let largest =
            |entries: &[L::Scalar]| entries.iter().fold(zero, |most, x| larger(most, Scalar::abs(*x)));
        let off = largest(found.v.minus(&expected.v).as_slice());
        match off <= power_of_epsilon::<L::Scalar>(0.5) * largest(expected.v.as_slice()) {
            true => Ok(()),
            false => Err(Error::NoDerivativeAcross {
                contact: Self::name(self.contact),
                time: expected.t.to_f64(),
                reason: "contacts part or press at a rate of zero there, and the arguments decide which",
            }),
        }
    }
}
