//! What a series has to go through: forces, dissipation, explicit time, a constraint on velocities.

use lagrange_core::prelude::*;

use super::difference;

#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((1 + y^2)*x_dot^2/2 + (x_dot*y_dot)*sin(z) + 2*y_dot^2 + (1 + x^2)*z_dot^2 + a*x_dot*y - x^2/2 - cos(z + t))]
#[dissipation(c*(x_dot^2 + z_dot^2)/2 + c*(x_dot^2 + y_dot^2)^2/40)]
#[force(x: sin(2*t))]
#[constraint(moving: y_dot - x*z_dot = cos(t)/3)]
struct Rich {
    a: f64,
    c: f64,
}

/// Mass that moves, gyroscopic terms, cubic drag, a nonholonomic constraint that depends on time and is affine.
#[test]
fn everything_at_once() -> Result<(), Error> {
    let system = Rich { a: 0.7, c: 0.3 };
    let start = State::new([0.3, -0.2, 0.5], [0.4, 1.0 / 3.0 + 0.3 * 0.6, 0.6]);
    assert!(difference(&system, start, 3.0)? < 1e-12);
    Ok(())
}
