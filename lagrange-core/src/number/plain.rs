//! `f64` and `f32` as scalars with an order, and as vectors of one lane.

use super::broadcast::Wide;
use super::real::Real;
use crate::system::Packed;

impl Real for f64 {
    const EPSILON: Self = Self::EPSILON;
    const SMALLEST: Self = Self::MIN_POSITIVE;

    #[cfg(feature = "std")]
    type Wide = super::lanes::FourLanes;
    #[cfg(not(feature = "std"))]
    type Wide = Self;

    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }
}

impl Real for f32 {
    const EPSILON: f64 = Self::EPSILON as f64;
    const SMALLEST: f64 = Self::MIN_POSITIVE as f64;

    type Wide = Self;

    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
}

/// Numbers that are a vector of one lane.
macro_rules! one_lane {
    ($scalar:ty) => {
        impl Wide<$scalar> for $scalar {
            const COUNT: usize = 1;

            #[inline(always)]
            fn from_lanes(mut of: impl FnMut(usize) -> $scalar) -> Self {
                of(0)
            }

            #[inline(always)]
            fn put(&mut self, _: usize, x: $scalar) {
                *self = x;
            }

            #[inline(always)]
            fn lane(&self, _: usize) -> $scalar {
                *self
            }
        }

        impl Packed<$scalar> for $scalar {
            #[inline(always)]
            fn splat(x: &$scalar) -> Self {
                *x
            }

            #[inline(always)]
            fn place(&mut self, _: usize, x: &$scalar) {
                *self = *x;
            }
        }
    };
}

one_lane!(f32);
#[cfg(not(feature = "std"))]
one_lane!(f64);
