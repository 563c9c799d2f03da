//! Pendulums in a plane and on a sphere.

use lagrange_core::prelude::*;

/// Pendulum in a plane, by its angle from the downward vertical.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(theta)]
#[lagrangian(m*l^2/2 * theta_dot^2 + m*g*l*cos(theta))]
pub struct Pendulum<T> {
    pub m: T,
    pub l: T,
    pub g: T,
}

/// Two pendulums in a plane, one below the other, by their angles from the downward vertical.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(a, b)]
#[lagrangian((m[0] + m[1])/2*l[0]^2*a_dot^2 + m[1]/2*l[1]^2*b_dot^2 + m[1]*l[0]*l[1]*a_dot*b_dot*cos(a - b)
    + (m[0] + m[1])*g*l[0]*cos(a) + m[1]*g*l[1]*cos(b))]
pub struct DoublePendulum<T> {
    pub m: [T; 2],
    pub l: [T; 2],
    pub g: T,
}

/// Pendulum on a sphere, with the multiplier of its string. The tension is −λ l.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
#[constraint(string: (x^2 + y^2 + z^2 - l^2)/2 = 0)]
pub struct SphericalPendulum<T> {
    pub m: T,
    pub g: T,
    pub l: T,
}

/// Pendulum on a sphere, by its angle from the downward vertical and its azimuth.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(theta, phi)]
#[lagrangian(m*l^2/2 * (theta_dot^2 + sin(theta)^2*phi_dot^2) + m*g*l*cos(theta))]
pub struct PolarPendulum<T> {
    pub m: T,
    pub g: T,
    pub l: T,
}

/// Bead on a hoop that turns about its vertical diameter, by its angle from the lowest point.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(theta)]
#[lagrangian(r^2/2*(theta_dot^2 + omega^2*sin(theta)^2) + g*r*cos(theta))]
pub struct BeadOnHoop<T> {
    pub r: T,
    pub g: T,
    pub omega: T,
}

/// Foucault's pendulum on an Earth that turns at the rate `rate`: x east, y north, z up.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(r: [3])]
#[define(v = r_dot)]
#[define(W = [0, rate*cos(latitude), rate*sin(latitude)])]
#[lagrangian(m/2*dot(v, v) + m*dot(v, cross(W, r)) + m/2*dot(cross(W, r), cross(W, r)) - m*g*r[2])]
#[constraint(string: (dot(r, r) - l^2)/2 = 0)]
pub struct Foucault<T> {
    pub m: T,
    pub g: T,
    pub l: T,
    pub rate: T,
    pub latitude: T,
}
