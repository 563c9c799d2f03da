//! Jacobian of the accelerations and multipliers.

use nalgebra::{SMatrix, SVector};

use super::tangent::Tangent;
use super::{Linearized, StateDerivatives};
use crate::error::Error;
use crate::names::Entry;
use crate::number::{Real, Wide};
use crate::system::{Direction, Lagrangian, Solution, State};

/// Partial derivatives of `R` quantities by the time, `N` coordinates, `N` velocities and `P` parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartialDerivatives<T, const R: usize, const N: usize, const P: usize> {
    /// Derivatives by the time.
    pub t: SVector<T, R>,
    /// Derivatives by the coordinates, one column each.
    pub q: SMatrix<T, R, N>,
    /// Derivatives by the velocities, one column each.
    pub v: SMatrix<T, R, N>,
    /// Derivatives by the parameters, one column each.
    pub parameters: SMatrix<T, R, P>,
}

/// Accelerations and multipliers at a state, with their partial derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jacobian<T, const N: usize, const M: usize, const P: usize> {
    /// Accelerations and multipliers.
    pub solution: Solution<T, N, M>,
    /// Derivatives of the accelerations q̈.
    pub accelerations: PartialDerivatives<T, N, N, P>,
    /// Derivatives of the multipliers λ; if constraints are dependent, the change of least norm.
    pub multipliers: PartialDerivatives<T, M, N, P>,
}

/// See [`StateDerivatives::state_jacobian`].
pub(super) fn state_jacobian<L, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
) -> Result<Jacobian<L::Scalar, N, M, 0>, Error>
where
    L: StateDerivatives<N, M, Scalar: Real>,
{
    let tangent = Tangent::at(system, state)?;
    let mut jacobian = Jacobian::of(tangent.solution);
    jacobian.set_by_state(&tangent)?;
    Ok(jacobian)
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
    let mut jacobian = Jacobian::of(tangent.solution);
    jacobian.set_by_state(&tangent)?;
    let Jacobian { accelerations, multipliers, .. } = &mut jacobian;
    tangent.by_parameters(
        P,
        |k| k,
        |k, change| {
            accelerations.parameters.set_column(k, &change.accelerations);
            multipliers.parameters.set_column(k, &change.multipliers);
        },
    )?;
    Ok(jacobian)
}

impl<T: Real, const N: usize, const M: usize, const P: usize> Jacobian<T, N, M, P> {
    /// A Jacobian with all derivatives zero.
    fn of(solution: Solution<T, N, M>) -> Self {
        Self { solution, accelerations: PartialDerivatives::zero(), multipliers: PartialDerivatives::zero() }
    }

    /// Computes the derivatives by the time and the state in place, because the matrices are large.
    fn set_by_state<L>(&mut self, tangent: &Tangent<'_, L, N, M>) -> Result<(), Error>
    where
        L: StateDerivatives<N, M, Scalar = T>,
    {
        tangent.along_each(1 + 2 * N, put_argument, name_of::<L, N, M>, |k, change| {
            self.accelerations.set(k, &change.accelerations);
            self.multipliers.set(k, &change.multipliers);
        })
    }
}

/// Sets the direction in a lane to the unit vector of argument `k`: 0 is the time, then coordinates, then velocities.
pub(super) fn put_argument<T: Real, W: Wide<T>, const N: usize>(
    k: usize,
    directions: &mut Direction<W, N>,
    lane: usize,
) {
    let one = T::constant(1.0);
    match k.checked_sub(1) {
        None => directions.t.put(lane, one),
        Some(i) if i < N => directions.q[i].put(lane, one),
        Some(i) => directions.v[i - N].put(lane, one),
    }
}

/// Name of argument `k`.
pub(super) fn name_of<L: Lagrangian<N, M>, const N: usize, const M: usize>(k: usize) -> Entry {
    match k.checked_sub(1) {
        None => Entry::Time,
        Some(i) if i < N => Entry::Coordinate(L::COORDINATES[i]),
        Some(i) => Entry::Velocity(L::COORDINATES[i - N]),
    }
}

impl<T: Real, const R: usize, const N: usize, const P: usize> PartialDerivatives<T, R, N, P> {
    fn zero() -> Self {
        Self { t: SMatrix::zeros(), q: SMatrix::zeros(), v: SMatrix::zeros(), parameters: SMatrix::zeros() }
    }

    /// Sets the derivatives by argument `k`.
    fn set(&mut self, k: usize, change: &SVector<T, R>) {
        match k.checked_sub(1) {
            None => self.t = *change,
            Some(i) if i < N => self.q.set_column(i, change),
            Some(i) => self.v.set_column(i - N, change),
        }
    }
}
