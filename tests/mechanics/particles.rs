//! Particles in fields of force.

use lagrange_core::prelude::*;

use crate::by_hand::{Number, WithDerivatives, check};
use lagrange_random::Random;

#[derive(Lagrangian)]
#[coordinates(r, phi)]
#[lagrangian(m/2 * (r_dot^2 + r^2 * phi_dot^2) + k/r)]
struct Kepler {
    m: f64,
    k: f64,
}

impl WithDerivatives<2, 0> for Kepler {
    fn random(random: &mut Random) -> Self {
        Self { m: random.positive(), k: random.positive() }
    }

    fn state(&self, random: &mut Random) -> State<f64, 2> {
        let q = [random.positive(), random.signed()];
        State::new(q, random.array(Random::signed))
    }

    fn l<D: Number>(&self, _: D, [r, _]: &[D; 2], [r_dot, phi_dot]: &[D; 2]) -> D {
        (r_dot.powi(2) + (*r * *phi_dot).powi(2)) * (self.m / 2.0) + r.recip() * self.k
    }
}

#[test]
fn kepler_in_polar_coordinates() {
    check::<Kepler, _, _, _>();
}

/// The Lagrangian is not quadratic in the velocities.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[define(gamma = 1/sqrt(1 - (x_dot^2 + y_dot^2)/c^2))]
#[lagrangian(-m*c^2/gamma - k/2*(x^2 + y^2) - q*x*y^3)]
pub(crate) struct Relativistic {
    m: f64,
    c: f64,
    k: f64,
    q: f64,
}

impl WithDerivatives<2, 0> for Relativistic {
    fn random(random: &mut Random) -> Self {
        let c = random.between(3.0, 5.0);
        Self { m: random.positive(), c, k: random.positive(), q: random.signed() }
    }

    fn l<D: Number>(&self, _: D, [x, y]: &[D; 2], [vx, vy]: &[D; 2]) -> D {
        let beta_squared = (*vx * *vx + *vy * *vy) / self.c.powi(2);
        let rest = -(-beta_squared + 1.0).sqrt() * (self.m * self.c * self.c);
        rest - (*x * *x + *y * *y) * (self.k / 2.0) - *x * y.powi(3) * self.q
    }
}

#[test]
fn relativistic_particle() {
    check::<Relativistic, _, _, _>();
}

/// A charge in a magnetic field that is not homogeneous and changes with time, from its vector potential.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[define(ax = -b*y*(1 + z^2)*cos(w*t))]
#[define(ay = b*x*exp(-x^2 - y^2))]
#[define(az = b*x*y*t)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) + e*(ax*x_dot + ay*y_dot + az*z_dot) - e*u*x*z)]
pub(crate) struct MagneticField {
    m: f64,
    e: f64,
    b: f64,
    w: f64,
    u: f64,
}

impl WithDerivatives<3, 0> for MagneticField {
    fn random(random: &mut Random) -> Self {
        let [m, b, w, u] = random.array(Random::positive);
        Self { m, e: random.signed(), b, w, u }
    }

    fn l<D: Number>(&self, t: D, [x, y, z]: &[D; 3], [vx, vy, vz]: &[D; 3]) -> D {
        let potential = [
            -*y * (*z * *z + 1.0) * (t * self.w).cos() * self.b,
            *x * (-*x * *x - *y * *y).exp() * self.b,
            *x * *y * t * self.b,
        ];
        let kinetic = (*vx * *vx + *vy * *vy + *vz * *vz) * (self.m / 2.0);
        let coupling = potential[0] * *vx + potential[1] * *vy + potential[2] * *vz;
        kinetic + (coupling - *x * *z * self.u) * self.e
    }
}

#[test]
fn charge_in_a_magnetic_field() {
    check::<MagneticField, _, _, _>();
}

/// Forces by hand and by Rayleigh's function, on a scalar and on a vector coordinate.
#[derive(Lagrangian)]
#[coordinates(x, r: [2])]
#[lagrangian(m/2*(x_dot^2 + dot(r_dot, r_dot)) - k/2*(x^2 + dot(r, r)) + k*x*r[0])]
#[force(x: -b*x_dot*abs(x_dot) + f*cos(w*t))]
#[force(x: f*t*r[0]*r_dot[1])]
#[force(r: [-b*r_dot[1]*x, f*sin(w*t)*r_dot[0]^2])]
#[force(r[1]: f*x_dot^3)]
#[dissipation(c/2*(1 + x^2)*x_dot^2 + c/4*(dot(r_dot, r_dot))^2*exp(-t) + c*x_dot*r_dot[0]*r[1])]
pub(crate) struct Driven {
    m: f64,
    k: f64,
    b: f64,
    c: f64,
    f: f64,
    w: f64,
}

impl WithDerivatives<3, 0> for Driven {
    fn random(random: &mut Random) -> Self {
        let [m, k, b, c, f, w] = random.array(Random::positive);
        Self { m, k, b, c, f, w }
    }

    fn l<D: Number>(&self, _: D, [x, r0, r1]: &[D; 3], v: &[D; 3]) -> D {
        let kinetic = v.iter().map(|v| v.powi(2)).sum::<D>() * (self.m / 2.0);
        kinetic - (x.powi(2) + r0.powi(2) + r1.powi(2)) * (self.k / 2.0) + *x * *r0 * self.k
    }

    fn forces(&self, t: f64, q: &[f64; 3], v: &[f64; 3]) -> [f64; 3] {
        let Self { b, f, w, .. } = self;
        [
            -b * v[0] * v[0].abs() + f * (w * t).cos() + f * t * q[1] * v[2],
            -b * v[2] * q[0],
            f * (w * t).sin() * v[1].powi(2) + f * v[0].powi(3),
        ]
    }

    fn dissipation<D: Number>(&self, t: D, q: &[D; 3], v: &[D; 3]) -> D {
        let linear = (q[0].powi(2) + 1.0) * v[0].powi(2) * (self.c / 2.0);
        let cubic = (v[1].powi(2) + v[2].powi(2)).powi(2) * (-t).exp() * (self.c / 4.0);
        linear + cubic + v[0] * v[1] * q[2] * self.c
    }
}

#[test]
fn forces_and_dissipation() {
    check::<Driven, _, _, _>();
}

/// A frame with prescribed angular velocity and acceleration, Milton (8.44).
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[define(omega = [w*sin(t), w*t, w])]
#[define(a = [0, 0, b*t^3])]
#[lagrangian(
    m/2*dot(r_dot, r_dot) + m*dot(r_dot, cross(omega, r))
        + m/2*dot(cross(omega, r), cross(omega, r)) - m*dot(a, r) - k/4*dot(r, r)^2
)]
pub(crate) struct RotatingFrame {
    m: f64,
    w: f64,
    b: f64,
    k: f64,
}

impl WithDerivatives<3, 0> for RotatingFrame {
    fn random(random: &mut Random) -> Self {
        let [m, w, b, k] = random.array(Random::positive);
        Self { m, w, b, k }
    }

    /// m/2 |v + Ω × r|² − …, with the square not expanded.
    fn l<D: Number>(&self, t: D, [x, y, z]: &[D; 3], [vx, vy, vz]: &[D; 3]) -> D {
        let omega = [t.sin() * self.w, t * self.w, D::from(self.w)];
        let absolute = [
            *vx + omega[1] * *z - omega[2] * *y,
            *vy + omega[2] * *x - omega[0] * *z,
            *vz + omega[0] * *y - omega[1] * *x,
        ];
        let kinetic = absolute.iter().map(|v| v.powi(2)).sum::<D>() * (self.m / 2.0);
        let distance_squared = x.powi(2) + y.powi(2) + z.powi(2);
        kinetic - t.powi(3) * *z * (self.m * self.b) - distance_squared.powi(2) * (self.k / 4.0)
    }
}

#[test]
fn rotating_and_accelerating_frame() {
    check::<RotatingFrame, _, _, _>();
}
