//! Chosen numbers of numerical methods.

/// Iterations on one block of a matrix between two exceptional shifts, as in LAPACK's `dlahqr`. A handful is usual for an eigenvalue.
pub(super) const PATIENCE: usize = 10;
