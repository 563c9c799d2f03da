//! Residual of the equilibrium equations at one point of the search, and its derivatives.

use nalgebra::{ComplexField, DMatrix, DVector};

use crate::error::Error;
use crate::linearized::Linearized;
use crate::linearized::argument::Argument;
use crate::number::Real;
use crate::solution::solve::row;
use crate::system::{ResidualChange, Solution, StateOf};
use crate::vector::{Entrywise, StaticLength, Vector, zeros};

/// Values of the unknowns: parameters of the system, state and multipliers.
#[derive(Clone)]
pub(super) struct Point<L: Linearized> {
    pub(super) system: L,
    pub(super) state: StateOf<L>,
    pub(super) multipliers: Vector<L::Scalar, L::M>,
}

impl<L: Linearized<Scalar: Real>> Point<L> {
    /// Residual R, with the rows of the motion first.
    pub(super) fn residual(&self) -> DVector<L::Scalar> {
        let Self { system, state, multipliers } = self;
        let motion = system
            .forcing(state)
            .each_with(&system.constraint_force(state, multipliers), |h, force| -(h + force));
        stacked(&ResidualChange {
            motion,
            acceleration: system.constraint_bias(state),
            rate: system.constraint_rate(state),
            position: system.constraint_residual(state),
        })
    }

    /// Derivatives of R by the unknowns, followed by those by the multipliers.
    pub(super) fn jacobian(&self, unknowns: &[Argument]) -> DMatrix<L::Scalar> {
        let mut jacobian = DMatrix::zeros(<L::N>::COUNT + 3 * <L::M>::COUNT, unknowns.len() + <L::M>::COUNT);
        let still = Solution::given(zeros(), self.multipliers);
        for (j, &unknown) in unknowns.iter().enumerate() {
            let change = unknown.residual_change(&self.system, &self.state, &still);
            jacobian.set_column(j, &stacked(&change));
        }
        let f = self.system.constraint_jacobian(&self.state);
        for i in 0..<L::N>::COUNT {
            for a in 0..<L::M>::COUNT {
                jacobian[(i, unknowns.len() + a)] = -f[(a, i)];
            }
        }
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
                let (row, entry) = (row::<L>(i), unknown.entry::<L>());
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

    /// Sets an unknown.
    pub(super) fn set(&mut self, unknown: Argument, value: L::Scalar) {
        match unknown {
            Argument::Coordinate(i) => self.state.q[i] = value,
            Argument::Velocity(i) => self.state.v[i] = value,
            Argument::Parameter(k) => {
                self.system.set_parameter(k, value);
            }
        }
    }
}

fn stacked<T: Real, N: StaticLength, M: StaticLength>(residual: &ResidualChange<T, N, M>) -> DVector<T> {
    let ResidualChange { motion, acceleration, rate, position } = residual;
    let rows = motion.iter().chain(acceleration).chain(rate).chain(position);
    DVector::from_iterator(N::COUNT + 3 * M::COUNT, rows.copied())
}
