//! Natural units, in which masses are about 1 and constraint rows have length 1.

use crate::number::{Real, Scalar, entries, larger, largest, norm, power_of_two};

/// The natural units of a mass matrix and a constraint Jacobian.
///
/// The length of a row is stored as a product of two factors: the entries and the units of the coordinates may
/// be so large or small that the length itself overflows or underflows.
pub(crate) struct Units<T, const N: usize, const M: usize> {
    /// For each coordinate, the unit in which its mass is ±1; for a massless coordinate, the unit in which its
    /// strongest coupling is 1.
    pub(crate) coordinates: [T; N],
    /// For each row, a power of two about as large as its entries.
    pub(super) powers: [T; M],
    /// For each row, its length in units of `powers` and `coordinates`; 1 for a row of zeros.
    pub(super) lengths: [T; M],
}

impl<T: Real, const N: usize, const M: usize> Units<T, N, M> {
    pub(crate) fn of(m: &[[T; N]; N], f: &[[T; N]; M]) -> Self {
        let (zero, one) = (T::constant(0.0), T::constant(1.0));
        let mass = |i: usize| Scalar::abs(m[i][i]);
        let mut units = Self {
            coordinates: entries(|i| if mass(i) > zero { one / Scalar::sqrt(mass(i)) } else { zero }),
            powers: entries(|a| power_of_two(largest(&f[a]))),
            lengths: [one; M],
        };
        // If a row ties massless coordinates only, its entries determine their units.
        units.lengths = units.lengths_of(f);
        for i in (0..N).filter(|&i| mass(i) == zero) {
            units.coordinates[i] = units.of_massless(i, m, f);
        }
        units.lengths = units.lengths_of(f);
        units
    }

    /// Returns row `a`, scaled to length 1.
    pub(super) fn unit_row(&self, a: usize, row: &[T; N]) -> [T; N] {
        entries(|i| row[i] / self.powers[a] * (self.coordinates[i] / self.lengths[a]))
    }

    /// Converts a quantity of row `a`, such as its residual, to the unit of that row.
    pub(crate) fn of_row(&self, a: usize, x: T) -> T {
        x / self.powers[a] / self.lengths[a]
    }

    fn lengths_of(&self, f: &[[T; N]; M]) -> [T; M] {
        entries(|a| {
            let length = norm::<T>(&entries::<T, N>(|i| f[a][i] / self.powers[a] * self.coordinates[i]));
            if length > T::constant(0.0) { length } else { T::constant(1.0) }
        })
    }

    fn of_massless(&self, i: usize, m: &[[T; N]; N], f: &[[T; N]; M]) -> T {
        let (zero, one) = (T::constant(0.0), T::constant(1.0));
        let unit = |j: usize| if self.coordinates[j] > zero { self.coordinates[j] } else { one };
        let inertia = (0..N).map(|j| Scalar::abs(m[i][j]) * unit(j));
        let couplings = (0..M).map(|a| Scalar::abs(self.of_row(a, f[a][i])));
        let strongest = inertia.chain(couplings).fold(zero, larger);
        if strongest > zero { one / strongest } else { one }
    }
}
