//! Bobs on rods, in Cartesian coordinates.

use lagrange_core::prelude::*;

/// Pendulum whose pivot swings along the horizontal as a·sin(w t).
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(rod: (x - a*sin(w*t))^2 + y^2 = l^2)]
pub struct ShakenPendulum<T> {
    pub m: T,
    pub g: T,
    pub l: T,
    pub a: T,
    pub w: T,
}

/// Two bobs of equal mass, one below the other, on rods of length 1.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(r: [2], s: [2])]
#[lagrangian(m/2 * (dot(r_dot, r_dot) + dot(s_dot, s_dot)) - m*g*(r[1] + s[1]))]
#[constraint(upper: dot(r, r) = 1)]
#[constraint(lower: dot(s - r, s - r) = 1)]
pub struct TwoBobs<T> {
    pub m: T,
    pub g: T,
}

/// Damped bob on two constraints, which are the same rod for `a = 1`.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - g*y)]
#[constraint(rod: x^2 + y^2 = 1)]
#[constraint(again: a*x^2 + y^2 = 1)]
#[dissipation(c/2 * (x_dot^2 + y_dot^2))]
pub struct DoubledRod<T> {
    pub g: T,
    pub a: T,
    pub c: T,
}
