//! Balls and beads that hit floors, ceilings and walls.

use lagrange_core::contact::Contact;
use lagrange_core::prelude::*;

/// A ball over a floor at the height r, whose weight a thrust lightens.
#[derive(Clone, Copy, Debug, Default, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*(g - thrust)*y)]
#[contact(floor: y >= r, restitution: e)]
#[observable(height = 2*y)]
pub struct Ball {
    pub m: f64,
    pub g: f64,
    pub r: f64,
    pub e: f64,
    pub thrust: f64,
    pub floor: Contact,
}

/// A ball between a floor and a ceiling that comes down.
#[derive(Clone, Copy, Debug, Default, Lagrangian)]
#[coordinates(y)]
#[lagrangian(y_dot^2/2 - g*y)]
#[contact(floor: y - low >= 0, restitution: e[0])]
#[contact(ceiling: high - speed*t - y >= 0, restitution: e[1])]
pub struct Slot {
    pub g: f64,
    pub e: [f64; 2],
    pub low: f64,
    pub high: f64,
    pub speed: f64,
    pub floor: Contact,
    pub ceiling: Contact,
}

/// A ball over a floor that swings; its weight and its restitution may swing too.
#[derive(Clone, Copy, Debug, Default, Lagrangian)]
#[coordinates(y)]
#[lagrangian(m/2 * y_dot^2 - m*y*(g + b*cos(w*t)))]
#[contact(floor: y - a*sin(w*t) >= 0, restitution: e + c*sin(w*t))]
pub struct Shaken {
    pub m: f64,
    pub g: f64,
    pub a: f64,
    pub b: f64,
    pub c: f64,
    pub e: f64,
    pub w: f64,
    pub floor: Contact,
}

/// A pendulum on a rod beside a wall that is curved and moves; its restitution depends on the velocity.
#[derive(Clone, Copy, Debug, Default, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + n*x_dot*y_dot*x - m*g*y)]
#[constraint(rod: (x^2 + y^2 - l^2)/2 = 0)]
#[contact(wall: d + a*sin(w*t) - x - b*y^2 >= 0, restitution: e*exp(-c*x_dot))]
pub struct Walled {
    pub m: f64,
    pub n: f64,
    pub g: f64,
    pub l: f64,
    pub a: f64,
    pub b: f64,
    pub d: f64,
    pub w: f64,
    pub e: f64,
    pub c: f64,
    pub wall: Contact,
}
