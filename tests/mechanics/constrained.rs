//! Constraints: holonomic and not, homogeneous and not, with and without time.

use lagrange_core::ConstraintKind::{self, Holonomic, Velocity};
use lagrange_core::nalgebra::Matrix3;
use lagrange_core::prelude::*;

use crate::by_hand::{ByHand, D, DualNum, checks, square};
use lagrange_random::Random;

/// A bead on a wire that turns ever faster; its height follows a rule for the velocities.
#[derive(Default, Lagrangian)]
#[coordinates(x, y, z)]
#[define(angle = w*t + b*t^2/2)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
#[constraint(wire: x*sin(angle) = y*cos(angle))]
#[constraint(climb: z_dot - x*y*y_dot*exp(-t) = c*sin(w*t)*x + t^2)]
struct BeadOnWire {
    m: f64,
    g: f64,
    w: f64,
    b: f64,
    c: f64,
}

impl ByHand<3, 2> for BeadOnWire {
    const KINDS: [ConstraintKind; 2] = [Holonomic, Velocity];

    fn l(&self, _: D, [_, _, z]: &[D; 3], v: &[D; 3]) -> D {
        square(v) * (self.m / 2.0) - *z * (self.m * self.g)
    }

    fn constraints(&self, t: D, [x, y, _]: &[D; 3], [_, vy, vz]: &[D; 3]) -> [D; 2] {
        let angle = t * self.w + t.powi(2) * (self.b / 2.0);
        let climb = *vz - *x * *y * *vy * (-t).exp();
        [*x * angle.sin() - *y * angle.cos(), climb - ((t * self.w).sin() * *x * self.c + t.powi(2))]
    }
}

/// A sphere on a turntable and a tilted plane, its orientation by the components of its spin: a vector
/// constraint with an inhomogeneous part.
#[derive(Default, Lagrangian)]
#[coordinates(x, y, s: [3])]
#[define(table = w*cos(t))]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + m*k*a^2/2*dot(s_dot, s_dot) - m*g*x)]
#[constraint(contact: [x_dot - a*s_dot[1], y_dot + a*s_dot[0]] = [-table*y, table*x])]
struct Turntable {
    m: f64,
    k: f64,
    a: f64,
    g: f64,
    w: f64,
}

impl ByHand<5, 2> for Turntable {
    const KINDS: [ConstraintKind; 2] = [Velocity; 2];

    fn l(&self, _: D, q: &[D; 5], v: &[D; 5]) -> D {
        let inertia = self.m * self.k * self.a.powi(2);
        let moving = (v[0].powi(2) + v[1].powi(2)) * (self.m / 2.0);
        moving + square(&v[2..]) * (inertia / 2.0) - q[0] * (self.m * self.g)
    }

    fn constraints(&self, t: D, q: &[D; 5], v: &[D; 5]) -> [D; 2] {
        let table = t.cos() * self.w;
        [v[0] - v[3] * self.a + table * q[1], v[1] + v[2] * self.a - table * q[0]]
    }
}

/// `der` makes a velocity constraint of a holonomic one.
#[derive(Default, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(curve: der(y - b*atan2(x, 1 + t) - ln(2 + x^2)) = 0)]
struct BeadOnCurve {
    m: f64,
    g: f64,
    b: f64,
}

impl ByHand<2, 1> for BeadOnCurve {
    const KINDS: [ConstraintKind; 1] = [Velocity];

    fn l(&self, _: D, [_, y]: &[D; 2], [vx, vy]: &[D; 2]) -> D {
        (vx.powi(2) + vy.powi(2)) * (self.m / 2.0) - *y * (self.m * self.g)
    }

    fn constraints(&self, t: D, [x, _]: &[D; 2], [vx, vy]: &[D; 2]) -> [D; 1] {
        let s = t + 1.0;
        let angle_rate = (s * *vx - *x) / (s.powi(2) + x.powi(2));
        [*vy - angle_rate * self.b - *x * *vx * 2.0 / (x.powi(2) + 2.0)]
    }
}

/// A heavy top of any inertia, hung up by its pole, which also moves as a point would in q so that M is regular.
#[derive(Default, Lagrangian)]
#[coordinates(q: [4])]
#[define(w = quat_rate_body(q, q_dot))]
#[define(spin = quat_rate(q, q_dot))]
#[define(pole = quat_rotate(q, arm))]
#[lagrangian(dot(w, inertia*w)/2 + k*dot(q_dot, q_dot)/2 - g*pole[2] + k*dot(spin, pole))]
#[constraint(unit: dot(q, q) = 1)]
#[constraint(level: quat_rate(q, q_dot)[2] = pole[0])]
struct Top {
    inertia: Matrix3<f64>,
    arm: [f64; 3],
    g: f64,
    k: f64,
}

/// R(q) with R v the vector part of q v q̄, for q of any length.
fn rotation(&[w, x, y, z]: &[D; 4]) -> [[D; 3]; 3] {
    let sq = |x: D| x * x;
    [
        [sq(w) + sq(x) - sq(y) - sq(z), (x * y - w * z) * 2.0, (x * z + w * y) * 2.0],
        [(x * y + w * z) * 2.0, sq(w) - sq(x) + sq(y) - sq(z), (y * z - w * x) * 2.0],
        [(x * z - w * y) * 2.0, (y * z + w * x) * 2.0, sq(w) - sq(x) - sq(y) + sq(z)],
    ]
}

/// The angular velocity in the fixed frame, or in the body's where `sign` is −1.
fn spin([w, x, y, z]: [D; 4], [vw, vx, vy, vz]: [D; 4], sign: f64) -> [D; 3] {
    [
        (w * vx - x * vw + (y * vz - z * vy) * sign) * 2.0,
        (w * vy - y * vw + (z * vx - x * vz) * sign) * 2.0,
        (w * vz - z * vw + (x * vy - y * vx) * sign) * 2.0,
    ]
}

impl Top {
    fn pole(&self, q: &[D; 4]) -> [D; 3] {
        rotation(q).map(|row| (0..3).map(|i| row[i] * self.arm[i]).sum())
    }
}

impl ByHand<4, 2> for Top {
    const KINDS: [ConstraintKind; 2] = [Holonomic, Velocity];
    const AT_ORIGIN: bool = false;

    fn random(random: &mut Random) -> Self {
        let inertia = Matrix3::from_fn(|i, j| if i == j { 3.0 } else { 0.3 * random.signed() });
        Self { inertia, arm: random.array(Random::signed), g: random.positive(), k: random.positive() }
    }

    fn l(&self, _: D, q: &[D; 4], v: &[D; 4]) -> D {
        let (w, fixed, pole) = (spin(*q, *v, -1.0), spin(*q, *v, 1.0), self.pole(q));
        let mut total = square(v) * (self.k / 2.0) - pole[2] * self.g;
        for i in 0..3 {
            total += fixed[i] * pole[i] * self.k;
            for j in 0..3 {
                total += w[i] * w[j] * (self.inertia[(i, j)] / 2.0);
            }
        }
        total
    }

    fn constraints(&self, _: D, q: &[D; 4], v: &[D; 4]) -> [D; 2] {
        [square(q) - 1.0, spin(*q, *v, 1.0)[2] - self.pole(q)[0]]
    }
}

checks! {
    bead_on_a_rotating_wire: BeadOnWire, with check_jacobian;
    sphere_on_a_turntable: Turntable;
    derivative_of_a_curve_as_constraint: BeadOnCurve;
    a_top_in_quaternions: Top;
}
