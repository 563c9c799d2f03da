//! Vectors, matrices and arrays whose length is a type.

mod array;
mod length;
mod nalgebra;
mod phase_vector;

pub(crate) use array::from_fn;
pub use array::{Array, FixedArray};
pub use length::{Contiguous, Element, Length};
pub(crate) use nalgebra::{Entrywise, array, matrix, rows, vector, zeros};
pub use nalgebra::{Matrix, Vector};
pub use phase_vector::PhaseVector;
