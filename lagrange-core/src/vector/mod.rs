//! Vectors, matrices and arrays whose length is a type, and lengths that are values.

mod array;
mod each;
mod kind;
mod length;
mod nalgebra;
mod phase_vector;
#[cfg(feature = "alloc")]
pub(crate) mod run_time;
#[cfg(feature = "alloc")]
pub(crate) mod scratch;

pub(crate) use array::from_fn;
pub use array::{Array, FixedArray};
pub(crate) use each::{each, is_constant};
pub use kind::{Constant, Kind, Length, Numbers, VectorOf, ViewOf};
pub(crate) use kind::{vector_of, view_of};
pub use length::{Contiguous, Element, StaticLength};
pub(crate) use nalgebra::{Entrywise, array, matrix, rows, vector, zeros};
pub use nalgebra::{Matrix, Vector};
pub use phase_vector::PhaseVector;
pub(crate) use phase_vector::SpareVectors;
