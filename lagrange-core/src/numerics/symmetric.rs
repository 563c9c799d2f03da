//! Factorization of a symmetric matrix, definite or indefinite.

use crate::number::{Real, Scalar, smaller};
use crate::vector::{Array, Element, StaticLength, from_fn};

/// Factorization P A Pᵀ = L D Lᵀ of a symmetric matrix of order `size` ≤ N. D has 1×1 and 2×2 blocks, by
/// complete pivoting (Bunch and Parlett 1971; Golub and Van Loan, *Matrix Computations*, 4.4.4).
///
/// In a positive definite matrix the largest entry is on the diagonal, so this is Cholesky's method with
/// pivoting.
pub(crate) struct Symmetric<T: Element, N: StaticLength> {
    size: usize,
    /// L below the diagonal (or the 2×2 block), D on it.
    a: Array<Array<T, N>, N>,
    order: Array<usize, N>,
    /// True where a 2×2 block of D starts.
    pair: Array<bool, N>,
    pub(crate) rank: usize,
    /// Smallest pivot, as the magnitude that selected it.
    pub(crate) smallest: T,
}

impl<T: Real, N: StaticLength> Symmetric<T, N> {
    /// Factorizes the leading block of order `size`; a remainder with no entry above `tolerance` counts as
    /// zero.
    pub(crate) fn of(a: Array<Array<T, N>, N>, size: usize, tolerance: T) -> Self {
        let smallest = T::constant(f64::MAX);
        let mut f = Self { size, a, order: from_fn(|i| i), pair: Array::filled(false), rank: 0, smallest };
        let growth = T::constant(0.640_388_203_202_208); // (1 + √17)/8
        while f.rank < size {
            let k = f.rank;
            let ([p, q], largest, on_diagonal, largest_on_diagonal) = f.largest_entries(k);
            if largest <= tolerance {
                break;
            }
            f.smallest = smaller(f.smallest, largest);
            if largest_on_diagonal >= growth * largest {
                f.swap(k, on_diagonal);
                f.eliminate_one(k);
                f.rank += 1;
            } else {
                f.swap(k, q);
                f.swap(k + 1, p);
                f.eliminate_two(k);
                f.rank += 2;
            }
        }
        f
    }

    /// Returns the position [row, column] (row > column) and the size of the largest entry, and those of the
    /// largest diagonal entry.
    fn largest_entries(&self, k: usize) -> ([usize; 2], T, usize, T) {
        let zero = T::constant(0.0);
        let (mut place, mut largest) = ([k, k], zero);
        let (mut diagonal, mut largest_diagonal) = (k, zero);
        for i in k..self.size {
            for j in k..=i {
                let x = Scalar::abs(self.a[i][j]);
                if x > largest {
                    (place, largest) = ([i, j], x);
                }
                if i == j && x > largest_diagonal {
                    (diagonal, largest_diagonal) = (i, x);
                }
            }
        }
        (place, largest, diagonal, largest_diagonal)
    }

    fn swap(&mut self, k: usize, p: usize) {
        self.order.swap(k, p);
        self.a.swap(k, p);
        for row in self.a.iter_mut().take(self.size).skip(self.rank) {
            row.swap(k, p);
        }
    }

    fn eliminate_one(&mut self, k: usize) {
        for i in k + 1..self.size {
            let l = self.a[i][k] / self.a[k][k];
            for j in k + 1..self.size {
                let change = l * self.a[k][j];
                self.a[i][j] -= change;
            }
            self.a[i][k] = l;
        }
    }

    fn eliminate_two(&mut self, k: usize) {
        self.pair[k] = true;
        for i in k + 2..self.size {
            let [l0, l1] = self.solve_pair(k, [self.a[i][k], self.a[i][k + 1]]);
            for j in k + 2..self.size {
                let change = l0 * self.a[k][j] + l1 * self.a[k + 1][j];
                self.a[i][j] -= change;
            }
            (self.a[i][k], self.a[i][k + 1]) = (l0, l1);
        }
    }

    /// Multiplies x by the inverse of the 2×2 block at k. Its off-diagonal entry b is the largest, so dividing
    /// by it is safe.
    fn solve_pair(&self, k: usize, x: [T; 2]) -> [T; 2] {
        let b = self.a[k + 1][k];
        let (a, c) = (self.a[k][k] / b, self.a[k + 1][k + 1] / b);
        let determinant = (a * c - T::constant(1.0)) * b;
        [(c * x[0] - x[1]) / determinant, (a * x[1] - x[0]) / determinant]
    }

    /// Returns A⁻¹ b for a matrix of full rank; entries of `b` beyond `size` are ignored.
    pub(crate) fn solve(&self, b: &Array<T, N>) -> Array<T, N> {
        let mut x = Array::filled(T::constant(0.0));
        for i in 0..self.size {
            x[i] = b[self.order[i]];
            for j in 0..self.block_start(i) {
                let change = self.a[i][j] * x[j];
                x[i] -= change;
            }
        }
        let mut k = 0;
        while k < self.size {
            if self.pair[k] {
                [x[k], x[k + 1]] = self.solve_pair(k, [x[k], x[k + 1]]);
                k += 2;
            } else {
                x[k] /= self.a[k][k];
                k += 1;
            }
        }
        self.back_substitute(x)
    }

    /// Returns the null vector of the `index`-th dependent row (`rank + index < size`).
    pub(crate) fn null_vector(&self, index: usize) -> Array<T, N> {
        let mut x = Array::filled(T::constant(0.0));
        x[self.rank + index] = T::constant(1.0);
        self.back_substitute(x)
    }

    /// Returns a vector x with xᵀ A x < 0, if there is one. Every 2×2 block of D has one, since its
    /// off-diagonal entry is the largest.
    pub(crate) fn negative(&self) -> Option<Array<T, N>> {
        let (zero, one) = (T::constant(0.0), T::constant(1.0));
        let starts = (0..self.rank).filter(|&k| self.block_start(k) == k);
        let k = { starts }.find(|&k| self.pair[k] || self.a[k][k] < zero)?;
        let mut x = Array::filled(zero);
        x[k] = one;
        if self.pair[k] {
            x[k + 1] = if self.a[k + 1][k] > zero { -one } else { one };
        }
        Some(self.back_substitute(x))
    }

    /// Returns Pᵀ L⁻ᵀ x.
    fn back_substitute(&self, mut x: Array<T, N>) -> Array<T, N> {
        let mut y = Array::filled(T::constant(0.0));
        for i in (0..self.size).rev() {
            for j in 0..self.block_start(i).min(self.rank) {
                let change = self.a[i][j] * x[i];
                x[j] -= change;
            }
            y[self.order[i]] = x[i];
        }
        y
    }

    fn block_start(&self, i: usize) -> usize {
        if i > 0 && self.pair[i - 1] { i - 1 } else { i }
    }
}
