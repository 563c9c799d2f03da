//! Natural units, in which masses are about 1 and constraint rows have length 1.

use crate::number::{Real, Scalar, larger, largest, norm, power_of_two, unit_of};
use crate::vector::{Array, Element, StaticLength};

/// The natural units of a mass matrix and a constraint Jacobian.
///
/// The length of a row is stored as a product of two factors: the entries and the units of the coordinates may
/// be so large or small that the length itself overflows or underflows.
pub(crate) struct Units<T: Element, N: StaticLength, M: StaticLength> {
    /// For each coordinate, the unit in which its mass is ±1; for a massless coordinate, the unit in which its
    /// strongest coupling is 1.
    pub(crate) coordinates: Array<T, N>,
    /// For each row, a power of two about as large as its entries.
    pub(super) powers: Array<T, M>,
    /// For each row, its length in units of `powers` and `coordinates`; 1 for a row of zeros.
    pub(super) lengths: Array<T, M>,
}

impl<T: Real, N: StaticLength, M: StaticLength> Units<T, N, M> {
    pub(crate) fn of(m: &Array<Array<T, N>, N>, f: &Array<Array<T, N>, M>) -> Self {
        let (zero, one) = (T::constant(0.0), T::constant(1.0));
        let mass = |i: usize| Scalar::abs(m[i][i]);
        let mut units = Self {
            coordinates: Array::from_fn(|i| if mass(i) > zero { one / Scalar::sqrt(mass(i)) } else { zero }),
            powers: Array::from_fn(|a| power_of_two(largest(&f[a]))),
            lengths: Array::filled(one),
        };
        // If a row ties massless coordinates only, its entries determine their units.
        units.lengths = units.lengths_of(f);
        for i in (0..N::COUNT).filter(|&i| mass(i) == zero) {
            units.coordinates[i] = units.of_massless(i, m, f);
        }
        units.lengths = units.lengths_of(f);
        units
    }

    /// Returns row `a`, scaled to length 1.
    pub(super) fn unit_row(&self, a: usize, row: &Array<T, N>) -> Array<T, N> {
        Array::from_fn(|i| row[i] / self.powers[a] * (self.coordinates[i] / self.lengths[a]))
    }

    /// Converts a quantity of row `a`, such as its residual, to the unit of that row.
    pub(crate) fn of_row(&self, a: usize, x: T) -> T {
        x / self.powers[a] / self.lengths[a]
    }

    fn lengths_of(&self, f: &Array<Array<T, N>, M>) -> Array<T, M> {
        Array::from_fn(|a| {
            unit_of(norm::<T>(&Array::<T, N>::from_fn(|i| f[a][i] / self.powers[a] * self.coordinates[i])))
        })
    }

    fn of_massless(&self, i: usize, m: &Array<Array<T, N>, N>, f: &Array<Array<T, N>, M>) -> T {
        let zero = T::constant(0.0);
        // Two coordinates that have an inertia only together share it.
        let inertia = |j: usize| match m[j][j] == zero {
            true => Scalar::sqrt(Scalar::abs(m[i][j])),
            false => Scalar::abs(m[i][j]) * self.coordinates[j],
        };
        let couplings = (0..M::COUNT).map(|a| Scalar::abs(self.of_row(a, f[a][i])));
        let strongest = (0..N::COUNT).map(inertia).chain(couplings).fold(zero, larger);
        T::constant(1.0) / unit_of(strongest)
    }
}
