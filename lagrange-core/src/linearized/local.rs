//! Local coordinates of the changes of a state: a quaternion of length 1 changes by a rotation.
//!
//! A frame that a quaternion Q turns has the angular velocity ω = 2 Q̄ ⊗ Q̇ along its own axes, and a change of its
//! orientation is a small rotation δφ = 2 Q̄ ⊗ δQ along these axes (vector parts; J. Solà, J. Deray and D. Atchuthan, "A
//! micro Lie theory for state estimation in robotics", 2018, (22) and example 5). With |Q| = 1 they follow from (Q, Q̇),
//! and the other way around: δQ = ½ Q ⊗ δφ, δQ̇ = ½ δQ ⊗ ω + ½ Q ⊗ δω.

use alloc::string::{String, ToString};
use alloc::vec::Vec;
use alloc::{format, vec};
use core::array::from_fn;

use nalgebra::{DMatrix, DVector};

use super::argument::check_parameters;
use super::linearization::Linearization;
use super::tangent::Tangent;
use super::{Linearized, StateDerivatives};
use crate::error::Error;
use crate::names::Entry;
use crate::number::Real;
use crate::solution::consistent;
use crate::system::finite::check_finite;
use crate::system::{StateOf, lookup};
use crate::vector::Length;

/// Local coordinates z of the changes of a state: δ(q, q̇) = Z z.
///
/// Where a quaternion `q` turns a frame, its change is δφ, a rotation about the axes of the frame, and the change of its
/// velocity is δω, the change of the angular velocity along these axes. All other coordinates are their own local
/// coordinates. With [`basis`](Self::basis) and [`inverse`](Self::inverse) other derivatives are converted, such as those
/// of a [`DiscreteTime`](super::DiscreteTime) step from x to x⁺: A in local coordinates is Z⁻(x⁺) A Z(x), and B is Z⁻(x⁺)
/// B.
///
/// ```
/// use lagrange_core::linearized::DiscreteTime;
/// use lagrange_core::prelude::*;
///
/// #[derive(Lagrangian)]
/// #[coordinates(q: [4])]
/// #[frame(body: rotate(q))]
/// #[lagrangian(kinetic(body, 1, [0, 0, 0], [[a, 0, 0], [0, a, 0], [0, 0, a]]))]
/// struct Ball { a: f64 }
///
/// let state = State::new([1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 2.0, 0.0]);
/// let mut ball = DiscreteTime::new(Ball { a: 1.0 }, Dop853::default(), &[])?;
/// ball.advance(&state, 0.1)?;
/// let [before, after] = [&state, ball.state()].map(|state| ball.system().local_coordinates(state));
/// let (before, after) = (before?, after?);
/// assert_eq!(before.names()[..3], ["rotation(q)[0]", "rotation(q)[1]", "rotation(q)[2]"]);
/// let a = after.inverse() * ball.a() * before.basis();
/// // The angular velocity of a ball stays.
/// assert!((a[(3, 3)] - 1.0).abs() < 1e-9 && a[(3, 0)].abs() < 1e-9);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LocalCoordinates<T> {
    names: Vec<String>,
    basis: DMatrix<T>,
    inverse: DMatrix<T>,
}

impl<T> LocalCoordinates<T> {
    /// Names of the local coordinates, places first: `rotation(q)[0]` … `rotation(q)[2]` for δφ of a quaternion `q`, and
    /// `omega(q)[0]` … for δω.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Z: one row for each coordinate, then for each velocity; one column for each local coordinate.
    pub fn basis(&self) -> &DMatrix<T> {
        &self.basis
    }

    /// Z⁻, with Z⁻ Z = 1: the local coordinates of a change that keeps the lengths of the quaternions.
    pub fn inverse(&self) -> &DMatrix<T> {
        &self.inverse
    }
}

/// See [`Linearized::linearize_locally`].
pub(super) fn linearize<L: Linearized<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
    names: &[&str],
) -> Result<Linearization<L::Scalar>, Error> {
    const {
        check_parameters::<L>();
        assert!(
            L::QUATERNIONS.len() == <L::M>::COUNT,
            "local coordinates leave no constraint but the lengths of quaternions: use `linearize`"
        );
    };
    let parameters = lookup::indices::<L>(L::PARAMETERS, "parameter", names)?;
    let LocalCoordinates { names, basis, inverse } = LocalCoordinates::at(system, state)?;
    let tangent = Tangent::at(system, state)?;
    let (q, v, accelerations) = (&state.q, &state.v, &tangent.solution.accelerations);
    // d/dt (Z⁻ δ) = Z⁻ δ̇ + Ż⁻ δ, where the rows of quaternions in Z⁻ are linear in (q, q̇).
    let turning = Blocks::of::<L>().turning([v.as_slice(), accelerations.as_slice()]);
    let a = &inverse * tangent.change_along(&basis)? + turning * &basis;
    Ok(Linearization {
        a,
        b: inverse * tangent.change_by(&parameters)?,
        rate: DVector::from_iterator(q.len() + v.len(), v.iter().chain(accelerations).copied()),
        states: names,
        inputs: parameters.iter().map(|&k| L::PARAMETERS[k].into()).collect(),
        basis,
    })
}

impl<T: Real> LocalCoordinates<T> {
    /// See [`Linearized::local_coordinates`].
    pub(super) fn at<L: StateDerivatives<Scalar = T>>(system: &L, state: &StateOf<L>) -> Result<Self, Error> {
        check_finite(system, state)?;
        consistent::check(system, state)?;
        let (blocks, point) = (Blocks::of::<L>(), [state.q.as_slice(), state.v.as_slice()]);
        let inverse = blocks.turning(point) + blocks.unchanged().transpose();
        Ok(Self {
            names: blocks.names(L::COORDINATES),
            basis: blocks.turned(point) + blocks.unchanged(),
            inverse,
        })
    }
}

/// Coordinates in blocks: the four numbers of a quaternion, or one other coordinate.
struct Blocks {
    /// Index of the first coordinate of each block, and of its first local coordinate; in their order.
    quaternions: Vec<[usize; 2]>,
    others: Vec<[usize; 2]>,
    /// Number of the coordinates, and of the local coordinates of place.
    counts: [usize; 2],
}

impl Blocks {
    fn of<L: StateDerivatives>() -> Self {
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
    fn names(&self, coordinates: &[&'static str]) -> Vec<String> {
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
    fn unchanged<T: Real>(&self) -> DMatrix<T> {
        let [n, count] = self.counts;
        let mut columns = DMatrix::from_element(2 * n, 2 * count, T::constant(0.0));
        for &[i, local] in &self.others {
            columns[(i, local)] = T::constant(1.0);
            columns[(n + i, count + local)] = T::constant(1.0);
        }
        columns
    }

    /// Columns of Z for the quaternions at (q, q̇): δQ = ½ Q ⊗ δφ, δQ̇ = ½ δQ ⊗ ω + ½ Q ⊗ δω.
    fn turned<T: Real>(&self, point: [&[T]; 2]) -> DMatrix<T> {
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
    fn turning<T: Real>(&self, point: [&[T]; 2]) -> DMatrix<T> {
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
type Four<T> = [T; 4];

fn four<T: Real>(entries: &[T], first: usize) -> Four<T> {
    from_fn(|k| entries[first + k])
}

fn unit<T: Real, const K: usize>(k: usize) -> [T; K] {
    from_fn(|j| T::constant(if j == k { 1.0 } else { 0.0 }))
}

/// Writes a column from this entry on.
fn put<T: Real>(matrix: &mut DMatrix<T>, [row, column]: [usize; 2], entries: &[T]) {
    entries.iter().enumerate().for_each(|(k, x)| matrix[(row + k, column)] = *x);
}

/// Vector part of p̄ ⊗ r.
fn turned_back<T: Real>([w, x, y, z]: Four<T>, [a, b, c, d]: Four<T>) -> [T; 3] {
    [w * b - x * a - y * d + z * c, w * c - y * a - z * b + x * d, w * d - z * a - x * c + y * b]
}

/// p ⊗ (0, v).
fn times<T: Real>([w, x, y, z]: Four<T>, [a, b, c]: [T; 3]) -> Four<T> {
    [-(x * a + y * b + z * c), w * a + y * c - z * b, w * b + z * a - x * c, w * c + x * b - y * a]
}
