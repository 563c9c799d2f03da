//! Coordinates, definitions and what is observed, in arrays of vectors and in families: against loops over the same numbers.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod bodies;
mod families;
mod jacobian;
mod observables;
mod particles;
