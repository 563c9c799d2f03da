//! Vectors of `f64` as one SIMD register or several.

use super::scalar::Scalar;

/// A vector of `f64`.
pub(super) trait Vector: Scalar {
    /// How many there are.
    const COUNT: usize = size_of::<Self>() / size_of::<f64>();

    /// `self` where `chosen` is positive, `other` elsewhere.
    #[must_use]
    fn select(self, chosen: Self, other: Self) -> Self;
}
