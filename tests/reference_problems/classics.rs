//! Systems of textbooks: pendulums, orbits, pulleys.

use approx::assert_abs_diff_eq;
use lagrange_core::prelude::*;
use lagrange_systems::{DoublePendulum, HenonHeiles, Planet, TwoBobs};

use crate::reference::{BAR, Problem, table};

const DOUBLE: DoublePendulum<f64> = DoublePendulum { m: [1.0, 1.0], l: [1.0, 1.0], g: 9.81 };

/// A perturbation of the start grows by 143 until t = 10.
#[test]
fn double_pendulum_from_the_horizontal() {
    let problem =
        Problem { name: "double pendulum, angles", system: DOUBLE, known: table!("double_pendulum") };
    problem.check(&[[1e-13, 1e-14, 0.0], [1e-9, 1e-10, 0.0]]);
}

/// A perturbation of the start grows by 43 until t = 10.
#[test]
fn double_pendulum_swinging_mildly() {
    let known = table!("double_pendulum_mild");
    let problem = Problem { name: "double pendulum, mild swing", system: DOUBLE, known };
    problem.check(&[[1e-13, 1e-13, 0.0], [1e-10, 1e-10, 0.0], BAR]);
}

/// λ is −½ of the tension: Φ is not halved. The second run ends before the start is amplified by more than 13.
#[test]
fn double_pendulum_with_multipliers() {
    let system = TwoBobs { m: 1.0, g: 9.81 };
    let problem = Problem { name: "double pendulum, x, y of both bobs", system, known: table!("two_bobs") };
    problem.check(&[[5e-13, 2e-12, 5e-13], [1e-11, 1e-11, 1e-11]]);
    problem.until(5.0).check(&[[1e-13, 1e-13, 1e-14], [1e-12, 1e-12, 1e-12]]);
}

/// A regular orbit.
#[test]
fn henon_heiles() {
    let problem = Problem { name: "Hénon and Heiles", system: HenonHeiles, known: table!("henon_heiles") };
    problem.check(&[[1e-13, 1e-13, 0.0], [1e-10, 1e-10, 0.0]]);
}

/// With the eccentricity 0.6 and the period 2π.
#[test]
fn kepler_ellipse() {
    let problem = Problem { name: "Kepler's ellipse", system: Planet { mu: 1.0 }, known: table!("kepler") };
    problem.check(&[[1e-12, 1e-12, 0.0], [1e-9, 1e-9, 0.0]]);
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
    for (m, inertia, radius) in
        [([2.0, 1.0], 0.3, 0.5), ([0.4, 3.0], 1e-3, 0.1), ([1.0, 1.0], 0.2, 0.7), ([0.3, 5.0], 0.0, 0.4)]
    {
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
