//! Coordinates x = Lᵀ q̇ with M = L Lᵀ, in which |x|² is twice the kinetic energy.

use alloc::vec::Vec;

use crate::cone::{dot, sqrt};

/// Cholesky's factor L of a mass matrix, by rows.
pub(super) struct KineticFactor {
    n: usize,
    l: Vec<f64>,
}

impl KineticFactor {
    /// Decomposes a matrix given by rows. `None` if it is not positive definite.
    pub(super) fn of(mut mass: Vec<f64>, n: usize) -> Option<Self> {
        for i in 0..n {
            for k in 0..=i {
                let (above, row) = mass.split_at_mut(i * n);
                let rest = row[k]
                    - if k < i { dot(&above[k * n..][..k], &row[..k]) } else { dot(&row[..k], &row[..k]) };
                row[k] = match k < i {
                    true => rest / above[k * n + k],
                    false if rest > 0.0 && rest.is_finite() => sqrt(rest),
                    false => return None,
                };
            }
        }
        Some(Self { n, l: mass })
    }

    fn row(&self, i: usize) -> &[f64] {
        &self.l[i * self.n..][..self.n]
    }

    /// L⁻¹ w: what a row w of rates is in these coordinates.
    pub(super) fn solve_lower(&self, w: &mut [f64]) {
        for i in 0..self.n {
            w[i] = (w[i] - dot(&self.row(i)[..i], &w[..i])) / self.row(i)[i];
        }
    }

    /// L⁻ᵀ x: the velocities of these coordinates.
    pub(super) fn solve_upper(&self, x: &mut [f64]) {
        for i in (0..self.n).rev() {
            x[i] /= self.row(i)[i];
            let by = x[i];
            x[..i].iter_mut().zip(self.row(i)).for_each(|(x, l)| *x -= by * l);
        }
    }

    /// |Lᵀ v|, the root of twice the kinetic energy.
    pub(super) fn speed(&self, v: &[f64]) -> f64 {
        let along = |c: usize| (c..self.n).fold(0.0, |sum, i| sum + self.row(i)[c] * v[i]);
        sqrt((0..self.n).map(along).fold(0.0, |sum, x| sum + x * x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;

    #[test]
    fn velocities_have_their_kinetic_energy() {
        let mass = vec![4.0, 2.0, 0.0, 2.0, 5.0, 2.0, 0.0, 2.0, 3.0];
        let (factor, v) = (KineticFactor::of(mass.clone(), 3).unwrap(), [1.0, -2.0, 0.5]);
        let momenta: Vec<f64> = mass.chunks(3).map(|row| dot(row, &v)).collect();
        assert!((factor.speed(&v) - dot(&momenta, &v).sqrt()).abs() < 1e-14);
        let mut back = momenta;
        factor.solve_lower(&mut back);
        factor.solve_upper(&mut back);
        assert!(back.iter().zip(v).all(|(x, v)| (x - v).abs() < 1e-14), "{back:?}");
        assert!(KineticFactor::of(vec![1.0, 2.0, 2.0, 1.0], 2).is_none());
    }
}
