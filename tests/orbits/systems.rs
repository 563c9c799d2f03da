//! Systems of the tests, and the motions that are known of them.

use lagrange_core::prelude::*;
use lagrange_systems::{DrivenSpring, Pendulum};

/// A pendulum of length 1 with g = 1.
pub(crate) const PENDULUM: Pendulum<f64> = Pendulum { m: 1.0, l: 1.0, g: 1.0 };

/// A spring with friction under a force of amplitude 1.
pub(crate) const DRIVEN: DrivenSpring<f64> = DrivenSpring { m: 1.0, k: 1.0, c: 0.2, a: 1.0, w: 0.7 };

/// Circular limit cycles of radius √ρ with a − b ρ + ρ² = 0, and an oscillator beside them.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - x^2/2 - p*y^2/2 - y^4/4)]
#[define(square = x^2 + x_dot^2)]
#[force(x: -(a - b*square + square^2)*x_dot)]
#[force(y: -c*y_dot)]
pub(crate) struct Cycle {
    pub(crate) a: f64,
    pub(crate) b: f64,
    pub(crate) p: f64,
    pub(crate) c: f64,
}

pub(crate) const CYCLE: Cycle = Cycle { a: 0.1, b: 1.0, p: 3.0, c: 0.1 };

/// A saddle beside a spring, both with friction, both driven.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 + h*x^2/2 - k*y^2/2 + a*cos(t)*(x + y))]
#[dissipation(c*(x_dot^2/4 + y_dot^2/2))]
pub(crate) struct Saddle {
    pub(crate) h: f64,
    pub(crate) k: f64,
    pub(crate) a: f64,
    pub(crate) c: f64,
}
