//! The symplectic form Σ dp_i ∧ dq_i in coordinates and velocities, and the derivatives of the momenta.

use alloc::vec::Vec;

use nalgebra::DMatrix;

use crate::StateOf;
use crate::generic::{Direction, Solution, StaticLength};
use crate::linearized::Linearized;
use crate::number::{Real, Scalar, larger};
use crate::vector::zeros;

/// Matrix Ω of the form ω(x, y) = xᵀ Ω y = δp·δq′ − δp′·δq in (q, q̇).
///
/// With A = ∂p/∂q and M = ∂p/∂q̇, Ω = (Aᵀ − A, −M; Mᵀ, 0). The skew part of A follows from the equations of motion: at q̈ = 0
/// and λ = 0 their residual has the derivative A − Aᵀ + Ṁ by q̇, and Ṁ is symmetric. A total time derivative in L, which
/// changes the symmetric part of A, leaves Ω as it is.
pub(super) fn symplectic_form<L: Linearized<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
) -> DMatrix<L::Scalar> {
    let n = <L::N>::COUNT;
    let zero = L::Scalar::constant(0.0);
    let still = Solution::given(zeros(), zeros());
    let mass = system.mass_matrix(state);
    let mut by_velocity = DMatrix::zeros(n, n);
    for j in 0..n {
        let change = system.residual_change(state, &still, &Direction::of_velocity(j));
        (0..n).for_each(|i| by_velocity[(i, j)] = change.motion[i]);
    }
    let half = L::Scalar::constant(0.5);
    DMatrix::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
        (true, true) => half * (by_velocity[(j, i)] - by_velocity[(i, j)]),
        (true, false) => -mass[(i, j - n)],
        (false, true) => mass[(j, i - n)],
        (false, false) => zero,
    })
}

/// Derivatives of (q, p) by (q, q̇): the identity above ∂p/∂q and ∂p/∂q̇ = M.
///
/// ∂p/∂q is extrapolated from central differences of the momenta, since no equation of motion knows its symmetric part; 11 or more
/// digits are right where the momenta are smooth functions on the scale of the coordinates.
pub(super) fn phase_derivatives<L: Linearized<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
) -> DMatrix<L::Scalar> {
    let n = <L::N>::COUNT;
    let mut derivatives = DMatrix::identity(2 * n, 2 * n);
    let mass = system.mass_matrix(state);
    for j in 0..n {
        let slopes = extrapolated(
            |h| {
                let [ahead, behind] = [h, -h].map(|by| {
                    let mut moved = *state;
                    moved.q[j] += by;
                    system.momentum(&moved)
                });
                (0..n).map(|i| (ahead[i] - behind[i]) / (h + h)).collect()
            },
            larger(Scalar::abs(state.q[j]), L::Scalar::constant(1.0)),
        );
        for i in 0..n {
            derivatives[(n + i, j)] = slopes[i];
            derivatives[(n + i, n + j)] = mass[(i, j)];
        }
    }
    derivatives
}

/// Limit of the differences as h → 0, by Ridders's table: h shrinks by √2 at each row, and the entry whose neighbours agree best is
/// taken (Ridders, *Advances in Engineering Software* 4, 1982).
fn extrapolated<T: Real>(difference: impl Fn(T) -> Vec<T>, size: T) -> Vec<T> {
    const ROWS: usize = 12;
    let (mut h, shrink) = (size * T::constant(0.1), T::constant(core::f64::consts::FRAC_1_SQRT_2));
    let mut table = alloc::vec![difference(h)];
    let mut best = table[0].clone();
    let mut errors: Vec<Option<T>> = alloc::vec![None; best.len()];
    for _ in 1..ROWS {
        h *= shrink;
        let mut row = alloc::vec![difference(h)];
        let mut factor = T::constant(2.0);
        for above in &table {
            let left = &row[row.len() - 1];
            let next: Vec<T> =
                left.iter().zip(above).map(|(x, y)| *x + (*x - *y) / (factor - T::constant(1.0))).collect();
            for i in 0..next.len() {
                let error = larger(Scalar::abs(next[i] - left[i]), Scalar::abs(next[i] - above[i]));
                if errors[i].is_none_or(|known| error < known) {
                    (errors[i], best[i]) = (Some(error), next[i]);
                }
            }
            row.push(next);
            factor += factor;
        }
        table = row;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Derivatives of x⁵, sin x and eˣ at 1, of each component on its own.
    #[test]
    fn differences_are_extrapolated_to_the_derivatives() {
        let values = |x: f64| [x.powi(5), x.sin(), x.exp()];
        let difference = |h: f64| {
            let [ahead, behind] = [1.0 + h, 1.0 - h].map(values);
            (0..3).map(|i| (ahead[i] - behind[i]) / (2.0 * h)).collect()
        };
        let found = extrapolated(difference, 1.0);
        for (found, expected) in found.iter().zip([5.0, 1.0_f64.cos(), core::f64::consts::E]) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
    }
}
