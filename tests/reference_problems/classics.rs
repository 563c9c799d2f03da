//! Systems of textbooks: pendulums, orbits, pulleys, a bead on a wire, a cylinder that rolls.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use lagrange_core::prelude::*;

use crate::reference_motions::reference::{BAR, Known, Problem, table};

/// Two bobs on rods in a plane, the angles from the vertical.
#[derive(Lagrangian)]
#[coordinates(a, b)]
#[lagrangian((m[0] + m[1])/2*l[0]^2*a_dot^2 + m[1]/2*l[1]^2*b_dot^2 + m[1]*l[0]*l[1]*a_dot*b_dot*cos(a - b)
    + (m[0] + m[1])*g*l[0]*cos(a) + m[1]*g*l[1]*cos(b))]
struct DoublePendulum {
    m: [f64; 2],
    l: [f64; 2],
    g: f64,
}

const DOUBLE: DoublePendulum = DoublePendulum { m: [1.0, 1.0], l: [1.0, 1.0], g: 9.81 };

/// The bobs in Cartesian coordinates. λ is −½ of the tension over the length: Φ is not halved here.
#[derive(Lagrangian)]
#[coordinates(r: [2], s: [2])]
#[lagrangian(m[0]/2*dot(r_dot, r_dot) + m[1]/2*dot(s_dot, s_dot) - m[0]*g*r[1] - m[1]*g*s[1])]
#[constraint(upper: dot(r, r) = l[0]^2)]
#[constraint(lower: dot(s - r, s - r) = l[1]^2)]
struct TwoBobs {
    m: [f64; 2],
    l: [f64; 2],
    g: f64,
}

/// A perturbation of the start grows by 143 until t = 10.
#[test]
fn double_pendulum_from_the_horizontal() {
    let problem =
        Problem { name: "double pendulum, angles", system: DOUBLE, known: table!("double_pendulum") };
    problem.check(&[("Taylor", [1e-13, 1e-14, 0.0]), ("Dop853", [1e-9, 1e-10, 0.0])]);
}

/// A perturbation of the start grows by 43 until t = 10.
#[test]
fn double_pendulum_swinging_mildly() {
    let known = table!("double_pendulum_mild");
    let problem = Problem { name: "double pendulum, mild swing", system: DOUBLE, known };
    problem.check(&[("Taylor", [1e-13, 1e-13, 0.0]), ("Dop853", [1e-10, 1e-10, 0.0]), ("Dopri5", BAR)]);
}

/// The second run ends before the start is amplified by more than 13.
#[test]
fn double_pendulum_with_multipliers() {
    let system = TwoBobs { m: [1.0, 1.0], l: [1.0, 1.0], g: 9.81 };
    let problem = Problem { name: "double pendulum, x, y of both bobs", system, known: table!("two_bobs") };
    problem.check(&[("Taylor", [5e-13, 2e-12, 5e-13]), ("Dop853", [1e-11, 1e-11, 1e-11])]);
    problem.until(5.0).check(&[("Taylor", [1e-13, 1e-13, 1e-14]), ("Dop853", [1e-12, 1e-12, 1e-12])]);
}

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - (x^2 + y^2)/2 - x^2*y + y^3/3)]
struct HenonHeiles;

/// A regular orbit.
#[test]
fn henon_heiles() {
    let problem = Problem { name: "Hénon and Heiles", system: HenonHeiles, known: table!("henon_heiles") };
    problem.check(&[("Taylor", [1e-13, 1e-13, 0.0]), ("Dop853", [1e-10, 1e-10, 0.0])]);
}

#[derive(Lagrangian)]
#[coordinates(r: [2])]
#[lagrangian(dot(r_dot, r_dot)/2 + k/norm(r))]
struct Kepler {
    k: f64,
}

/// With the eccentricity 0.6 and the period 2π.
#[test]
fn kepler_ellipse() {
    let problem = Problem { name: "Kepler's ellipse", system: Kepler { k: 1.0 }, known: table!("kepler") };
    problem.check(&[("Taylor", [1e-12, 1e-12, 0.0]), ("Dop853", [1e-9, 1e-9, 0.0])]);
}

/// Two weights on a string over a pulley that turns with it; both coordinates count downward.
#[derive(Lagrangian)]
#[coordinates(x, y, phi)]
#[lagrangian(m[0]/2*x_dot^2 + m[1]/2*y_dot^2 + inertia/2*phi_dot^2 + m[0]*g*x + m[1]*g*y)]
#[constraint(string: x + y = 0)]
#[constraint(pulley: x_dot = radius*phi_dot)]
struct Atwood {
    m: [f64; 2],
    inertia: f64,
    radius: f64,
    g: f64,
}

/// ẍ = (m₁ − m₂) g/(m₁ + m₂ + I/R²). λ of the string is minus the tension on the side of m₂, and λ of the pulley
/// minus the difference of the tensions.
#[test]
fn atwood_machine() {
    for (m, inertia, radius) in [([2.0, 1.0], 0.3, 0.5), ([0.4, 3.0], 1e-3, 0.1), ([1.0, 1.0], 0.2, 0.7)] {
        let machine = Atwood { m, inertia, radius, g: 9.81 };
        let solution = machine.solve(&State::at_rest([0.0; 3])).unwrap();
        let acceleration = (m[0] - m[1]) * 9.81 / (m[0] + m[1] + inertia / radius.powi(2));
        let tensions = [m[0] * (9.81 - acceleration), m[1] * (9.81 + acceleration)];
        assert_abs_diff_eq!(solution.accelerations[0], acceleration, epsilon = 1e-14);
        assert_abs_diff_eq!(solution.accelerations[1], -acceleration, epsilon = 1e-14);
        assert_abs_diff_eq!(solution.accelerations[2], acceleration / radius, epsilon = 1e-13);
        assert_abs_diff_eq!(solution.multipliers[0], -tensions[1], epsilon = 1e-13);
        assert_abs_diff_eq!(solution.multipliers[1], tensions[1] - tensions[0], epsilon = 1e-13);
    }
}

/// Without inertia of the pulley the tension is 2 m₁ m₂ g/(m₁ + m₂).
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m[0]/2*x_dot^2 + m[1]/2*y_dot^2 + m[0]*g*x + m[1]*g*y)]
#[constraint(string: x + y = 0)]
struct LightPulley {
    m: [f64; 2],
    g: f64,
}

#[test]
fn atwood_machine_with_a_light_pulley() {
    for m in [[2.0, 1.0], [0.3, 5.0]] {
        let machine = LightPulley { m, g: 9.81 };
        let path = machine.integrate(State::at_rest([0.0; 2]), 2.0, Dop853::default()).unwrap();
        let total = m[0] + m[1];
        let fallen = (m[0] - m[1]) / total * 9.81 * 2.0;
        assert_relative_eq!(path.end().coordinate("x").unwrap(), fallen, max_relative = 1e-13);
        let tension = -path.end().multiplier("string").unwrap();
        assert_relative_eq!(tension, 2.0 * m[0] * m[1] * 9.81 / total, max_relative = 1e-14);
    }
}

/// A bead on a straight wire that turns about the vertical.
#[derive(Lagrangian)]
#[coordinates(r, phi)]
#[lagrangian(m/2*(r_dot^2 + r^2*phi_dot^2))]
#[constraint(drive: phi = omega*t)]
struct BeadOnWire {
    m: f64,
    omega: f64,
}

/// r = r₀ cosh ωt, and the torque of the drive is 2 m ω r ṙ.
#[test]
fn bead_on_a_rotating_wire() {
    let (m, omega, start) = (0.3, 1.7, 0.2);
    let at = |t: f64| {
        let (r, rate) = (start * (omega * t).cosh(), start * omega * (omega * t).sinh());
        Known { t, q: [r, omega * t], v: [rate, omega], lambda: Some([2.0 * m * omega * r * rate]) }
    };
    let known = (0..=30).map(|k| at(0.1 * f64::from(k))).collect();
    let problem =
        Problem { name: "bead on a turning wire, r and angle", system: BeadOnWire { m, omega }, known };
    problem.check(&[("Taylor", [1e-14, 1e-13, 1e-13]), ("Dop853", [1e-11, 1e-11, 1e-11]), ("Dopri5", BAR)]);
}

/// A cylinder of radius a inside a fixed one of radius R: θ is the angle of the line of centres, φ that by which the
/// cylinder has turned.
#[derive(Lagrangian)]
#[coordinates(theta, phi)]
#[define(inertia = m*a^2/2)]
#[lagrangian(m/2*(R - a)^2*theta_dot^2 + inertia/2*phi_dot^2 + m*g*(R - a)*cos(theta))]
#[constraint(no_slip: (R - a)*theta_dot = a*phi_dot)]
#[allow(non_snake_case)]
struct CylinderInCylinder {
    m: f64,
    a: f64,
    R: f64,
    g: f64,
}

/// θ̈ = −(2g/3(R − a)) sin θ exactly, so that small oscillations have ω² = 2g/3(R − a); friction is (m g/3) sin θ.
#[test]
fn cylinder_rolling_in_a_cylinder() {
    let cylinder = CylinderInCylinder { m: 0.8, a: 0.3, R: 1.1, g: 9.81 };
    let rate = 2.0 * 9.81 / (3.0 * (1.1 - 0.3));
    for theta in [-2.0, 0.4, 1.3_f64] {
        let phi_dot = (1.1 - 0.3) / 0.3 * 0.7;
        let solution = cylinder.solve(&State::new([theta, 0.0], [0.7, phi_dot])).unwrap();
        assert_relative_eq!(solution.accelerations[0], -rate * theta.sin(), max_relative = 1e-14);
        let friction = 0.8 * 9.81 / 3.0 * theta.sin();
        assert_relative_eq!(solution.multipliers[0], friction, max_relative = 1e-13);
    }
    let path = cylinder.integrate(State::at_rest([1e-4, 0.0]), 5.0, Dop853::with_tolerance(1e-13)).unwrap();
    for sample in path.samples(51) {
        let exact = 1e-4 * (rate.sqrt() * sample.time()).cos();
        // The period grows by θ²/16, which is 6·10⁻¹⁰ of it.
        assert_abs_diff_eq!(sample.coordinate("theta").unwrap(), exact, epsilon = 2e-12);
    }
}
