//! Jacobian of the accelerations and multipliers.

use nalgebra::Const;

use super::tangent::Tangent;
use super::{Linearized, StateDerivatives};
use crate::error::Error;
use crate::names::Entry;
use crate::number::Real;
use crate::system::{Lagrangian, Solution, StateOf, entry};
use crate::vector::{Array, Element, Matrix, StaticLength, Vector, matrix, zeros};

/// Partial derivatives of `R` quantities by the time, `N` coordinates, `N` velocities and `P` parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartialDerivatives<T: Element, R: StaticLength, N: StaticLength, P: StaticLength> {
    /// Derivatives by the time.
    pub t: Vector<T, R>,
    /// Derivatives by the coordinates, one column each.
    pub q: Matrix<T, R, N>,
    /// Derivatives by the velocities, one column each.
    pub v: Matrix<T, R, N>,
    /// Derivatives by the parameters, one column each.
    pub parameters: Matrix<T, R, P>,
}

/// Accelerations and multipliers at a state, with their partial derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jacobian<T: Element, N: StaticLength, M: StaticLength, P: StaticLength> {
    /// Accelerations and multipliers.
    pub solution: Solution<T, N, M>,
    /// Derivatives of the accelerations q̈.
    pub accelerations: PartialDerivatives<T, N, N, P>,
    /// Derivatives of the multipliers λ; if constraints are dependent, the change of least norm in units in which the rows of F have length 1.
    pub multipliers: PartialDerivatives<T, M, N, P>,
}

/// See [`StateDerivatives::state_jacobian`].
pub(crate) fn state_jacobian<L: StateDerivatives<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
) -> Result<Jacobian<L::Scalar, L::N, L::M, Const<0>>, Error> {
    let tangent = Tangent::at(system, state)?;
    let mut jacobian = Jacobian::of(tangent.solution);
    jacobian.set_by_state(&tangent)?;
    Ok(jacobian)
}

/// See [`Linearized::jacobian`].
pub(crate) fn jacobian<L: Linearized<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
) -> Result<Jacobian<L::Scalar, L::N, L::M, L::P>, Error> {
    let tangent = Tangent::at(system, state)?;
    let mut jacobian = Jacobian::of(tangent.solution);
    jacobian.set_by_state(&tangent)?;
    let Jacobian { accelerations, multipliers, .. } = &mut jacobian;
    tangent.by_parameters(
        <L::P>::COUNT,
        |k| k,
        |k, change| {
            accelerations.parameters.set_column(k, &change.accelerations);
            multipliers.parameters.set_column(k, &change.multipliers);
        },
    )?;
    Ok(jacobian)
}

impl<T: Real, N: StaticLength, M: StaticLength, P: StaticLength> Jacobian<T, N, M, P> {
    /// A Jacobian with all derivatives zero.
    fn of(solution: Solution<T, N, M>) -> Self {
        Self { solution, accelerations: PartialDerivatives::zero(), multipliers: PartialDerivatives::zero() }
    }

    /// Computes the derivatives by the time and the state in place, because the matrices are large.
    fn set_by_state<L: StateDerivatives<N = N, M = M, Scalar = T>>(
        &mut self,
        tangent: &Tangent<'_, L>,
    ) -> Result<(), Error> {
        tangent.by_arguments(0..1 + 2 * N::COUNT, |k, change| {
            self.accelerations.set(k, &change.accelerations);
            self.multipliers.set(k, &change.multipliers);
        })
    }
}

/// Name of argument `k`.
pub(crate) fn name_of<L: Lagrangian>(k: usize) -> Entry {
    k.checked_sub(1).map_or(Entry::Time, entry::<L>)
}

impl<T: Real, R: StaticLength, N: StaticLength, P: StaticLength> PartialDerivatives<T, R, N, P> {
    fn zero() -> Self {
        fn columns<T: Real, R: StaticLength, C: StaticLength>() -> Matrix<T, R, C> {
            matrix(Array::filled(Array::filled(T::constant(0.0))))
        }
        Self { t: zeros(), q: columns(), v: columns(), parameters: columns() }
    }

    /// Sets the derivatives by argument `k`.
    fn set(&mut self, k: usize, change: &Vector<T, R>) {
        match k.checked_sub(1) {
            None => self.t = *change,
            Some(i) if i < N::COUNT => self.q.set_column(i, change),
            Some(i) => self.v.set_column(i - N::COUNT, change),
        }
    }
}
