//! Branch-free elimination of the equations of motion, for any scalar.

use crate::number::{Broadcast, Scalar, dot};
use crate::numerics::ldl::{Ldl, poison};
use crate::system::Solution;
use crate::vector::{Array, Element, StaticLength, Vector, array, vector};

/// Solves M q̈ − Fᵀλ = h, F q̈ = −γ by LDLᵀ of M and of the Schur complement F M⁻¹ Fᵀ, without pivoting.
///
/// `m` holds rows, of which the lower triangle is read; `f` holds one row per constraint. The result is correct
/// if M is positive definite and the constraints are independent; otherwise [`Solution::pivot`] indicates
/// failure. (Golub and Van Loan, *Matrix Computations*, 4.1.2, and the range-space method of Nocedal and
/// Wright, *Numerical Optimization*, 16.2.)
#[inline]
pub(crate) fn eliminate<T: Scalar, N: StaticLength, M: StaticLength>(
    m: Array<Array<T, N>, N>,
    h: Array<T, N>,
    f: Array<Array<T, N>, M>,
    gamma: Array<T, M>,
) -> Solution<T, N, M> {
    let none = Array::filled(T::constant(0.0));
    LoopFactor::of(m, f, none, none).solve_completed(h, gamma)
}

/// Factorizations of M and F M⁻¹ Fᵀ + c, computed in loops. The compliance c is zero, but 1 for a constraint that is
/// switched off, whose row of F and γ are zero.
#[derive(Clone, Copy, Debug)]
pub struct LoopFactor<T: Element, N: StaticLength, M: StaticLength> {
    mass: Ldl<T, N>,
    f: Array<Array<T, N>, M>,
    /// M⁻¹Fᵀ, one row per constraint.
    w: Array<Array<T, N>, M>,
    schur: Ldl<T, M>,
    /// Weights σ; zero for constraints that do not complete M.
    weights: Array<T, M>,
}

impl<T: Scalar, N: StaticLength, M: StaticLength> LoopFactor<T, N, M> {
    /// Factorizes the completed mass matrix M + FᵀσF, whose lower triangle is read row by row. `f` holds one
    /// row per constraint, `weights` is σ, `compliance` is c.
    #[inline]
    pub fn of(
        m: Array<Array<T, N>, N>,
        f: Array<Array<T, N>, M>,
        weights: Array<T, M>,
        compliance: Array<T, M>,
    ) -> Self {
        let mass = Ldl::of(m);
        let mut w = f;
        for row in &mut w {
            mass.solve(row);
        }
        let mut schur = Array::filled(Array::filled(T::constant(0.0)));
        for a in 0..M::COUNT {
            for b in 0..=a {
                schur[a][b] = dot(&f[a], &w[b]);
            }
            schur[a][a] = schur[a][a] + compliance[a];
        }
        Self { mass, f, w, schur: Ldl::of(schur), weights }
    }

    /// Solves M x − Fᵀλ = `forcing`, F x = −`bias`.
    #[inline]
    pub fn solve<S: Broadcast<T>>(&self, forcing: &Vector<S, N>, bias: &Vector<S, M>) -> Solution<S, N, M> {
        let (mut h, gamma) = (array(*forcing), array(*bias));
        for a in (0..M::COUNT).filter(|&a| self.weights[a] != T::constant(0.0)) {
            let part = S::of(self.weights[a]) * gamma[a];
            for i in 0..N::COUNT {
                h[i] = h[i] - S::of(self.f[a][i]) * part;
            }
        }
        self.solve_completed(h, gamma)
    }

    /// Solves M x = `forcing` without constraints, for a factorization without weights.
    pub(crate) fn free(&self, forcing: &Array<T, N>) -> Array<T, N> {
        let mut x = *forcing;
        self.mass.solve(&mut x);
        x
    }

    /// Multipliers ν with F(x + M⁻¹Fᵀν) = −`bias`.
    pub(crate) fn multipliers(&self, x: &Array<T, N>, bias: &Array<T, M>) -> Array<T, M> {
        let mut nu = Array::from_fn(|a| -(bias[a] + dot(&self.f[a], x)));
        self.schur.solve(&mut nu);
        nu
    }

    /// Returns x + M⁻¹Fᵀμ.
    pub(crate) fn held(&self, x: &Array<T, N>, mu: &Array<T, M>) -> Array<T, N> {
        Array::from_fn(|i| (0..M::COUNT).fold(x[i], |sum, a| sum + self.w[a][i] * mu[a]))
    }

    /// Solves with the completed right-hand side h − Fᵀσγ.
    #[inline]
    pub(crate) fn solve_completed<S: Broadcast<T>>(
        &self,
        h: Array<S, N>,
        gamma: Array<S, M>,
    ) -> Solution<S, N, M> {
        let mut q = h;
        self.mass.solve(&mut q);
        let mut lambda = gamma;
        for a in 0..M::COUNT {
            lambda[a] = -(lambda[a] + dot::<S>(&self.f[a].map(S::of), &q));
        }
        self.schur.solve(&mut lambda);
        for a in 0..M::COUNT {
            for i in 0..N::COUNT {
                q[i] = q[i] + S::of(self.w[a][i]) * lambda[a];
            }
        }
        let pivots = [self.mass.pivot, self.schur.pivot];
        let pivot = poison(pivots[0].min(pivots[1]), pivots[0] * pivots[1]);
        let doubt = S::of(nan_if_ill_conditioned(pivot, T::constant(1.0)));
        Solution {
            accelerations: vector(q.map(|x| x + doubt)),
            multipliers: vector(lambda.map(|x| x + doubt)),
            pivot: S::of(pivot),
            rank: M::COUNT,
        }
    }
}

/// Returns zero if the smallest and the largest ratio of a pivot to its diagonal entry preserve two thirds of
/// the digits of the scalar, else NaN, lane by lane. The bound is `least_pivot`, ε^(1/3), and its inverse.
#[inline]
pub fn nan_if_ill_conditioned<T: Scalar>(least: T, most: T) -> T {
    let [zero, one, nan] = [0.0, 1.0, f64::NAN].map(T::constant);
    let is_single = T::constant(1.0 + f64::EPSILON) == one;
    let bound = if is_single { 4.921_566_601_151_855e-3 } else { 6.055_454_452_393_343e-6 };
    let below = most.select_by_order(T::constant(1.0 / bound), zero, nan, nan);
    least.select_by_order(T::constant(bound), nan, nan, below)
}
