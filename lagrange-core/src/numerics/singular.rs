//! Singular value decomposition A = U Σ Vᵀ by one-sided Jacobi rotations (Golub and Van Loan, *Matrix Computations*,
//! 4th edition, 8.6.3).
//!
//! Rotations of pairs of columns make all columns of A V orthogonal; their lengths are the singular values. Works for
//! matrices of every shape and rank: |A − U Σ Vᵀ| is a few round-offs of |A|.

#[cfg(test)]
mod tests;

use alloc::vec::Vec;

use nalgebra::{DMatrix, DVector};

use crate::number::limits::ITERATIONS;
use crate::number::{Real, Scalar, is_within, larger};

/// A singular value decomposition, with the singular values unsorted. Squares of entries must be finite; callers scale
/// columns by their lengths.
pub(crate) struct Singular<T> {
    rows: usize,
    /// A V stacked on V; rotations act on both.
    columns: DMatrix<T>,
    /// Singular values σ, one for each column of A.
    pub(crate) values: Vec<T>,
}

impl<T: Real> Singular<T> {
    /// Decomposes `a`; `None` if an entry is not finite, or if the rotations do not converge.
    pub(crate) fn of(a: &DMatrix<T>) -> Option<Self> {
        if !a.iter().all(|x| x.is_finite()) {
            return None;
        }
        let (rows, count) = a.shape();
        let unit = |i: usize, j: usize| T::constant(if i == j { 1.0 } else { 0.0 });
        let entry = |i: usize, j: usize| if i < rows { a[(i, j)] } else { unit(i - rows, j) };
        let mut it = Self { rows, columns: DMatrix::from_fn(rows + count, count, entry), values: Vec::new() };
        let longest = (0..count).fold(T::constant(0.0), |most, j| larger(most, it.product(j, j)));
        // Columns shorter than round-off of the longest count as zero.
        let negligible = longest * T::constant(T::EPSILON * T::EPSILON);
        (0..ITERATIONS).find(|_| it.sweep(negligible) == 0)?;
        it.values = (0..count).map(|j| Scalar::sqrt(it.product(j, j))).collect();
        Some(it)
    }

    /// Largest singular value.
    pub(crate) fn norm(&self) -> T {
        self.values.iter().fold(T::constant(0.0), |most, x| larger(most, *x))
    }

    /// Entry `j` of the right singular vector v_k.
    pub(crate) fn direction(&self, k: usize, j: usize) -> T {
        self.columns[(self.rows + j, k)]
    }

    /// σ_k u_k·b, the component of b along the left singular vector u_k, times σ_k.
    pub(crate) fn along(&self, k: usize, b: impl Iterator<Item = T>) -> T {
        b.zip(self.columns.column(k).iter())
            .take(self.rows)
            .fold(T::constant(0.0), |sum, (x, y)| sum + x * *y)
    }

    /// The least x with A x = −b, if μ = 0: −Σ_k v_k σ_k (u_k·b)/(σ_k² + μ) over the singular values above `least`. `scaled`
    /// converts entry `j` of a vector in the units of the columns.
    pub(crate) fn step(
        &self,
        b: impl Iterator<Item = T> + Clone,
        (least, damping): (T, T),
        scaled: impl Fn(usize, T) -> T,
    ) -> DVector<T> {
        let mut step = DVector::from_element(self.values.len(), T::constant(0.0));
        for (k, &sigma) in self.values.iter().enumerate().filter(|(_, sigma)| **sigma > least) {
            let length = -self.along(k, b.clone()) / (sigma * sigma + damping);
            (0..step.len()).for_each(|j| step[j] += scaled(j, self.direction(k, j) * length));
        }
        step
    }

    /// Largest magnitude of entry `j` in the right singular vectors whose singular values are at most `least`.
    pub(crate) fn freedom(&self, j: usize, least: T) -> T {
        let free = self.values.iter().enumerate().filter(|(_, sigma)| **sigma <= least);
        free.fold(T::constant(0.0), |most, (k, _)| larger(most, Scalar::abs(self.direction(k, j))))
    }

    /// Scalar product of two columns of A V.
    fn product(&self, p: usize, q: usize) -> T {
        self.along(p, self.columns.column(q).iter().copied())
    }

    /// Rotates all pairs of columns once; returns how many were not yet orthogonal.
    fn sweep(&mut self, negligible: T) -> usize {
        let count = self.columns.ncols();
        let pairs = (0..count).flat_map(|p| (p + 1..count).map(move |q| (p, q)));
        pairs.filter(|&(p, q)| self.rotate(p, q, negligible)).count()
    }

    /// Makes two columns orthogonal by the smaller of the two possible angles. Returns false if they are orthogonal to
    /// round-off already.
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
