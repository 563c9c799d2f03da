//! Bodies whose masses and inertias vary, against closed solutions.

use approx::assert_relative_eq;
use lagrange_core::StateDerivatives;
use lagrange_core::nalgebra::{Matrix3, SVector};
use lagrange_core::prelude::*;

/// T = m l² (1 + x²) ẋ²/2, so that (1 + x²) ẍ = −x ẋ².
#[derive(Lagrangian)]
#[coordinates(x)]
#[frame(rod: rotate_y(x), translate([0, 0, l]))]
#[lagrangian(kinetic(rod, m*(1 + x^2)))]
struct Gathering {
    m: f64,
    l: f64,
}

#[test]
fn a_mass_that_depends_on_a_coordinate_has_its_slope() -> Result<(), lagrange_core::Error> {
    let system = Gathering { m: 1.3, l: 0.7 };
    let (x, v) = (0.5, 1.0);
    let state = State::new([x], [v]);
    assert_relative_eq!(system.solve(&state)?.accelerations[0], -0.4, epsilon = 1e-15);
    let jacobian = system.state_jacobian(&state)?.accelerations;
    let square = 1.0 + x * x;
    let expected = [-v * v * (1.0 - x * x) / (square * square), -2.0 * x * v / square];
    assert_relative_eq!(jacobian.q[(0, 0)], expected[0], epsilon = 1e-14);
    assert_relative_eq!(jacobian.v[(0, 0)], expected[1], epsilon = 1e-14);
    Ok(())
}

/// A wheel that burns while it turns about its axle: m e^{−rt} at the rim, J (1 + s t) of its own.
#[derive(Lagrangian)]
#[coordinates(x, phi)]
#[frame(wheel: translate([x, 0, 0]), rotate_z(phi))]
#[define(burnt(s) = exp(-r*s))]
#[define(left = m*burnt(t))]
#[lagrangian(kinetic(wheel, left, [0, l, 0]) + kinetic(wheel, left, [0, -l, 0], (1 + s*t)*inertia))]
struct Burning {
    m: f64,
    r: f64,
    s: f64,
    l: f64,
    inertia: Matrix3<f64>,
}

/// p_x = 2 m e^{−rt} ẋ and p_φ = (2 m e^{−rt} l² + (1 + st) J₃₃) φ̇ are conserved: the centre of both is on the axle.
#[test]
fn momenta_of_bodies_that_burn_are_conserved() -> Result<(), lagrange_core::Error> {
    let inertia = Matrix3::new(0.4, 0.1, 0.0, 0.1, 0.5, 0.0, 0.0, 0.0, 0.9);
    let system = Burning { m: 2.0, r: 0.3, s: 0.2, l: 0.5, inertia };
    let state = State::new([0.0, 0.4], [1.5, -2.0]).at_time(1.7);
    let left = 2.0 * 2.0 * (-0.3 * 1.7_f64).exp();
    let (about, rate) = (left * 0.25 + (1.0 + 0.2 * 1.7) * 0.9, -0.3 * left * 0.25 + 0.2 * 0.9);
    let expected = SVector::from([0.3 * 1.5, 2.0 * rate / about]);
    assert_relative_eq!(system.solve(&state)?.accelerations, expected, epsilon = 1e-14);
    assert_relative_eq!(system.momentum(&state), SVector::from([left * 1.5, -2.0 * about]), epsilon = 1e-14);
    Ok(())
}
