//! Rank-revealing Householder QR with column pivoting.

use crate::number::{Real, Scalar, dot, norm, power_of_two};
use crate::vector::{Array, Element, StaticLength, from_fn};

/// Factorization A P = Q R of a K×C matrix A (Golub and Van Loan, *Matrix Computations*, 5.4.2).
pub(crate) struct Qr<T: Element, K: StaticLength, C: StaticLength> {
    /// Columns of R, in pivoted order.
    r: Array<Array<T, K>, C>,
    /// Reflection k is I − v vᵀ with v = `reflectors[k]`, which is zero above entry k.
    reflectors: Array<Array<T, K>, C>,
    /// For each column of R, the index of its column of A.
    pub(crate) order: Array<usize, C>,
    /// Number of independent columns.
    pub(crate) rank: usize,
}

impl<T: Real, K: StaticLength, C: StaticLength> Qr<T, K, C> {
    /// Factorizes the matrix with these columns; a remainder up to `tolerance` counts as zero.
    pub(crate) fn of(columns: Array<Array<T, K>, C>, tolerance: T) -> Self {
        let zero = T::constant(0.0);
        let mut qr = Self {
            r: columns,
            reflectors: Array::filled(Array::filled(zero)),
            order: from_fn(|j| j),
            rank: 0,
        };
        for k in 0..K::COUNT.min(C::COUNT) {
            let (longest, length) = qr.longest_remainder(k);
            if length <= tolerance {
                break;
            }
            qr.r.swap(k, longest);
            qr.order.swap(k, longest);
            qr.eliminate(k, length);
            qr.rank = k + 1;
        }
        qr
    }

    fn longest_remainder(&self, k: usize) -> (usize, T) {
        let mut best = (k, T::constant(0.0));
        for j in k..C::COUNT {
            let length = norm(&self.r[j][k..]);
            if length > best.1 {
                best = (j, length);
            }
        }
        best
    }

    fn eliminate(&mut self, k: usize, length: T) {
        let zero = T::constant(0.0);
        let head = self.r[k][k];
        let diagonal = if head > zero { -length } else { length };
        // vᵀv = 2 ‖x‖ (‖x‖ + |x₀|) for v = x − diagonal·e₀; scaled to vᵀv = 2.
        let (unit, sum) = (power_of_two(length), length + Scalar::abs(head));
        let scale = T::constant(1.0) / (Scalar::sqrt(length / unit * (sum / unit)) * unit);
        let v = &mut self.reflectors[k];
        v[k] = (head - diagonal) * scale;
        for (entry, x) in v.iter_mut().zip(&self.r[k]).skip(k + 1) {
            *entry = *x * scale;
        }
        self.r[k][k] = diagonal;
        for j in k + 1..C::COUNT {
            reflect(&self.reflectors[k], &mut self.r[j], k);
        }
    }

    /// Replaces x by Qᵀ x.
    pub(crate) fn enter_basis(&self, x: &mut Array<T, K>) {
        for k in 0..self.rank {
            reflect(&self.reflectors[k], x, k);
        }
    }

    /// Replaces x by Q x.
    pub(crate) fn leave_basis(&self, x: &mut Array<T, K>) {
        for k in (0..self.rank).rev() {
            reflect(&self.reflectors[k], x, k);
        }
    }

    /// Returns the entry of R in this row and (pivoted) column.
    pub(crate) fn entry(&self, row: usize, column: usize) -> T {
        self.r[column][row]
    }

    /// Returns the length of the part of this (pivoted) column that is orthogonal to the independent columns.
    pub(crate) fn remainder(&self, column: usize) -> T {
        norm(&self.r[column][self.rank..])
    }

    /// Returns the coefficients of the columns of A whose sum is that orthogonal part, in the order of A: 1 for
    /// the column itself.
    pub(crate) fn combination(&self, column: usize) -> Array<T, C> {
        let mut parts = self.solve(&self.r[column]).map(|x| -x);
        parts[self.order[column]] = T::constant(1.0);
        parts
    }

    /// Returns y with Rᵀ y = c in the first `rank` rows, zero beyond; c is in the order of the columns of A.
    pub(crate) fn solve_transposed(&self, c: &Array<T, C>) -> Array<T, K> {
        let mut y = Array::filled(T::constant(0.0));
        for i in 0..self.rank {
            let known = dot(&self.r[i][..i], &y[..i]);
            y[i] = (c[self.order[i]] - known) / self.r[i][i];
        }
        y
    }

    /// Returns x with A x = Q y for y in the range; x is in the order of the columns of A, and zero for
    /// dependent columns.
    pub(crate) fn solve(&self, y: &Array<T, K>) -> Array<T, C> {
        let mut y = *y;
        let mut x = Array::filled(T::constant(0.0));
        for i in (0..self.rank).rev() {
            let value = y[i] / self.r[i][i];
            for (entry, r) in y.iter_mut().zip(&self.r[i]).take(i) {
                *entry -= *r * value;
            }
            x[self.order[i]] = value;
        }
        x
    }
}

fn reflect<T: Real>(v: &[T], x: &mut [T], k: usize) {
    let along = dot(&v[k..], &x[k..]);
    for (entry, v) in x.iter_mut().zip(v).skip(k) {
        *entry -= *v * along;
    }
}
