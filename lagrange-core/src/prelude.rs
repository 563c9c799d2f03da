//! What a program that simulates a system needs: `use lagrange_core::prelude::*`.

#[cfg(feature = "std")]
pub use crate::Ensemble;
pub use crate::{
    Adjustment, ByHand, Classification, ConstraintKind, Direction, Error, Evidence, Extent, Function,
    Hamiltonian, HandWritten, Integrability, Integrals, Jacobian, Lagrangian, LinearPart, Linearized,
    PhaseRate, PhaseState, Real, Scalar, Simulate, Solution, State,
};
#[cfg(feature = "alloc")]
pub use crate::{
    Dop853, Dopri5, Ending, Equilibrium, HamiltonianFlow, Linearization, Method, Progress, Sample, Stability,
    Statistics, Table, Trajectory,
};
