//! What the equations of motion depend on, by names.

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
    /// Those of these names.
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

    /// Coordinates on which a generalized force acts, and parameters, of these names.
    pub(crate) fn actuators<L: Linearized<N, M, P>, const N: usize, const M: usize, const P: usize>(
        names: &[&str],
    ) -> Result<Vec<Self>, Error> {
        let known = [&L::COORDINATES[..], &L::PARAMETERS].concat();
        let found = lookup::indices::<L, N, M>(&known, "coordinate or parameter", names)?;
        let argument = |i| if i < N { Self::Coordinate(i) } else { Self::Parameter(i - N) };
        Ok(found.into_iter().map(argument).collect())
    }

    /// What it is called.
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

    /// How the residual changes with it alone.
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

/// Which of the system's parameters this is, if it is one.
pub(crate) fn parameter<L, const N: usize, const M: usize, const P: usize>(entry: Entry) -> Option<usize>
where
    L: Linearized<N, M, P>,
{
    match entry {
        Entry::Parameter(name) => L::PARAMETERS.iter().position(|known| *known == name),
        _ => None,
    }
}
