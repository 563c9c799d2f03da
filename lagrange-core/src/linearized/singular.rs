//! The singular value decomposition A = U Σ Vᵀ by one-sided Jacobi rotations (Golub and Van Loan, *Matrix Computations*,
//! 4th edition, 8.6.3).
//!
//! Rotations of pairs of columns make all columns of A V orthogonal; their lengths are the singular values. Matrices of
//! every shape and rank have their decomposition: |A − U Σ Vᵀ| is a few round-offs of |A|.

#[cfg(test)]
mod tests;

use alloc::vec::Vec;

use nalgebra::DMatrix;

use crate::number::{Real, Scalar, is_within, larger};

/// Passes over all pairs of columns, as in LAPACK's `dgesvj`. Ten are usual.
const SWEEPS: usize = 30;

/// A singular value decomposition, in no order. The squares of entries must be numbers: columns come in units of their lengths.
pub(super) struct Singular<T> {
    rows: usize,
    /// A V above V: both rotate alike.
    columns: DMatrix<T>,
    /// The singular values σ, one for each column of A.
    pub(super) values: Vec<T>,
}

impl<T: Real> Singular<T> {
    /// The decomposition; none where an entry is not finite, or the rotations do not come to an end.
    pub(super) fn of(a: &DMatrix<T>) -> Option<Self> {
        if !a.iter().all(|x| x.is_finite()) {
            return None;
        }
        let (rows, count) = a.shape();
        let unit = |i: usize, j: usize| T::constant(if i == j { 1.0 } else { 0.0 });
        let entry = |i: usize, j: usize| if i < rows { a[(i, j)] } else { unit(i - rows, j) };
        let mut it = Self { rows, columns: DMatrix::from_fn(rows + count, count, entry), values: Vec::new() };
        let longest = (0..count).fold(T::constant(0.0), |most, j| larger(most, it.product(j, j)));
        // What is shorter by a round-off does not count.
        let negligible = longest * T::constant(T::EPSILON * T::EPSILON);
        (0..SWEEPS).find(|_| it.sweep(negligible) == 0)?;
        it.values = (0..count).map(|j| Scalar::sqrt(it.product(j, j))).collect();
        Some(it)
    }

    /// The largest singular value.
    pub(super) fn norm(&self) -> T {
        self.values.iter().fold(T::constant(0.0), |most, x| larger(most, *x))
    }

    /// Entry `j` of v_k.
    pub(super) fn direction(&self, k: usize, j: usize) -> T {
        self.columns[(self.rows + j, k)]
    }

    /// σ_k u_k·b
    pub(super) fn along(&self, k: usize, b: impl Iterator<Item = T>) -> T {
        b.zip(self.columns.column(k).iter())
            .take(self.rows)
            .fold(T::constant(0.0), |sum, (x, y)| sum + x * *y)
    }

    /// The scalar product of two columns of A V.
    fn product(&self, p: usize, q: usize) -> T {
        self.along(p, self.columns.column(q).iter().copied())
    }

    /// Makes each pair of columns orthogonal, one after the other; how many were not.
    fn sweep(&mut self, negligible: T) -> usize {
        let count = self.columns.ncols();
        let pairs = (0..count).flat_map(|p| (p + 1..count).map(move |q| (p, q)));
        pairs.filter(|&(p, q)| self.rotate(p, q, negligible)).count()
    }

    /// Makes two columns orthogonal by the smaller of the two angles that do, unless they are to round-off.
    fn rotate(&mut self, p: usize, q: usize, negligible: T) -> bool {
        let [a, b, c] = [(p, p), (q, q), (p, q)].map(|(p, q)| self.product(p, q));
        let round_off = T::constant(T::EPSILON * self.rows as f64);
        if is_within(Scalar::abs(c), round_off * Scalar::sqrt(a * b)) || a <= negligible || b <= negligible {
            return false;
        }
        let one = T::constant(1.0);
        let cotangent = (b - a) / (c + c);
        let part = one / (Scalar::abs(cotangent) + Scalar::sqrt(one + cotangent * cotangent));
        let tangent = if cotangent < T::constant(0.0) { -part } else { part };
        let cosine = one / Scalar::sqrt(one + tangent * tangent);
        for i in 0..self.columns.nrows() {
            let [x, y] = [p, q].map(|j| self.columns[(i, j)]);
            self.columns[(i, p)] = cosine * (x - tangent * y);
            self.columns[(i, q)] = cosine * (y + tangent * x);
        }
        true
    }
}
