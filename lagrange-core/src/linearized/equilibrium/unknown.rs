//! What can be sought.

use alloc::vec::Vec;

use crate::error::Error;
use crate::linearized::{Direction, Linearized};
use crate::names::Entry;
use crate::number::Real;
use crate::system::lookup;

/// A coordinate, a velocity or a parameter, by its index.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Unknown {
    Coordinate(usize),
    Velocity(usize),
    Parameter(usize),
}

impl Unknown {
    /// Those of these names; all coordinates where there are none.
    pub(super) fn of<L: Linearized<N, M, P>, const N: usize, const M: usize, const P: usize>(
        names: &[&str],
    ) -> Result<Vec<Self>, Error> {
        if names.is_empty() {
            return Ok((0..N).map(Self::Coordinate).collect());
        }
        let mut known = lookup::entries::<L, N, M>();
        known.extend(L::PARAMETERS.map(Into::into));
        let found = lookup::indices::<L, N, M>(&known, "coordinate, velocity or parameter", names)?;
        let unknown = |i| match i {
            i if i < N => Self::Coordinate(i),
            i if i < 2 * N => Self::Velocity(i - N),
            i => Self::Parameter(i - 2 * N),
        };
        Ok(found.into_iter().map(unknown).collect())
    }

    /// What it is called.
    pub(super) fn entry<L, const N: usize, const M: usize, const P: usize>(self) -> Entry
    where
        L: Linearized<N, M, P>,
    {
        match self {
            Self::Coordinate(i) => Entry::Coordinate(L::COORDINATES[i]),
            Self::Velocity(i) => Entry::Velocity(L::COORDINATES[i]),
            Self::Parameter(k) => Entry::Parameter(L::PARAMETERS[k]),
        }
    }

    /// The direction in which it alone changes.
    pub(super) fn direction<T: Real, const N: usize, const P: usize>(self) -> Direction<T, N, P> {
        match self {
            Self::Coordinate(i) => Direction::of_coordinate(i),
            Self::Velocity(i) => Direction::of_velocity(i),
            Self::Parameter(k) => Direction::of_parameter(k),
        }
    }
}
