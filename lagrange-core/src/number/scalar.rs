//! The numbers that emitted code computes with.

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A number that equations of motion can be evaluated on: `f64`, `f32`, a SIMD lane type, a dual number.
///
/// Emitted code reaches all mathematics through this trait. It is implemented for every type with
/// [`simba`'s `SimdRealField`](simba::simd::SimdRealField): the floating-point types, the lane types of `simba`
/// (`WideF64x4`, …) and the dual numbers of `num-dual`.
#[diagnostic::on_unimplemented(
    message = "equations of motion are not evaluated on `{Self}`",
    label = "not a real number such as `f64`",
    note = "write whole numbers with a point: `1.0` for `1`; numbers of one's own implement `Scalar`"
)]
pub trait Scalar:
    Copy
    + PartialEq
    + Debug
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The constant `x`, the same in every lane and with derivative zero.
    fn constant(x: f64) -> Self;
    /// Sine and cosine at once.
    fn sin_cos(self) -> (Self, Self);
    /// Sines and cosines of several angles at once, of [small ones](Self::small_angles): those of `f64` are computed side by
    /// side. Of larger angles they may be anything.
    #[inline(always)]
    fn sin_cos_of_small<const K: usize>(angles: [Self; K]) -> ([Self; K], [Self; K]) {
        one_by_one(angles)
    }
    /// Angles with the same sines and cosines, less full turns where they are large: `f64` from 10⁵ on, to 4·10⁻¹⁶, which is
    /// less than a ten-thousandth of the distance from one such number to the next.
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
    /// The angle of the point `(x, self)`, in (−π, π].
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
    /// `self` to the power `exponent`.
    fn powf(self, exponent: Self) -> Self;
    /// The smaller of the two, lane by lane; where one is not a number, what the type makes of it.
    fn min(self, other: Self) -> Self;
    /// The larger of the two, as [`min`](Self::min).
    fn max(self, other: Self) -> Self;
    /// `less`, `equal` or `greater` as `self` is to `other`, and NaN where one of them is, lane by lane. Of numbers with
    /// derivatives the values are compared.
    #[must_use]
    fn select_by_order(self, other: Self, less: Self, equal: Self, greater: Self) -> Self;
    /// The larger of `self` and 0, and NaN where `self` is: what `max` and `min` are made of.
    #[inline(always)]
    #[must_use]
    fn ramp(self) -> Self {
        let [zero, half] = [0.0, 0.5].map(Self::constant);
        // With derivatives: half of the slope where it changes.
        self.select_by_order(zero, zero, self * half, self)
    }
    /// 0 below zero, 1 above it, ½ there, and NaN where `self` is: the slope of [`ramp`](Self::ramp).
    #[inline(always)]
    #[must_use]
    fn step(self) -> Self {
        let [zero, half, one] = [0.0, 0.5, 1.0].map(Self::constant);
        self.select_by_order(zero, zero, half, one)
    }
    /// `self` · `y`, and zero where `self` is zero, be `y` infinite or not a number.
    #[inline(always)]
    #[must_use]
    fn zero_or_product(self, y: Self) -> Self {
        let (zero, product) = (Self::constant(0.0), self * y);
        self.select_by_order(zero, product, zero, product)
    }
    /// `value`, zero where `self` is zero and NaN where it is: of one comparison with zero, for functions that have hundreds.
    #[doc(hidden)]
    #[inline(always)]
    #[must_use]
    fn only_where_not_zero(self, value: Self) -> Self {
        self.select_by_order(Self::constant(0.0), value, self, value)
    }
    /// `self` · `y` + `z`: rounded once where the target has an instruction for it (always on aarch64, on x86 with the
    /// target feature `fma`), else twice.
    #[inline(always)]
    fn multiply_add(self, y: Self, z: Self) -> Self {
        self * y + z
    }
    /// `z` − `self` · `y`, rounded like [`multiply_add`](Self::multiply_add).
    #[inline(always)]
    fn subtract_product(self, y: Self, z: Self) -> Self {
        z - self * y
    }
}

#[inline]
pub(super) fn one_by_one<S: Scalar, const K: usize>(angles: [S; K]) -> ([S; K], [S; K]) {
    // Not by `map`, which the compiler leaves a function of its own for lanes.
    let (mut sines, mut cosines) = (angles, angles);
    for ((sine, cosine), angle) in sines.iter_mut().zip(&mut cosines).zip(angles) {
        (*sine, *cosine) = angle.sin_cos();
    }
    (sines, cosines)
}

/// Whether the target has an instruction that rounds a product and a sum once; without, that would be a slow function.
pub(crate) const FUSED: bool = cfg!(any(target_feature = "fma", target_arch = "aarch64"));
