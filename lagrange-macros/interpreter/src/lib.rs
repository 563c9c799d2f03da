//! Moves mechanical systems whose Lagrangian is read from a text when the program runs: a model from a file, from a configuration or
//! from a text field, without a compiler.
//!
//! [`System::parse`] derives the equations of motion. A [`Model`] is such a system with values of its parameters. It implements
//! [`ManyBodies`](lagrange_core::ManyBodies), so that the methods of `lagrange-core` that serve any number of coordinates move it:
//! [`Dop853`](lagrange_core::Dop853), [`Dopri5`](lagrange_core::Dopri5), [`RungeKutta4`](lagrange_core::RungeKutta4) and pairs of one's
//! own, with events, samples and quantities. Steps end on the constraints.
//!
//! ```
//! use lagrange_core::prelude::*;
//! use lagrange_interpreter::{Model, System};
//!
//! // As it stands on a struct. It may come from a file: `std::fs::read_to_string("pendulum.txt")?`.
//! let text = "
//!     #[coordinates(theta)]
//!     #[lagrangian(m/2 * l^2 * theta_dot^2 + m*g*l*cos(theta))]
//!     #[observable(height = -l*cos(theta))]
//!     struct Pendulum { m: f64, l: f64, g: f64 }";
//! let system = System::parse(text)?;
//! assert!(system.equations().text().contains("l θ̈ = −g sin θ"));
//!
//! let pendulum = Model::new(&system, [("m", 1.0), ("l", 2.0), ("g", 9.81)])?;
//! let start = pendulum.at_rest([0.5]);
//! let path = pendulum.integrate(start.clone(), 10.0, Dop853::default())?;
//! let end = path.end().state().clone();
//! assert!((pendulum.energy(&end) - pendulum.energy(&start)).abs() < 1e-6);
//! assert_eq!(pendulum.observe(&end)?, [-2.0 * end.q[0].cos()]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! `#[derive(Lagrangian)]` compiles the same text to the same operations, which take a fifth to a tenth of the time, and has more: contacts and friction,
//! lengths that are fields, functions of one's own, other number types, Taylor's method, geometric methods and derivatives of motions.
//! What a model cannot do is an error: [`Unsupported`] names it.
//!
//! It is not published yet: `cargo add --path ../lagrange/lagrange-macros/interpreter` adds it to a project beside the repository.

mod dense;
mod error;
mod many_bodies;
mod model;
mod parameters;
#[cfg(test)]
mod tests;

pub use error::{ModelError, ParameterError};
pub use lagrange_derive::{Diagnostic, Refusal, System, Unsupported};
pub use model::Model;
pub use parameters::{Parameters, Values};
