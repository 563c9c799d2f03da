//! Linear complementarity problems of contacts: w = G z + c ≥ 0, z ≥ 0, wᵀz = 0.

use alloc::vec;
use alloc::vec::Vec;

use crate::number::{Real, Scalar, larger, order};

/// Largest number of changes of the active set, for each unknown. Without cycles 2ⁿ suffice, and a few are usual.
const CHANGES: usize = 100;

/// A row W of G = W K⁻¹ Wᵀ counts as a combination of others if the square of what they leave of it, |W + Σ g Wₖ|² in the metric K⁻¹,
/// is below this many units of round-off of (|W| + Σ |g| |Wₖ|)², by which the elimination that finds the g may be off (Higham,
/// *Accuracy and Stability of Numerical Algorithms*, 2002, theorem 10.4).
const DEPENDENT: f64 = 64.0;

/// A problem whose matrix is symmetric and positive semidefinite, by rows.
pub(super) struct Complementarity<T> {
    pub(super) matrix: Vec<Vec<T>>,
    pub(super) constant: Vec<T>,
    /// Round-off of each constant, below which w counts as zero.
    pub(super) noise: Vec<T>,
}

/// Result of letting an unknown of the problem grow from zero.
enum Joined<T> {
    Active,
    /// Its row depends on those of the active ones, none of which becomes zero: their growth as it grows by 1.
    Dependent(Vec<T>),
}

/// Solution of the problem: z and w, and the round-off of w. The active unknowns are those that may exceed zero; their w is
/// zero.
pub(super) struct ComplementarySolution<T> {
    pub(super) z: Vec<T>,
    pub(super) w: Vec<T>,
    pub(super) noise: Vec<T>,
    pub(super) is_active: Vec<bool>,
}

impl<T: Real> Complementarity<T> {
    /// Solves by an active set: of the unknowns at zero, the one with the most negative w joins, and one that would become
    /// negative leaves (Lawson and Hanson, *Solving Least Squares Problems*, 1974, chapter 23). The result is exact but
    /// for round-off. `None` if there is no solution: w < 0 in some row whatever z is.
    pub(super) fn solve(&self) -> Option<ComplementarySolution<T>> {
        let size = self.constant.len();
        let (mut z, mut active) = (vec![T::constant(0.0); size], Vec::new());
        // Rows whose w is zero because it depends on others that are.
        let mut dependent = Vec::new();
        for _ in 0..=CHANGES * size {
            let (w, noise) = (self.w(&z), self.noise_of_w(&z));
            let Some(joins) = worst(&w, &noise, &[&active[..], &dependent].concat()) else {
                let is_active = (0..size).map(|k| active.contains(&k)).collect();
                return Some(ComplementarySolution { z, w, noise, is_active });
            };
            match self.join(joins, &mut z, &mut active) {
                Joined::Active => {}
                Joined::Dependent(growth) if self.is_round_off(joins, (&active, &growth), &w, &noise) => {
                    dependent.push(joins);
                }
                Joined::Dependent(_) => return None,
            }
        }
        None
    }

    /// Whether a negative w is the round-off of those of the active unknowns on which its row depends.
    fn is_round_off(&self, joins: usize, (active, growth): (&[usize], &[T]), w: &[T], noise: &[T]) -> bool {
        let of_active = active.iter().zip(growth);
        let all = of_active.fold(noise[joins], |sum, (&k, &g)| sum + larger(noise[k], Scalar::abs(w[k])) * g);
        -w[joins] <= all
    }

    /// Round-off of w: that of the constants, and of the terms of G z.
    fn noise_of_w(&self, z: &[T]) -> Vec<T> {
        let unit = T::constant(T::EPSILON * DEPENDENT);
        let terms = |k: usize| {
            (0..z.len()).fold(T::constant(0.0), |sum, j| sum + Scalar::abs(self.matrix[k][j] * z[j]))
        };
        (0..z.len()).map(|k| self.noise[k] + unit * terms(k)).collect()
    }

    fn w(&self, z: &[T]) -> Vec<T> {
        let row = |k: usize| (0..z.len()).fold(self.constant[k], |sum, j| sum + self.matrix[k][j] * z[j]);
        (0..z.len()).map(row).collect()
    }

    /// Lets an unknown grow until its w is zero. Those that would become negative on the way leave.
    fn join(&self, joins: usize, z: &mut [T], active: &mut Vec<usize>) -> Joined<T> {
        loop {
            let (growth, rate) = self.growth(joins, active);
            let whole = rate.map(|rate| -self.w(z)[joins] / rate);
            // The first to become zero.
            let blocks = active.iter().zip(&growth).enumerate().filter(|(_, (_, g))| **g < T::constant(0.0));
            let first = blocks
                .map(|(place, (&k, &g))| (place, -(z[k] / g)))
                .min_by(|one, other| order(one.1, other.1));
            let step = match (whole, first) {
                (Some(whole), Some((_, first))) if first < whole => first,
                (Some(whole), _) => whole,
                (None, Some((_, first))) => first,
                (None, None) => return Joined::Dependent(growth),
            };
            active.iter().zip(&growth).for_each(|(&k, &g)| z[k] += g * step);
            z[joins] += step;
            match first {
                Some((place, first)) if whole.is_none_or(|whole| first < whole) => {
                    z[active.swap_remove(place)] = T::constant(0.0);
                }
                _ => {
                    active.push(joins);
                    return Joined::Active;
                }
            }
        }
    }

    /// Growth of the active unknowns as one that joins grows by 1, while their w stay zero, and that of its own w. `None` if
    /// the latter is zero to its round-off: the row of the unknown depends on those of the active ones.
    fn growth(&self, joins: usize, active: &[usize]) -> (Vec<T>, Option<T>) {
        let own = self.matrix[joins][joins];
        let growth = self.inverse(active, active.iter().map(|&k| -self.matrix[k][joins]).collect());
        let parts = || active.iter().zip(&growth);
        let rate = parts().fold(own, |sum, (&k, &g)| sum + self.matrix[joins][k] * g);
        let size_of = |k: usize| Scalar::sqrt(self.matrix[k][k]);
        let size = parts().fold(size_of(joins), |sum, (&k, &g)| sum + Scalar::abs(g) * size_of(k));
        let is_free = rate > T::constant(T::EPSILON * DEPENDENT) * size * size;
        (growth, is_free.then_some(rate))
    }

    /// Solves G x = b over the active unknowns, by elimination without pivoting: their block is positive definite.
    fn inverse(&self, active: &[usize], mut b: Vec<T>) -> Vec<T> {
        let size = active.len();
        let row = |&i: &usize| active.iter().map(|&j| self.matrix[i][j]).collect::<Vec<T>>();
        let mut matrix: Vec<Vec<T>> = active.iter().map(row).collect();
        for k in 0..size {
            let (top, pivot) = (matrix[k].clone(), b[k]);
            for i in k + 1..size {
                let factor = matrix[i][k] / top[k];
                (k..size).for_each(|j| matrix[i][j] -= factor * top[j]);
                b[i] -= factor * pivot;
            }
        }
        for k in (0..size).rev() {
            let rest = (k + 1..size).fold(b[k], |rest, j| rest - matrix[k][j] * b[j]);
            b[k] = rest / matrix[k][k];
        }
        b
    }

    /// Solves G x = −c with w = 0 over the unknowns given.
    pub(super) fn equality(&self, active: &[usize]) -> Vec<T> {
        let solved = self.inverse(active, active.iter().map(|&k| -self.constant[k]).collect());
        let mut z = vec![T::constant(0.0); self.constant.len()];
        active.iter().zip(solved).for_each(|(&k, x)| z[k] = x);
        z
    }

    /// The row of an unknown as a combination of those of the active ones, on which it depends.
    pub(super) fn combination(&self, k: usize, active: &[usize]) -> Vec<T> {
        match active.iter().position(|&of| of == k) {
            Some(place) => (0..active.len()).map(|of| T::constant(f64::from(of == place))).collect(),
            None => self.growth(k, active).0.into_iter().map(|part| -part).collect(),
        }
    }

    /// Growth of w of an unknown as it grows by 1 while those of the active ones stay. `None` if it depends on them.
    pub(super) fn response(&self, k: usize, active: &[usize]) -> Option<T> {
        self.growth(k, active).1
    }

    /// Whether the row of an unknown depends on those of the active ones.
    pub(super) fn depends(&self, k: usize, active: &[usize]) -> bool {
        self.response(k, active).is_none()
    }
}

/// The unknown at zero whose w is most negative.
fn worst<T: Real>(w: &[T], noise: &[T], active: &[usize]) -> Option<usize> {
    let is_wrong = |&k: &usize| w[k] < -noise[k] && !active.contains(&k);
    (0..w.len()).filter(is_wrong).min_by(|&j, &k| order(w[j], w[k]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number from 0 to 1, by a linear congruence.
    fn random(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// G = W Wᵀ of random rows, some of them combinations of others, and c = W u, so that there is a solution.
    #[test]
    fn random_problems_are_solved() {
        let mut seed = 7;
        for case in 0..100_000 {
            let (size, motions) = (1 + case % 7, 1 + case / 7 % 5);
            let mut rows: Vec<Vec<f64>> =
                (0..size).map(|_| (0..motions).map(|_| 2.0 * random(&mut seed) - 1.0).collect()).collect();
            if size > 2 && case % 3 == 0 {
                rows[size - 1] = rows[0].iter().zip(&rows[1]).map(|(x, y)| x + 2.0 * y).collect();
            }
            let u: Vec<f64> = (0..motions).map(|_| 2.0 * random(&mut seed) - 1.0).collect();
            let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
            let matrix = rows.iter().map(|row| rows.iter().map(|other| dot(row, other)).collect()).collect();
            let constant: Vec<f64> = rows.iter().map(|row| dot(row, &u)).collect();
            let problem = Complementarity { matrix, constant, noise: vec![1e-12; size] };
            let ComplementarySolution { z, w, .. } = problem.solve().expect("a solution");
            let scale = 1.0 + z.iter().fold(0.0, |most: f64, z| most.max(*z));
            for k in 0..size {
                assert!(z[k] >= 0.0 && w[k] >= -1e-9 * scale, "case {case}: z = {z:?}, w = {w:?}");
                assert!((z[k] * w[k]).abs() < 1e-9 * scale * scale, "case {case}: z = {z:?}, w = {w:?}");
            }
        }
    }

    #[test]
    fn two_walls_that_close_in_have_no_solution() {
        let matrix = vec![vec![1.0, -1.0], vec![-1.0, 1.0]];
        assert!(Complementarity { matrix, constant: vec![-1.0; 2], noise: vec![0.0; 2] }.solve().is_none());
    }
}
