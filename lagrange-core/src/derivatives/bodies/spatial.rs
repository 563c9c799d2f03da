//! Vectors of space, and pairs of them: twists and wrenches about one point, along one set of axes (Featherstone, *Rigid
//! Body Dynamics Algorithms*, chapter 2).

use crate::number::Scalar;

pub(super) type Triple<T> = [T; 3];

#[inline(always)]
pub(super) fn dot<T: Scalar>(x: Triple<T>, y: Triple<T>) -> T {
    x[0].multiply_add(y[0], x[1].multiply_add(y[1], x[2] * y[2]))
}

#[inline(always)]
pub(super) fn cross<T: Scalar>(x: Triple<T>, y: Triple<T>) -> Triple<T> {
    let of = |i: usize, j: usize| x[j].subtract_product(y[i], x[i] * y[j]);
    [of(1, 2), of(2, 0), of(0, 1)]
}

#[inline(always)]
pub(super) fn plus<T: Scalar>(x: Triple<T>, y: Triple<T>) -> Triple<T> {
    [x[0] + y[0], x[1] + y[1], x[2] + y[2]]
}

#[inline(always)]
pub(super) fn minus<T: Scalar>(x: Triple<T>, y: Triple<T>) -> Triple<T> {
    [x[0] - y[0], x[1] - y[1], x[2] - y[2]]
}

#[inline(always)]
pub(super) fn times<T: Scalar>(scale: T, x: Triple<T>) -> Triple<T> {
    [scale * x[0], scale * x[1], scale * x[2]]
}

/// Product of a matrix, given by its rows, and a vector.
#[inline(always)]
pub(super) fn product<T: Scalar>(rows: &[Triple<T>; 3], x: Triple<T>) -> Triple<T> {
    [dot(rows[0], x), dot(rows[1], x), dot(rows[2], x)]
}

#[inline(always)]
pub(super) fn columns<T: Scalar>([x, y, z]: [Triple<T>; 3]) -> [Triple<T>; 3] {
    [[x[0], y[0], z[0]], [x[1], y[1], z[1]], [x[2], y[2], z[2]]]
}

/// Twist (ω, v), with v the velocity of the body at the common point; or wrench (torque about that point, force).
#[derive(Clone, Copy, Debug)]
pub(super) struct Spatial<T> {
    pub(super) turning: Triple<T>,
    pub(super) moving: Triple<T>,
}

impl<T: Scalar> Spatial<T> {
    pub(super) fn zero() -> Self {
        Self { turning: [T::constant(0.0); 3], moving: [T::constant(0.0); 3] }
    }

    #[inline(always)]
    pub(super) fn plus(self, other: Self) -> Self {
        Self { turning: plus(self.turning, other.turning), moving: plus(self.moving, other.moving) }
    }

    #[inline(always)]
    pub(super) fn times(self, scale: T) -> Self {
        Self { turning: times(scale, self.turning), moving: times(scale, self.moving) }
    }

    /// Rate of change of a twist that is carried along by this one.
    #[inline(always)]
    pub(super) fn carries(self, twist: Self) -> Self {
        Self {
            turning: cross(self.turning, twist.turning),
            moving: plus(cross(self.turning, twist.moving), cross(self.moving, twist.turning)),
        }
    }

    /// Rate of change of a wrench that is carried along by this twist.
    #[inline(always)]
    pub(super) fn carries_wrench(self, wrench: Self) -> Self {
        Self {
            turning: plus(cross(self.turning, wrench.turning), cross(self.moving, wrench.moving)),
            moving: cross(self.turning, wrench.moving),
        }
    }
}
