//! Where a leg of a motion across contacts ends: the function that is zero there, and its derivative.

use super::fails;
use super::law::NamedLaw;
use crate::contact::{Contact, Contacts, Friction, FrictionRows};
use crate::error::{Ending, Error};
use crate::linearized::Linearized;
use crate::linearized::argument::parameter;
use crate::linearized::sensitivity::state::{StateSensitivity, at_event};
use crate::linearized::tangent::Tangent;
use crate::names::{Entry, name};
use crate::number::{Real, Scalar, Wide};
use crate::system::{Direction, ResidualChange, Solution, StateOf};
use crate::trajectory::Trajectory;
use crate::vector::{Array, Length, vector};

/// What becomes zero at the end of a leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Boundary {
    /// The gap of this open contact.
    Gap(usize),
    /// The multiplier of this closed contact.
    Push(usize),
    /// The velocity of this friction, which slides.
    Slip(usize),
    /// What is left of the limit of this friction, which sticks.
    Hold(usize),
}

impl Boundary {
    /// The boundary at the end of a leg; `None` if the leg ends at a time.
    pub(super) fn of<L: Contacts<Scalar: Real>>(leg: &Trajectory<L>) -> Option<Self> {
        let Ending::Event { event, .. } = leg.ending() else { return None };
        let of_contact = L::CONTACTS.iter().position(|&row| L::CONSTRAINTS[row] == *event);
        let of_friction = || L::FRICTIONS.iter().position(|of| L::CONSTRAINTS[of.row] == *event);
        match of_contact {
            Some(k) if leg.system().contact(k) == Some(Contact::Open) => Some(Self::Gap(k)),
            Some(k) => Some(Self::Push(k)),
            None => of_friction().map(|f| match leg.system().friction(f) {
                Some(Friction::Sticks | Friction::Shares(_)) => Self::Hold(f),
                _ => Self::Slip(f),
            }),
        }
    }

    /// Index of its constraint.
    fn row<L: Contacts>(self) -> usize {
        match self {
            Self::Gap(k) | Self::Push(k) => L::CONTACTS[k],
            Self::Slip(f) | Self::Hold(f) => L::FRICTIONS[f].row,
        }
    }

    pub(super) fn name<L: Contacts>(self) -> &'static str {
        name(L::CONSTRAINTS, self.row::<L>())
    }

    /// Derivatives at the end of a leg, of its time too, from those at a fixed time.
    pub(super) fn reach<L: Linearized<Scalar: Real> + Contacts + Clone>(
        self,
        leg: &Trajectory<L>,
        at: StateSensitivity<L::Scalar, L::N>,
    ) -> Result<StateSensitivity<L::Scalar, L::N>, Error> {
        let end = leg.end();
        if leg.start_time() == end.time() {
            let reason =
                "another transition happens at the same time, and the arguments may change their order";
            return fails(self.name::<L>(), end.time(), reason);
        }
        let steps = leg.statistics().accepted;
        let before = leg.states_of_steps().nth(steps.saturating_sub(1)).unwrap_or(at.state);
        let system = self.closed(leg.system());
        let change =
            |state: &StateOf<L>, direction: &_, argument| self.change(&system, state, direction, argument);
        at_event(leg.system(), at, (self.name::<L>(), &change), &before)
    }

    /// The system with the constraint of the boundary.
    fn closed<L: Contacts + Clone>(self, system: &L) -> L {
        let mut closed = system.clone();
        match self {
            Self::Gap(k) => closed.set_contact(k, Contact::Closed),
            Self::Slip(f) => closed.set_friction(f, Friction::Sticks),
            Self::Push(_) | Self::Hold(_) => true,
        };
        closed
    }

    /// Derivative of the function along a direction and by an argument.
    fn change<L: Linearized<Scalar: Real> + Contacts + Clone>(
        self,
        system: &L,
        state: &StateOf<L>,
        direction: &Direction<L::Scalar, L::N>,
        argument: Option<Entry>,
    ) -> Result<L::Scalar, Error> {
        let row = self.row::<L>();
        match self {
            Self::Gap(_) => Ok(kinematic(system, state, direction, argument).position[row].lane(0)),
            Self::Slip(_) => Ok(kinematic(system, state, direction, argument).rate[row].lane(0)),
            Self::Push(_) => Ok(multipliers(system, state, direction, argument)?.1[row]),
            Self::Hold(f) => hold(f, system, state, direction, argument),
        }
    }
}

/// Derivative of what is left of the limit of friction that sticks: limit times press, less the size of its force.
fn hold<L: Linearized<Scalar: Real> + Contacts + Clone>(
    f: usize,
    system: &L,
    state: &StateOf<L>,
    direction: &Direction<L::Scalar, L::N>,
    argument: Option<Entry>,
) -> Result<L::Scalar, Error> {
    let FrictionRows { row, count, contact, .. } = L::FRICTIONS[f];
    let limit = NamedLaw {
        name: name(L::CONSTRAINTS, row),
        value: &|system: &L, state: &StateOf<L>| system.friction_limit(f, state),
    };
    let [value, change] = [limit.at(system, state), limit.change(system, state, direction, argument)?];
    let (forces, changes) = multipliers(system, state, direction, argument)?;
    let left = match contact.map(|k| L::CONTACTS[k]) {
        Some(gap) => change * forces[gap] + value * changes[gap],
        None => change,
    };
    let zero = L::Scalar::constant(0.0);
    let [square, product] = (row..row + count).fold([zero; 2], |[square, product], a| {
        [square + forces[a] * forces[a], product + forces[a] * changes[a]]
    });
    Ok(left - product / Scalar::sqrt(square))
}

/// Multipliers, and their derivatives along a direction and by an argument.
type ForcesAndChanges<L> = (MultipliersOf<L>, MultipliersOf<L>);
type MultipliersOf<L> =
    crate::vector::Vector<<L as crate::system::Lagrangian>::Scalar, <L as crate::system::Lagrangian>::M>;

fn multipliers<L: Linearized<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
    direction: &Direction<L::Scalar, L::N>,
    argument: Option<Entry>,
) -> Result<ForcesAndChanges<L>, Error> {
    let tangent = Tangent::at(system, state)?;
    let change = tangent.change_with(direction, argument.and_then(parameter::<L>));
    let response = tangent.responses(1, &change, |_| argument.unwrap_or(Entry::Time))?;
    let changes = vector(Array::from_fn(|a| response.multipliers[a].lane(0)));
    Ok((tangent.solution.multipliers, changes))
}

/// Derivatives of gaps and velocities, which need no forces.
pub(super) fn kinematic<L: Linearized<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
    direction: &Direction<L::Scalar, L::N>,
    argument: Option<Entry>,
) -> ResidualChange<crate::linearized::tangent::WideOf<L>, L::N, L::M> {
    let (zero, one) = (L::Scalar::constant(0.0), L::Scalar::constant(1.0));
    let (accelerations, multipliers) = (vector(Array::filled(zero)), vector(Array::filled(zero)));
    let none = Solution { accelerations, multipliers, pivot: one, rank: <L::M>::COUNT };
    Tangent::of(system, state, none).change_with(direction, argument.and_then(parameter::<L>))
}
