//! Blocks that slide, and bodies in a row.

use lagrange_core::contact::{Contact, Friction};
use lagrange_core::prelude::*;

/// A block on a rough floor of the slope s, which may swing along itself, pulled by a force.
#[derive(Clone, Copy, Debug, Default, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*(y + s*x))]
#[force(x: pull)]
#[contact(floor: y >= 0, restitution: e, friction(mu): x_dot - a*omega*cos(omega*t))]
#[observable(drag = lambda(floor_friction))]
pub struct Block<T> {
    pub m: T,
    pub g: T,
    pub s: T,
    pub e: T,
    pub mu: T,
    pub pull: T,
    pub a: T,
    pub omega: T,
    pub floor: Contact,
}

/// A block on a belt, held by a spring and pulled by a force that grows; its friction may fall.
#[derive(Clone, Copy, Debug, Default, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
#[force(x: from + grows*t)]
#[friction(belt: x_dot - speed, limit: hold*(1 - falls*t), sliding: pull*(1 - falls*t))]
pub struct Belt<T> {
    pub m: T,
    pub k: T,
    pub speed: T,
    pub hold: T,
    pub pull: T,
    pub from: T,
    pub grows: T,
    pub falls: T,
    pub belt: Friction,
}

/// A point on a rough plane that tilts and turns, with springs, and with forces along it.
#[derive(Clone, Copy, Debug, Default, Lagrangian)]
#[coordinates(x, y, z)]
#[define(alpha = tilt + tilting*t)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) + m*g*(sin(alpha)*(x*down[0] + y*down[1]) - cos(alpha)*z)
    - k/2 * (x - a)^2 - c/2 * (y - b*t)^2)]
#[force(x: push[0] + grows[0]*t + swing*sin(omega*t))]
#[force(y: push[1] + grows[1]*t)]
#[contact(floor: z >= 0, friction(mu): [x_dot + turning*y, y_dot - turning*x])]
pub struct Puck {
    pub m: f64,
    pub g: f64,
    pub mu: f64,
    pub tilt: f64,
    pub tilting: f64,
    pub down: [f64; 2],
    pub turning: f64,
    pub k: f64,
    pub c: f64,
    pub a: f64,
    pub b: f64,
    pub push: [f64; 2],
    pub grows: [f64; 2],
    pub swing: f64,
    pub omega: f64,
    pub floor: Contact,
}

/// Three bodies of the height h, one above the other, over a floor.
#[derive(Clone, Copy, Debug, Default, Lagrangian)]
#[coordinates(y: [3])]
#[lagrangian(sum(i in 0..3, m[i]*(y_dot[i]^2/2 - g*y[i])))]
#[contact(floor: y[0] - low >= 0, restitution: e[0])]
#[contact(pair[i in 0..2]: y[i + 1] - y[i] - h >= 0, restitution: e[i + 1])]
pub struct Stack {
    pub m: [f64; 3],
    pub g: f64,
    pub h: f64,
    pub low: f64,
    pub e: [f64; 3],
    pub floor: Contact,
    pub pair: [Contact; 2],
}
