//! Methods with steps of one length that keep the structure of mechanics: their orders, and what they keep.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod applicability;
mod dense_output;
mod derivatives;
mod faults;
mod long_time;
mod nonholonomic;
mod orders;
mod own_scheme;
mod symplectic;
mod systems;

/// Whether problems are taken that compile for long and move for long, by all methods.
const IS_LONG: bool = lagrange_random::is_full(option_env!("LAGRANGE_CASES"));
