//! Coordinates in blocks, and products of quaternions.

use alloc::string::{String, ToString};
use alloc::vec::Vec;
use alloc::{format, vec};
use core::array::from_fn;

use nalgebra::DMatrix;

use crate::linearized::StateDerivatives;
use crate::names::Entry;
use crate::number::Real;
use crate::vector::StaticLength;

/// Coordinates in blocks: the four numbers of a quaternion, or one other coordinate.
pub(super) struct Blocks {
    /// Index of the first coordinate of each block, and of its first local coordinate; in their order.
    pub(super) quaternions: Vec<[usize; 2]>,
    pub(super) others: Vec<[usize; 2]>,
    /// Number of the coordinates, and of the local coordinates of place.
    pub(super) counts: [usize; 2],
}

impl Blocks {
    pub(super) fn of<L: StateDerivatives>() -> Self {
        let (mut quaternions, mut others, mut at) = (Vec::new(), Vec::new(), [0, 0]);
        while at[0] < <L::N>::COUNT {
            let is_quaternion = L::QUATERNIONS.contains(&at[0]);
            let (blocks, size) =
                if is_quaternion { (&mut quaternions, [4, 3]) } else { (&mut others, [1, 1]) };
            blocks.push(at);
            at = [at[0] + size[0], at[1] + size[1]];
        }
        Self { quaternions, others, counts: at }
    }

    /// Names of the local coordinates, then of their velocities.
    pub(super) fn names(&self, coordinates: &[&'static str]) -> Vec<String> {
        let [mut places, mut velocities] = [0, 1].map(|_| vec![String::new(); self.counts[1]]);
        for &[i, local] in &self.others {
            places[local] = coordinates[i].into();
            velocities[local] = Entry::Velocity(coordinates[i]).to_string();
        }
        for &[i, local] in &self.quaternions {
            let name = coordinates[i].strip_suffix("[0]").unwrap_or(coordinates[i]);
            for k in 0..3 {
                places[local + k] = format!("rotation({name})[{k}]");
                velocities[local + k] = format!("omega({name})[{k}]");
            }
        }
        places.append(&mut velocities);
        places
    }

    /// Columns of Z for the coordinates that are their own local coordinates.
    pub(super) fn unchanged<T: Real>(&self) -> DMatrix<T> {
        let [n, count] = self.counts;
        let mut columns = DMatrix::from_element(2 * n, 2 * count, T::constant(0.0));
        for &[i, local] in &self.others {
            columns[(i, local)] = T::constant(1.0);
            columns[(n + i, count + local)] = T::constant(1.0);
        }
        columns
    }

    /// Columns of Z for the quaternions at (q, q̇): δQ = ½ Q ⊗ δφ, δQ̇ = ½ δQ ⊗ ω + ½ Q ⊗ δω.
    pub(super) fn turned<T: Real>(&self, point: [&[T]; 2]) -> DMatrix<T> {
        let ([n, count], half) = (self.counts, T::constant(0.5));
        let mut columns = DMatrix::from_element(2 * n, 2 * count, T::constant(0.0));
        for &[i, local] in &self.quaternions {
            let [q, rate] = point.map(|entries| four(entries, i));
            // ½ ω = vector part of Q̄ ⊗ Q̇
            let half_omega = turned_back(q, rate);
            for k in 0..3 {
                let change = times(q, unit::<T, 3>(k).map(|x| x * half));
                put(&mut columns, [i, local + k], &change);
                put(&mut columns, [n + i, local + k], &times(change, half_omega));
                put(&mut columns, [n + i, count + local + k], &change);
            }
        }
        columns
    }

    /// Rows of Z⁻ for the quaternions at (q, q̇): δφ = 2 Q̄ ⊗ δQ, δω = 2 (δQ)‾ ⊗ Q̇ + 2 Q̄ ⊗ δQ̇, vector parts. They are
    /// linear in (q, q̇).
    pub(super) fn turning<T: Real>(&self, point: [&[T]; 2]) -> DMatrix<T> {
        let ([n, count], two) = (self.counts, T::constant(2.0));
        let mut columns = DMatrix::from_element(2 * count, 2 * n, T::constant(0.0));
        for &[i, local] in &self.quaternions {
            let [q, rate] = point.map(|entries| four(entries, i));
            for k in 0..4 {
                let change = unit::<T, 4>(k).map(|x| x * two);
                put(&mut columns, [local, i + k], &turned_back(q, change));
                put(&mut columns, [count + local, i + k], &turned_back(change, rate));
                put(&mut columns, [count + local, n + i + k], &turned_back(q, change));
            }
        }
        columns
    }
}

/// Four numbers of a quaternion.
pub(super) type Four<T> = [T; 4];

pub(super) fn four<T: Real>(entries: &[T], first: usize) -> Four<T> {
    from_fn(|k| entries[first + k])
}

fn unit<T: Real, const K: usize>(k: usize) -> [T; K] {
    from_fn(|j| T::constant(if j == k { 1.0 } else { 0.0 }))
}

/// Writes entries into a column of the matrix, from this row on.
fn put<T: Real>(matrix: &mut DMatrix<T>, [row, column]: [usize; 2], entries: &[T]) {
    entries.iter().enumerate().for_each(|(k, x)| matrix[(row + k, column)] = *x);
}

/// Vector part of p̄ ⊗ r.
pub(super) fn turned_back<T: Real>([w, x, y, z]: Four<T>, [a, b, c, d]: Four<T>) -> [T; 3] {
    [w * b - x * a - y * d + z * c, w * c - y * a - z * b + x * d, w * d - z * a - x * c + y * b]
}

/// p ⊗ (0, v).
pub(super) fn times<T: Real>([w, x, y, z]: Four<T>, [a, b, c]: [T; 3]) -> Four<T> {
    [-(x * a + y * b + z * c), w * a + y * c - z * b, w * b + z * a - x * c, w * c + x * b - y * a]
}
