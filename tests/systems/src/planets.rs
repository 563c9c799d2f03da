//! Bodies that attract each other.

use lagrange_core::prelude::*;

/// Planet in a plane about a fixed sun.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 + mu/sqrt(x^2 + y^2))]
pub struct Planet<T> {
    pub mu: T,
}

/// Small body in the plane of Earth and Moon, in the frame that turns with them. `mu` is the Moon's part of both masses.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(x, y)]
#[define(r1 = sqrt((x + mu)^2 + y^2))]
#[define(r2 = sqrt((x - 1 + mu)^2 + y^2))]
#[lagrangian(((x_dot - y)^2 + (y_dot + x)^2)/2 + (1 - mu)/r1 + mu/r2)]
pub struct ThreeBodies<T> {
    pub mu: T,
}
