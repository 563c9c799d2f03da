//! Residual of the equilibrium equations at one point of the search, and its derivatives.

use nalgebra::{ComplexField, DMatrix, DVector, SVector};

use crate::error::Error;
use crate::linearized::Linearized;
use crate::linearized::argument::Argument;
use crate::names::Row;
use crate::number::{Real, Scalar, vector};
use crate::system::{Lagrangian, ResidualChange, Solution, State};

/// Values of the unknowns: parameters of the system, state and multipliers.
#[derive(Clone)]
pub(super) struct Point<L: Lagrangian<N, M>, const N: usize, const M: usize, const P: usize> {
    pub(super) system: L,
    pub(super) state: State<L::Scalar, N>,
    pub(super) multipliers: SVector<L::Scalar, M>,
}

impl<L, const N: usize, const M: usize, const P: usize> Point<L, N, M, P>
where
    L: Linearized<N, M, P, Scalar: Real>,
{
    /// Residual R, with the rows of the motion first.
    pub(super) fn residual(&self) -> DVector<L::Scalar> {
        let Self { system, state, multipliers } = self;
        let motion = -(system.forcing(state) + system.constraint_force(state, multipliers));
        stacked(&ResidualChange {
            motion,
            acceleration: system.constraint_bias(state),
            rate: system.constraint_rate(state),
            position: system.constraint_residual(state),
        })
    }

    /// Derivatives of R by the unknowns, followed by those by the multipliers.
    pub(super) fn jacobian(&self, unknowns: &[Argument]) -> DMatrix<L::Scalar> {
        let mut jacobian = DMatrix::zeros(N + 3 * M, unknowns.len() + M);
        let multipliers = self.multipliers;
        let zero = vector([L::Scalar::constant(0.0); N]);
        let still = Solution { accelerations: zero, multipliers, pivot: L::Scalar::constant(1.0), rank: M };
        for (j, &unknown) in unknowns.iter().enumerate() {
            let change = unknown.residual_change(&self.system, &self.state, &still);
            jacobian.set_column(j, &stacked(&change));
        }
        let f = self.system.constraint_jacobian(&self.state);
        jacobian.view_mut((0, unknowns.len()), (N, M)).copy_from(&-f.transpose());
        jacobian
    }

    /// Fails at the first derivative by an unknown that is not finite, and names it.
    pub(super) fn check_derivatives(
        &self,
        jacobian: &DMatrix<L::Scalar>,
        unknowns: &[Argument],
    ) -> Result<(), Error> {
        for (&unknown, column) in unknowns.iter().zip(jacobian.column_iter()) {
            if let Some(i) = column.iter().position(|x| !x.is_finite()) {
                let (row, entry) = (row::<L, N, M>(i), unknown.entry::<L, N, M, P>());
                return Err(Error::DerivativeNotFinite { row, entry, time: self.state.t.to_f64() });
            }
        }
        Ok(())
    }

    /// Value of an unknown.
    pub(super) fn value(&self, unknown: Argument) -> L::Scalar {
        match unknown {
            Argument::Coordinate(i) => self.state.q[i],
            Argument::Velocity(i) => self.state.v[i],
            Argument::Parameter(k) => self.system.parameters()[k],
        }
    }

    /// Sets an unknown; returns false if it is a parameter that cannot be changed.
    pub(super) fn set(&mut self, unknown: Argument, value: L::Scalar) -> bool {
        match unknown {
            Argument::Coordinate(i) => self.state.q[i] = value,
            Argument::Velocity(i) => self.state.v[i] = value,
            Argument::Parameter(k) => return self.system.set_parameter(k, value),
        }
        true
    }
}

fn stacked<T: Real, const N: usize, const M: usize>(residual: &ResidualChange<T, N, M>) -> DVector<T> {
    let ResidualChange { motion, acceleration, rate, position } = residual;
    let rows = motion.iter().chain(acceleration).chain(rate).chain(position);
    DVector::from_iterator(N + 3 * M, rows.copied())
}

/// Coordinate or constraint that row `i` of R belongs to.
pub(super) fn row<L: Lagrangian<N, M>, const N: usize, const M: usize>(i: usize) -> Row {
    if i < N { Row::Coordinate(L::COORDINATES[i]) } else { Row::Constraint(L::CONSTRAINTS[(i - N) % M]) }
}
