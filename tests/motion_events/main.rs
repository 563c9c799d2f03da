//! Where functions of a motion cross zero.

mod adversary;
mod hybrid;
mod impacts;
mod middle;
mod rule;
mod runs;
mod section;

use lagrange_core::prelude::*;

/// Its height is q.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(height)]
#[lagrangian(height_dot^2/2 - g*height)]
pub(crate) struct Ball {
    pub(crate) g: f64,
}

/// x = cos(t) from rest at 1.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - x^2/2)]
pub(crate) struct Spring;

/// Which moves as it did.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2)]
pub(crate) struct Free;
