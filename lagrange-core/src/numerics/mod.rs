//! Numerical methods without mechanics, each once: they know numbers and vectors alone.
//!
//! | file | method | where nalgebra does not serve |
//! |---|---|---|
//! | `ldl` | LDLᵀ without pivoting | numbers are lanes, dual numbers and power series; nothing branches |
//! | `sparse` | the same of sparse matrices, whose pattern is known when the program runs | no fill where none is needed; no allocation once the pattern is known |
//! | `symmetric` | LDLᵀ of indefinite matrices, complete pivoting | rank, null vectors, directions of negative curvature |
//! | `qr` | QR with pivoting, lengths that are constants | rank by a tolerance, no allocator, lengths that do not overflow |
//! | `least_norm` | QR with pivoting, lengths that are not | solutions of least norm of equations that depend on one another |
//! | `lu` | LU with partial pivoting, real and complex | factorizes again without an allocation |
//! | `singular` | singular values by Jacobi's rotations | small ones are as accurate as large ones |
//! | `francis` | eigenvalues by double shifts | ends for every matrix |
//! | `newton` | damped Newton's iteration, Levenberg and Marquardt | – |
//! | `bracket` | zero between two points of opposite sign | – |
//! | `spread`, `bare` | evenly distributed numbers; arithmetic without a library of functions | – |

#[cfg(feature = "alloc")]
pub(crate) mod bare;
pub(crate) mod bracket;
#[cfg(feature = "alloc")]
pub(crate) mod francis;
pub(crate) mod ldl;
#[cfg(feature = "alloc")]
pub(crate) mod least_norm;
#[cfg(feature = "alloc")]
mod limits;
#[cfg(feature = "alloc")]
pub(crate) mod lu;
pub(crate) mod newton;
pub(crate) mod qr;
#[cfg(feature = "alloc")]
pub(crate) mod singular;
#[cfg(feature = "alloc")]
pub(crate) mod sparse;
pub(crate) mod spread;
pub(crate) mod symmetric;
