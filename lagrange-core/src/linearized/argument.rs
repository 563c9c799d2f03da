//! Arguments of the equations of motion, looked up by name.

use alloc::vec::Vec;

use super::Linearized;
use crate::error::Error;
use crate::names::Entry;
use crate::system::{Direction, ResidualChange, SolutionOf, StateOf, lookup, unit};
use crate::vector::StaticLength;

/// A coordinate, a velocity or a parameter, by its index.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Argument {
    Coordinate(usize),
    Velocity(usize),
    Parameter(usize),
}

/// Checks at compile time that a manual implementation names all parameters, in a program that uses the
/// names.
pub(crate) const fn check_parameters<L: Linearized>() {
    assert!(L::PARAMETERS.len() == <L::P>::COUNT, "`PARAMETERS` must have `P` names");
}

impl Argument {
    /// Finds the arguments of these names.
    pub(crate) fn named<L: Linearized>(names: &[&str]) -> Result<Vec<Self>, Error> {
        const { check_parameters::<L>() };
        let mut known = lookup::entries::<L>();
        known.extend(L::PARAMETERS.iter().copied().map(Into::into));
        let found = lookup::indices::<L>(&known, "coordinate, velocity or parameter", names)?;
        let argument = |i| match i {
            i if i < <L::N>::COUNT => Self::Coordinate(i),
            i if i < 2 * <L::N>::COUNT => Self::Velocity(i - <L::N>::COUNT),
            i => Self::Parameter(i - 2 * <L::N>::COUNT),
        };
        Ok(found.into_iter().map(argument).collect())
    }

    /// Finds the actuators of these names: a coordinate stands for the generalized force on it, a parameter for itself.
    pub(crate) fn actuators<L: Linearized>(names: &[&str]) -> Result<Vec<Self>, Error> {
        const { check_parameters::<L>() };
        let known = [L::COORDINATES, L::PARAMETERS].concat();
        let found = lookup::indices::<L>(&known, "coordinate or parameter", names)?;
        let argument =
            |i| if i < <L::N>::COUNT { Self::Coordinate(i) } else { Self::Parameter(i - <L::N>::COUNT) };
        Ok(found.into_iter().map(argument).collect())
    }

    /// Name of the argument, for messages.
    pub(crate) fn entry<L: Linearized>(self) -> Entry {
        match self {
            Self::Coordinate(i) => Entry::Coordinate(L::COORDINATES[i]),
            Self::Velocity(i) => Entry::Velocity(L::COORDINATES[i]),
            Self::Parameter(k) => Entry::Parameter(L::PARAMETERS[k]),
        }
    }

    /// Derivative of the residual by this argument.
    pub(crate) fn residual_change<L: Linearized>(
        self,
        system: &L,
        state: &StateOf<L>,
        solution: &SolutionOf<L>,
    ) -> ResidualChange<L::Scalar, L::N, L::M> {
        match self {
            Self::Coordinate(i) => system.residual_change(state, solution, &Direction::of_coordinate(i)),
            Self::Velocity(i) => system.residual_change(state, solution, &Direction::of_velocity(i)),
            Self::Parameter(k) => system.residual_change_by_parameters(state, solution, &unit(k)),
        }
    }
}

/// Sets a parameter; an error if it cannot be set.
pub(crate) fn set_parameter<L: Linearized>(system: &mut L, k: usize, value: L::Scalar) -> Result<(), Error> {
    match system.set_parameter(k, value) {
        true => Ok(()),
        false => Err(Error::ParameterFixed { name: L::PARAMETERS[k] }),
    }
}
