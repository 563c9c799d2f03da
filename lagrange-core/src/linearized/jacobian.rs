//! The Jacobian of the accelerations and of the multipliers.

use nalgebra::{SMatrix, SVector};

use super::tangent::Tangent;
use super::{Direction, Linearized};
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

/// See [`Linearized::jacobian`].
pub(super) fn jacobian<L, const N: usize, const M: usize, const P: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
) -> Result<Jacobian<L::Scalar, N, M, P>, Error>
where
    L: Linearized<N, M, P, Scalar: Real>,
{
    let tangent = Tangent::at(system, state)?;
    let by_time = tangent.along(&Direction::of_time(), Entry::Time)?;
    let (q2_q, lambda_q) = columns(&tangent, L::COORDINATES, Direction::of_coordinate, Entry::Coordinate)?;
    let (q2_v, lambda_v) = columns(&tangent, L::COORDINATES, Direction::of_velocity, Entry::Velocity)?;
    let (q2_p, lambda_p) = columns(&tangent, L::PARAMETERS, Direction::of_parameter, Entry::Parameter)?;
    Ok(Jacobian {
        solution: tangent.solution,
        accelerations: Partials { t: by_time.accelerations, q: q2_q, v: q2_v, parameters: q2_p },
        multipliers: Partials { t: by_time.multipliers, q: lambda_q, v: lambda_v, parameters: lambda_p },
    })
}

/// Derivatives of the accelerations and of the multipliers by the `K` entries of these names, a column each.
type Columns<T, const N: usize, const M: usize, const K: usize> = (SMatrix<T, N, K>, SMatrix<T, M, K>);

fn columns<L, const N: usize, const M: usize, const P: usize, const K: usize>(
    tangent: &Tangent<'_, L, N, M, P>,
    names: [&'static str; K],
    direction: fn(usize) -> Direction<L::Scalar, N, P>,
    entry: fn(&'static str) -> Entry,
) -> Result<Columns<L::Scalar, N, M, K>, Error>
where
    L: Linearized<N, M, P, Scalar: Real>,
{
    let mut accelerations = SMatrix::<_, N, K>::zeros();
    let mut multipliers = SMatrix::<_, M, K>::zeros();
    for (k, name) in names.into_iter().enumerate() {
        let change = tangent.along(&direction(k), entry(name))?;
        accelerations.set_column(k, &change.accelerations);
        multipliers.set_column(k, &change.multipliers);
    }
    Ok((accelerations, multipliers))
}
