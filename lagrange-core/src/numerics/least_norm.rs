//! Householder QR with column pivoting, and least-norm solutions of equations whose rows depend on one another (Golub and Van Loan,
//! *Matrix Computations*, 5.4 and 5.5).

use alloc::vec;
use alloc::vec::Vec;

use super::bare::{dot, sqrt};
use crate::number::limits::HALF_THE_DIGITS;

/// A = Q R Pᵀ of a `rows` × `columns` matrix; the rank is the number of pivots that are not round-off.
pub(crate) struct PivotedQr {
    rows: usize,
    columns: usize,
    /// By columns: R in and above the diagonal; below it the vectors v of the reflections 1 − v vᵀ, without their first entries.
    a: Vec<f64>,
    /// First entries of v.
    heads: Vec<f64>,
    /// Column of A at each place of R.
    order: Vec<usize>,
    pub(crate) rank: usize,
}

/// Makes `column` the vector v of the reflection that leaves only its first entry, and returns that entry.
fn reflection(column: &mut [f64]) -> f64 {
    let norm = sqrt(dot(column, column));
    if norm == 0.0 {
        return 0.0;
    }
    let first = if column[0] > 0.0 { -norm } else { norm };
    column[0] -= first;
    let size = sqrt(dot(column, column) / 2.0);
    column.iter_mut().for_each(|x| *x /= size);
    first
}

/// Squared norms of what is left of the columns, and these norms when they were last computed.
struct Norms(Vec<[f64; 2]>);

impl Norms {
    /// The column with the largest norm from place `k` on.
    fn pivot(&mut self, k: usize, a: &[f64], rows: usize) -> usize {
        let mut pivot = k;
        for c in k..self.0.len() {
            // What is taken off has left it less than half of its digits.
            if self.0[c][0] <= HALF_THE_DIGITS * self.0[c][1] {
                let rest = &a[c * rows + k..(c + 1) * rows];
                self.0[c] = [dot(rest, rest); 2];
            }
            if self.0[c][0] > self.0[pivot][0] {
                pivot = c;
            }
        }
        pivot
    }
}

impl PivotedQr {
    /// Decomposes a matrix given by columns. Pivots of at most this part of the largest are round-off.
    pub(crate) fn new(a: Vec<f64>, [rows, columns]: [usize; 2], tolerance: f64) -> Self {
        let most = rows.min(columns);
        let squares = (0..columns).map(|c| [dot(&a[c * rows..][..rows], &a[c * rows..][..rows]); 2]);
        let mut norms = Norms(squares.collect());
        let mut qr =
            Self { rows, columns, a, heads: vec![0.0; most], order: (0..columns).collect(), rank: 0 };
        let (mut largest, mut v) = (0.0_f64, vec![0.0; rows]);
        for k in 0..most {
            let pivot = norms.pivot(k, &qr.a, rows);
            let rest = &qr.a[pivot * rows + k..(pivot + 1) * rows];
            let size = sqrt(dot(rest, rest));
            largest = largest.max(size);
            if size <= tolerance * largest || !size.is_finite() {
                break;
            }
            qr.exchange(k, pivot);
            norms.0.swap(k, pivot);
            qr.eliminate(k, &mut v[k..], &mut norms);
            qr.rank = k + 1;
        }
        qr
    }

    fn exchange(&mut self, k: usize, pivot: usize) {
        if pivot != k {
            let (left, right) = self.a.split_at_mut(pivot * self.rows);
            left[k * self.rows..][..self.rows].swap_with_slice(&mut right[..self.rows]);
            self.order.swap(k, pivot);
        }
    }

    /// Reflects all columns from `k` on, so that column `k` ends in its diagonal.
    fn eliminate(&mut self, k: usize, v: &mut [f64], norms: &mut Norms) {
        let rows = self.rows;
        v.copy_from_slice(&self.a[k * rows + k..(k + 1) * rows]);
        let diagonal = reflection(v);
        for c in k + 1..self.columns {
            let column = &mut self.a[c * rows + k..(c + 1) * rows];
            let along = dot(v, column);
            column.iter_mut().zip(&*v).for_each(|(x, v)| *x -= along * v);
            norms.0[c][0] -= column[0] * column[0];
        }
        self.heads[k] = v[0];
        self.a[k * rows + k..(k + 1) * rows].copy_from_slice(v);
        self.a[k * rows + k] = diagonal;
    }

    fn r(&self, row: usize, column: usize) -> f64 {
        self.a[column * self.rows + row]
    }

    fn reflect(&self, k: usize, x: &mut [f64]) {
        let v = &self.a[k * self.rows + k + 1..(k + 1) * self.rows];
        let along = self.heads[k] * x[k] + dot(v, &x[k + 1..]);
        x[k] -= along * self.heads[k];
        x[k + 1..].iter_mut().zip(v).for_each(|(x, v)| *x -= along * v);
    }

    /// Solves R₁ z = z in place, with the leading square R₁ of R.
    fn back_substitute(&self, z: &mut [f64]) {
        for i in (0..self.rank).rev() {
            z[i] /= self.r(i, i);
            let by = z[i];
            (0..i).for_each(|row| z[row] -= by * self.r(row, i));
        }
    }

    /// Q₁ᵀ x: components of x along the columns of A.
    pub(crate) fn components(&self, x: &[f64]) -> Vec<f64> {
        let mut x = x.to_vec();
        (0..self.rank).for_each(|k| self.reflect(k, &mut x));
        x.truncate(self.rank);
        x
    }

    /// Q₁ y: the vector with these components.
    pub(crate) fn combination(&self, y: &[f64]) -> Vec<f64> {
        let mut x = vec![0.0; self.rows];
        x[..self.rank].copy_from_slice(&y[..self.rank]);
        (0..self.rank).rev().for_each(|k| self.reflect(k, &mut x));
        x
    }

    /// Components y of an x along the columns of A with Aᵀ x = b, by the entries of b at the pivots.
    pub(crate) fn coordinates(&self, b: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.rank];
        for i in 0..self.rank {
            y[i] = (b[self.order[i]] - dot(&self.a[i * self.rows..][..i], &y[..i])) / self.r(i, i);
        }
        y
    }

    /// Vectors y with A y = 0, one for each column beyond the rank.
    pub(crate) fn null(&self) -> Vec<Vec<f64>> {
        let of = |c: usize| {
            let (mut y, mut z) = (vec![0.0; self.columns], self.a[c * self.rows..][..self.rank].to_vec());
            self.back_substitute(&mut z);
            (0..self.rank).for_each(|i| y[self.order[i]] = -z[i]);
            y[self.order[c]] = 1.0;
            y
        };
        (self.rank..self.columns).map(of).collect()
    }

    /// The shortest x that makes |A x − b| least. Of fewer pivots than columns, [R S]ᵀ = Q' R' gives [R S] x = z by x = Q' R'⁻ᵀ z.
    pub(crate) fn least_norm(&self, b: &[f64]) -> Vec<f64> {
        let (rank, mut x) = (self.rank, vec![0.0; self.columns]);
        let mut z = self.components(b);
        if rank == self.columns {
            self.back_substitute(&mut z);
        } else {
            let mut transposed = vec![0.0; self.columns * rank];
            for i in 0..rank {
                (i..self.columns).for_each(|c| transposed[i * self.columns + c] = self.r(i, c));
            }
            let second = Self::new(transposed, [self.columns, rank], 0.0);
            z = second.combination(&second.coordinates(&z));
        }
        self.order.iter().zip(z).for_each(|(&c, z)| x[c] = z);
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lagrange_random::{Random, cases};

    fn random_matrix(random: &mut Random, [rows, columns]: [usize; 2], rank: usize) -> Vec<f64> {
        let mut many = |count: usize| (0..count).map(|_| random.between(-1.0, 1.0)).collect::<Vec<f64>>();
        let (left, right) = (many(rows * rank), many(rank * columns));
        let entry =
            |row: usize, c: usize| (0..rank).map(|k| left[k * rows + row] * right[c * rank + k]).sum();
        (0..columns).flat_map(|c| (0..rows).map(move |row| (row, c))).map(|(row, c)| entry(row, c)).collect()
    }

    /// The solution is that of the pseudoinverse: its residual is across all columns, and it is along the rows.
    #[test]
    fn least_norm_solutions_are_those_of_the_pseudoinverse() {
        for seed in 0..cases([200, 500, 100_000]) as u64 {
            let mut random = Random(seed);
            let [rows, columns] = [0; 2].map(|_| 1 + random.below(6));
            let rank = 1 + random.below(rows.min(columns));
            let a = random_matrix(&mut random, [rows, columns], rank);
            let b: Vec<f64> = (0..rows).map(|_| random.between(-1.0, 1.0)).collect();
            let qr = PivotedQr::new(a.clone(), [rows, columns], 1e-11);
            assert_eq!(qr.rank, rank, "seed {seed}");
            let x = qr.least_norm(&b);
            let column = |c: usize| &a[c * rows..][..rows];
            let product = |x: &[f64]| -> Vec<f64> {
                (0..rows).map(|row| (0..columns).map(|c| a[c * rows + row] * x[c]).sum()).collect()
            };
            let rest: Vec<f64> = product(&x).iter().zip(&b).map(|(x, b)| x - b).collect();
            let size = 1.0 + dot(&x, &x).sqrt();
            assert!((0..columns).all(|c| dot(column(c), &rest).abs() < 1e-9 * size * size), "seed {seed}");
            let null = qr.null();
            assert_eq!(null.len(), columns - rank);
            for y in null {
                let length = dot(&y, &y).sqrt();
                assert!(product(&y).iter().all(|x| x.abs() < 1e-9 * length), "seed {seed}");
                assert!(dot(&x, &y).abs() < 1e-9 * size * length * length, "seed {seed}");
            }
        }
    }
}
