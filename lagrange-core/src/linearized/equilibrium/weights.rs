//! Weights that make the rows of the equilibrium search comparable.

use nalgebra::{DMatrix, DVector};

use crate::linearized::limits::CONSTRAINTS;
use crate::number::limits::ITERATIONS;
use crate::number::{Real, Scalar};

/// Weights of the rows. Factors for rows and columns bring the entries of the Jacobian nearest to 1, in a least-squares
/// sense of their logarithms (Curtis and Reid 1972), so that the search does not depend on units. A common factor makes
/// the weighted |R| 1. The first `forces` rows are forces, the others constraints.
pub(super) fn weights<T: Real>(jacobian: &DMatrix<T>, residual: &DVector<T>, forces: usize) -> DVector<T> {
    let zero = T::constant(0.0);
    let mut rows = DVector::repeat(jacobian.nrows(), zero);
    let mut columns = DVector::repeat(jacobian.ncols(), zero);
    for _ in 0..ITERATIONS {
        for (j, column) in jacobian.column_iter().enumerate() {
            columns[j] = -mean(column.iter().zip(&rows));
        }
        for (i, row) in jacobian.row_iter().enumerate() {
            rows[i] = -mean(row.iter().zip(&columns));
        }
    }
    let weights = DVector::from_fn(residual.len(), |i, _| {
        Scalar::exp(rows[i]) * T::constant(if i < forces { 1.0 } else { CONSTRAINTS })
    });
    let size = weights.component_mul(residual).norm();
    if size > zero { weights / size } else { weights }
}

/// Mean of ln |x| + y over the pairs with x ≠ 0; zero if there are none.
fn mean<'a, T: Real>(pairs: impl Iterator<Item = (&'a T, &'a T)>) -> T {
    let (zero, one) = (T::constant(0.0), T::constant(1.0));
    let (sum, count) = pairs
        .filter(|(x, _)| **x != zero)
        .fold((zero, zero), |(sum, count), (x, y)| (sum + Scalar::ln(Scalar::abs(*x)) + *y, count + one));
    if count > zero { sum / count } else { zero }
}
