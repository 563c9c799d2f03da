//! Structure of a system that an integrator relies on, as marker traits.
//!
//! `#[derive(Lagrangian)]` implements a marker where it can prove the statement from the derived equations. A method
//! that needs the structure bounds its systems by the marker, so that a program with an unsuitable system does not
//! compile:
//!
//! ```compile_fail,E0277
//! # use lagrange_core::prelude::*;
//! use lagrange_core::structure::VelocityFreeForces;
//!
//! fn kick<L: VelocityFreeForces>(system: &L) {}
//!
//! #[derive(Lagrangian)]
//! #[coordinates(x)]
//! #[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
//! #[force(x: -c*x_dot)]
//! struct Damped { m: f64, k: f64, c: f64 }
//!
//! kick(&Damped { m: 1.0, k: 4.0, c: 0.1 }); // error: the forces on `Damped` depend on the velocities
//! ```
//!
//! A manual implementation of [`Lagrangian`](crate::Lagrangian) has only the markers that are implemented by hand. So
//! has a derived system whose structure the derive macro cannot prove.

pub use crate::system::{ConstantMassMatrix, HolonomicConstraints, Unconstrained, VelocityFreeForces};
