//! Moving frames, constraints that move, and magnetic fields: terms of L that are linear in the velocity.

use std::f64::consts::TAU;

use lagrange_core::linearized::Stability;
use lagrange_core::prelude::*;

use crate::reference_motions::reference::{ARE_SPANS_WHOLE, BAR, Known, Problem, largest, table};

/// A bead on a hoop that turns about its vertical diameter, by its angle from the lowest point.
#[derive(Lagrangian)]
#[coordinates(th)]
#[lagrangian(R^2/2*(th_dot^2 + Om^2*sin(th)^2) + g*R*cos(th))]
#[allow(non_snake_case)]
struct HoopByAngle {
    R: f64,
    g: f64,
    Om: f64,
}

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

const BY_ANGLE: HoopByAngle = HoopByAngle { R: 0.5, g: 9.81, Om: 6.0 };
const BY_POSITION: HoopByPosition = HoopByPosition { R: 0.5, g: 9.81, Om: 6.0 };

#[test]
fn hoop_by_angle() {
    let problem =
        Problem { name: "bead on a turning hoop, angle", system: BY_ANGLE, known: table!("hoop_by_angle") };
    problem.check(&[("Taylor", [1e-14, 1e-14, 0.0]), ("Dop853", [1e-11, 1e-11, 0.0]), ("Dopri5", BAR)]);
}

#[test]
fn hoop_by_position() {
    let known = table!("hoop_by_position");
    let problem = Problem { name: "bead on a turning hoop, x, y, z", system: BY_POSITION, known };
    problem.check(&[("Taylor", [1e-13, 1e-13, 1e-12]), ("Dop853", [1e-11, 1e-11, 1e-10]), ("Dopri5", BAR)]);
}

/// Both forms have one motion over 50 s, between the steps too.
#[test]
fn hoop_moves_alike_by_angle_and_by_position() {
    let method = Dop853::with_tolerance(1e-12);
    let (sine, cosine) = 0.4_f64.sin_cos();
    let start = State::new([0.5 * sine, 0.0, -0.5 * cosine], [0.0, 3.0 * sine, 0.0]);
    let by_angle = BY_ANGLE.integrate(State::at_rest([0.4]), 50.0, method).unwrap();
    let by_position = BY_POSITION.integrate(start, 50.0, method).unwrap();
    let apart = largest(by_angle.samples(1001).zip(by_position.samples(1001)).map(|(angle, position)| {
        let (th, s) = (angle.state().q[0], position.state());
        let out = 0.5 * th.sin();
        let turned = (6.0 * s.t).sin_cos();
        let off = [s.q[0] - out * turned.1, s.q[1] - out * turned.0, s.q[2] + 0.5 * th.cos()];
        largest(off.map(f64::abs))
    }));
    assert!(apart < 1e-8, "{apart:e}");
}

/// Equilibrium at cos θ = g/(R Ω²), with oscillations of Ω √(1 − (g/(R Ω²))²) about it.
#[test]
fn hoop_at_rest() {
    let resting = State::at_rest([0.994_407_212_058_699_5]);
    assert!(BY_ANGLE.solve(&resting).unwrap().accelerations[0].abs() < 1e-13);
    let frequency = BY_ANGLE.linearize(&resting, &[]).unwrap().natural_frequencies().unwrap()[0];
    assert!((frequency - 5.030_616_264_435_203).abs() < 1e-14);
}

/// A bead on a straight wire that turns in a plane.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2)]
#[constraint(wire: y*cos(w*t) - x*sin(w*t) = 0)]
struct Wire {
    w: f64,
}

/// Energy grows: the constraint depends on time.
#[test]
fn bead_on_a_turning_wire() {
    let problem =
        Problem { name: "bead on a turning wire, x, y", system: Wire { w: 2.0 }, known: table!("wire") };
    problem.check(&[("Taylor", [1e-14, 1e-13, 1e-14]), ("Dop853", [1e-12, 1e-12, 1e-13]), ("Dopri5", BAR)]);
}

/// r = cosh wt and λ = 2 w ṙ, at many times.
#[test]
fn bead_on_a_turning_wire_at_many_times() {
    let at = |t: f64| {
        let (angle, r) = (2.0 * t, (2.0 * t).cosh());
        let ((s, c), rate) = (angle.sin_cos(), 2.0 * angle.sinh());
        let v = [rate * c - 2.0 * r * s, rate * s + 2.0 * r * c];
        Known { t, q: [r * c, r * s], v, lambda: Some([4.0 * rate]) }
    };
    let known = (0..=20).map(|k| at(0.1 * f64::from(k))).collect();
    let problem =
        Problem { name: "bead on a turning wire, x, y, closed form", system: Wire { w: 2.0 }, known };
    problem.check(&[("Taylor", [1e-14, 1e-13, 1e-14]), ("Dop853", [1e-12, 1e-12, 1e-13]), ("Dopri5", BAR)]);
}

/// A charge in crossed fields B e_z and Ey e_y.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) + q*B/2*(x*y_dot - y*x_dot) + q*Ey*y)]
#[allow(non_snake_case)]
struct Charge {
    m: f64,
    q: f64,
    B: f64,
    Ey: f64,
}

const CHARGE: Charge = Charge { m: 1.2, q: 0.7, B: 2.5, Ey: 0.9 };

#[test]
fn charge_in_crossed_fields() {
    let known: Vec<Known<3, 0>> = table!("charge");
    let energy = CHARGE.energy(&State::new(known[0].q, known[0].v));
    assert!((energy - 0.174).abs() < 1e-16);
    let problem = Problem { name: "charge in crossed fields", system: CHARGE, known };
    problem.check(&[("Taylor", [1e-14, 1e-13, 0.0]), ("Dop853", [1e-10, 1e-11, 0.0]), ("Dopri5", BAR)]);
}

/// Drift at E/B along x, and a circle at the rate qB/m.
#[test]
fn charge_in_crossed_fields_at_many_times() {
    let (rate, drift) = (0.7 * 2.5 / 1.2, 0.9 / 2.5);
    let (u, v) = (0.3 - drift, -0.4);
    let at = |t: f64| {
        let (s, c) = (rate * t).sin_cos();
        let x = drift * t + (u * s + v * (1.0 - c)) / rate;
        let y = (v * s - u * (1.0 - c)) / rate;
        Known { t, q: [x, y, 0.2 * t], v: [drift + u * c + v * s, v * c - u * s, 0.2], lambda: Some([]) }
    };
    let known = (0..=50).map(|k| at(f64::from(k))).collect();
    let problem = Problem { name: "charge in crossed fields, closed form", system: CHARGE, known };
    problem.check(&[("Taylor", [1e-12, 1e-12, 0.0]), ("Dop853", [1e-10, 1e-10, 0.0])]);
}

/// A Penning trap: a magnetic field along z and a quadrupole.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) + q*B/2*(x*y_dot - y*x_dot) - m*wz^2/2*(z^2 - (x^2 + y^2)/2))]
#[allow(non_snake_case)]
struct PenningTrap {
    m: f64,
    q: f64,
    B: f64,
    wz: f64,
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
    let system = PenningTrap { m: 1.2, q: 0.7, B: 2.5, wz };
    let known = (0..=50).map(|k| at(f64::from(k))).collect();
    let problem = Problem { name: "Penning trap, closed form", system, known };
    problem.check(&[("Taylor", [1e-12, 1e-12, 0.0]), ("Dop853", [1e-10, 1e-10, 0.0])]);
}

/// The trap holds the charge if ω_c² > 2 ω_z².
#[test]
fn penning_trap_holds_in_a_strong_field() {
    let critical = 0.7 * 2.5 / 1.2 / 2.0_f64.sqrt();
    for (part, stability) in [(1.0 - 1e-6, Stability::Undecided), (1.0 + 1e-6, Stability::Unstable)] {
        let trap = PenningTrap { m: 1.2, q: 0.7, B: 2.5, wz: part * critical };
        assert_eq!(trap.linearize(&State::at_rest([0.0; 3]), &[]).unwrap().stability(), Ok(stability));
    }
}

/// A pendulum whose pivot moves up and down.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - g*y)]
#[constraint(rod: x^2 + (y - a*cos(nu*t))^2 - l^2 = 0)]
struct Kapitza {
    l: f64,
    a: f64,
    g: f64,
    nu: f64,
}

const KAPITZA: Kapitza = Kapitza { l: 1.0, a: 0.1, g: 9.81, nu: 50.0 };

#[test]
fn kapitza_pendulum_stands() {
    let problem =
        Problem { name: "Kapitza's pendulum stands", system: KAPITZA, known: table!("kapitza_stands") };
    problem.check(&[("Taylor", [1e-12, 1e-13, 1e-14]), ("Dop853", [1e-10, 1e-11, 1e-13]), ("Dopri5", BAR)]);
}

#[test]
fn kapitza_pendulum_falls() {
    let (system, known) = (Kapitza { nu: 40.0, ..KAPITZA }, table!("kapitza_falls"));
    let problem = Problem { name: "Kapitza's pendulum falls", system, known };
    problem.check(&[("Taylor", [1e-13, 1e-13, 1e-13]), ("Dop853", [1e-10, 1e-10, 1e-11]), ("Dopri5", BAR)]);
}

/// The upright position is stable if the trace of the monodromy matrix is below 2. The trace is 2 at ν² = −4g/(l a₀(2a/l)),
/// with the lowest even characteristic value a₀ of Mathieu's equation: a₀(0.2) = −0.0199132963584375.
#[test]
fn kapitza_pendulum_stands_above_a_rate_of_mathieu() {
    let trace = |nu: f64| {
        let upright = State::at_rest([0.0, 1.1]);
        let method = Dop853::with_tolerance(1e-14);
        let pendulum = Kapitza { nu, ..KAPITZA };
        let motion = pendulum.integrate_sensitivities(upright, TAU / nu, method, &["x", "x_dot"]).unwrap();
        let end = motion.at(TAU / nu).unwrap();
        end.q[(0, 0)] + end.v[(0, 1)]
    };
    let threshold = 44.390_794_780_327_37;
    assert!((trace(threshold) - 2.0).abs() < 1e-12, "{:e}", trace(threshold) - 2.0);
    let slope = (trace(threshold * 1.001) - trace(threshold * 0.999)) / 0.002;
    assert!(slope < -0.1, "{slope}");
}

/// A pendulum on a turning Earth: x east, y north, z up.
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[define(W = [0, Om*cos(latitude), Om*sin(latitude)])]
#[lagrangian(m/2*dot(r_dot, r_dot) + m*dot(W, cross(r, r_dot)) + m/2*dot(cross(W, r), cross(W, r)) - m*g*r[2])]
#[constraint(string: dot(r, r) - l^2 = 0)]
#[allow(non_snake_case)]
struct Foucault {
    m: f64,
    g: f64,
    l: f64,
    Om: f64,
    latitude: f64,
}

#[test]
fn foucault_pendulum() {
    let system =
        Foucault { m: 1.0, g: 9.81, l: 67.0, Om: 7.292_115e-5, latitude: 48.846_222_f64.to_radians() };
    let problem = Problem { name: "Foucault's pendulum, 1000 s", system, known: table!("foucault") };
    problem.until(1000.0).check(&[("Taylor", [1e-12, 1e-12, 1e-14]), ("Dop853", [1e-10, 1e-9, 1e-12])]);
}

/// The plane turns by 11.325111831508° in an hour, up to a precession of the ellipse of the order of (a/l)².
#[test]
fn foucault_pendulum_for_an_hour() {
    if ARE_SPANS_WHOLE {
        let known = table!("foucault");
        let Known { q: [x, y, _], v: [u, v, _], .. } = known[known.len() - 1];
        let square = 9.81 / 67.0;
        let axis = (2.0 * (square * x * y + u * v)).atan2(square * (x * x - y * y) + u * u - v * v) / 2.0;
        assert!((axis.to_degrees() / 11.325_111_831_508 + 1.0).abs() < f64::powi(3.0 / 67.0, 2), "{axis}");
        let latitude = 48.846_222_f64.to_radians();
        let system = Foucault { m: 1.0, g: 9.81, l: 67.0, Om: 7.292_115e-5, latitude };
        let problem = Problem { name: "Foucault's pendulum, one hour", system, known };
        problem.check(&[("Taylor", [1e-12, 2e-12, 1e-14]), ("Dop853", BAR)]);
    }
}
