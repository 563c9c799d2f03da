//! Constants of linearized equations, chosen once for all of them.

/// Number of equal parts of a motion whose scatter gives the standard errors of Lyapunov exponents; in one part before them the variations
/// align with the growing directions. A standard error estimated from n parts has a relative uncertainty of 1/√(2n), here a sixth.
pub(super) const PARTS: usize = 20;

/// Weight of a constraint relative to a force, each in its own unit. A search for an equilibrium that stays near the constraints does
/// not end where a rod has shrunk to nothing.
pub(super) const CONSTRAINTS: f64 = 10.0;
