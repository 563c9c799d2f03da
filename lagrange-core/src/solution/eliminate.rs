//! Elimination of the equations of motion without a branch, for any scalar.

use crate::number::{Scalar, vector};
use crate::system::Solution;

/// Solves M q̈ − Fᵀλ = h, F q̈ = −γ by LDLᵀ of M and of the Schur complement F M⁻¹ Fᵀ, without pivoting.
///
/// `m` is row by row, of which the lower triangle is read; `f` is one row a constraint. Right where M is
/// positive definite and the constraints are independent; elsewhere [`Solution::pivot`] tells.
/// (Golub and Van Loan, *Matrix Computations*, 4.1.2, and the range-space method of Nocedal and Wright,
/// *Numerical Optimization*, 16.2.)
#[inline]
pub fn eliminate<T: Scalar, const N: usize, const M: usize>(
    m: [[T; N]; N],
    h: [T; N],
    f: [[T; N]; M],
    gamma: [T; M],
) -> Solution<T, N, M> {
    eliminate_active(m, h, f, gamma, [true; M])
}

/// The same with only the `active` constraints; the rows of `f` and `gamma` of the others must be zero.
#[inline]
pub(crate) fn eliminate_active<T: Scalar, const N: usize, const M: usize>(
    m: [[T; N]; N],
    h: [T; N],
    f: [[T; N]; M],
    gamma: [T; M],
    active: [bool; M],
) -> Solution<T, N, M> {
    let mass = Ldl::of(m);
    let mut q = h;
    mass.solve(&mut q);
    let mut w = f;
    for row in &mut w {
        mass.solve(row);
    }
    let mut schur = [[T::constant(0.0); M]; M];
    let mut lambda = gamma;
    for a in 0..M {
        lambda[a] = -(lambda[a] + dot(&f[a], &q));
        for b in 0..=a {
            schur[a][b] = dot(&f[a], &w[b]);
        }
        if !active[a] {
            schur[a][a] = T::constant(1.0);
        }
    }
    let schur = Ldl::of(schur);
    schur.solve(&mut lambda);
    for a in 0..M {
        for i in 0..N {
            q[i] = q[i] + w[a][i] * lambda[a];
        }
    }
    Solution {
        accelerations: vector(q),
        multipliers: vector(lambda),
        pivot: poison(mass.pivot.min(schur.pivot), mass.pivot * schur.pivot),
        rank: M,
    }
}

/// L below the diagonal, 1/D on it.
struct Ldl<T, const K: usize> {
    l: [[T; K]; K],
    pivot: T,
}

impl<T: Scalar, const K: usize> Ldl<T, K> {
    #[inline]
    fn of(mut a: [[T; K]; K]) -> Self {
        let one = T::constant(1.0);
        let mut pivot = one;
        for i in 0..K {
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
            // At most 1 where the matrix is definite; larger is the growth of an indefinite one.
            let ratio = d / diagonal;
            pivot = poison(pivot.min(ratio).min(one / ratio), ratio);
            a[i][i] = one / d;
        }
        Self { l: a, pivot }
    }

    #[inline]
    fn solve(&self, x: &mut [T; K]) {
        for i in 0..K {
            for j in 0..i {
                x[i] = x[i] - self.l[i][j] * x[j];
            }
        }
        for i in 0..K {
            x[i] = x[i] * self.l[i][i];
        }
        for i in (0..K).rev() {
            for j in i + 1..K {
                x[i] = x[i] - self.l[j][i] * x[j];
            }
        }
    }
}

/// `x`, or NaN where `y` is not finite: a minimum drops NaN, and 0/0 must not pass for a good pivot.
#[inline]
fn poison<T: Scalar>(x: T, y: T) -> T {
    x + y * T::constant(0.0)
}

#[inline]
fn dot<T: Scalar, const K: usize>(a: &[T; K], b: &[T; K]) -> T {
    let mut sum = T::constant(0.0);
    for i in 0..K {
        sum = sum + a[i] * b[i];
    }
    sum
}
