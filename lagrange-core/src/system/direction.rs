//! Directions in (t, q, q̇), and derivatives of the equations along them.

use crate::number::{Scalar, Wide};
use crate::vector::{Array, Element, Entrywise, StaticLength, Vector, vector, zeros};

/// Direction of differentiation: rate of change of the time and of each entry of the state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction<T: Element, N: StaticLength> {
    /// Rate of the time.
    pub t: T,
    /// Rates of the coordinates.
    pub q: Vector<T, N>,
    /// Rates of the velocities.
    pub v: Vector<T, N>,
}

impl<T: Scalar, N: StaticLength> Direction<T, N> {
    /// The zero direction.
    pub fn zero() -> Self {
        Self { t: T::constant(0.0), q: zeros(), v: zeros() }
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

    /// Directions along which one argument changes at rate 1, one in each component: argument 0 is the time, then
    /// coordinates, then velocities.
    #[inline]
    pub(crate) fn of_arguments<X: Scalar>(arguments: impl Iterator<Item = usize>) -> Self
    where
        T: Wide<X>,
    {
        let mut directions = Self::zero();
        for (lane, k) in arguments.enumerate() {
            let rate = match k.checked_sub(1) {
                None => &mut directions.t,
                Some(i) if i < N::COUNT => &mut directions.q[i],
                Some(i) => &mut directions.v[i - N::COUNT],
            };
            rate.put(lane, X::constant(1.0));
        }
        directions
    }
}

/// Returns unit vector `i`, or zero for `i` ≥ `K`.
pub(crate) fn unit<T: Scalar, K: StaticLength>(i: usize) -> Vector<T, K> {
    vector(Array::from_fn(|j| T::constant(if i == j { 1.0 } else { 0.0 })))
}

/// Derivatives of the residuals of the equations of motion along a direction, at fixed accelerations and
/// multipliers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResidualChange<T: Element, N: StaticLength, M: StaticLength> {
    /// Derivative of M q̈ − h − Fᵀλ.
    pub motion: Vector<T, N>,
    /// Derivative of F q̈ + γ.
    pub acceleration: Vector<T, M>,
    /// Derivative of F q̇ + b.
    pub rate: Vector<T, M>,
    /// Derivative of Φ; zero for velocity constraints.
    pub position: Vector<T, M>,
}

impl<T: Scalar, N: StaticLength, M: StaticLength> ResidualChange<T, N, M> {
    /// Returns the sum of two derivatives.
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self {
            motion: self.motion.plus(&other.motion),
            acceleration: self.acceleration.plus(&other.acceleration),
            rate: self.rate.plus(&other.rate),
            position: self.position.plus(&other.position),
        }
    }

    /// Returns the derivatives in one SIMD lane.
    pub(crate) fn lane<X: Element>(&self, lane: usize) -> ResidualChange<X, N, M>
    where
        T: Wide<X>,
    {
        self.each(|x| x.lane(lane))
    }

    /// Returns the values of a function of each entry.
    pub(crate) fn each<X: Element>(&self, of: impl Fn(T) -> X + Copy) -> ResidualChange<X, N, M> {
        let Self { motion, acceleration, rate, position } = self;
        ResidualChange {
            motion: motion.each(of),
            acceleration: acceleration.each(of),
            rate: rate.each(of),
            position: position.each(of),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::Direction;
    use crate::generated::vector;

    #[test]
    fn a_direction_of_one_argument_changes_that_alone() {
        let zero = Direction::<f64, 2>::zero();
        assert_eq!((zero.t, zero.q, zero.v), (0.0, vector([0.0; 2]), vector([0.0; 2])));
        assert_eq!(Direction::of_time(), Direction { t: 1.0, ..zero });
        assert_eq!(Direction::of_coordinate(1), Direction { q: vector([0.0, 1.0]), ..zero });
        assert_eq!(Direction::of_velocity(0), Direction { v: vector([1.0, 0.0]), ..zero });
        assert_eq!(Direction::of_velocity(2), zero);
    }
}
