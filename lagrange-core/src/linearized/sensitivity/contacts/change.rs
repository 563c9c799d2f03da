//! Conditions on which neighbouring motions pass a transition in the same way.

use super::boundary::{Boundary, kinematic};
use super::{IN_THE_PLANE, fails};
use crate::contact::{Contact, Contacts, Friction, FrictionRows};
use crate::error::Error;
use crate::linearized::Linearized;
use crate::linearized::sensitivity::state::StateSensitivity;
use crate::number::{Real, Scalar, Wide, power_of_epsilon};
use crate::solution::solve::solve;
use crate::system::StateOf;
use crate::vector::{Array, Length, Vector, vector};

/// A transition: the states before and after it, and the systems whose contacts are as then.
pub(super) struct Change<'a, L: Linearized> {
    pub(super) systems: [&'a L; 2],
    pub(super) states: [StateOf<L>; 2],
}

/// The system with this friction sticking, for its velocity and its force.
fn stuck<L: Contacts + Clone>(system: &L, f: usize) -> L {
    let mut stuck = system.clone();
    stuck.set_friction(f, Friction::Sticks);
    stuck
}

/// Size of the velocity of this friction in the system where it sticks.
fn speed<L: Contacts<Scalar: Real>>(stuck: &L, f: usize, state: &StateOf<L>) -> L::Scalar {
    let (FrictionRows { row, count, .. }, rates) = (L::FRICTIONS[f], stuck.constraint_rate(state));
    let square = (row..row + count).fold(L::Scalar::constant(0.0), |sum, a| sum + rates[a] * rates[a]);
    Scalar::sqrt(square)
}

/// Sum of the magnitudes Σ |Wᵢ uᵢ| of the velocity of friction in the system where it sticks.
fn terms<L: Contacts<Scalar: Real>>(
    stuck: &L,
    f: usize,
    state: &StateOf<L>,
    u: &Vector<L::Scalar, L::N>,
) -> L::Scalar {
    let (FrictionRows { row, count, .. }, jacobian) = (L::FRICTIONS[f], stuck.constraint_jacobian(state));
    let each = (row..row + count).flat_map(|a| (0..<L::N>::COUNT).map(move |i| (a, i)));
    each.fold(L::Scalar::constant(0.0), |sum, (a, i)| sum + Scalar::abs(jacobian[(a, i)] * u[i]))
}

/// Whether the velocity of friction is zero after a transition: below √ε of its terms before and after.
pub(super) fn is_at_rest<L: Contacts<Scalar: Real>>(stuck: &L, f: usize, states: [&StateOf<L>; 2]) -> bool {
    let sizes = states.map(|state| terms(stuck, f, state, &state.v) + speed(stuck, f, state));
    let [before, _] = states;
    let still = StateOf::<L> { v: vector(Array::filled(L::Scalar::constant(0.0))), ..*before };
    let size = sizes[0] + sizes[1] + speed(stuck, f, &still);
    speed(stuck, f, states[1]) <= power_of_epsilon::<L::Scalar>(0.5) * size
}

impl<L: Linearized<Scalar: Real> + Contacts + Clone> Change<'_, L> {
    /// Fails if contacts or friction change beside that of the boundary.
    pub(super) fn check_alone(
        &self,
        boundary: Boundary,
        at: &StateSensitivity<L::Scalar, L::N>,
    ) -> Result<(), Error> {
        let reason = "several contacts or frictions change at one time, whose order the arguments may change";
        let [before, after] = self.systems;
        let is_open = |system: &L, k: usize| system.contact(k) == Some(Contact::Open);
        if let Some(k) = (0..L::CONTACTS.len()).find(|&k| is_open(before, k) != is_open(after, k)) {
            return fails(L::CONSTRAINTS[L::CONTACTS[k]], self.states[1].t, reason);
        }
        let others = |&f: &usize| ![Boundary::Slip(f), Boundary::Hold(f)].contains(&boundary);
        for f in (0..L::FRICTIONS.len()).filter(others) {
            let is_same = match [before, after].map(|system| system.friction(f)) {
                [Some(Friction::Slides(_)), Some(Friction::Slides(_))] if L::FRICTIONS[f].count == 2 => true,
                [Some(one), Some(other)] if one.is_at_rest() && other.is_at_rest() => true,
                [one, other] => one == other,
            };
            if !is_same && !self.follows(f, at)? {
                return fails(L::CONSTRAINTS[L::FRICTIONS[f].row], self.states[1].t, reason);
            }
        }
        Ok(())
    }

    /// Whether another friction changes along with the boundary on neighbouring motions too: it has stuck below its limit, so that
    /// the jump of the forces makes it slide, or it stops at the same time.
    fn follows(&self, f: usize, at: &StateSensitivity<L::Scalar, L::N>) -> Result<bool, Error> {
        let [before, _] = self.systems;
        match before.friction(f) {
            Some(Friction::Shares(_)) => Ok(false),
            Some(Friction::Sticks) => Ok(!is_at_limit(before, f, &self.states[0])?),
            Some(Friction::Slides(_)) => Ok(self.stops_with(f, at)),
            None => Ok(false),
        }
    }

    /// Whether friction that slides stops at the end of the leg along all neighbouring motions: the derivatives of its velocity
    /// there are zero, to √ε of their terms.
    fn stops_with(&self, f: usize, at: &StateSensitivity<L::Scalar, L::N>) -> bool {
        let ([before, _], row) = (self.systems, L::FRICTIONS[f].row);
        let stuck = stuck(before, f);
        let is_none = |j: usize| {
            let (direction, argument) = (at.direction(j), at.arguments()[j]);
            let change = kinematic(&stuck, &at.state, &direction, Some(argument)).rate[row].lane(0);
            let terms = terms(&stuck, f, &at.state, &direction.v);
            Scalar::abs(change) <= power_of_epsilon::<L::Scalar>(0.5) * terms
        };
        (0..at.arguments().len()).all(is_none)
    }

    /// Fails if the force that would keep bodies together is at its limit, to √ε of both, where friction is at rest: the
    /// arguments decide whether it sticks.
    pub(super) fn check_limits(&self, boundary: Option<Boundary>) -> Result<(), Error> {
        let [_, after] = self.systems;
        let left = |&f: &usize| boundary != Some(Boundary::Hold(f));
        for f in (0..L::FRICTIONS.len()).filter(left) {
            let stuck = stuck(after, f);
            let rests = match after.friction(f) {
                // What others keep at rest does not depend on the shares of the forces.
                None | Some(Friction::Slides([0.0, 0.0]) | Friction::Shares(_)) => false,
                Some(Friction::Sticks) => true,
                Some(Friction::Slides(_)) => {
                    boundary == Some(Boundary::Slip(f)) || is_at_rest(&stuck, f, self.states.each_ref())
                }
            };
            let slides = after.friction(f) != Some(Friction::Sticks);
            if rests && slides && L::FRICTIONS[f].count == 2 {
                return fails(L::CONSTRAINTS[L::FRICTIONS[f].row], self.states[1].t, IN_THE_PLANE);
            }
            if rests && is_at_limit(&stuck, f, &self.states[1])? {
                let reason = "its force is at the limit, and the arguments decide whether it sticks";
                return fails(L::CONSTRAINTS[L::FRICTIONS[f].row], self.states[1].t, reason);
            }
        }
        Ok(())
    }

    /// Fails if a derivative of the start moves bodies that are at rest, and begin to slide: it has another one in the other
    /// direction.
    pub(super) fn check_start(&self, at: &StateSensitivity<L::Scalar, L::N>) -> Result<(), Error> {
        let [_, after] = self.systems;
        for f in 0..L::FRICTIONS.len() {
            let (stuck, FrictionRows { row, count, .. }) = (stuck(after, f), L::FRICTIONS[f]);
            let slides =
                matches!(after.friction(f), Some(Friction::Slides(direction)) if direction != [0.0; 2]);
            let moves = |j: usize| {
                let change = kinematic(&stuck, &at.state, &at.direction(j), Some(at.arguments()[j])).rate;
                (row..row + count).any(|a| change[a].lane(0) != L::Scalar::constant(0.0))
            };
            if slides && is_at_rest(&stuck, f, self.states.each_ref()) && (0..at.arguments().len()).any(moves)
            {
                let reason =
                    "it begins to slide from rest at the start, and an argument changes its velocity there";
                return fails(L::CONSTRAINTS[row], self.states[1].t, reason);
            }
        }
        Ok(())
    }
}

/// Whether the force of friction in the system where it sticks is at its limit. Where contacts share forces in more than one
/// way, none has a limit of its own.
fn is_at_limit<L: Linearized<Scalar: Real> + Contacts>(
    stuck: &L,
    f: usize,
    state: &StateOf<L>,
) -> Result<bool, Error> {
    let FrictionRows { row, count, contact, .. } = L::FRICTIONS[f];
    let (solution, one) = (solve(stuck, state)?, L::Scalar::constant(1.0));
    if !solution.multipliers_are_unique() {
        return Ok(false);
    }
    let forces = solution.multipliers;
    let press = contact.map_or(one, |k| forces[L::CONTACTS[k]]);
    let limit = press * stuck.friction_limit(f, state).unwrap_or(L::Scalar::constant(0.0));
    let square = (row..row + count).fold(L::Scalar::constant(0.0), |sum, a| sum + forces[a] * forces[a]);
    let force = Scalar::sqrt(square);
    Ok(Scalar::abs(force - limit) <= power_of_epsilon::<L::Scalar>(0.5) * (force + Scalar::abs(limit)))
}
