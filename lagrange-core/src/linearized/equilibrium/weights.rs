//! Units in which the rows of the search compare.

use nalgebra::{DMatrix, DVector};

use crate::{Real, Scalar};

/// How much more a constraint counts than a force, both in their own units: a search that keeps near the constraints
/// does not end where a rod has shrunk to nothing.
const CONSTRAINTS: f64 = 10.0;

/// What brings the entries of the Jacobian nearest to 1, by their logarithms, with factors for rows and columns: the
/// search then does not depend on units (Curtis and Reid 1972). Times what makes |R| 1. The first `forces` rows are
/// forces, the others constraints.
pub(super) fn weights<T: Real>(jacobian: &DMatrix<T>, residual: &DVector<T>, forces: usize) -> DVector<T> {
    let (zero, one) = (T::constant(0.0), T::constant(1.0));
    let mut rows = DVector::repeat(jacobian.nrows(), zero);
    let mut columns = DVector::repeat(jacobian.ncols(), zero);
    let mean = |entries: &mut dyn Iterator<Item = (T, T)>| {
        let (sum, count) = entries
            .filter(|(entry, _)| *entry != zero)
            .fold((zero, zero), |(sum, count), (x, y)| (sum + Scalar::ln(Scalar::abs(x)) + y, count + one));
        if count > zero { sum / count } else { zero }
    };
    for _ in 0..20 {
        for (j, column) in jacobian.column_iter().enumerate() {
            columns[j] = -mean(&mut column.iter().copied().zip(rows.iter().copied()));
        }
        for (i, row) in jacobian.row_iter().enumerate() {
            rows[i] = -mean(&mut row.iter().copied().zip(columns.iter().copied()));
        }
    }
    let weights = DVector::from_fn(residual.len(), |i, _| {
        Scalar::exp(rows[i]) * T::constant(if i < forces { 1.0 } else { CONSTRAINTS })
    });
    let size = weights.component_mul(residual).norm();
    if size > zero { weights / size } else { weights }
}
