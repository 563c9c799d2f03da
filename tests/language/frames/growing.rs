//! Bodies whose masses and inertias vary, against closed solutions.

use approx::assert_relative_eq;
use lagrange_core::StateDerivatives;
use lagrange_core::nalgebra::Matrix3;
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
    // The energy, which is T, is conserved: ∫ √(1 + x²) dx grows evenly.
    let grown = |x: f64| (x * (1.0 + x * x).sqrt() + x.asinh()) / 2.0;
    let end = system.integrate(state, 2.0, Dop853::with_tolerance(1e-12))?.end().coordinate("x")?;
    assert_relative_eq!(grown(end) - grown(0.5), 2.0 * (1.25_f64).sqrt(), epsilon = 1e-9);
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

#[test]
fn momenta_of_bodies_that_burn_are_conserved() -> Result<(), lagrange_core::Error> {
    let inertia = Matrix3::new(0.4, 0.1, 0.0, 0.1, 0.5, 0.0, 0.0, 0.0, 0.9);
    let system = Burning { m: 2.0, r: 0.3, s: 0.2, l: 0.5, inertia };
    let start = State::new([0.0, 0.4], [1.5, -2.0]);
    let path = system.integrate(start, 3.0, Dop853::with_tolerance(1e-12))?;
    let velocities = path.end().state().v;
    // p_x = 2 m e^{−rt} ẋ, p_φ = (2 m e^{−rt} l² + (1 + st) J₃₃) φ̇: the centre of both is on the axle.
    let left = 2.0 * 2.0 * (-0.3 * 3.0_f64).exp();
    assert_relative_eq!(velocities[0], 1.5 * 4.0 / left, epsilon = 1e-10);
    let about = |left: f64, t: f64| left * 0.25 + (1.0 + 0.2 * t) * 0.9;
    assert_relative_eq!(velocities[1], -2.0 * about(4.0, 0.0) / about(left, 3.0), epsilon = 1e-10);
    Ok(())
}
