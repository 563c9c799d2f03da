//! Four numbers that are computed with at once.

use core::ops::{Add, Div, Mul, Neg, Sub};

use simba::simd::{SimdComplexField, SimdPartialOrd, SimdValue, WideF64x4};

use super::scalar::Scalar;

/// Four `f64` side by side, on which the equations of four systems are evaluated at once.
///
/// No lane depends on another: what comes out of a lane is bit for bit what comes out with anything else beside it.
/// Sines and cosines are within 3·10⁻¹⁶ of those of the standard library, and NaN for angles of 10⁸ and more: there the
/// vectors of four lose digits, and an [`Ensemble`](crate::Ensemble) takes the step of that member alone.
///
/// The vectors are those of the crate `wide`, which uses AVX2 and FMA where the compiler is told that they exist:
/// `RUSTFLAGS="-C target-cpu=native"` or `"-C target-feature=+avx2,+fma"`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes(WideF64x4);

/// Beyond, the reduction of an angle to the first octant loses digits, which it does in three parts of π/2.
const LARGEST_ANGLE: f64 = 1e8;

impl Lanes {
    /// How many there are.
    pub const COUNT: usize = 4;

    /// The numbers in all lanes.
    #[inline(always)]
    pub fn to_array(self) -> [f64; Self::COUNT] {
        self.0.into()
    }

    /// `self` where `chosen` is positive, `other` elsewhere.
    #[inline(always)]
    pub(crate) fn select(self, chosen: Self, other: Self) -> Self {
        Self(self.0.select(chosen.0.simd_gt(WideF64x4::splat(0.0)), other.0))
    }
}

impl From<[f64; Self::COUNT]> for Lanes {
    #[inline(always)]
    fn from(all: [f64; Self::COUNT]) -> Self {
        Self(all.into())
    }
}

macro_rules! operators {
    ($($operator:ident $method:ident),*) => {
        $(impl $operator for Lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        })*
    };
}

operators!(Add add, Sub sub, Mul mul, Div div);

impl Neg for Lanes {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

macro_rules! lane_by_lane {
    ($($name:ident($($argument:ident),*)),* $(,)?) => {
        $(#[inline(always)]
        fn $name(self $(, $argument: Self)*) -> Self {
            Self(Scalar::$name(self.0 $(, $argument.0)*))
        })*
    };
}

impl Scalar for Lanes {
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self(WideF64x4::splat(x))
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.0.simd_sin_cos();
        let is_accurate = SimdComplexField::simd_abs(self.0).simd_lt(WideF64x4::splat(LARGEST_ANGLE));
        let nan = WideF64x4::splat(f64::NAN);
        (Self(sin.select(is_accurate, nan)), Self(cos.select(is_accurate, nan)))
    }

    lane_by_lane! {
        tan(), asin(), acos(), atan(), atan2(x), sinh(), cosh(), tanh(), exp(), ln(), sqrt(), abs(),
        powf(exponent), min(other), max(other), by_order(other, less, equal, greater),
        multiply_add(y, z), subtract_product(y, z),
    }
}

#[cfg(test)]
mod tests;
