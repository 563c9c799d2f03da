//! Accelerations that complete those of some coordinates on the constraints.

use alloc::vec::Vec;

use nalgebra::{DMatrix, DVector};

use crate::error::Error;
use crate::names::Row;
use crate::number::{Real, Scalar, exceeds, larger, power_of_epsilon, unit_of};
use crate::numerics::singular::Singular;
use crate::solution::consistent;
use crate::solution::solve::first_row;
use crate::system::{Lagrangian, StateOf, finite::check_finite, lookup};
use crate::vector::{StaticLength, Vector};

/// See [`Linearized::complete_accelerations`](crate::linearized::Linearized::complete_accelerations).
pub(crate) fn complete<L: Lagrangian<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
    accelerations: &Vector<L::Scalar, L::N>,
    held: &[&str],
) -> Result<Vector<L::Scalar, L::N>, Error> {
    check_finite(system, state)?;
    consistent::check(system, state)?;
    let held = lookup::indices::<L>(L::COORDINATES, "coordinate", held)?;
    let demands = Demands::at(system, state)?;
    let (mut completed, sought): (_, Vec<usize>) =
        (*accelerations, (0..<L::N>::COUNT).filter(|i| !held.contains(i)).collect());
    sought.iter().for_each(|&i| completed[i] = L::Scalar::constant(0.0));
    let found = demands.solve::<L>(&sought, &completed)?;
    sought.iter().zip(&found).for_each(|(&i, x)| completed[i] = *x);
    demands.check::<L>(&completed)?;
    Ok(completed)
}

/// The rows F q̈ + γ = 0 of all constraints at a state, in units in which rows of F have length 1.
struct Demands<T> {
    f: DMatrix<T>,
    gamma: DVector<T>,
    /// Lengths of the rows of F as they are.
    lengths: DVector<T>,
    time: f64,
}

impl<T: Real> Demands<T> {
    fn at<L: Lagrangian<Scalar = T>>(system: &L, state: &StateOf<L>) -> Result<Self, Error> {
        let (f, gamma, time) =
            (system.constraint_jacobian(state), system.constraint_bias(state), state.t.to_f64());
        let mut f = DMatrix::from_fn(<L::M>::COUNT, <L::N>::COUNT, |a, i| f[(a, i)]);
        let mut gamma = DVector::from_iterator(<L::M>::COUNT, gamma.iter().copied());
        let lengths = DVector::from_fn(<L::M>::COUNT, |a, _| unit_of(f.row(a).norm()));
        for (a, length) in lengths.iter().enumerate() {
            f.row_mut(a).unscale_mut(*length);
            gamma[a] /= *length;
        }
        let is_broken = |a: usize| !(gamma[a].is_finite() && f.row(a).iter().all(|x| x.is_finite()));
        match first_row::<L>(|_| false, is_broken) {
            None => Ok(Self { f, gamma, lengths, time }),
            Some(row) => Err(Error::EquationsNotFinite { row, time }),
        }
    }

    /// F q̈ + γ of each row.
    fn left(&self, accelerations: &[T]) -> DVector<T> {
        &self.f * DVector::from_column_slice(accelerations) + &self.gamma
    }

    /// The accelerations sought, beside these of the others; an error if several satisfy the rows.
    fn solve<L: Lagrangian<Scalar = T>>(
        &self,
        sought: &[usize],
        others: &Vector<T, L::N>,
    ) -> Result<DVector<T>, Error> {
        let left = self.left(others.as_slice());
        // Columns of length 1: the decision does not depend on the units of the coordinates.
        let length = |j: usize| unit_of(self.f.column(sought[j]).norm());
        let columns = DMatrix::from_fn(left.len(), sought.len(), |a, j| self.f[(a, sought[j])] / length(j));
        let factors = Singular::of(&columns).ok_or(Error::EigenvaluesNotFound)?;
        let least = power_of_epsilon::<T>(2.0 / 3.0);
        if let Some(k) = factors.values.iter().position(|sigma| *sigma <= least) {
            let is_free = |j: &usize| Scalar::abs(factors.direction(k, *j)) > power_of_epsilon::<T>(0.5);
            let coordinates = (0..sought.len()).filter(is_free).map(|j| L::COORDINATES[sought[j]]).collect();
            return Err(Error::AccelerationsNotUnique { coordinates, time: self.time });
        }
        Ok(factors.step(left.iter().copied(), (least, T::constant(0.0)), |j, x| x / length(j)))
    }

    /// Requires each row to vanish to √ε of its terms.
    fn check<L: Lagrangian<Scalar = T>>(&self, accelerations: &Vector<T, L::N>) -> Result<(), Error> {
        let left = self.left(accelerations.as_slice());
        for a in 0..left.len() {
            let terms = (0..<L::N>::COUNT).map(|i| Scalar::abs(self.f[(a, i)] * accelerations[i]));
            let most = terms.fold(Scalar::abs(self.gamma[a]), larger);
            if exceeds(Scalar::abs(left[a]), power_of_epsilon::<T>(0.5) * most) {
                let (row, residual) =
                    (Row::Constraint(L::CONSTRAINTS[a]), (left[a] * self.lengths[a]).to_f64());
                return Err(Error::NotRealizable { row, residual, time: self.time });
            }
        }
        Ok(())
    }
}
