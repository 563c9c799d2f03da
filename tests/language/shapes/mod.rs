//! Coordinates, definitions and what is observed, in arrays of vectors and in families: against loops over the same numbers.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod families;
mod jacobian;
mod observables;
mod particles;

// Twenty-one coordinates, of which twelve are those of quaternions.
#[cfg(feature = "thorough")]
mod bodies;
