//! Directions in (t, q, q̇), and derivatives of the equations along them.

use nalgebra::SVector;

use crate::number::{Scalar, Wide, vector};

/// Direction of differentiation: rate of change of the time and of each entry of the state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction<T, const N: usize> {
    /// Rate of the time.
    pub t: T,
    /// Rates of the coordinates.
    pub q: SVector<T, N>,
    /// Rates of the velocities.
    pub v: SVector<T, N>,
}

impl<T: Scalar, const N: usize> Direction<T, N> {
    /// The zero direction.
    pub fn zero() -> Self {
        let zero = T::constant(0.0);
        Self { t: zero, q: vector([zero; N]), v: vector([zero; N]) }
    }

    /// Direction in which the time alone changes, at rate 1.
    pub fn of_time() -> Self {
        Self { t: T::constant(1.0), ..Self::zero() }
    }

    /// Direction in which coordinate `i` alone changes, at rate 1.
    pub fn of_coordinate(i: usize) -> Self {
        Self { q: unit(i), ..Self::zero() }
    }

    /// Direction in which velocity `i` alone changes, at rate 1.
    pub fn of_velocity(i: usize) -> Self {
        Self { v: unit(i), ..Self::zero() }
    }
}

/// Returns unit vector `i`, or zero for `i` ≥ `K`.
pub(crate) fn unit<T: Scalar, const K: usize>(i: usize) -> SVector<T, K> {
    vector(core::array::from_fn(|j| T::constant(if i == j { 1.0 } else { 0.0 })))
}

/// Derivatives of the residuals of the equations of motion along a direction, at fixed accelerations and
/// multipliers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResidualChange<T, const N: usize, const M: usize> {
    /// Derivative of M q̈ − h − Fᵀλ.
    pub motion: SVector<T, N>,
    /// Derivative of F q̈ + γ.
    pub acceleration: SVector<T, M>,
    /// Derivative of F q̇ + b.
    pub rate: SVector<T, M>,
    /// Derivative of Φ; zero for velocity constraints.
    pub position: SVector<T, M>,
}

impl<T: Scalar, const N: usize, const M: usize> ResidualChange<T, N, M> {
    /// Returns the sum of two derivatives.
    #[cfg(feature = "alloc")]
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self {
            motion: self.motion.zip_map(&other.motion, |x, y| x + y),
            acceleration: self.acceleration.zip_map(&other.acceleration, |x, y| x + y),
            rate: self.rate.zip_map(&other.rate, |x, y| x + y),
            position: self.position.zip_map(&other.position, |x, y| x + y),
        }
    }

    /// Returns the derivatives in one SIMD lane.
    pub(crate) fn lane<X: nalgebra::Scalar>(&self, lane: usize) -> ResidualChange<X, N, M>
    where
        T: Wide<X>,
    {
        let Self { motion, acceleration, rate, position } = self;
        ResidualChange {
            motion: motion.map(|x| x.lane(lane)),
            acceleration: acceleration.map(|x| x.lane(lane)),
            rate: rate.map(|x| x.lane(lane)),
            position: position.map(|x| x.lane(lane)),
        }
    }
}
