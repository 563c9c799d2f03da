//! What a program that simulates a system needs: `use lagrange_core::prelude::*`.

pub use crate::{
    Adjustment, ByHand, ConstraintKind, Error, Evidence, Function, HandWritten, Lagrangian, LinearPart, Real,
    Scalar, Simulate, Solution, State,
};
#[cfg(feature = "alloc")]
pub use crate::{Dop853, Dopri5, Ending, Method, Progress, Sample, Statistics, Table, Trajectory};
