//! The Jacobian of the accelerations and of the multipliers.

use nalgebra::{SMatrix, SVector};

use super::tangent::Tangent;
use super::{Direction, Linearized};
use crate::names::Entry;
use crate::{Error, Real, Solution, State};

/// Partial derivatives of `R` quantities by the time, `N` coordinates, `N` velocities and `P` parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Partials<T, const R: usize, const N: usize, const P: usize> {
    /// By the time.
    pub t: SVector<T, R>,
    /// By the coordinates, a column each.
    pub q: SMatrix<T, R, N>,
    /// By the velocities, a column each.
    pub v: SMatrix<T, R, N>,
    /// By the parameters, a column each.
    pub parameters: SMatrix<T, R, P>,
}

impl<T: Real, const R: usize, const N: usize, const P: usize> Partials<T, R, N, P> {
    fn zero() -> Self {
        Self { t: SVector::zeros(), q: SMatrix::zeros(), v: SMatrix::zeros(), parameters: SMatrix::zeros() }
    }
}

/// What the equations of motion give at a state, and its partial derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jacobian<T, const N: usize, const M: usize, const P: usize> {
    /// Accelerations and multipliers.
    pub solution: Solution<T, N, M>,
    /// Of the accelerations q̈.
    pub accelerations: Partials<T, N, N, P>,
    /// Of the multipliers λ; where constraints depend on one another, the change of least norm.
    pub multipliers: Partials<T, M, N, P>,
}

/// See [`Linearized::jacobian`].
pub(super) fn jacobian<L, const N: usize, const M: usize, const P: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
) -> Result<Jacobian<L::Scalar, N, M, P>, Error>
where
    L: Linearized<N, M, P, Scalar: Real>,
{
    let tangent = Tangent::at(system, state)?;
    let (mut q2, mut lambda) = (Partials::zero(), Partials::zero());
    let change = tangent.along(&Direction::of_time(), Entry::Time)?;
    (q2.t, lambda.t) = (change.accelerations, change.multipliers);
    for (i, name) in L::COORDINATES.iter().enumerate() {
        let change = tangent.along(&Direction::of_coordinate(i), Entry::Coordinate(name))?;
        q2.q.set_column(i, &change.accelerations);
        lambda.q.set_column(i, &change.multipliers);
        let change = tangent.along(&Direction::of_velocity(i), Entry::Velocity(name))?;
        q2.v.set_column(i, &change.accelerations);
        lambda.v.set_column(i, &change.multipliers);
    }
    for (k, name) in L::PARAMETERS.iter().enumerate() {
        let change = tangent.along(&Direction::of_parameter(k), Entry::Parameter(name))?;
        q2.parameters.set_column(k, &change.accelerations);
        lambda.parameters.set_column(k, &change.multipliers);
    }
    Ok(Jacobian { solution: tangent.solution, accelerations: q2, multipliers: lambda })
}
