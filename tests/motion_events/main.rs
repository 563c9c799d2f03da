//! Where functions of a motion cross zero.

mod adversary;
mod impacts;
mod rule;
mod runs;
mod section;

// Several systems in one motion, of which the documentation of `HybridTrajectory` shows the most.
#[cfg(feature = "thorough")]
mod hybrid;

use lagrange_core::prelude::*;
use lagrange_systems::PushedSpring;

/// x = cos(t) from rest at 1.
const SPRING: PushedSpring<f64> = PushedSpring { m: 1.0, k: 1.0, u: 0.0, mark: [0.0; 2], label: 0 };

/// Moves as it did.
const FREE: PushedSpring<f64> = PushedSpring { k: 0.0, ..SPRING };

/// Falls with x as its height.
fn ball(g: f64) -> PushedSpring<f64> {
    PushedSpring { u: -g, ..FREE }
}

/// A particle in a plane, which falls along both axes.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - g*(x + y))]
struct Plane {
    g: f64,
}

/// A rod with one end on the ground.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x, y, theta)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*a^2/6 * theta_dot^2 - m*g*y)]
#[constraint(ground: y - a*sin(theta) = 0)]
#[observable(foot = x + a*cos(theta))]
struct Rod {
    m: f64,
    a: f64,
    g: f64,
}
