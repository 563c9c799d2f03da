//! Linear complementarity problems with friction: w = M z + q, w ≥ 0, z ≥ 0, wᵀz = 0, where M is not symmetric.

use alloc::vec;
use alloc::vec::Vec;
use core::cmp::Ordering;

use crate::number::{Real, Scalar, larger, order};

/// Largest number of exchanges of unknowns, for each unknown. With the lexicographic rule no basis comes back.
const EXCHANGES: usize = 1_000;

/// An entry of the tableau counts as zero below this many units of round-off of the largest one of its column.
const ZERO: f64 = 4096.0;

/// A problem, by rows. The unknowns marked as free may have any sign, and their w is zero.
pub(super) struct Exchange<T> {
    pub(super) matrix: Vec<Vec<T>>,
    pub(super) constant: Vec<T>,
    /// Round-off of each constant, below which it counts as zero.
    pub(super) noise: Vec<T>,
    pub(super) is_free: Vec<bool>,
}

/// A solution: z, and which of its entries are basic, so that their w is zero.
pub(super) struct Exchanged<T> {
    pub(super) z: Vec<T>,
    pub(super) is_basic: Vec<bool>,
}

/// The equations w − M z − e z₀ = q, solved for the basic ones of the 2n + 1 unknowns: w, z and the artificial z₀.
struct ExchangeTableau<T> {
    size: usize,
    /// A row for each basic unknown: the columns of w, z and z₀, and the right-hand side.
    rows: Vec<Vec<T>>,
    basic: Vec<usize>,
}

impl<T: Real> Exchange<T> {
    /// Solves by the method of Lemke (Cottle, Pang and Stone, *The Linear Complementarity Problem*, 1992, 4.4), with the
    /// lexicographic rule against cycles. `None` if the method ends on a ray: for friction with a small coefficient there is
    /// then no solution.
    pub(super) fn solve(&self) -> Option<Exchanged<T>> {
        let size = self.constant.len();
        let mut tableau = ExchangeTableau::new(self);
        for k in (0..size).filter(|&k| self.is_free[k]) {
            // A free unknown whose row depends on those before stays zero.
            if !tableau.is_zero(k, size + k) {
                tableau.pivot(k, size + k);
            }
        }
        let is_bound = |unknown: usize| unknown == 2 * size || !self.is_free[unknown % size];
        tableau.complement(&is_bound)?;
        let mut solution = Exchanged { z: vec![T::constant(0.0); size], is_basic: vec![false; size] };
        for (row, &unknown) in tableau.basic.iter().enumerate() {
            if let Some(k) = unknown.checked_sub(size).filter(|&k| k < size) {
                (solution.z[k], solution.is_basic[k]) = (tableau.rows[row][2 * size + 1], true);
            }
        }
        self.refine(&tableau, &mut solution);
        for k in (0..size).filter(|&k| !self.is_free[k]) {
            solution.z[k] = larger(solution.z[k], T::constant(0.0));
        }
        Some(solution)
    }

    /// One step of refinement: what is left of w of the basic unknowns, by the inverse that the tableau holds.
    fn refine(&self, tableau: &ExchangeTableau<T>, Exchanged { z, is_basic }: &mut Exchanged<T>) {
        let size = z.len();
        let residual = |k: usize| {
            let w = (0..size).fold(self.constant[k], |sum, j| sum + self.matrix[k][j] * z[j]);
            if is_basic[k] { w } else { T::constant(0.0) }
        };
        let residuals: Vec<T> = (0..size).map(residual).collect();
        for (row, &unknown) in tableau.basic.iter().enumerate() {
            if let Some(k) = unknown.checked_sub(size).filter(|&k| k < size) {
                z[k] = (0..size).fold(z[k], |z, j| z + tableau.rows[row][j] * residuals[j]);
            }
        }
    }
}

impl<T: Real> ExchangeTableau<T> {
    fn new(problem: &Exchange<T>) -> Self {
        let size = problem.constant.len();
        let [zero, one] = [0.0, 1.0].map(T::constant);
        let row = |k: usize| {
            let mut row = vec![zero; 2 * size + 2];
            row[k] = one;
            (0..size).for_each(|j| row[size + j] = -problem.matrix[k][j]);
            row[2 * size] = if problem.is_free[k] { zero } else { -one };
            let constant = problem.constant[k];
            row[2 * size + 1] = if Scalar::abs(constant) <= problem.noise[k] { zero } else { constant };
            row
        };
        Self { size, rows: (0..size).map(row).collect(), basic: (0..size).collect() }
    }

    /// Exchanges unknowns until z₀ is zero.
    fn complement(&mut self, is_bound: &impl Fn(usize) -> bool) -> Option<()> {
        let (size, artificial) = (self.size, 2 * self.size);
        let is_negative =
            |&row: &usize| is_bound(self.basic[row]) && self.rows[row][artificial + 1] < T::constant(0.0);
        let least = |&one: &usize, &other: &usize| self.order(one, other, None);
        let Some(row) = (0..size).filter(is_negative).min_by(least) else { return Some(()) };
        let mut entering = self.complement_of(self.basic[row]);
        let round_off = Scalar::abs(self.rows[row][artificial + 1]) * T::constant(T::EPSILON * ZERO);
        self.pivot(row, artificial);
        for _ in 0..=EXCHANGES * size {
            // Of dependent rows z₀ may become zero without leaving.
            let value = |row: usize| self.rows[row][artificial + 1];
            if (0..size).any(|row| self.basic[row] == artificial && value(row) <= round_off) {
                return Some(());
            }
            let is_blocking = |&row: &usize| {
                is_bound(self.basic[row])
                    && self.rows[row][entering] > T::constant(0.0)
                    && !self.is_zero(row, entering)
            };
            let first = |&one: &usize, &other: &usize| {
                // z₀ leaves if it may.
                let leaves = |row: usize| self.basic[row] == artificial;
                self.order(one, other, Some(entering)).then(leaves(other).cmp(&leaves(one)))
            };
            let row = (0..size).filter(is_blocking).min_by(first)?;
            let leaving = self.basic[row];
            self.pivot(row, entering);
            if leaving == artificial {
                return Some(());
            }
            entering = self.complement_of(leaving);
        }
        None
    }

    fn complement_of(&self, unknown: usize) -> usize {
        if unknown < self.size { unknown + self.size } else { unknown - self.size }
    }

    /// Order of two rows by right-hand side and inverse, divided by their entries in a column if one is given.
    fn order(&self, one: usize, other: usize, column: Option<usize>) -> Ordering {
        let divisor = |row: usize| column.map_or(T::constant(1.0), |column| self.rows[row][column]);
        let (by, by_other) = (divisor(one), divisor(other));
        let places = [2 * self.size + 1].into_iter().chain(0..self.size);
        let compared = places.map(|place| {
            let (x, y) = (self.rows[one][place] / by, self.rows[other][place] / by_other);
            let round_off = T::constant(T::EPSILON * ZERO) * larger(Scalar::abs(x), Scalar::abs(y));
            if Scalar::abs(x - y) <= round_off { Ordering::Equal } else { order(x, y) }
        });
        compared.into_iter().find(|&order| order != Ordering::Equal).unwrap_or(Ordering::Equal)
    }

    /// Whether an entry is zero to its round-off.
    fn is_zero(&self, row: usize, column: usize) -> bool {
        let largest =
            self.rows.iter().fold(T::constant(0.0), |most, row| larger(most, Scalar::abs(row[column])));
        Scalar::abs(self.rows[row][column]) <= T::constant(T::EPSILON * ZERO) * largest
    }

    fn pivot(&mut self, row: usize, column: usize) {
        let pivot = self.rows[row][column];
        self.rows[row].iter_mut().for_each(|entry| *entry /= pivot);
        let top = self.rows[row].clone();
        for (_, other) in self.rows.iter_mut().enumerate().filter(|(k, _)| *k != row) {
            let factor = other[column];
            for (entry, &above) in other.iter_mut().zip(&top) {
                *entry -= factor * above;
            }
        }
        self.basic[row] = column;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number from −1 to 1, by a linear congruence.
    fn random(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Contacts of bodies with as many motions: rows of normals and tangents, and the problem of Coulomb's law at a rate.
    fn with_friction(contacts: usize, motions: usize, mu: f64, seed: &mut u64) -> Exchange<f64> {
        let mut rows = || (0..motions).map(|_| random(seed)).collect::<Vec<f64>>();
        let all: Vec<[Vec<f64>; 2]> = (0..contacts).map(|_| [rows(), rows()]).collect();
        let velocity = rows();
        let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        let size = 4 * contacts;
        let (mut matrix, mut constant) = (vec![vec![0.0; size]; size], vec![0.0; size]);
        for (i, [normal, tangent]) in all.iter().enumerate() {
            let i = 4 * i;
            for (row, of, sign) in [(i, normal, 1.0), (i + 1, tangent, 1.0), (i + 2, tangent, -1.0)] {
                constant[row] = sign * dot(of, &velocity);
                for (j, [push, drag]) in all.iter().enumerate() {
                    let drag = sign * dot(of, drag);
                    matrix[row][4 * j..4 * j + 3].copy_from_slice(&[sign * dot(of, push), drag, -drag]);
                }
            }
            (matrix[i + 1][i + 3], matrix[i + 2][i + 3]) = (1.0, 1.0);
            matrix[i + 3][i..i + 3].copy_from_slice(&[mu, -1.0, -1.0]);
        }
        Exchange { matrix, constant, noise: vec![1e-14; size], is_free: vec![false; size] }
    }

    #[test]
    fn random_contacts_with_friction_are_decided() {
        let mut seed = 11;
        for case in 0..lagrange_random::cases([10_000, 30_000, 1_000_000]) {
            let (contacts, motions) = (1 + case % 4, 2 + case / 4 % 5);
            let problem = with_friction(contacts, motions, [0.0, 0.1, 0.3, 1.0][case % 7 % 4], &mut seed);
            // Impacts with friction always have a solution.
            let Exchanged { z, .. } = problem.solve().expect("a solution");
            let scale = 1.0 + z.iter().fold(0.0, |most: f64, z| most.max(*z));
            for k in 0..z.len() {
                let w =
                    problem.constant[k] + problem.matrix[k].iter().zip(&z).map(|(m, z)| m * z).sum::<f64>();
                assert!(z[k] >= 0.0 && w >= -1e-9 * scale, "case {case}: z = {z:?}, w[{k}] = {w}");
                assert!((z[k] * w).abs() < 1e-9 * scale * scale, "case {case}: z = {z:?}, w[{k}] = {w}");
            }
        }
    }

    #[test]
    fn a_free_unknown_may_be_negative() {
        let matrix = vec![vec![2.0, 1.0], vec![1.0, 2.0]];
        let problem =
            Exchange { matrix, constant: vec![-3.0, 3.0], noise: vec![0.0; 2], is_free: vec![false, true] };
        let Exchanged { z, .. } = problem.solve().expect("a solution");
        assert!((z[0] - 3.0).abs() < 1e-15 && (z[1] + 3.0).abs() < 1e-15, "{z:?}");
    }
}
