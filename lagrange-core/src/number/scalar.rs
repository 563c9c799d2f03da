//! Number types for generated code.

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A number on which equations of motion can be evaluated: `f64`, `f32`, a SIMD lane type, a dual number.
///
/// Generated code uses mathematical functions only through this trait. Every type with [`simba`'s
/// `SimdRealField`](simba::simd::SimdRealField) implements it: the floating-point types, the lane types of
/// `simba` (`WideF64x4`, …) and the dual numbers of `num-dual`.
#[diagnostic::on_unimplemented(
    message = "equations of motion are not evaluated on `{Self}`",
    label = "not a real number such as `f64`",
    note = "write whole numbers with a point: `1.0` for `1`; numbers of one's own implement `Scalar`"
)]
pub trait Scalar:
    Copy
    + PartialEq
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Returns the constant `x`, equal in every lane and with derivative zero.
    fn constant(x: f64) -> Self;
    /// Sine and cosine together.
    fn sin_cos(self) -> (Self, Self);
    /// Sines and cosines of several [small angles](Self::small_angles) together; for `f64` they are computed on
    /// SIMD lanes. For larger angles the results are unspecified.
    #[inline(always)]
    fn sin_cos_of_small<const K: usize>(angles: [Self; K]) -> ([Self; K], [Self; K]) {
        one_by_one(angles)
    }
    /// Returns angles with the same sines and cosines, reduced by full turns if they are large: for `f64` from
    /// 10⁵ on. The reduction is exact to 4·10⁻¹⁶, less than a ten-thousandth of the distance between
    /// neighbouring numbers of that size.
    #[inline(always)]
    fn small_angles<const K: usize>(angles: [Self; K]) -> [Self; K] {
        angles
    }
    /// Sine.
    #[inline(always)]
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    /// Cosine.
    #[inline(always)]
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    /// Tangent.
    fn tan(self) -> Self;
    /// Arcsine.
    fn asin(self) -> Self;
    /// Arccosine.
    fn acos(self) -> Self;
    /// Arctangent.
    fn atan(self) -> Self;
    /// Angle of the point `(x, self)`, in (−π, π].
    fn atan2(self, x: Self) -> Self;
    /// Hyperbolic sine.
    fn sinh(self) -> Self;
    /// Hyperbolic cosine.
    fn cosh(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Exponential.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// Raises `self` to the power `exponent`.
    fn powf(self, exponent: Self) -> Self;
    /// The smaller of the two, lane by lane. If one is NaN, the result depends on the type.
    fn min(self, other: Self) -> Self;
    /// The larger of the two; for NaN see [`min`](Self::min).
    fn max(self, other: Self) -> Self;
    /// Returns `less`, `equal` or `greater` according to the order of `self` and `other`, and NaN if one of
    /// them is NaN, lane by lane. Numbers with derivatives compare by value.
    #[must_use]
    fn select_by_order(self, other: Self, less: Self, equal: Self, greater: Self) -> Self;
    /// The larger of `self` and 0, NaN for NaN. The derive expresses `max` and `min` by `ramp`.
    #[inline(always)]
    #[must_use]
    fn ramp(self) -> Self {
        let [zero, half] = [0.0, 0.5].map(Self::constant);
        // At the kink the derivative is half the slope.
        self.select_by_order(zero, zero, self * half, self)
    }
    /// Unit step: 0 below zero, ½ at zero, 1 above, NaN for NaN. The derivative of [`ramp`](Self::ramp).
    #[inline(always)]
    #[must_use]
    fn step(self) -> Self {
        let [zero, half, one] = [0.0, 0.5, 1.0].map(Self::constant);
        self.select_by_order(zero, zero, half, one)
    }
    /// Returns `self` · `y`, and zero if `self` is zero, even if `y` is infinite or NaN.
    #[inline(always)]
    #[must_use]
    fn zero_or_product(self, y: Self) -> Self {
        let (zero, product) = (Self::constant(0.0), self * y);
        self.select_by_order(zero, product, zero, product)
    }
    /// Returns `value`, but zero where `self` is zero and NaN where `self` is NaN. It needs a single
    /// comparison, for functions with hundreds of calls.
    #[doc(hidden)]
    #[inline(always)]
    #[must_use]
    fn only_where_not_zero(self, value: Self) -> Self {
        self.select_by_order(Self::constant(0.0), value, self, value)
    }
    /// Returns `self` · `y` + `z`, rounded once if the target has a fused instruction (always on aarch64, on
    /// x86 with the target feature `fma`), else twice.
    #[inline(always)]
    fn multiply_add(self, y: Self, z: Self) -> Self {
        self * y + z
    }
    /// Returns `z` − `self` · `y`, rounded like [`multiply_add`](Self::multiply_add).
    #[inline(always)]
    fn subtract_product(self, y: Self, z: Self) -> Self {
        z - self * y
    }
}

#[inline]
pub(super) fn one_by_one<S: Scalar, const K: usize>(angles: [S; K]) -> ([S; K], [S; K]) {
    // No `map` here: for lanes the compiler would not inline it.
    let (mut sines, mut cosines) = (angles, angles);
    for ((sine, cosine), angle) in sines.iter_mut().zip(&mut cosines).zip(angles) {
        (*sine, *cosine) = angle.sin_cos();
    }
    (sines, cosines)
}

/// True if the target has a fused multiply-add instruction. Without one, a fused operation would be a slow
/// library call.
pub(crate) const FUSED: bool = cfg!(any(target_feature = "fma", target_arch = "aarch64"));
