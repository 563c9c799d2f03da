//! Lagrangian mechanics from a struct.
#![cfg_attr(not(feature = "std"), no_std)]

// Generated code names this crate `::lagrange_core`, also inside it.
extern crate self as lagrange_core;
#[cfg(feature = "alloc")]
extern crate alloc;

pub mod eliminate;
pub mod prelude;
mod scalar;
mod state;
mod system;

pub use lagrange_macros::Lagrangian;
pub use nalgebra;
pub use scalar::{Real, Scalar};
pub use state::{Solution, State};
pub use system::{ConstraintKind, Lagrangian};
