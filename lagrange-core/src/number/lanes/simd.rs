//! SIMD vectors of `f64`, in one register or several.

use crate::number::Scalar;

/// A vector of `f64`.
pub(super) trait SimdVector: Scalar {
    /// Number of lanes.
    const COUNT: usize = size_of::<Self>() / size_of::<f64>();

    /// Returns `self` in lanes where `chosen` is positive, `other` elsewhere.
    #[must_use]
    fn select(self, chosen: Self, other: Self) -> Self;
}
