//! Rigid bodies in the plane that touch floors and walls.

use lagrange_core::contact::Contact;
use lagrange_core::prelude::*;

/// A rod of the length 2a, or the lower edge of a block 2h high, between a rough floor and a rough wall.
#[derive(Clone, Copy, Debug, Default, Lagrangian)]
#[coordinates(x, y, theta)]
#[define(end(s) = [x + s*a*cos(theta) + h*sin(theta), y + s*a*sin(theta) - h*cos(theta)])]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + j/2 * theta_dot^2 - m*g*y)]
#[contact(floor[i in 0..2]: end(2*i - 1)[1] >= 0, restitution: e, friction(mu[i]): der(end(2*i - 1))[0])]
#[contact(wall[i in 0..2]: end(2*i - 1)[0] - left >= 0, restitution: e, friction(mu[i]): der(end(2*i - 1))[1])]
pub struct Rod {
    pub m: f64,
    pub j: f64,
    pub a: f64,
    pub h: f64,
    pub g: f64,
    pub e: f64,
    pub mu: [f64; 2],
    pub left: f64,
    pub floor: [Contact; 2],
    pub wall: [Contact; 2],
}

/// The same over a floor alone, with Poisson's law of impact.
#[derive(Clone, Copy, Debug, Default, Lagrangian)]
#[coordinates(x, y, theta)]
#[define(end(s) = [x + s*a*cos(theta) + h*sin(theta), y + s*a*sin(theta) - h*cos(theta)])]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + j/2 * theta_dot^2 - m*g*y)]
#[contact(floor[i in 0..2]: end(2*i - 1)[1] >= 0, restitution(poisson): e[i], friction(mu): der(end(2*i - 1))[0])]
pub struct PoissonRod {
    pub m: f64,
    pub j: f64,
    pub a: f64,
    pub h: f64,
    pub g: f64,
    pub e: [f64; 2],
    pub mu: f64,
    pub floor: [Contact; 2],
}

/// A sphere that rolls or slides on a rough floor, and may bounce.
#[derive(Clone, Copy, Debug, Default, Lagrangian)]
#[coordinates(x, y, phi)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*r^2/5 * phi_dot^2 - m*g*y)]
#[contact(floor: y - r >= 0, restitution: e, friction(mu): x_dot - r*phi_dot)]
pub struct Sphere<T> {
    pub m: T,
    pub g: T,
    pub r: T,
    pub e: T,
    pub mu: T,
    pub floor: Contact,
}
