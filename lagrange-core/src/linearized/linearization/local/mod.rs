//! Local coordinates of the changes of a state: a quaternion of length 1 changes by a rotation.
//!
//! A frame that a quaternion Q turns has the angular velocity ω = 2 Q̄ ⊗ Q̇ along its own axes, and a change of its
//! orientation is a small rotation δφ = 2 Q̄ ⊗ δQ along these axes (vector parts; J. Solà, J. Deray and D. Atchuthan, "A
//! micro Lie theory for state estimation in robotics", 2018, (22) and example 5). With |Q| = 1 they follow from (Q, Q̇),
//! and the other way around: δQ = ½ Q ⊗ δφ, δQ̇ = ½ δQ ⊗ ω + ½ Q ⊗ δω.

mod blocks;
mod finite;

use alloc::string::String;
use alloc::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::Linearization;
use crate::derivatives::tangent::Tangent;
use crate::error::Error;
use crate::linearized::argument::check_parameters;
use crate::linearized::{Linearized, StateDerivatives};
use crate::number::Real;
use crate::solution::consistent;
use crate::system::finite::check_finite;
use crate::system::{StateOf, lookup};
use crate::vector::StaticLength;
use blocks::Blocks;
pub(crate) use finite::{change, changed};

/// Local coordinates z of the changes of a state: δ(q, q̇) = Z z.
///
/// Where a quaternion `q` turns a frame, its change is δφ, a rotation about the axes of the frame, and the change of its
/// velocity is δω, the change of the angular velocity along these axes. All other coordinates are their own local
/// coordinates. With [`basis`](Self::basis) and [`inverse`](Self::inverse) other derivatives are converted, such as those
/// of a [`DiscreteTime`](crate::linearized::DiscreteTime) step from x to x⁺: A in local coordinates is Z⁻(x⁺) A Z(x), and B is Z⁻(x⁺)
/// B. [`local_change`](Linearized::local_change) and [`locally_changed`](Linearized::locally_changed) are for changes that are not
/// small.
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
pub(crate) fn linearize_locally<L: Linearized<Scalar: Real>>(
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
    pub(crate) fn at<L: StateDerivatives<Scalar = T>>(system: &L, state: &StateOf<L>) -> Result<Self, Error> {
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
