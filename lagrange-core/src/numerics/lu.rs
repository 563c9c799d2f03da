//! LU factorization with partial pivoting, for real and complex matrices.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::{Deref, DerefMut};

use nalgebra::ComplexField;

use crate::vector::{Array, Element, StaticLength};

/// N rows, or columns, of N entries, on the heap: they are never on the stack together.
#[derive(Clone)]
pub(crate) struct Square<F: Element, N: StaticLength>(Vec<Array<F, N>>);

impl<F: Element, N: StaticLength> Square<F, N> {
    pub(crate) fn filled(x: F) -> Self {
        Self(vec![Array::filled(x); N::COUNT])
    }
}

impl<F: Element, N: StaticLength> Deref for Square<F, N> {
    type Target = [Array<F, N>];

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<F: Element, N: StaticLength> DerefMut for Square<F, N> {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.0
    }
}

/// L without its diagonal of ones, U, and the row that was exchanged with each row.
#[derive(Clone)]
pub(crate) struct Lu<F: Element, N: StaticLength> {
    rows: Square<F, N>,
    exchanged: Array<usize, N>,
}

impl<F: ComplexField + Element, N: StaticLength> Lu<F, N> {
    pub(crate) fn new() -> Self {
        Self { rows: Square::filled(F::zero()), exchanged: Array::filled(0) }
    }

    /// Factorizes a matrix, given by its entries; false if it is singular or not finite (Golub and Van Loan, *Matrix
    /// Computations*, algorithm 3.4.1).
    pub(crate) fn factorize(&mut self, entry: impl Fn(usize, usize) -> F) -> bool {
        let Self { rows, exchanged } = self;
        for (i, row) in rows.iter_mut().enumerate() {
            row.iter_mut().enumerate().for_each(|(j, x)| *x = entry(i, j));
        }
        for k in 0..N::COUNT {
            let size = |i: usize| rows[i][k].norm1();
            let pivot = (k..N::COUNT).fold(k, |best, i| if size(i) > size(best) { i } else { best });
            exchanged[k] = pivot;
            rows.swap(k, pivot);
            let (above, below) = rows.split_at_mut(k + 1);
            let row = &above[k];
            if row[k] == F::zero() || !row[k].is_finite() {
                return false;
            }
            for other in below {
                let factor = other[k] / row[k];
                other[k] = factor;
                other[k + 1..].iter_mut().zip(&row[k + 1..]).for_each(|(x, y)| *x -= factor * *y);
            }
        }
        true
    }

    /// True if the determinant of the matrix is negative.
    pub(crate) fn has_negative_determinant(&self) -> bool
    where
        F: PartialOrd,
    {
        (0..N::COUNT).fold(false, |all, k| all ^ (self.exchanged[k] != k) ^ (self.rows[k][k] < F::zero()))
    }

    /// Solves the equations with this right-hand side.
    pub(crate) fn solve(&self, mut x: Array<F, N>) -> Array<F, N> {
        let product = |row: &[F], x: &[F]| row.iter().zip(x).fold(F::zero(), |sum, (a, x)| sum + *a * *x);
        for k in 0..N::COUNT {
            x.swap(k, self.exchanged[k]);
        }
        for k in 0..N::COUNT {
            let known = product(&self.rows[k][..k], &x[..k]);
            x[k] -= known;
        }
        for k in (0..N::COUNT).rev() {
            let known = product(&self.rows[k][k + 1..], &x[k + 1..]);
            x[k] = (x[k] - known) / self.rows[k][k];
        }
        x
    }
}
