//! Limits that hold for all numerical methods of the crate.

/// Largest number of steps of an iteration that converges linearly with a ratio below 0.83, to round-off: 0.83²⁰⁰ = 7·10⁻¹⁷. Where a
/// function vanishes to the third order, Newton's iteration has the ratio 2/3, and 8/27 of the function is left.
pub(crate) const ITERATIONS: usize = 200;

/// Round-off of a sum of a few terms, in units of ε times the sum of their magnitudes: half a unit for each operation.
pub(crate) const SUM: f64 = 4.0;

/// Round-off of a sum whose terms are results of a few operations themselves, in the same units. Residuals of constraints at
/// which projections end lie below it, with four terms of four operations.
pub(crate) const CANCELLED: f64 = 16.0;

/// Round-off of a sum whose terms are results of many operations, such as a factorization, in the same units.
pub(crate) const ACCUMULATED: f64 = 64.0;

/// Relative change of a coordinate that shows how much a function really varies with it: an angle of 10¹⁶ times the gradient of
/// its sine is a large term, but no sine changes by more than 2.
pub(crate) const CHANGE: f64 = 0.125;

/// Smallest reduction of a residual from one sweep of an iteration to the next that counts as progress.
pub(super) const PROGRESS: f64 = 0.75;

/// First damping of a search by the method of Levenberg and Marquardt, in units of the squares of the derivatives: the first step is
/// Newton's to a thousandth, where that one leads nearer.
pub(crate) const DAMPING: f64 = 1e-3;

/// Half of the digits, √ε: what Newton's method has to reach so that its next step has all of them.
pub(crate) const HALF_THE_DIGITS: f64 = 1.0 / (1 << 26) as f64;
