//! Derivatives of motions across contacts.
//!
//! The legs of a motion are integrated once more, with the derivatives of the motion in the tangent space of their closed
//! contacts. Where a gap g closes, at a time that depends on the arguments, and an impact follows, the derivatives jump by the
//! saltation matrix: Aizerman and Gantmacher, "On the stability of periodic motions", *Journal of Applied Mathematics and
//! Mechanics* 22, 1958; Leine and Nijmeijer, *Dynamics and Bifurcations of Non-Smooth Mechanical Systems*, 2004, chapter 7.
//! Where a contact opens, its multiplier is zero, so that accelerations and derivatives are continuous.
//!
//! Friction that slides acts with −μ λ v/|v|, whose derivatives the equations of the leg have; while it sticks, its velocity is
//! a constraint. Where accelerations ẍ jump, as it stops, slides back, or leaves a limit above the force of sliding, the
//! derivatives jump by (ẋ⁻ − ẋ⁺) δt, the saltation matrix of an event without a reset. In an impact, the impulses follow
//! from the linear equations of what sticks and what slides in it.

mod boundary;
mod change;
mod hit;
mod law;

use alloc::vec::Vec;

use boundary::Boundary;
use change::Change;
use hit::Hit;

use super::state::{StateSensitivity, start};
use super::trajectory::integrate;
use crate::contact::{Contacts, Transition};
use crate::error::Error;
use crate::linearized::Linearized;
use crate::linearized::variation::DifferentiableMethod;
use crate::names::name;
use crate::number::{Real, largest, power_of_epsilon};
use crate::solution::solve::solve;
use crate::system::StateOf;
use crate::trajectory::{Leg, Trajectory};
use crate::vector::Entrywise;

/// Reason why a motion by time steps is not differentiated.
const BY_TIME_STEPS: &str = "time steps do not locate its transitions; move by `with_contacts`";

/// Reason why friction of two velocities that begins or ceases to slide is not differentiated.
const IN_THE_PLANE: &str = "friction of two velocities has no direction at rest, and its force no derivative; end the motion before, or start after it";

impl<L: Linearized<Scalar: Real> + Contacts + Clone> Trajectory<L> {
    /// Returns the last state with its derivatives by these arguments: entries of the start, and parameters of the equations, of
    /// gaps, of restitutions and of friction. The legs are integrated once more by `method`.
    ///
    /// The end is at a fixed time, at a terminal event that of the event; after an impact there. Derivatives by a start whose
    /// contacts are closed are projected onto them, and onto friction that sticks.
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
    /// [`Error::Grazing`], with the name of the contact or friction, if a gap closes, or a force passes its limit with a jump of the
    /// accelerations, at a rate below √ε of its terms; [`Error::UnknownName`] and [`Error::RepeatedName`];
    /// [`Error::Unfinished`] if the motion failed; those of a
    /// [motion with derivatives](crate::linearized::MotionDerivatives::motion_with_derivatives). [`Error::NoDerivativeAcross`]:
    ///
    /// - for a motion by time steps;
    /// - if a contact comes to rest by accumulating impacts, if several contacts are hit at one time, and for an impact at the start;
    /// - if a contact at rest neither pushes nor parts in an impact that could make it do either;
    /// - if two frictions change at one time, unless one changes because of the other;
    /// - if a force or an impulse of friction is within √ε of its limit where the bodies are at rest, so that the arguments decide
    ///   whether they stick;
    /// - if a restitution is lowered to where impacts gain no energy;
    /// - for an impact by Poisson's law in which friction sticks or several contacts push;
    /// - if friction of two velocities begins or ceases to slide, and if it slides in an impact;
    /// - by an argument that changes a velocity at the start, if friction begins to slide from rest there.
    pub fn sensitivity<D: DifferentiableMethod<L>>(
        &self,
        arguments: &[&str],
        method: D,
    ) -> Result<StateSensitivity<L::Scalar, L::N>, Error> {
        self.check_finished()?;
        self.check_located()?;
        let mut at = start::<L>(self.first_leg().first(), arguments)?;
        self.check_plane()?;
        check_start(self.first_leg(), &at)?;
        let mut before = None;
        for (leg, transitions) in self.legs().iter().zip(self.transitions_before_legs()) {
            at = cross(before, (leg.system(), *leg.first()), transitions, at)?;
            (at.state, before) = (*leg.first(), Some(leg));
            let end = *leg.last();
            if at.state.t != end.t {
                at = integrate(leg.system(), &at, end.t, &method, &mut [], None)?
                    .finished()?
                    .derivatives_at_end()?
                    .clone();
            }
            at.state = end;
        }
        let accelerations = solve(self.system(), &at.state)?.accelerations;
        (0..at.arguments().len()).for_each(|j| at.delay(j, -at.t[j], &accelerations));
        Ok(at)
    }

    /// Fails if transitions are not located.
    fn check_located(&self) -> Result<(), Error> {
        let first = L::CONTACTS.iter().chain(L::FRICTIONS.iter().map(|friction| &friction.row)).next();
        match (self.first_leg().is_in_time_steps(), first) {
            (true, Some(&row)) => fails(name(L::CONSTRAINTS, row), self.first_leg().first().t, BY_TIME_STEPS),
            _ => Ok(()),
        }
    }

    /// Fails if friction of two velocities begins or ceases to slide: the turn of its direction grows without bound there.
    fn check_plane(&self) -> Result<(), Error> {
        let planar = |name: &str| {
            L::FRICTIONS.iter().any(|friction| friction.count == 2 && L::CONSTRAINTS[friction.row] == name)
        };
        for transition in self.transitions() {
            if let Transition::Sticks { friction, time } | Transition::Slips { friction, time } = *transition
                && planar(friction)
            {
                return fails(friction, time, IN_THE_PLANE);
            }
        }
        Ok(())
    }
}

fn check_start<L: Linearized<Scalar: Real> + Contacts + Clone>(
    first: &Leg<L>,
    at: &StateSensitivity<L::Scalar, L::N>,
) -> Result<(), Error> {
    // At rest compared with the end of the leg.
    let change = Change { systems: [first.system(); 2], states: [*first.last(), at.state] };
    change.check_start(at)?;
    change.check_limits(None)
}

/// Derivatives of the state after the transitions between two legs. `before` is the leg that ends there.
fn cross<L: Linearized<Scalar: Real> + Contacts + Clone>(
    before: Option<&Leg<L>>,
    (system, state): (&L, StateOf<L>),
    transitions: &[Transition<L::Scalar>],
    at: StateSensitivity<L::Scalar, L::N>,
) -> Result<StateSensitivity<L::Scalar, L::N>, Error> {
    let rest = transitions.iter().find_map(|transition| match *transition {
        Transition::Rests { contact, .. } => Some(contact),
        _ => None,
    });
    if let Some(contact) = rest {
        let reason = "impacts accumulate there, each with a derivative of its own; end the motion before";
        return fails(contact, state.t, reason);
    }
    let impacts = |transition: &&Transition<L::Scalar>| matches!(transition, Transition::Impact { .. });
    let impacts: Vec<_> = transitions.iter().filter(impacts).collect();
    let reason = match (before, &impacts[..]) {
        (Some(leg), [Transition::Impact { impulses, .. }]) => {
            let hit = Hit::of(leg, impulses, &state)?;
            let after = hit.after(leg, at.clone())?;
            hit.check(&after.state, &state)?;
            hit.check_idle(leg, impulses, [&at, &after])?;
            let (systems, states) = ([leg.system(), system], [*leg.last(), state]);
            Change { systems, states }.check_limits(None)?;
            return Ok(after);
        }
        (Some(leg), []) => return without_impact(leg, (system, &state), transitions, at),
        (None, []) => return Ok(at),
        (None, _) => "the motion starts with an impact; start before it",
        (Some(_), _) => "several impacts at one time, whose order the arguments may change",
    };
    fails(first_name(transitions), state.t, reason)
}

/// Name of the first contact among these transitions.
fn first_name<T>(transitions: &[Transition<T>]) -> &'static str {
    let of = |transition: &Transition<T>| match transition {
        Transition::Impact { impulses, .. } => impulses.first().map(|&(contact, _)| contact),
        Transition::Rests { contact, .. }
        | Transition::Closes { contact, .. }
        | Transition::Opens { contact, .. } => Some(*contact),
        Transition::Sticks { friction, .. }
        | Transition::Slips { friction, .. }
        | Transition::Reverses { friction, .. } => Some(*friction),
    };
    transitions.iter().find_map(of).unwrap_or("")
}

/// Derivatives across the end of a leg without an impact. Where the accelerations are continuous, so are the derivatives; else
/// they jump by (ẋ⁻ − ẋ⁺) δt, with the change δt of the time at which the leg ends.
fn without_impact<L: Linearized<Scalar: Real> + Contacts + Clone>(
    leg: &Leg<L>,
    (system, state): (&L, &StateOf<L>),
    transitions: &[Transition<L::Scalar>],
    at: StateSensitivity<L::Scalar, L::N>,
) -> Result<StateSensitivity<L::Scalar, L::N>, Error> {
    let boundary = Boundary::of(leg);
    if let Some(Boundary::Gap(_)) = boundary {
        let event = boundary.map_or("", Boundary::name::<L>);
        return Err(Error::Grazing { event, time: state.t.to_f64() });
    }
    if is_continuous(leg, (system, state))? {
        return Ok(at);
    }
    let Some(boundary @ (Boundary::Slip(_) | Boundary::Hold(_))) = boundary else {
        return Err(Error::Grazing { event: first_name(transitions), time: state.t.to_f64() });
    };
    let at = boundary.reach(leg, at)?;
    let change = Change { systems: [leg.system(), system], states: [*leg.last(), *state] };
    change.check_alone(boundary, &at)?;
    change.check_limits(Some(boundary))?;
    Ok(at)
}

/// Whether the accelerations do not jump at the end of a leg.
fn is_continuous<L: Linearized<Scalar: Real> + Contacts + Clone>(
    leg: &Leg<L>,
    (system, state): (&L, &StateOf<L>),
) -> Result<bool, Error> {
    let [one, other] = [solve(leg.system(), leg.last())?, solve(system, state)?];
    let jump = one.accelerations.minus(&other.accelerations);
    // At the zero of a multiplier, its rate times the round-off of the time is left.
    let least = power_of_epsilon::<L::Scalar>(0.5) * largest(one.accelerations.as_slice());
    Ok(largest(jump.as_slice()) <= least)
}

/// The motion has no derivative across the transition of this contact or friction.
fn fails<T: Real, X>(contact: &'static str, time: T, reason: &'static str) -> Result<X, Error> {
    Err(Error::NoDerivativeAcross { contact, time: time.to_f64(), reason })
}
