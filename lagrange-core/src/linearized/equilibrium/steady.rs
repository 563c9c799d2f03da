//! Checks that a motion with q̈ = 0 stays one: the equations must not change as the moving coordinates change.

use alloc::vec::Vec;

use nalgebra::DMatrix;

use super::point::Point;
use crate::error::Error;
use crate::linearized::Linearized;
use crate::linearized::argument::Argument;
use crate::number::{Real, Scalar, larger, power_of_epsilon};
use crate::solution::solve::row;
use crate::vector::StaticLength;

/// Contributions of the moving coordinates (q̇ᵢ ≠ 0), one per column, to the time derivative of the residuals (M q̈ −
/// h − Fᵀλ, F q̈ + γ) at q̈ = 0. If γ stays zero, so do F q̇ + b and Φ.
pub(super) struct Unsteadiness<T> {
    moving: Vec<usize>,
    columns: DMatrix<T>,
}

impl<T: Real> Unsteadiness<T> {
    fn terms(&self, row: usize) -> T {
        self.columns.row(row).iter().fold(T::constant(0.0), |sum, x| sum + Scalar::abs(*x))
    }
}

impl<L: Linearized<Scalar: Real>> Point<L> {
    pub(super) fn unsteadiness(&self) -> Result<Unsteadiness<L::Scalar>, Error> {
        let v = &self.state.v;
        let moving: Vec<usize> = (0..<L::N>::COUNT).filter(|&i| v[i] != L::Scalar::constant(0.0)).collect();
        let coordinates: Vec<_> = moving.iter().copied().map(Argument::Coordinate).collect();
        let jacobian = self.jacobian(&coordinates);
        self.check_derivatives(&jacobian, &coordinates)?;
        let mut columns = jacobian.view((0, 0), (<L::N>::COUNT + <L::M>::COUNT, moving.len())).into_owned();
        for (mut column, &i) in columns.column_iter_mut().zip(&moving) {
            column.scale_mut(v[i]);
        }
        Ok(Unsteadiness { moving, columns })
    }

    /// Checks that each residual has a time derivative of zero: the contributions in its row must cancel. Their
    /// sum may be at most √ε times the sum of their magnitudes, at this point or at the guess, whichever is larger.
    pub(super) fn check_steady(&self, guess: &Unsteadiness<L::Scalar>) -> Result<(), Error> {
        let here = self.unsteadiness()?;
        let part = power_of_epsilon::<L::Scalar>(0.5);
        let changes = |i: &usize| {
            let terms = larger(here.terms(*i), guess.terms(*i));
            Scalar::abs(here.columns.row(*i).sum()) > part * terms
        };
        match (0..<L::N>::COUNT + <L::M>::COUNT).find(changes) {
            None => Ok(()),
            Some(i) => {
                let most = here.moving[here.columns.row(i).transpose().icamax()];
                let (coordinate, time) = (L::COORDINATES[most], self.state.t.to_f64());
                Err(Error::NotSteady { coordinate, row: row::<L>(i), time })
            }
        }
    }
}
