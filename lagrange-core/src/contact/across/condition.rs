//! Conditions under which a leg goes on, and steps within which bounds on the multipliers say that they hold.

use super::friction::bounds;
use super::states::LegStates;
use super::{Contacts, FrictionRows};
use crate::error::Error;
use crate::motion::MultiplierBounds;
use crate::number::{Real, Scalar, larger};
use crate::system::StateOf;
use crate::vector::StaticLength;

/// Condition under which a leg goes on; an event says where it fails.
#[derive(Clone, Copy, Debug)]
pub(super) enum LegCondition<T> {
    /// The contact of this constraint pushes.
    Pushes { row: usize },
    /// Friction sticks, with a constant limit, as a multiple of the multiplier of the constraint `press` if there is one.
    Sticks { row: usize, count: usize, press: Option<usize>, limit: T },
    /// A condition on coordinates and velocities, or one that depends on them.
    Motion,
}

impl<T: Real> LegCondition<T> {
    /// Condition of friction `f` in these states.
    pub(super) fn of_friction<L: Contacts<Scalar = T>>(
        (closed, f): (&L, usize),
        states: &LegStates,
        state: &StateOf<L>,
    ) -> Result<Self, Error> {
        let FrictionRows { row, count, contact, has_constant_limit } = L::FRICTIONS[f];
        if !has_constant_limit || !states.frictions[f].friction.is_at_rest() {
            return Ok(Self::Motion);
        }
        let [limit, _] = bounds(closed, f, state)?;
        Ok(Self::Sticks { row, count, press: contact.map(|k| L::CONTACTS[k]), limit })
    }

    /// True if multipliers decide on the condition.
    pub(super) fn is_on_forces(&self) -> bool {
        !matches!(self, Self::Motion)
    }

    /// True if λ > 0, or μ λ_N > |λ_T|, for all multipliers within these bounds.
    #[inline]
    pub(super) fn holds_within<M: StaticLength>(&self, within: &MultiplierBounds<T, M>) -> bool {
        let MultiplierBounds { lowest, highest } = within;
        match *self {
            Self::Pushes { row } => lowest[row] > T::constant(0.0),
            Self::Sticks { row, count, press, limit } => {
                let most = |a: usize| larger(Scalar::abs(lowest[a]), Scalar::abs(highest[a]));
                let force = match count {
                    1 => most(row),
                    _ => Scalar::sqrt(most(row) * most(row) + most(row + 1) * most(row + 1)),
                };
                press.map_or(limit, |press| limit * lowest[press]) > force
            }
            Self::Motion => false,
        }
    }
}
