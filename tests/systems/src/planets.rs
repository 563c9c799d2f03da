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

/// The sun with the inner planets, and five outer bodies, by Newton's law of gravity.
#[derive(Clone, Debug, Lagrangian)]
#[coordinates(r: [6, 3])]
#[lagrangian(sum(i in 0..6, m[i]/2*dot(r_dot[i], r_dot[i]) + sum(j in 0..i, G*m[i]*m[j]/norm(r[i] - r[j]))))]
#[allow(non_snake_case)]
pub struct OuterSolarSystem {
    pub m: [f64; 6],
    pub G: f64,
}
