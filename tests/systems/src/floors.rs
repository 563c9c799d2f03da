//! Bodies in flight, and bodies that floors and walls hold.

use lagrange_core::prelude::*;

/// Ball in flight in a vertical plane.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
pub struct Flying<T> {
    pub m: T,
    pub g: T,
}

/// Ball of [`Flying`] that touches the floor y = 0.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(floor: y = 0)]
pub struct Touching<T> {
    pub m: T,
    pub g: T,
}

/// Rod that slides on the floor, in a vertical plane: its middle, its angle, and half its length `a`.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*a^2/6 * theta_dot^2 - m*g*y)]
#[constraint(floor: y - a*sin(theta) = 0)]
pub struct SlidingRod<T> {
    pub m: T,
    pub a: T,
    pub g: T,
}

/// Rod of [`SlidingRod`] that leans on a wall.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*a^2/6 * theta_dot^2 - m*g*y)]
#[constraint(floor: y - a*sin(theta) = 0)]
#[constraint(wall: x - a*cos(theta) = 0)]
pub struct LeaningRod<T> {
    pub m: T,
    pub a: T,
    pub g: T,
}

/// Body thrown upwards, with drag by the square of its speed.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - g*x)]
#[force(x: -c*x_dot*sqrt(x_dot^2))]
pub struct Thrown<T> {
    pub g: T,
    pub c: T,
}
