//! Coordinates x = Lᵀ q̇ with M = L Lᵀ, in which |x|² is twice the kinetic energy.

use alloc::vec;
use alloc::vec::Vec;

use crate::numerics::bare::{dot, sqrt};

/// Cholesky's factor L of a mass matrix, by rows, each from the first entry of the mass matrix in it to the diagonal.
pub(super) struct KineticFactor {
    l: Vec<f64>,
    /// Place of the first entry of each row, and its column.
    starts: Vec<(usize, usize)>,
}

impl KineticFactor {
    /// Decomposes the matrix that is the sum of these entries. `None` if it is not positive definite.
    pub(super) fn of(n: usize, entries: impl Iterator<Item = (usize, usize, f64)> + Clone) -> Option<Self> {
        let mut starts: Vec<_> = (0..n).map(|i| (0, i)).collect();
        for (i, k, _) in entries.clone() {
            starts[i].1 = starts[i].1.min(k);
        }
        let mut size = 0;
        for (i, (place, first)) in starts.iter_mut().enumerate() {
            *place = size;
            size += i + 1 - *first;
        }
        let mut factor = Self { l: vec![0.0; size], starts };
        for (i, k, x) in entries.filter(|(i, k, _)| k <= i) {
            let (place, first) = factor.starts[i];
            factor.l[place + k - first] += x;
        }
        (0..n).all(|i| factor.eliminate(i)).then_some(factor)
    }

    /// Computes a row from those above. False if its pivot is not positive.
    fn eliminate(&mut self, i: usize) -> bool {
        let (place, first) = self.starts[i];
        let (above, row) = self.l.split_at_mut(place);
        for k in first..i {
            let (place_above, first_above) = self.starts[k];
            let from = first.max(first_above);
            let other = &above[place_above + from - first_above..][..k + 1 - from];
            let rest = row[k - first] - dot(&other[..k - from], &row[from - first..k - first]);
            row[k - first] = rest / other[k - from];
        }
        let size = i - first;
        let rest = row[size] - dot(&row[..size], &row[..size]);
        row[size] = sqrt(rest);
        rest > 0.0 && rest.is_finite()
    }

    fn n(&self) -> usize {
        self.starts.len()
    }

    /// A row of L, from its first column on.
    fn row(&self, i: usize) -> (usize, &[f64]) {
        let (place, first) = self.starts[i];
        (first, &self.l[place..][..i + 1 - first])
    }

    /// An entry of the diagonal of L.
    pub(super) fn diagonal(&self, i: usize) -> f64 {
        let (first, row) = self.row(i);
        row[i - first]
    }

    /// L⁻¹ w: what a row w of rates is in these coordinates.
    pub(super) fn solve_lower(&self, w: &mut [f64]) {
        // Rows of one body leave most of the others at zero.
        let (mut start, mut last) = (None, 0);
        for i in 0..self.n() {
            let (first, row) = self.row(i);
            let from = start.map_or(i, |start: usize| start.max(first).min(i));
            if w[i] == 0.0 && (start.is_none() || last < from) {
                continue;
            }
            w[i] = (w[i] - dot(&row[from - first..i - first], &w[from..i])) / row[i - first];
            (start, last) = (start.or(Some(i)), i);
        }
    }

    /// L⁻ᵀ x: the velocities of these coordinates.
    pub(super) fn solve_upper(&self, x: &mut [f64]) {
        for i in (0..self.n()).rev() {
            let (first, row) = self.row(i);
            x[i] /= row[i - first];
            let by = x[i];
            x[first..i].iter_mut().zip(row).for_each(|(x, l)| *x -= by * l);
        }
    }

    /// Lᵀ v: these coordinates of velocities.
    pub(super) fn coordinates(&self, v: &[f64]) -> Vec<f64> {
        let mut x = vec![0.0; self.n()];
        for (i, v) in v.iter().enumerate() {
            let (first, row) = self.row(i);
            x[first..=i].iter_mut().zip(row).for_each(|(x, l)| *x += v * l);
        }
        x
    }

    /// |Lᵀ v|, the root of twice the kinetic energy.
    pub(super) fn speed(&self, v: &[f64]) -> f64 {
        let x = self.coordinates(v);
        sqrt(dot(&x, &x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn velocities_have_their_kinetic_energy() {
        let mass = vec![4.0, 2.0, 0.0, 2.0, 5.0, 2.0, 0.0, 2.0, 3.0];
        let entries = |mass: &[f64], n: usize| {
            mass.iter()
                .enumerate()
                .map(|(at, x)| (at / n, at % n, *x))
                .filter(|(.., x)| *x != 0.0)
                .collect::<Vec<_>>()
        };
        let factor = KineticFactor::of(3, entries(&mass, 3).into_iter()).unwrap();
        let v = [1.0, -2.0, 0.5];
        let momenta: Vec<f64> = mass.chunks(3).map(|row| dot(row, &v)).collect();
        assert!((factor.speed(&v) - dot(&momenta, &v).sqrt()).abs() < 1e-14);
        let mut back = momenta;
        factor.solve_lower(&mut back);
        factor.solve_upper(&mut back);
        assert!(back.iter().zip(v).all(|(x, v)| (x - v).abs() < 1e-14), "{back:?}");
        assert!(KineticFactor::of(2, entries(&[1.0, 2.0, 2.0, 1.0], 2).into_iter()).is_none());
    }
}
