//! User-supplied functions: potentials, fields, prescribed motions.
//!
//! A field named in `#[function(U(r))]` holds such a function. The equations need its derivatives, usually up
//! to the second. Each order of derivative has its own trait, so a type that lacks a required order fails to
//! compile with a clear message. A type that implements [`Function`] has all of them.

mod check;
pub(crate) mod gradients;
mod limits;
mod supplied;
#[cfg(feature = "alloc")]
mod table;
#[cfg(test)]
mod tests;

pub use check::{WrongDerivative, check_derivatives};
pub use supplied::{First, Function, FunctionWithDerivatives, Second, Third, Value, WithDerivatives};
#[cfg(feature = "alloc")]
pub use table::{SmoothTable, Table};
