//! Rigid bodies that a joint carries, as one.

use super::spatial::{Spatial, Triple, columns, cross, dot, minus, plus, product, times};
use crate::number::Scalar;

/// Orientation of a frame, by rows of its rotation matrix to the common axes, and its origin.
#[derive(Clone, Copy)]
pub(super) struct Pose<T> {
    pub(super) axes: [Triple<T>; 3],
    pub(super) origin: Triple<T>,
}

impl<T: Scalar> Pose<T> {
    #[inline(always)]
    pub(super) fn of(&[a, b, c, d, e, f, g, h, i, x, y, z]: &[T; 12]) -> Self {
        Self { axes: [[a, b, c], [d, e, f], [g, h, i]], origin: [x, y, z] }
    }
}

/// Sums over bodies. Particles of mass m at r have the velocity v.
#[derive(Clone, Copy, Debug)]
pub(super) struct Composite<T> {
    mass: T,
    /// Σ m r
    moment: Triple<T>,
    /// Σ m (r² − r rᵀ), by rows
    inertia: [Triple<T>; 3],
    /// 2 Σ m v rᵀ, by rows
    spread: [Triple<T>; 3],
    /// 2 Σ m v
    momentum: Triple<T>,
    /// Rate of change of momentum and angular momentum, without weight.
    pub(super) wrench: Spatial<T>,
}

impl<T: Scalar> Composite<T> {
    pub(super) fn nothing() -> Self {
        let zero = [T::constant(0.0); 3];
        Self {
            mass: zero[0],
            moment: zero,
            inertia: [zero; 3],
            spread: [zero; 3],
            momentum: zero,
            wrench: Spatial::zero(),
        }
    }

    /// The sums of one body by mass, centre, and inertia about it, from the twist of its frame and its rate of change.
    #[inline(always)]
    pub(super) fn of(body: &[T; 10], pose: &Pose<T>, twist: Spatial<T>, rate: Spatial<T>) -> Self {
        let &[mass, x, y, z, a, b, c, d, e, f] = body;
        let (centre, inertia) = ([x, y, z], [[a, b, c], [b, d, e], [c, e, f]]);
        let Spatial { turning, moving } = twist;
        let [a, b, c] = &pose.axes;
        let half = [product(&inertia, *a), product(&inertia, *b), product(&inertia, *c)];
        let central = columns([product(&half, *a), product(&half, *b), product(&half, *c)]);
        let at = plus(pose.origin, product(&pose.axes, centre));
        let velocity = plus(moving, cross(turning, at));
        let acceleration = plus(plus(rate.moving, cross(rate.turning, at)), cross(turning, velocity));
        let (moment, force) = (times(mass, at), times(mass, acceleration));
        let momentum = times(mass + mass, velocity);
        let about_centre = plus(product(&central, rate.turning), cross(turning, product(&central, turning)));
        let trace = central[0][0] + central[1][1] + central[2][2];
        let (mut about_point, mut second) = (central, central);
        let square = dot(at, moment);
        for i in 0..3 {
            for j in 0..3 {
                about_point[i][j] = at[i].subtract_product(moment[j], central[i][j]);
                second[i][j] = T::constant(0.0) - (central[i][j] + central[i][j]);
            }
            about_point[i][i] = about_point[i][i] + square;
            second[i][i] = second[i][i] + trace;
        }
        // Of the velocity about the centre, ω × r: the columns of Σ m r rᵀ, which is symmetric, turned by ω.
        let [a, b, c] = second;
        let mut spread = columns([cross(turning, a), cross(turning, b), cross(turning, c)]);
        for i in 0..3 {
            spread[i] = plus(spread[i], times(momentum[i], at));
        }
        let wrench = Spatial { turning: plus(about_centre, cross(at, force)), moving: force };
        Self { mass, moment, inertia: about_point, spread, momentum, wrench }
    }

    #[inline(always)]
    pub(super) fn add(&mut self, other: &Self) {
        self.mass = self.mass + other.mass;
        self.moment = plus(self.moment, other.moment);
        self.momentum = plus(self.momentum, other.momentum);
        self.wrench = self.wrench.plus(other.wrench);
        for i in 0..3 {
            self.inertia[i] = plus(self.inertia[i], other.inertia[i]);
            self.spread[i] = plus(self.spread[i], other.spread[i]);
        }
    }

    /// Momentum and angular momentum of the bodies along a twist.
    #[inline(always)]
    pub(super) fn momentum_of(&self, Spatial { turning, moving }: Spatial<T>) -> Spatial<T> {
        Spatial {
            turning: plus(product(&self.inertia, turning), cross(self.moment, moving)),
            moving: plus(times(self.mass, moving), cross(turning, self.moment)),
        }
    }

    /// Σ 2 m w × v, and its moment Σ r × (2 m w × v): inertial forces on bodies whose twist changes by one with the
    /// angular velocity w, beside those of its rate of change.
    #[inline(always)]
    pub(super) fn gyroscopic(&self, w: Triple<T>) -> Spatial<T> {
        let along = product(&self.spread, w);
        Spatial { turning: minus(times(self.trace(), w), along), moving: cross(w, self.momentum) }
    }

    /// Angular velocity whose power with any w is that of [`gyroscopic`](Self::gyroscopic) forces of w along `twist`.
    #[inline(always)]
    pub(super) fn gyroscopic_transposed(&self, Spatial { turning, moving }: Spatial<T>) -> Triple<T> {
        let along = product(&columns(self.spread), turning);
        plus(minus(times(self.trace(), turning), along), cross(self.momentum, moving))
    }

    #[inline(always)]
    fn trace(&self) -> T {
        self.spread[0][0] + self.spread[1][1] + self.spread[2][2]
    }
}
