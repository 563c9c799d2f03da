//! Pendulums on a sphere and particles in rotating frames: systems of Milton's chapter 8 against their exact laws.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod foucault;
mod particles;
mod polar;
mod small;

#[path = "../../../examples/pendulum/mod.rs"]
mod pendulum;
