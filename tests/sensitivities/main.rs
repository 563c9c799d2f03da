//! Derivatives of motions by where they start and by parameters.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod differences;
mod discrete;
mod event_differences;
mod event_errors;
mod events;
mod lyapunov;
mod motions;
mod stiff;

// Further systems, of which each takes the compiler seconds.
#[cfg(feature = "thorough")]
mod chaos;
#[cfg(feature = "thorough")]
mod impacts;
#[cfg(feature = "thorough")]
mod mixed;
#[cfg(feature = "thorough")]
mod trees;

use lagrange_core::prelude::*;

fn method() -> Dop853 {
    Dop853::with_tolerance(1e-13)
}

/// A pendulum with friction, driven by a torque.
#[derive(Clone, Debug, Lagrangian)]
#[coordinates(theta)]
#[lagrangian(m*l^2/2 * theta_dot^2 + m*g*l*cos(theta))]
#[dissipation(c/2 * theta_dot^2)]
#[force(theta: a*cos(w*t))]
struct Damped<T> {
    m: T,
    l: T,
    g: T,
    c: T,
    a: T,
    w: T,
}

const DAMPED: Damped<f64> = Damped { m: 1.2, l: 0.7, g: 9.81, c: 0.3, a: 1.15, w: 2.0 / 3.0 };

/// A bead on a wire that turns ever faster, its height after a rule for velocities.
#[derive(Clone, Debug, Lagrangian)]
#[coordinates(x, y, z)]
#[define(angle = w*t + b*t^2/2)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) - m*g*z - k/2*(x^2 + y^2))]
#[constraint(wire: x*sin(angle) = y*cos(angle))]
#[constraint(climb: z_dot = c*(x*x_dot + y*y_dot))]
struct BeadOnWire<T> {
    m: T,
    g: T,
    w: T,
    b: T,
    c: T,
    k: T,
}

const BEAD: BeadOnWire<f64> = BeadOnWire { m: 1.0, g: 2.0, w: 0.8, b: 0.3, c: 0.5, k: 9.0 };

fn bead_start() -> State<f64, 3> {
    State::new([0.7, 0.3, 0.0], [0.1, 0.5, 0.0]).at_time(0.5)
}
