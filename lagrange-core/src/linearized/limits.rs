//! Constants of linearized equations, chosen once for all of them.

/// Number of parts of a motion whose scatter gives the standard errors of Lyapunov exponents, after a first part in which the variations
/// align with the growing directions. An error from n parts is known to 1/√(2n), a sixth of it.
pub(super) const PARTS: usize = 20;

/// Weight of a constraint relative to a force, each in its own unit. A search for an equilibrium that stays near the constraints does
/// not end where a rod has shrunk to nothing.
pub(super) const CONSTRAINTS: f64 = 10.0;
