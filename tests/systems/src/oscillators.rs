//! Masses on springs.

use lagrange_core::prelude::*;

/// Mass on a spring.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
pub struct Spring<T> {
    pub m: T,
    pub k: T,
}

/// Mass on a spring, pushed by a force; without a spring it is free, or falls.
#[derive(Clone, Copy, Debug, Default, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
#[force(x: u)]
pub struct PushedSpring<T> {
    pub m: T,
    pub k: T,
    pub u: T,
    /// What a test notes of it.
    pub mark: [T; 2],
    /// What all lanes share.
    pub label: u8,
}

/// Mass on a spring, with friction and a periodic force. With `w = 0` the force is constant.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
#[dissipation(c/2 * x_dot^2)]
#[force(x: a*cos(w*t))]
pub struct DrivenSpring<T> {
    pub m: T,
    pub k: T,
    pub c: T,
    pub a: T,
    pub w: T,
}

/// Mass on a spring that sticks to a belt.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
#[constraint(friction: x_dot - belt = 0)]
pub struct Sticking<T> {
    pub m: T,
    pub k: T,
    pub belt: T,
}

/// Motion of a star in the plane of a galaxy (Hénon and Heiles, *Astronomical Journal* 69, 1964).
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - (x^2 + y^2)/2 - x^2*y + y^3/3)]
pub struct HenonHeiles;
