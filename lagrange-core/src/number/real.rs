//! [`Scalar`] for types with the traits of `simba`, and scalars with an order.

use core::any::Any;
use core::fmt::{Debug, Display};
use simba::scalar::{RealField, SupersetOf};
use simba::simd::SimdRealField;

use super::broadcast::Wide;
use super::parts::Parts;
use super::scalar::{FUSED, Scalar, one_by_one};

/// Returns the value as type `Y` if the types are the same. The compiler resolves the test.
#[inline(always)]
fn same<X: Copy + 'static, Y: Copy + 'static>(x: X) -> Option<Y> {
    (&x as &dyn Any).downcast_ref().copied()
}

macro_rules! through_simba {
    ($($name:ident => $simd:ident($($argument:ident),*)),* $(,)?) => {
        $(#[inline(always)]
        fn $name(self $(, $argument: Self)*) -> Self {
            self.$simd($($argument),*)
        })*
    };
}

#[diagnostic::do_not_recommend]
impl<T: SimdRealField + SupersetOf<f64> + Copy + Debug + 'static> Scalar for T {
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self::from_subset(&x)
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        self.simd_sin_cos()
    }

    #[inline(always)]
    fn sin_cos_of_small<const K: usize>(angles: [Self; K]) -> ([Self; K], [Self; K]) {
        #[cfg(feature = "std")]
        if let Some(found) = same::<_, [f64; K]>(angles).map(super::lanes::sines::sin_cos).and_then(same) {
            return found;
        }
        one_by_one(angles)
    }

    #[inline(always)]
    fn small_angles<const K: usize>(angles: [Self; K]) -> [Self; K] {
        #[cfg(feature = "std")]
        if let Some(small) = same::<_, [f64; K]>(angles).map(super::lanes::sines::small).and_then(same) {
            return small;
        }
        angles
    }

    // Compiles to one instruction. From many calls of `f64::min` the compiler would build a vector operation,
    // which waits for all arguments.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.select(self.simd_lt(other), other)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.select(self.simd_gt(other), other)
    }

    #[inline(always)]
    fn select_by_order(self, other: Self, less: Self, equal: Self, greater: Self) -> Self {
        let ordered = equal.select(self.simd_eq(other), greater);
        let ordered = less.select(self.simd_lt(other), ordered);
        ordered.select(self.simd_eq(self) & other.simd_eq(other), Self::constant(f64::NAN))
    }

    #[inline(always)]
    fn only_where_not_zero(self, value: Self) -> Self {
        let zero = Self::constant(0.0);
        // NaN is neither below nor above zero.
        value.select(self.simd_lt(zero) | self.simd_gt(zero), self)
    }

    #[inline(always)]
    fn multiply_add(self, y: Self, z: Self) -> Self {
        if FUSED { self.simd_mul_add(y, z) } else { self * y + z }
    }

    #[inline(always)]
    fn subtract_product(self, y: Self, z: Self) -> Self {
        if FUSED { (-self).simd_mul_add(y, z) } else { z - self * y }
    }

    through_simba! {
        sin => simd_sin(), cos => simd_cos(), tan => simd_tan(),
        asin => simd_asin(), acos => simd_acos(), atan => simd_atan(), atan2 => simd_atan2(x),
        sinh => simd_sinh(), cosh => simd_cosh(), tanh => simd_tanh(),
        exp => simd_exp(), ln => simd_ln(), sqrt => simd_sqrt(), abs => simd_abs(),
        powf => simd_powf(exponent),
    }
}

/// A scalar with an order, `f64` or `f32`. Choosing pivots, steps or endings requires one.
pub trait Real: Scalar + RealField + PartialOrd + Display {
    /// Distance from 1 to the next larger number.
    const EPSILON: f64;

    /// Smallest positive normal number.
    const SMALLEST: f64;

    /// Preferred SIMD vector of this scalar.
    type Wide: Wide<Self> + Parts;

    /// Converts the number to `f64`.
    fn to_f64(self) -> f64;
}
