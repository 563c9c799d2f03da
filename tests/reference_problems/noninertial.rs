//! Moving frames, constraints that move, and magnetic fields: terms of L that are linear in the velocity.

use lagrange_core::prelude::*;
use lagrange_systems::{BeadOnHoop, Foucault};

use crate::reference::{BAR, IS_LONG, Known, Problem, table};

/// The bead as a free particle with two constraints, one of which moves.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 - g*z)]
#[constraint(ring: x^2 + y^2 + z^2 - R^2 = 0)]
#[constraint(plane: y*cos(Om*t) - x*sin(Om*t) = 0)]
#[allow(non_snake_case)]
struct HoopByPosition {
    R: f64,
    g: f64,
    Om: f64,
}

const BY_ANGLE: BeadOnHoop<f64> = BeadOnHoop { r: 0.5, g: 9.81, omega: 6.0 };
const BY_POSITION: HoopByPosition = HoopByPosition { R: 0.5, g: 9.81, Om: 6.0 };

#[test]
fn hoop_by_angle() {
    let problem =
        Problem { name: "bead on a turning hoop, angle", system: BY_ANGLE, known: table!("hoop_by_angle") };
    problem.check(&[[1e-14, 1e-14, 0.0], [1e-11, 1e-11, 0.0], BAR]);
}

#[test]
fn hoop_by_position() {
    let known = table!("hoop_by_position");
    let problem = Problem { name: "bead on a turning hoop, x, y, z", system: BY_POSITION, known };
    problem.check(&[[1e-13, 1e-13, 1e-12], [1e-11, 1e-11, 1e-10], BAR]);
}

/// A bead on a straight wire that turns in a plane.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2)]
#[constraint(wire: y*cos(w*t) - x*sin(w*t) = 0)]
struct Wire {
    w: f64,
}

/// r = cosh wt and λ = 2 w ṙ: the constraint depends on time, and the energy grows.
#[test]
fn bead_on_a_turning_wire() {
    let at = |t: f64| {
        let (angle, r) = (2.0 * t, (2.0 * t).cosh());
        let ((s, c), rate) = (angle.sin_cos(), 2.0 * angle.sinh());
        let v = [rate * c - 2.0 * r * s, rate * s + 2.0 * r * c];
        Known { t, q: [r * c, r * s], v, lambda: Some([4.0 * rate]) }
    };
    let known = (0..=20).map(|k| at(0.1 * f64::from(k))).collect();
    let problem = Problem { name: "bead on a turning wire, x, y", system: Wire { w: 2.0 }, known };
    problem.check(&[[1e-14, 1e-13, 1e-14], [1e-12, 1e-12, 1e-13], BAR]);
}

/// A charge in a magnetic field B e_z, an electric field Ey e_y and the quadrupole of a Penning trap.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) + q*B/2*(x*y_dot - y*x_dot) + q*Ey*y
    - m*wz^2/2*(z^2 - (x^2 + y^2)/2))]
#[allow(non_snake_case)]
struct Charge {
    m: f64,
    q: f64,
    B: f64,
    Ey: f64,
    wz: f64,
}

const CHARGE: Charge = Charge { m: 1.2, q: 0.7, B: 2.5, Ey: 0.9, wz: 0.0 };

#[test]
fn charge_in_crossed_fields() {
    let problem = Problem { name: "charge in crossed fields", system: CHARGE, known: table!("charge") };
    problem.check(&[[1e-14, 1e-13, 0.0], [1e-10, 1e-11, 0.0], BAR]);
}

/// x + iy = Σ r e^(−iωt) with ω = (ω_c ± √(ω_c² − 2 ω_z²))/2, and z = z₀ cos ω_z t.
#[test]
fn penning_trap() {
    let (rate, wz) = (0.7 * 2.5 / 1.2, 0.9);
    let root = f64::sqrt(rate * rate - 2.0 * wz * wz);
    let circles = [(f64::midpoint(rate, root), 0.2), ((rate - root) / 2.0, 0.5)];
    let at = |t: f64| {
        let mut known = Known { t, q: [0.0; 3], v: [0.0; 3], lambda: Some([]) };
        for (w, r) in circles {
            let (s, c) = (w * t).sin_cos();
            let (q, v) = ([r * c, -r * s], [-r * w * s, -r * w * c]);
            for i in 0..2 {
                known.q[i] += q[i];
                known.v[i] += v[i];
            }
        }
        let (s, c) = (wz * t).sin_cos();
        (known.q[2], known.v[2]) = (0.3 * c, -0.3 * wz * s);
        known
    };
    let system = Charge { Ey: 0.0, wz, ..CHARGE };
    let known = (0..=50).map(|k| at(f64::from(k))).collect();
    let problem = Problem { name: "Penning trap, closed form", system, known };
    problem.check(&[[1e-12, 1e-12, 0.0], [1e-10, 1e-10, 0.0]]);
}

/// A pendulum whose pivot moves up and down.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - g*y)]
#[constraint(rod: x^2 + (y - a*cos(nu*t))^2 - l^2 = 0)]
pub(crate) struct Kapitza {
    pub(crate) l: f64,
    pub(crate) a: f64,
    pub(crate) g: f64,
    pub(crate) nu: f64,
}

pub(crate) const KAPITZA: Kapitza = Kapitza { l: 1.0, a: 0.1, g: 9.81, nu: 50.0 };

#[test]
fn kapitza_pendulum_stands() {
    let problem =
        Problem { name: "Kapitza's pendulum stands", system: KAPITZA, known: table!("kapitza_stands") };
    problem.check(&[[1e-12, 1e-13, 1e-14], [1e-10, 1e-11, 1e-13], BAR]);
}

#[test]
fn kapitza_pendulum_falls() {
    let (system, known) = (Kapitza { nu: 40.0, ..KAPITZA }, table!("kapitza_falls"));
    let problem = Problem { name: "Kapitza's pendulum falls", system, known };
    problem.check(&[[1e-13, 1e-13, 1e-13], [1e-10, 1e-10, 1e-11], BAR]);
}

#[test]
fn foucault_pendulum() {
    let latitude = 48.846_222_f64.to_radians();
    let system = Foucault { m: 1.0, g: 9.81, l: 67.0, rate: 7.292_115e-5, latitude };
    let problem = |name| Problem { name, system, known: table!("foucault") };
    let begins = problem("Foucault's pendulum, 1000 s").until(1000.0);
    begins.check(&[[1e-12, 1e-12, 1e-14], [1e-10, 1e-9, 1e-12]]);
    if IS_LONG {
        problem("Foucault's pendulum, one hour").check(&[[1e-12, 2e-12, 1e-14], BAR]);
    }
}
