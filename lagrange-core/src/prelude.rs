//! What a program that simulates a system needs: `use lagrange_core::prelude::*`.

pub use crate::{
    Adjustment, ByHand, Classification, ConstraintKind, Error, Evidence, Extent, Function, HandWritten,
    Integrability, Integrals, Lagrangian, Real, Scalar, Simulate, Solution, State,
};
#[cfg(feature = "alloc")]
pub use crate::{Dop853, Dopri5, Ending, Method, Progress, Sample, Statistics, Table, Trajectory};
