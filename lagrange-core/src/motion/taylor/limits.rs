//! Chosen constants of Taylor's method.

/// Margin in the test whether the last coefficients have underflowed, in bits per order. They may have if the known
/// coefficients fall nearly as fast per order as coefficients that reach the smallest number at the highest order. The
/// unit of a polynomial has to stay: in another one its states are rounded.
pub(super) const UNDERFLOW: f64 = 8.0;
