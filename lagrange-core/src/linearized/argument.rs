//! Arguments of the equations of motion, looked up by name.

use alloc::vec::Vec;

use super::Linearized;
use crate::error::Error;
use crate::names::Entry;
use crate::system::{Direction, ResidualChange, Solution, State, lookup, unit};

/// A coordinate, a velocity or a parameter, by its index.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Argument {
    Coordinate(usize),
    Velocity(usize),
    Parameter(usize),
}

impl Argument {
    /// Finds the arguments of these names.
    pub(crate) fn named<L: Linearized<N, M, P>, const N: usize, const M: usize, const P: usize>(
        names: &[&str],
    ) -> Result<Vec<Self>, Error> {
        let mut known = lookup::entries::<L, N, M>();
        known.extend(L::PARAMETERS.map(Into::into));
        let found = lookup::indices::<L, N, M>(&known, "coordinate, velocity or parameter", names)?;
        let argument = |i| match i {
            i if i < N => Self::Coordinate(i),
            i if i < 2 * N => Self::Velocity(i - N),
            i => Self::Parameter(i - 2 * N),
        };
        Ok(found.into_iter().map(argument).collect())
    }

    /// Finds the actuators of these names: a coordinate stands for the generalized force on it, a parameter for itself.
    pub(crate) fn actuators<L: Linearized<N, M, P>, const N: usize, const M: usize, const P: usize>(
        names: &[&str],
    ) -> Result<Vec<Self>, Error> {
        let known = [&L::COORDINATES[..], &L::PARAMETERS].concat();
        let found = lookup::indices::<L, N, M>(&known, "coordinate or parameter", names)?;
        let argument = |i| if i < N { Self::Coordinate(i) } else { Self::Parameter(i - N) };
        Ok(found.into_iter().map(argument).collect())
    }

    /// Name of the argument, for messages.
    pub(crate) fn entry<L, const N: usize, const M: usize, const P: usize>(self) -> Entry
    where
        L: Linearized<N, M, P>,
    {
        match self {
            Self::Coordinate(i) => Entry::Coordinate(L::COORDINATES[i]),
            Self::Velocity(i) => Entry::Velocity(L::COORDINATES[i]),
            Self::Parameter(k) => Entry::Parameter(L::PARAMETERS[k]),
        }
    }

    /// Derivative of the residual by this argument.
    pub(crate) fn residual_change<L, const N: usize, const M: usize, const P: usize>(
        self,
        system: &L,
        state: &State<L::Scalar, N>,
        solution: &Solution<L::Scalar, N, M>,
    ) -> ResidualChange<L::Scalar, N, M>
    where
        L: Linearized<N, M, P>,
    {
        match self {
            Self::Coordinate(i) => system.residual_change(state, solution, &Direction::of_coordinate(i)),
            Self::Velocity(i) => system.residual_change(state, solution, &Direction::of_velocity(i)),
            Self::Parameter(k) => system.residual_change_by_parameters(state, solution, &unit(k)),
        }
    }
}

/// Index of this parameter among those of the system; `None` if the system does not have it.
pub(crate) fn parameter<L, const N: usize, const M: usize, const P: usize>(entry: Entry) -> Option<usize>
where
    L: Linearized<N, M, P>,
{
    match entry {
        Entry::Parameter(name) => L::PARAMETERS.iter().position(|known| *known == name),
        _ => None,
    }
}
