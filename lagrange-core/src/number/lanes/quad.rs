//! SIMD vectors of four `f64`: the type of `wide` with the traits of `simba`.

use simba::simd::{SimdPartialOrd, SimdValue, WideF64x4};

use super::simd::SimdVector;

/// A vector of four `f64`.
pub(super) type Quad = WideF64x4;

impl SimdVector for Quad {
    #[inline(always)]
    fn select(self, chosen: Self, other: Self) -> Self {
        SimdValue::select(self, chosen.simd_gt(Self::splat(0.0)), other)
    }
}
