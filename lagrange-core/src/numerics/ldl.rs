//! LDLᵀ factorization without pivoting and without branches, for any scalar.

use crate::number::{Broadcast, Scalar};
use crate::vector::{Array, Element, StaticLength};

/// LDLᵀ factorization: L below the diagonal, 1/D on it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ldl<T: Element, K: StaticLength> {
    l: Array<Array<T, K>, K>,
    /// Smallest ratio of a pivot to its diagonal entry, or of the entry to the pivot.
    pub(crate) pivot: T,
}

impl<T: Scalar, K: StaticLength> Ldl<T, K> {
    #[inline]
    pub(crate) fn of(mut a: Array<Array<T, K>, K>) -> Self {
        let one = T::constant(1.0);
        let mut pivot = one;
        for i in 0..K::COUNT {
            let diagonal = a[i][i];
            let mut d = diagonal;
            for j in 0..i {
                let mut x = a[i][j];
                for k in 0..j {
                    x = x - a[i][k] * a[j][k];
                }
                a[i][j] = x;
            }
            for j in 0..i {
                let l = a[i][j] * a[j][j];
                d = d - l * a[i][j];
                a[i][j] = l;
            }
            // The ratio is at most 1 for a definite matrix; a larger one measures the growth in an indefinite
            // matrix.
            let ratio = d / diagonal;
            pivot = poison(pivot.min(ratio).min(one / ratio), ratio);
            a[i][i] = one / d;
        }
        Self { l: a, pivot }
    }

    #[inline]
    pub(crate) fn solve<S: Broadcast<T>>(&self, x: &mut Array<S, K>) {
        for i in 0..K::COUNT {
            for j in 0..i {
                x[i] = x[i] - S::of(self.l[i][j]) * x[j];
            }
        }
        for i in 0..K::COUNT {
            x[i] = x[i] * S::of(self.l[i][i]);
        }
        for i in (0..K::COUNT).rev() {
            for j in i + 1..K::COUNT {
                x[i] = x[i] - S::of(self.l[j][i]) * x[j];
            }
        }
    }
}

/// Returns `x`, or NaN if `y` is not finite. `min` drops NaN, but 0/0 must not count as a good pivot.
#[inline]
pub(crate) fn poison<T: Scalar>(x: T, y: T) -> T {
    x + y * T::constant(0.0)
}
