//! Places of frames in other frames.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Matrix3, Vector3};

/// Place of a frame in another, as URDF states it: a translation, then turns by yaw about z, pitch about the new y, roll
/// about the new x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pose {
    pub(crate) xyz: Vector3<f64>,
    /// Roll, pitch, yaw, in rad.
    pub(crate) rpy: [f64; 3],
}

impl Pose {
    pub(crate) const HERE: Self = Self { xyz: Vector3::new(0.0, 0.0, 0.0), rpy: [0.0; 3] };

    /// Rotation that maps components along the new axes to components along the old.
    pub(crate) fn rotation(&self) -> Matrix3<f64> {
        let [(sr, cr), (sp, cp), (sy, cy)] = self.rpy.map(sine_and_cosine);
        let roll = Matrix3::new(1.0, 0.0, 0.0, 0.0, cr, -sr, 0.0, sr, cr);
        let pitch = Matrix3::new(cp, 0.0, sp, 0.0, 1.0, 0.0, -sp, 0.0, cp);
        let yaw = Matrix3::new(cy, -sy, 0.0, sy, cy, 0.0, 0.0, 0.0, 1.0);
        yaw * pitch * roll
    }

    /// Place of the frame that lies at `next` in this one. Angles are kept as written where only one of the two turns.
    pub(crate) fn then(&self, next: &Self) -> Self {
        let xyz = self.xyz + self.rotation() * next.xyz;
        let rpy = match (self.rpy, next.rpy) {
            (turn, [0.0, 0.0, 0.0]) | ([0.0, 0.0, 0.0], turn) => turn,
            _ => roll_pitch_yaw(&(self.rotation() * next.rotation())),
        };
        Self { xyz, rpy }
    }
}

/// Exact at multiples of π/2, so that right angles stay right when they are composed.
fn sine_and_cosine(angle: f64) -> (f64, f64) {
    let quarters = (angle / FRAC_PI_2).round();
    if quarters * FRAC_PI_2 != angle {
        return angle.sin_cos();
    }
    match quarters.rem_euclid(4.0) {
        1.0 => (1.0, 0.0),
        2.0 => (0.0, -1.0),
        3.0 => (-1.0, 0.0),
        _ => (0.0, 1.0),
    }
}

/// Angles of a rotation. Of those that fit at a pitch of ±π/2, any; the rotation is met to round-off there too, because
/// the roll is taken from what is left after the yaw, whose entries are not small.
pub(crate) fn roll_pitch_yaw(rotation: &Matrix3<f64>) -> [f64; 3] {
    let entry = |i, j| rotation[(i, j)] + 0.0;
    let yaw = entry(1, 0).atan2(entry(0, 0));
    let (sine, cosine) = yaw.sin_cos();
    let pitch = (-entry(2, 0)).atan2(cosine * entry(0, 0) + sine * entry(1, 0));
    let roll = (sine * entry(0, 2) - cosine * entry(1, 2)).atan2(cosine * entry(1, 1) - sine * entry(0, 1));
    [roll + 0.0, pitch + 0.0, yaw + 0.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Angles of a grid that holds the poles, and of poles that are missed by little.
    fn angles() -> impl Iterator<Item = [f64; 3]> {
        let steps = (-6..=6).map(|k| f64::from(k) * FRAC_PI_2 / 3.0);
        let pitches = [0.0, 1e-3, 1e-6, 1e-8, 1e-9, 1e-12, 1e-16].map(|off| FRAC_PI_2 - off);
        let pitches: Vec<f64> = steps.clone().chain(pitches).chain(pitches.map(|pitch| -pitch)).collect();
        steps.clone().flat_map(move |roll| {
            let pitches = pitches.clone();
            steps
                .clone()
                .flat_map(move |yaw| pitches.clone().into_iter().map(move |pitch| [roll, pitch, yaw]))
        })
    }

    #[test]
    fn angles_give_the_rotation_back_at_the_poles_too() {
        for rpy in angles() {
            let rotation = Pose { rpy, ..Pose::HERE }.rotation();
            let back = Pose { rpy: roll_pitch_yaw(&rotation), ..Pose::HERE }.rotation();
            assert!((rotation - back).amax() < 2e-15, "{rpy:?}");
        }
    }

    #[test]
    fn a_place_in_a_place_is_the_product_of_both() {
        let place = |k: f64| Pose { xyz: Vector3::new(k, 1.0, -k), rpy: [0.3 * k, 1.1, -2.0 * k] };
        for (a, b) in [(place(1.0), place(-2.0)), (Pose::HERE, place(1.0)), (place(1.0), Pose::HERE)] {
            let both = a.then(&b);
            let point = Vector3::new(0.3, -0.2, 0.7);
            let expected = a.rotation() * (b.rotation() * point + b.xyz) + a.xyz;
            assert!((both.rotation() * point + both.xyz - expected).amax() < 1e-15);
        }
    }
}
