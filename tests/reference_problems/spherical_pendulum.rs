//! A pendulum on a sphere: in Cartesian coordinates with its multiplier, and by angles through whole periods.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3};

use lagrange_core::prelude::*;

use crate::reference_motions::reference::{BAR, Known, Problem, table};

/// Φ = r² − l² is not halved: λ is half of that for ½(r² − l²), and the tension is −2λl.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
#[constraint(string: x^2 + y^2 + z^2 - l^2 = 0)]
struct ByPosition {
    m: f64,
    g: f64,
    l: f64,
}

/// θ is counted from the downward vertical.
#[derive(Lagrangian)]
#[coordinates(th, ph)]
#[lagrangian(m*l^2/2*(th_dot^2 + sin(th)^2*ph_dot^2) + m*g*l*cos(th))]
struct ByAngles {
    m: f64,
    g: f64,
    l: f64,
}

#[test]
fn in_cartesian_coordinates() {
    let system = ByPosition { m: 1.0, g: 9.81, l: 1.0 };
    let problem =
        Problem { name: "spherical pendulum, x, y, z", system, known: table!("spherical_pendulum") };
    problem.check(&[("Taylor", [1e-14, 1e-13, 1e-14]), ("Dop853", [1e-11, 1e-11, 1e-11]), ("Dopri5", BAR)]);
}

/// Starts at a turning point, θ and φ̇, with period and azimuth of one oscillation of θ. Computed with 60 digits by
/// elliptic functions and by quadrature, which agree.
const OSCILLATIONS: [(&str, [f64; 4]); 3] = [
    (
        "spherical pendulum, moderate swing",
        [FRAC_PI_3, 1.5, 1.078_462_326_167_675_1, 3.654_902_541_135_339_5],
    ),
    (
        "spherical pendulum, from the horizontal",
        [FRAC_PI_2, 1.0, 1.176_933_241_758_156_8, 3.730_059_274_468_872],
    ),
    ("spherical pendulum, small swing", [0.1, 1.0, 1.003_723_877_220_113_4, 3.145_347_965_571_237_3]),
];

#[test]
fn by_angles_through_whole_oscillations() {
    for (name, [theta, rate, period, azimuth]) in OSCILLATIONS {
        let after =
            |n: f64| Known { t: n * period, q: [theta, n * azimuth], v: [0.0, rate], lambda: Some([]) };
        let system = ByAngles { m: 1.0, g: 9.81, l: 1.0 };
        let problem = Problem { name, system, known: [0.0, 1.0, 2.0, 10.0].map(after).to_vec() };
        problem.check(&[("Taylor", [1e-13, 1e-13, 0.0]), ("Dop853", [1e-11, 1e-11, 0.0]), ("Dopri5", BAR)]);
    }
}
