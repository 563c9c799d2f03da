//! Lagrangian mechanics from a struct.
#![cfg_attr(not(feature = "std"), no_std)]
// Algorithms on matrices read best with indices.
#![allow(clippy::needless_range_loop)]

// Generated code names this crate `::lagrange_core`, also inside it.
#[cfg(feature = "alloc")]
extern crate alloc;
extern crate self as lagrange_core;

mod consistent;
#[cfg(feature = "alloc")]
mod csv;
pub mod eliminate;
mod error;
#[cfg(test)]
mod fixtures;
#[cfg(feature = "alloc")]
pub mod integrate;
mod kkt;
#[cfg(feature = "alloc")]
mod lookup;
mod names;
mod numeric;
pub mod prelude;
#[cfg(feature = "alloc")]
mod sample;
mod scalar;
mod simulate;
mod solve;
mod state;
mod system;
#[cfg(feature = "alloc")]
mod trajectory;

pub use consistent::{Adjustment, Consistent};
#[cfg(feature = "alloc")]
pub use csv::Csv;
pub use error::Error;
#[cfg(feature = "alloc")]
pub use integrate::{Dop853, Dopri5, Ending, Method, Progress, Statistics};
pub use lagrange_macros::Lagrangian;
pub use nalgebra;
pub use names::{Entry, Names, Row};
#[cfg(feature = "alloc")]
pub use sample::Sample;
pub use scalar::{Real, Scalar};
pub use simulate::Simulate;
pub use state::{Solution, State};
pub use system::{ConstraintKind, Lagrangian};
#[cfg(feature = "alloc")]
pub use trajectory::Trajectory;
