//! Methods with steps of one length that keep the structure of mechanics: their orders, and what they keep.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod applicability;
mod dense_output;
mod faults;
mod orders;
mod own_scheme;
mod symplectic;
mod systems;

#[cfg(feature = "thorough")]
mod derivatives;
#[cfg(feature = "thorough")]
mod long_time;
#[cfg(feature = "thorough")]
mod nonholonomic;

/// Whether problems are taken that compile for long and move for long, by all methods.
const IS_LONG: bool = lagrange_random::is_full(option_env!("LAGRANGE_CASES"));
