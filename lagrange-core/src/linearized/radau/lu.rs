//! LU factorization with partial pivoting, for real and complex matrices.

use nalgebra::ComplexField;

use crate::room::Room;
use crate::vector::{Array, Element, Length};

/// L without its diagonal of ones, U, and the row that was exchanged with each row.
pub(super) struct Lu<F: Element, N: Length> {
    rows: Room<Array<Array<F, N>, N>>,
    exchanged: Array<usize, N>,
}

impl<F: ComplexField + Element, N: Length> Lu<F, N> {
    /// Factorizes a matrix, given row by row; `None` if it is singular or not finite (Golub and Van Loan, *Matrix
    /// Computations*, algorithm 3.4.1).
    pub(super) fn of(mut rows: Room<Array<Array<F, N>, N>>) -> Option<Self> {
        let mut exchanged = Array::filled(0);
        for k in 0..N::COUNT {
            let size = |i: usize, rows: &Array<Array<F, N>, N>| rows[i][k].norm1();
            let pivot =
                (k..N::COUNT).fold(k, |best, i| if size(i, &rows) > size(best, &rows) { i } else { best });
            exchanged[k] = pivot;
            rows.swap(k, pivot);
            let diagonal = rows[k][k];
            if diagonal == F::zero() || !diagonal.is_finite() {
                return None;
            }
            let row = rows[k];
            for i in k + 1..N::COUNT {
                let factor = rows[i][k] / diagonal;
                rows[i][k] = factor;
                for j in k + 1..N::COUNT {
                    rows[i][j] -= factor * row[j];
                }
            }
        }
        Some(Self { rows, exchanged })
    }

    /// Solves the equations with this right-hand side.
    pub(super) fn solve(&self, mut x: Array<F, N>) -> Array<F, N> {
        for k in 0..N::COUNT {
            x.swap(k, self.exchanged[k]);
        }
        for k in 0..N::COUNT {
            for j in 0..k {
                let known = x[j];
                x[k] -= self.rows[k][j] * known;
            }
        }
        for k in (0..N::COUNT).rev() {
            for j in k + 1..N::COUNT {
                let known = x[j];
                x[k] -= self.rows[k][j] * known;
            }
            x[k] /= self.rows[k][k];
        }
        x
    }
}
