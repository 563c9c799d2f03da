//! The Jacobian of the accelerations and of the multipliers.

use nalgebra::{SMatrix, SVector};

use super::tangent::Tangent;
use super::{Direction, Linearized, StateDerivatives};
use crate::error::Error;
use crate::names::Entry;
use crate::number::Real;
use crate::system::{Solution, State};

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

/// See [`StateDerivatives::state_jacobian`].
pub(super) fn state_jacobian<L, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
) -> Result<Jacobian<L::Scalar, N, M, 0>, Error>
where
    L: StateDerivatives<N, M, Scalar: Real>,
{
    with_parameters(&Tangent::at(system, state)?, |_| Ok((SMatrix::zeros(), SMatrix::zeros())))
}

/// See [`Linearized::jacobian`].
pub(super) fn jacobian<L, const N: usize, const M: usize, const P: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
) -> Result<Jacobian<L::Scalar, N, M, P>, Error>
where
    L: Linearized<N, M, P, Scalar: Real>,
{
    with_parameters(&Tangent::at(system, state)?, |tangent| columns(|k| tangent.by_parameter(k)))
}

fn with_parameters<'a, L, const N: usize, const M: usize, const P: usize>(
    tangent: &Tangent<'a, L, N, M>,
    by_parameters: impl FnOnce(&Tangent<'a, L, N, M>) -> Result<Columns<L::Scalar, N, M, P>, Error>,
) -> Result<Jacobian<L::Scalar, N, M, P>, Error>
where
    L: StateDerivatives<N, M, Scalar: Real>,
{
    let by_time = tangent.along(&Direction::of_time(), Entry::Time)?;
    let by_coordinate =
        |i: usize| tangent.along(&Direction::of_coordinate(i), Entry::Coordinate(L::COORDINATES[i]));
    let by_velocity =
        |i: usize| tangent.along(&Direction::of_velocity(i), Entry::Velocity(L::COORDINATES[i]));
    let (q2_q, lambda_q) = columns(by_coordinate)?;
    let (q2_v, lambda_v) = columns(by_velocity)?;
    let (q2_p, lambda_p) = by_parameters(tangent)?;
    Ok(Jacobian {
        solution: tangent.solution,
        accelerations: Partials { t: by_time.accelerations, q: q2_q, v: q2_v, parameters: q2_p },
        multipliers: Partials { t: by_time.multipliers, q: lambda_q, v: lambda_v, parameters: lambda_p },
    })
}

/// Derivatives of the accelerations and of the multipliers by `K` entries, a column each.
type Columns<T, const N: usize, const M: usize, const K: usize> = (SMatrix<T, N, K>, SMatrix<T, M, K>);

fn columns<T: Real, const N: usize, const M: usize, const K: usize>(
    by: impl Fn(usize) -> Result<Solution<T, N, M>, Error>,
) -> Result<Columns<T, N, M, K>, Error> {
    let mut accelerations = SMatrix::<_, N, K>::zeros();
    let mut multipliers = SMatrix::<_, M, K>::zeros();
    for k in 0..K {
        let change = by(k)?;
        accelerations.set_column(k, &change.accelerations);
        multipliers.set_column(k, &change.multipliers);
    }
    Ok((accelerations, multipliers))
}
