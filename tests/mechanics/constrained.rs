//! Constraints: holonomic and not, homogeneous and not, with and without time.

use lagrange_core::{ConstraintKind, prelude::*};

use crate::by_hand::{Number, WithDerivatives, check};
use lagrange_random::Random;

/// Milton (8.8)–(8.10).
#[derive(Lagrangian)]
#[coordinates(x, phi)]
#[define(inertia = 2/5 * m * a^2)]
#[lagrangian(m/2 * x_dot^2 + inertia/2 * phi_dot^2 + m*g*x*sin(alpha))]
#[constraint(no_slip: x_dot - a*phi_dot = 0)]
pub(crate) struct RollingSphere {
    m: f64,
    a: f64,
    g: f64,
    alpha: f64,
}

impl WithDerivatives<2, 1> for RollingSphere {
    const KINDS: [ConstraintKind; 1] = [ConstraintKind::Velocity];

    fn random(random: &mut Random) -> Self {
        let [m, a, g] = random.array(Random::positive);
        Self { m, a, g, alpha: random.between(0.0, 1.5) }
    }

    fn l<D: Number>(&self, _: D, [x, _]: &[D; 2], [vx, spin]: &[D; 2]) -> D {
        let inertia = 0.4 * self.m * self.a.powi(2);
        (vx.powi(2) * self.m + spin.powi(2) * inertia) * 0.5 + *x * (self.m * self.g * self.alpha.sin())
    }

    fn constraints<D: Number>(&self, _: D, _: &[D; 2], [vx, spin]: &[D; 2]) -> [D; 1] {
        [*vx - *spin * self.a]
    }
}

#[test]
fn sphere_rolling_down_an_incline() {
    check::<RollingSphere, _, _, _>();
}

/// A bead on a wire that turns ever faster; its height follows a rule for the velocities.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[define(angle = w*t + b*t^2/2)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
#[constraint(wire: x*sin(angle) = y*cos(angle))]
#[constraint(climb: z_dot - x*y*y_dot*exp(-t) = c*sin(w*t)*x + t^2)]
pub(crate) struct BeadOnWire {
    m: f64,
    g: f64,
    w: f64,
    b: f64,
    c: f64,
}

impl WithDerivatives<3, 2> for BeadOnWire {
    const KINDS: [ConstraintKind; 2] = [ConstraintKind::Holonomic, ConstraintKind::Velocity];

    fn random(random: &mut Random) -> Self {
        let [m, g, w, b, c] = random.array(Random::positive);
        Self { m, g, w, b, c }
    }

    fn l<D: Number>(&self, _: D, [_, _, z]: &[D; 3], v: &[D; 3]) -> D {
        v.iter().map(|v| v.powi(2)).sum::<D>() * (self.m / 2.0) - *z * (self.m * self.g)
    }

    fn constraints<D: Number>(&self, t: D, [x, y, _]: &[D; 3], [_, vy, vz]: &[D; 3]) -> [D; 2] {
        let angle = t * self.w + t.powi(2) * (self.b / 2.0);
        let climb = *vz - *x * *y * *vy * (-t).exp();
        [*x * angle.sin() - *y * angle.cos(), climb - ((t * self.w).sin() * *x * self.c + t.powi(2))]
    }
}

#[test]
fn bead_on_a_rotating_wire() {
    check::<BeadOnWire, _, _, _>();
}

/// The blade lets the contact point move along itself only; the centre of mass is at a distance.
#[derive(Lagrangian)]
#[coordinates(x, y, theta)]
#[define(center = [x + a*cos(theta), y + a*sin(theta)])]
#[define(velocity = der(center))]
#[lagrangian(m/2*dot(velocity, velocity) + inertia/2*theta_dot^2)]
#[constraint(blade: y_dot*cos(theta) - x_dot*sin(theta) = 0)]
pub(crate) struct ChaplyginSleigh {
    m: f64,
    a: f64,
    inertia: f64,
}

impl WithDerivatives<3, 1> for ChaplyginSleigh {
    const KINDS: [ConstraintKind; 1] = [ConstraintKind::Velocity];

    fn random(random: &mut Random) -> Self {
        let [m, a, inertia] = random.array(Random::positive);
        Self { m, a, inertia }
    }

    fn l<D: Number>(&self, _: D, [_, _, theta]: &[D; 3], [vx, vy, spin]: &[D; 3]) -> D {
        let x = *vx - theta.sin() * *spin * self.a;
        let y = *vy + theta.cos() * *spin * self.a;
        (x.powi(2) + y.powi(2)) * (self.m / 2.0) + spin.powi(2) * (self.inertia / 2.0)
    }

    fn constraints<D: Number>(&self, _: D, [_, _, theta]: &[D; 3], [vx, vy, _]: &[D; 3]) -> [D; 1] {
        [*vy * theta.cos() - *vx * theta.sin()]
    }
}

#[test]
fn chaplygin_sleigh() {
    check::<ChaplyginSleigh, _, _, _>();
}

/// A sphere on a turntable and a tilted plane, its orientation by the components of its spin: a vector
/// constraint with an inhomogeneous part.
#[derive(Lagrangian)]
#[coordinates(x, y, s: [3])]
#[define(table = w*cos(t))]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + m*k*a^2/2*dot(s_dot, s_dot) - m*g*x)]
#[constraint(contact: [x_dot - a*s_dot[1], y_dot + a*s_dot[0]] = [-table*y, table*x])]
pub(crate) struct Turntable {
    m: f64,
    k: f64,
    a: f64,
    g: f64,
    w: f64,
}

impl WithDerivatives<5, 2> for Turntable {
    const KINDS: [ConstraintKind; 2] = [ConstraintKind::Velocity; 2];

    fn random(random: &mut Random) -> Self {
        let [m, k, a, g, w] = random.array(Random::positive);
        Self { m, k, a, g, w }
    }

    fn l<D: Number>(&self, _: D, q: &[D; 5], v: &[D; 5]) -> D {
        let inertia = self.m * self.k * self.a.powi(2);
        let moving = (v[0].powi(2) + v[1].powi(2)) * (self.m / 2.0);
        moving + v[2..].iter().map(|s| s.powi(2)).sum::<D>() * (inertia / 2.0) - q[0] * (self.m * self.g)
    }

    fn constraints<D: Number>(&self, t: D, q: &[D; 5], v: &[D; 5]) -> [D; 2] {
        let table = t.cos() * self.w;
        [v[0] - v[3] * self.a + table * q[1], v[1] + v[2] * self.a - table * q[0]]
    }
}

#[test]
fn sphere_on_a_turntable() {
    check::<Turntable, _, _, _>();
}

/// Rods as a family of constraints, the first one of a length that changes.
#[derive(Lagrangian)]
#[coordinates(x: [3], y: [3])]
#[lagrangian(sum(i in 0..3, m[i]/2*(x_dot[i]^2 + y_dot[i]^2) - m[i]*g*y[i]))]
#[constraint(rod[0]: sqrt(x[0]^2 + y[0]^2) = l + b*sin(t))]
#[constraint(rod[i in 1..3]: (x[i] - x[i-1])^2 + (y[i] - y[i-1])^2 - l^2 = 0)]
struct Rods {
    m: [f64; 3],
    g: f64,
    l: f64,
    b: f64,
}

impl WithDerivatives<6, 3> for Rods {
    fn random(random: &mut Random) -> Self {
        let m = random.array(Random::positive);
        Self { m, g: random.positive(), l: random.positive(), b: random.signed() }
    }

    fn l<D: Number>(&self, _: D, q: &[D; 6], v: &[D; 6]) -> D {
        let particle = |i: usize| {
            (v[i].powi(2) + v[i + 3].powi(2)) * (self.m[i] / 2.0) - q[i + 3] * (self.m[i] * self.g)
        };
        (0..3).map(particle).sum()
    }

    fn constraints<D: Number>(&self, t: D, q: &[D; 6], _: &[D; 6]) -> [D; 3] {
        let rod = |i: usize, j: usize| (q[i] - q[j]).powi(2) + (q[i + 3] - q[j + 3]).powi(2) - self.l.powi(2);
        let first = (q[0].powi(2) + q[3].powi(2)).sqrt() - self.l - t.sin() * self.b;
        [first, rod(1, 0), rod(2, 1)]
    }
}

#[test]
fn rods_as_a_family() {
    check::<Rods, _, _, _>();
}

/// `der` makes a velocity constraint of a holonomic one.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(curve: der(y - b*atan2(x, 1 + t) - ln(2 + x^2)) = 0)]
pub(crate) struct BeadOnCurve {
    m: f64,
    g: f64,
    b: f64,
}

impl WithDerivatives<2, 1> for BeadOnCurve {
    const KINDS: [ConstraintKind; 1] = [ConstraintKind::Velocity];

    fn random(random: &mut Random) -> Self {
        let [m, g, b] = random.array(Random::positive);
        Self { m, g, b }
    }

    fn l<D: Number>(&self, _: D, [_, y]: &[D; 2], [vx, vy]: &[D; 2]) -> D {
        (vx.powi(2) + vy.powi(2)) * (self.m / 2.0) - *y * (self.m * self.g)
    }

    fn constraints<D: Number>(&self, t: D, [x, _]: &[D; 2], [vx, vy]: &[D; 2]) -> [D; 1] {
        let s = t + 1.0;
        let angle_rate = (s * *vx - *x) / (s.powi(2) + x.powi(2));
        [*vy - angle_rate * self.b - *x * *vx * 2.0 / (x.powi(2) + 2.0)]
    }
}

#[test]
fn derivative_of_a_curve_as_constraint() {
    check::<BeadOnCurve, _, _, _>();
}
