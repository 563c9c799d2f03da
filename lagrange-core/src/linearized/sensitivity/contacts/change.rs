//! Conditions on which neighbouring motions pass a transition in the same way.

use core::ops::Range;

use super::boundary::{Boundary, kinematic};
use super::{IN_THE_PLANE, fails};
use crate::contact::across::held;
use crate::contact::{Contact, Contacts, Friction};
use crate::error::Error;
use crate::linearized::Linearized;
use crate::linearized::sensitivity::state::StateSensitivity;
use crate::number::{Real, Scalar, power_of_epsilon};
use crate::solution::solve::solve;
use crate::system::{Lagrangian, StateOf};
use crate::vector::{StaticLength, Vector, zeros};

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
    let rates = stuck.constraint_rate(state);
    L::FRICTIONS[f].size(|a| rates[a])
}

/// Sum of the magnitudes Σ |Wᵢ uᵢ| of the rates of these constraints.
pub(super) fn terms<L: Lagrangian<Scalar: Real>>(
    system: &L,
    rows: Range<usize>,
    state: &StateOf<L>,
    u: &Vector<L::Scalar, L::N>,
) -> L::Scalar {
    let jacobian = system.constraint_jacobian(state);
    let each = rows.flat_map(|a| (0..<L::N>::COUNT).map(move |i| (a, i)));
    each.fold(L::Scalar::constant(0.0), |sum, (a, i)| sum + Scalar::abs(jacobian[(a, i)] * u[i]))
}

/// Whether the velocity of friction is zero after a transition: below √ε of its terms before and after.
pub(super) fn is_at_rest<L: Contacts<Scalar: Real>>(stuck: &L, f: usize, states: [&StateOf<L>; 2]) -> bool {
    let sizes =
        states.map(|state| terms(stuck, L::FRICTIONS[f].rows(), state, &state.v) + speed(stuck, f, state));
    let [before, _] = states;
    let still = StateOf::<L> { v: zeros(), ..*before };
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
            let changing = at.by(j);
            let change = kinematic(&stuck, &changing).rate[row];
            let terms = terms(&stuck, L::FRICTIONS[f].rows(), &at.state, &changing.direction.v);
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
            let (stuck, friction) = (stuck(after, f), L::FRICTIONS[f]);
            let slides =
                matches!(after.friction(f), Some(Friction::Slides(direction)) if direction != [0.0; 2]);
            let moves = |j: usize| {
                let change = kinematic(&stuck, &at.by(j)).rate;
                friction.rows().any(|a| change[a] != L::Scalar::constant(0.0))
            };
            if slides && is_at_rest(&stuck, f, self.states.each_ref()) && (0..at.arguments().len()).any(moves)
            {
                let reason =
                    "it begins to slide from rest at the start, and an argument changes its velocity there";
                return fails(L::CONSTRAINTS[friction.row], self.states[1].t, reason);
            }
        }
        Ok(())
    }
}

/// Whether the force of friction in the system where it sticks is at its limit. Where contacts share forces in more than one
/// way, none has a limit of its own.
fn is_at_limit<L: Linearized<Scalar: Real> + Contacts + Clone>(
    stuck: &L,
    f: usize,
    state: &StateOf<L>,
) -> Result<bool, Error> {
    let solution = solve(stuck, state)?;
    if !solution.multipliers_are_unique() {
        return Ok(false);
    }
    let [limit, force] = held(stuck, f, state, &solution)?;
    Ok(Scalar::abs(force - limit) <= power_of_epsilon::<L::Scalar>(0.5) * (force + Scalar::abs(limit)))
}
