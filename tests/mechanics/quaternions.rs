//! Orientations as quaternions, against rotation matrices written out.

use lagrange_core::nalgebra::Matrix3;
use lagrange_core::{ConstraintKind, prelude::*};

use crate::by_hand::{Number, WithDerivatives, check};
use lagrange_random::Random;

/// A heavy top of any inertia, hung up by its pole, which also moves as a point would in q so that M is regular.
#[derive(Lagrangian)]
#[coordinates(q: [4])]
#[define(w = quat_rate_body(q, q_dot))]
#[define(spin = quat_rate(q, q_dot))]
#[define(pole = quat_rotate(q, arm))]
#[lagrangian(dot(w, inertia*w)/2 + k*dot(q_dot, q_dot)/2 - g*pole[2] + k*dot(spin, pole))]
#[constraint(unit: dot(q, q) = 1)]
#[constraint(level: quat_rate(q, q_dot)[2] = pole[0])]
pub(crate) struct Top {
    inertia: Matrix3<f64>,
    arm: [f64; 3],
    g: f64,
    k: f64,
}

/// R(q) with R v the vector part of q v q̄, for q of any length.
fn rotation<D: Number>(&[w, x, y, z]: &[D; 4]) -> [[D; 3]; 3] {
    let sq = |x: D| x * x;
    [
        [sq(w) + sq(x) - sq(y) - sq(z), (x * y - w * z) * 2.0, (x * z + w * y) * 2.0],
        [(x * y + w * z) * 2.0, sq(w) - sq(x) + sq(y) - sq(z), (y * z - w * x) * 2.0],
        [(x * z - w * y) * 2.0, (y * z + w * x) * 2.0, sq(w) - sq(x) - sq(y) + sq(z)],
    ]
}

/// The angular velocity in the fixed frame, or in the body's where `sign` is −1.
fn spin<D: Number>([w, x, y, z]: [D; 4], [vw, vx, vy, vz]: [D; 4], sign: f64) -> [D; 3] {
    [
        (w * vx - x * vw + (y * vz - z * vy) * sign) * 2.0,
        (w * vy - y * vw + (z * vx - x * vz) * sign) * 2.0,
        (w * vz - z * vw + (x * vy - y * vx) * sign) * 2.0,
    ]
}

impl Top {
    fn pole<D: Number>(&self, q: &[D; 4]) -> [D; 3] {
        rotation(q).map(|row| (0..3).map(|i| row[i] * self.arm[i]).sum())
    }
}

impl WithDerivatives<4, 2> for Top {
    const KINDS: [ConstraintKind; 2] = [ConstraintKind::Holonomic, ConstraintKind::Velocity];

    fn random(random: &mut Random) -> Self {
        let inertia = Matrix3::from_fn(|i, j| if i == j { 3.0 } else { 0.3 * random.signed() });
        Self { inertia, arm: random.array(Random::signed), g: random.positive(), k: random.positive() }
    }

    fn l<D: Number>(&self, _: D, q: &[D; 4], v: &[D; 4]) -> D {
        let (w, fixed, pole) = (spin(*q, *v, -1.0), spin(*q, *v, 1.0), self.pole(q));
        let mut total = v.iter().map(|v| *v * *v).sum::<D>() * (self.k / 2.0) - pole[2] * self.g;
        for i in 0..3 {
            total += fixed[i] * pole[i] * self.k;
            for j in 0..3 {
                total += w[i] * w[j] * (self.inertia[(i, j)] / 2.0);
            }
        }
        total
    }

    fn constraints<D: Number>(&self, _: D, q: &[D; 4], v: &[D; 4]) -> [D; 2] {
        [q.iter().map(|q| *q * *q).sum::<D>() - 1.0, spin(*q, *v, 1.0)[2] - self.pole(q)[0]]
    }
}

#[test]
fn a_top_in_quaternions() {
    check::<Top, _, _, _>();
}
