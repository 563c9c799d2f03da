//! Directions in time and state, and how the equations change along one.

use nalgebra::SVector;

use crate::number::{Scalar, Wide, vector};

/// A direction in which to differentiate: how fast the time and each entry of the state change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction<T, const N: usize> {
    /// Of the time.
    pub t: T,
    /// Of the coordinates.
    pub q: SVector<T, N>,
    /// Of the velocities.
    pub v: SVector<T, N>,
}

impl<T: Scalar, const N: usize> Direction<T, N> {
    /// Nothing changes.
    pub fn zero() -> Self {
        let zero = T::constant(0.0);
        Self { t: zero, q: vector([zero; N]), v: vector([zero; N]) }
    }

    /// The time alone changes, at the rate 1.
    pub fn of_time() -> Self {
        Self { t: T::constant(1.0), ..Self::zero() }
    }

    /// Coordinate `i` alone changes, at the rate 1.
    pub fn of_coordinate(i: usize) -> Self {
        Self { q: unit(i), ..Self::zero() }
    }

    /// Velocity `i` alone changes, at the rate 1.
    pub fn of_velocity(i: usize) -> Self {
        Self { v: unit(i), ..Self::zero() }
    }
}

/// The unit vector `i`; zero beyond the last.
pub(crate) fn unit<T: Scalar, const K: usize>(i: usize) -> SVector<T, K> {
    vector(core::array::from_fn(|j| T::constant(if i == j { 1.0 } else { 0.0 })))
}

/// Derivatives along a direction, at fixed accelerations and multipliers, of what the equations of motion set to zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResidualChange<T, const N: usize, const M: usize> {
    /// Of M q̈ − h − Fᵀλ.
    pub motion: SVector<T, N>,
    /// Of F q̈ + γ.
    pub acceleration: SVector<T, M>,
    /// Of F q̇ + b.
    pub rate: SVector<T, M>,
    /// Of Φ; zero for velocity constraints.
    pub position: SVector<T, M>,
}

impl<T: Scalar, const N: usize, const M: usize> ResidualChange<T, N, M> {
    /// The sum.
    #[cfg(feature = "alloc")]
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self {
            motion: self.motion.zip_map(&other.motion, |x, y| x + y),
            acceleration: self.acceleration.zip_map(&other.acceleration, |x, y| x + y),
            rate: self.rate.zip_map(&other.rate, |x, y| x + y),
            position: self.position.zip_map(&other.position, |x, y| x + y),
        }
    }

    /// What is in one lane.
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
