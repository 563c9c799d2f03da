//! Types over the lengths of vectors, for functions that are generic over the system.
//!
//! The number of coordinates of a system is a type, [`Lagrangian::N`](crate::Lagrangian::N), and so is the number
//! of its constraints. For a known system they are [`Const<2>`](nalgebra::Const) and the like, and
//! [`State<f64, 2>`](crate::State) is short for [`State<f64, Const<2>>`](State).

pub use crate::hamiltonian::PhaseState;
pub use crate::system::{Direction, ResidualChange, Solution, State};
pub use crate::vector::{Array, Contiguous, Element, FixedArray, Length, Matrix, PhaseVector, Vector};
