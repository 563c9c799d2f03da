//! Where a leg of a motion across contacts ends: the function that is zero there, and its derivative.

use super::fails;
use super::law::NamedLaw;
use crate::contact::{Contact, Contacts, Friction};
use crate::derivatives::tangent::Tangent;
use crate::error::Error;
use crate::linearized::Linearized;
use crate::linearized::sensitivity::state::{ChangingStateOf, StateSensitivity, at_event};
use crate::names::{Entry, name};
use crate::number::{Real, Scalar};
use crate::system::{ResidualChange, Solution, StateOf, System};
use crate::trajectory::Leg;
use crate::vector::{Vector, zeros};

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
    pub(super) fn of<L: Contacts<Scalar: Real>>(leg: &Leg<L>) -> Option<Self> {
        let event = leg.boundary()?;
        let of_contact = L::CONTACTS.iter().position(|&row| L::CONSTRAINTS[row] == event);
        let of_friction = || L::FRICTIONS.iter().position(|of| L::CONSTRAINTS[of.row] == event);
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
        leg: &Leg<L>,
        at: StateSensitivity<L::Scalar, L::N>,
    ) -> Result<StateSensitivity<L::Scalar, L::N>, Error> {
        let Some(before) = leg.before_last() else {
            let reason =
                "another transition happens at the same time, and the arguments may change their order";
            return fails(self.name::<L>(), leg.last().t, reason);
        };
        let system = self.closed(leg.system());
        let change = |at: &ChangingStateOf<'_, L>| self.change(&system, at);
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

    /// Derivative of the function.
    fn change<L: Linearized<Scalar: Real> + Contacts + Clone>(
        self,
        system: &L,
        at: &ChangingStateOf<'_, L>,
    ) -> Result<L::Scalar, Error> {
        let row = self.row::<L>();
        match self {
            Self::Gap(_) => Ok(kinematic(system, at).position[row]),
            Self::Slip(_) => Ok(kinematic(system, at).rate[row]),
            Self::Push(_) => Ok(multipliers(system, at)?.1[row]),
            Self::Hold(f) => hold(f, system, at),
        }
    }
}

/// Derivative of what is left of the limit of friction that sticks: limit times press, less the size of its force.
fn hold<L: Linearized<Scalar: Real> + Contacts + Clone>(
    f: usize,
    system: &L,
    at: &ChangingStateOf<'_, L>,
) -> Result<L::Scalar, Error> {
    let friction = L::FRICTIONS[f];
    let limit = NamedLaw {
        name: name(L::CONSTRAINTS, friction.row),
        value: &|system: &L, state: &StateOf<L>| system.friction_limit(f, state),
    };
    let [value, change] = [limit.at(system, at.state), limit.change(system, at)?];
    let (forces, changes) = multipliers(system, at)?;
    let left = match friction.contact.map(|k| L::CONTACTS[k]) {
        Some(gap) => change * forces[gap] + value * changes[gap],
        None => change,
    };
    let product = friction.rows().fold(L::Scalar::constant(0.0), |sum, a| sum + forces[a] * changes[a]);
    Ok(left - product / friction.size(|a| forces[a]))
}

/// Multipliers, and their derivatives.
type ForcesAndChanges<L> = (MultipliersOf<L>, MultipliersOf<L>);
type MultipliersOf<L> = Vector<<L as System>::Scalar, <L as System>::M>;

fn multipliers<L: Linearized<Scalar: Real>>(
    system: &L,
    at: &ChangingStateOf<'_, L>,
) -> Result<ForcesAndChanges<L>, Error> {
    let tangent = Tangent::at(system, at.state)?;
    let change = tangent.change_with(&at.direction, at.argument);
    let response = tangent.response(&change, at.argument.unwrap_or(Entry::Time))?;
    Ok((tangent.solution.multipliers, response.multipliers))
}

/// Derivatives of gaps and velocities, which need no forces.
pub(super) fn kinematic<L: Linearized<Scalar: Real>>(
    system: &L,
    at: &ChangingStateOf<'_, L>,
) -> ResidualChange<L::Scalar, L::N, L::M> {
    Tangent::of(system, at.state, Solution::given(zeros(), zeros())).change_with(&at.direction, at.argument)
}
