//! A pendulum on a sphere: in Cartesian coordinates with its multiplier, and by angles through whole periods.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3};

use lagrange_systems::{PolarPendulum, SphericalPendulum};

use crate::reference::{BAR, Known, Problem, table};

#[test]
fn in_cartesian_coordinates() {
    let system = SphericalPendulum { m: 1.0, g: 9.81, l: 1.0 };
    let problem =
        Problem { name: "spherical pendulum, x, y, z", system, known: table!("spherical_pendulum") };
    problem.check(&[[1e-14, 1e-13, 1e-14], [1e-11, 1e-11, 1e-11], BAR]);
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
        let system = PolarPendulum { m: 1.0, g: 9.81, l: 1.0 };
        let problem = Problem { name, system, known: [0.0, 1.0, 2.0, 10.0].map(after).to_vec() };
        problem.check(&[[1e-13, 1e-13, 0.0], [1e-11, 1e-11, 0.0], BAR]);
    }
}
