//! What a program that simulates a system needs: `use lagrange_core::prelude::*`.

pub use crate::{ConstraintKind, Lagrangian, Scalar, Solution, State};
