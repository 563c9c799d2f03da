//! SIMD vectors of eight `f64`, for the registers of AVX-512.

use core::array::from_fn;
use core::ops::{Add, Div, Mul, Neg, Sub};

use wide::f64x8;

use super::simd::SimdVector;
use crate::number::Scalar;

/// A vector of eight `f64`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Eight(f64x8);

impl SimdVector for Eight {
    #[inline(always)]
    fn select(self, chosen: Self, other: Self) -> Self {
        Self(chosen.0.simd_gt(f64x8::splat(0.0)).select(self.0, other.0))
    }
}

impl From<[f64; 8]> for Eight {
    #[inline(always)]
    fn from(all: [f64; 8]) -> Self {
        Self(all.into())
    }
}

impl From<Eight> for [f64; 8] {
    #[inline(always)]
    fn from(all: Eight) -> Self {
        all.0.to_array()
    }
}

macro_rules! operators {
    ($($operator:ident $method:ident),*) => {
        $(impl $operator for Eight {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        })*
    };
}

operators!(Add add, Sub sub, Mul mul, Div div);

impl Neg for Eight {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

macro_rules! one_by_one {
    ($($name:ident($($argument:ident),*)),* $(,)?) => {
        $(fn $name(self $(, $argument: Self)*) -> Self {
            let (x, $($argument,)*) = (self.0.to_array(), $($argument.0.to_array(),)*);
            Self::from(from_fn(|lane| Scalar::$name(x[lane] $(, $argument[lane])*)))
        })*
    };
}

/// Same definitions as `simba` has for vectors of four.
#[diagnostic::do_not_recommend]
impl Scalar for Eight {
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self(f64x8::splat(x))
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.0.sin_cos();
        (Self(sin), Self(cos))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.simd_lt(other.0).select(self.0, other.0))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.simd_gt(other.0).select(self.0, other.0))
    }

    #[inline(always)]
    fn select_by_order(self, other: Self, less: Self, equal: Self, greater: Self) -> Self {
        let ordered = self.0.simd_eq(other.0).select(equal.0, greater.0);
        let ordered = self.0.simd_lt(other.0).select(less.0, ordered);
        let are_numbers = self.0.simd_eq(self.0) & other.0.simd_eq(other.0);
        Self(are_numbers.select(ordered, f64x8::splat(f64::NAN)))
    }

    #[inline(always)]
    fn only_where_not_zero(self, value: Self) -> Self {
        let zero = f64x8::splat(0.0);
        Self((self.0.simd_lt(zero) | self.0.simd_gt(zero)).select(value.0, self.0))
    }

    #[inline(always)]
    fn multiply_add(self, y: Self, z: Self) -> Self {
        Self(self.0.mul_add(y.0, z.0))
    }

    #[inline(always)]
    fn subtract_product(self, y: Self, z: Self) -> Self {
        Self(self.0.mul_neg_add(y.0, z.0))
    }

    one_by_one! {
        tan(), asin(), acos(), atan(), atan2(x), sinh(), cosh(), tanh(), exp(), ln(), powf(exponent),
    }
}
