//! Mass, centre of mass and inertia of links, and of links that are fixed to each other.

use crate::pose::Pose;
use crate::robot::Inertial;
use nalgebra::{Matrix3, Vector3};

/// A rigid body in the axes of its link.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Body {
    /// In kg.
    pub(crate) m: f64,
    /// In m.
    pub(crate) centre: Vector3<f64>,
    /// About the centre of mass, in kg m².
    pub(crate) inertia: Matrix3<f64>,
}

impl Body {
    pub(crate) fn of(inertial: &Inertial) -> Self {
        Self { m: inertial.mass, centre: Vector3::zeros(), inertia: inertial.inertia }.at(&inertial.origin)
    }

    /// The same body in the axes of a frame in which its own lies at `pose`. Numbers are kept as they are where nothing
    /// turns.
    pub(crate) fn at(&self, pose: &Pose) -> Self {
        if pose.rpy == [0.0; 3] {
            return Self { centre: self.centre + pose.xyz, ..*self };
        }
        let rotation = pose.rotation();
        let inertia = rotation * self.inertia * rotation.transpose();
        let inertia = (inertia + inertia.transpose()) * 0.5;
        Self { m: self.m, centre: rotation * self.centre + pose.xyz, inertia }
    }

    /// Both as one, in the same axes: by the parallel-axis theorem.
    pub(crate) fn with(&self, other: &Self) -> Self {
        if other.is_nothing() {
            return *self;
        }
        if self.is_nothing() {
            return *other;
        }
        let m = self.m + other.m;
        let centre = if m == 0.0 { self.centre } else { (self.centre * self.m + other.centre * other.m) / m };
        let about = |body: &Self| body.inertia + body.m * square(&(body.centre - centre));
        Self { m, centre, inertia: about(self) + about(other) }
    }

    /// True without mass and inertia.
    pub(crate) fn is_nothing(&self) -> bool {
        self.m == 0.0 && self.inertia == Matrix3::zeros()
    }

    /// Inertia about an axis through the origin of the frame, given by its direction of length 1.
    pub(crate) fn about(&self, axis: &Vector3<f64>) -> f64 {
        axis.dot(&((self.inertia + self.m * square(&self.centre)) * axis))
    }
}

/// Inertia of a unit mass at `d`, |d|² − d dᵀ.
fn square(d: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::from_diagonal_element(d.norm_squared()) - d * d.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two equal point masses are a dumbbell: m d²/2 across, nothing along.
    #[test]
    fn points_make_a_dumbbell() {
        let point = |x| Body { m: 1.5, centre: Vector3::new(x, 0.0, 0.0), inertia: Matrix3::zeros() };
        let both = point(0.25).with(&point(1.25));
        assert_eq!((both.m, both.centre), (3.0, Vector3::new(0.75, 0.0, 0.0)));
        assert_eq!(both.inertia, Matrix3::from_diagonal(&Vector3::new(0.0, 0.75, 0.75)));
        assert_eq!(both.about(&Vector3::y()), 1.5 * (0.0625 + 1.5625));
    }

    /// A quarter of a turn about z takes x to y.
    #[test]
    fn inertia_turns_with_its_axes() {
        let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0));
        let body = Body { m: 1.0, centre: Vector3::x(), inertia };
        let pose = Pose { xyz: Vector3::z(), rpy: [0.0, 0.0, std::f64::consts::FRAC_PI_2] };
        let turned = body.at(&pose);
        assert_eq!(turned.centre, Vector3::new(0.0, 1.0, 1.0));
        assert_eq!(turned.inertia, Matrix3::from_diagonal(&Vector3::new(2.0, 1.0, 3.0)));
    }
}
