//! Functions that a user supplies: potentials, fields, prescribed motions.
//!
//! A field named in `#[function(U(r))]` is one. The equations need its derivatives, up to the second as a rule; each
//! order is a trait of its own here, so that a form that does not go far enough is a compile-time error that says so.
//! Whoever implements [`Function`] has them all.

mod check;
mod supplied;
#[cfg(feature = "alloc")]
mod table;
#[cfg(test)]
mod tests;

pub use check::{WrongDerivative, check_derivatives};
pub use supplied::{First, Function, FunctionWithDerivatives, Second, Third, Value, WithDerivatives};
#[cfg(feature = "alloc")]
pub use table::{SmoothTable, Table};
