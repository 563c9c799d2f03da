//! SIMD lanes as scalars.

#[cfg(target_feature = "avx512f")]
mod eight;
mod quad;
mod simd;
pub(super) mod sines;

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::broadcast::{Broadcast, Wide};
use super::parts::Parts;
use super::scalar::Scalar;
use crate::system::Packed;
#[cfg(target_feature = "avx512f")]
use eight::Eight as Widest;
use quad::Quad;
#[cfg(not(target_feature = "avx512f"))]
use quad::Quad as Widest;
use simd::SimdVector;

/// Largest angle for vector sines. Beyond, the reduction by π/2 in three parts loses digits.
const LARGEST_ANGLE: f64 = 1e8;

// Arithmetic is `#[inline]`, not `#[inline(always)]`: LLVM then simplifies each function once before it inlines
// it. A function that is always inlined arrives with all its locals in memory. The SROA pass, which splits
// these locals, takes time that grows with their square: 60 of 115 s for the Jacobians of a robot of 40
// coordinates.
macro_rules! lanes {
    ($(#[$attribute:meta])* $lanes:ident of $vector:ty) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $lanes($vector);

        impl $lanes {
            /// Number of lanes.
            pub const COUNT: usize = <$vector>::COUNT;

            /// Returns the numbers of all lanes.
            #[inline(always)]
            pub fn to_array(self) -> [f64; Self::COUNT] {
                self.0.into()
            }
        }

        impl From<[f64; $lanes::COUNT]> for $lanes {
            #[inline(always)]
            fn from(all: [f64; $lanes::COUNT]) -> Self {
                Self(all.into())
            }
        }

        operators!($lanes: Add add, Sub sub, Mul mul, Div div);

        impl Neg for $lanes {
            type Output = Self;

            #[inline]
            fn neg(self) -> Self {
                Self(-self.0)
            }
        }

        impl Broadcast<f64> for $lanes {
            #[inline(always)]
            fn of(x: f64) -> Self {
                Self::constant(x)
            }
        }

        #[diagnostic::do_not_recommend]
        impl Scalar for $lanes {
            #[inline(always)]
            fn constant(x: f64) -> Self {
                Self(<$vector>::constant(x))
            }

            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                let (sin, cos) = Scalar::sin_cos(self.0);
                self.where_exact((Self(sin), Self(cos)))
            }

            #[inline]
            fn only_where_not_zero(self, value: Self) -> Self {
                Self(self.0.only_where_not_zero(value.0))
            }

            lane_by_lane! {
                tan(), asin(), acos(), atan(), atan2(x), sinh(), cosh(), tanh(), exp(), ln(), sqrt(), abs(),
                powf(exponent), min(other), max(other), select_by_order(other, less, equal, greater),
                multiply_add(y, z), subtract_product(y, z),
            }
        }
    };
}

macro_rules! operators {
    ($lanes:ident: $($operator:ident $method:ident),*) => {
        $(impl $operator for $lanes {
            type Output = Self;

            #[inline]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        })*
    };
}

macro_rules! lane_by_lane {
    ($($name:ident($($argument:ident),*)),* $(,)?) => {
        $(#[inline]
        fn $name(self $(, $argument: Self)*) -> Self {
            Self(Scalar::$name(self.0 $(, $argument.0)*))
        })*
    };
}

lanes! {
    /// `f64` on four SIMD lanes or, with AVX-512, eight: evaluates the equations of one system per lane at
    /// once.
    ///
    /// No lane depends on another: the result in a lane is bit for bit the same whatever the other lanes hold.
    /// Sines and cosines are within 3·10⁻¹⁶ of those of the standard library, and NaN for angles of 10⁸ and
    /// more. The vector functions lose digits there, and an [`Ensemble`](crate::Ensemble) repeats the step of
    /// that member in scalar arithmetic.
    ///
    /// The vectors come from the crate `wide`, which uses AVX2 and FMA, or AVX-512, if the compiler may assume
    /// them: `RUSTFLAGS="-C target-cpu=native"` or `"-C target-feature=+avx2,+fma"`.
    Lanes of Widest
}

lanes! {
    /// [`Lanes`] with four lanes on every CPU, for directional derivatives of one system, which are seldom
    /// many.
    FourLanes of Quad
}

impl Lanes {
    /// Returns `self` in lanes where `chosen` is positive, `other` elsewhere.
    #[inline(always)]
    pub(crate) fn select(self, chosen: Self, other: Self) -> Self {
        Self(self.0.select(chosen.0, other.0))
    }

    /// Sines and cosines from the vector functions; NaN for larger angles.
    #[inline(always)]
    fn where_exact(self, (sin, cos): (Self, Self)) -> (Self, Self) {
        let (left, nan) = (Self::constant(LARGEST_ANGLE) - self.abs(), Self::constant(f64::NAN));
        (sin.select(left, nan), cos.select(left, nan))
    }
}

impl FourLanes {
    /// Sines and cosines from the vector functions; for larger angles, which no caller computes again, from those of `f64`.
    #[inline(always)]
    fn where_exact(self, both: (Self, Self)) -> (Self, Self) {
        let is_large = self.to_array().into_iter().fold(false, |any, x| any | (x.abs() >= LARGEST_ANGLE));
        if is_large { self.lane_by_lane(both) } else { both }
    }

    #[cold]
    #[inline(never)]
    fn lane_by_lane(self, (mut sin, mut cos): (Self, Self)) -> (Self, Self) {
        for (lane, angle) in self.to_array().into_iter().enumerate() {
            if angle.abs() >= LARGEST_ANGLE {
                let exact = Scalar::sin_cos(angle);
                sin.put(lane, exact.0);
                cos.put(lane, exact.1);
            }
        }
        (sin, cos)
    }
}

impl Wide<f64> for FourLanes {
    const COUNT: usize = Self::COUNT;

    #[inline(always)]
    fn from_lanes(mut of: impl FnMut(usize) -> f64) -> Self {
        [of(0), of(1), of(2), of(3)].into()
    }

    #[inline(always)]
    fn put(&mut self, lane: usize, x: f64) {
        let mut all = self.to_array();
        all[lane] = x;
        *self = all.into();
    }

    #[inline(always)]
    fn lane(&self, lane: usize) -> f64 {
        self.to_array()[lane]
    }
}

impl Parts for FourLanes {
    const EPSILON: f64 = f64::EPSILON;
    const HAS_SLOPES: bool = false;

    #[inline]
    fn magnitude(self) -> Self {
        self.abs()
    }

    #[inline]
    fn least(self, other: Self) -> Self {
        self.min(other)
    }

    #[inline]
    fn is_within(self, factor: f64, bound: Self) -> bool {
        let pairs = self.to_array().into_iter().zip(bound.to_array());
        pairs.fold(true, |all, (x, bound)| all & x.is_within(factor, bound))
    }

    #[inline]
    fn is_at_most(self, bound: f64) -> bool {
        self.to_array().iter().all(|x| *x <= bound)
    }

    #[inline]
    fn is_finite(self) -> bool {
        self.to_array().iter().all(|x| x.is_finite())
    }

    #[inline]
    fn has_settled(self, before: Self, terms: Self) -> bool {
        let (x, before, terms) = (self.to_array(), before.to_array(), terms.to_array());
        (0..Self::COUNT).all(|k| x[k].has_settled(before[k], terms[k]))
    }
}

macro_rules! on_lanes {
    ($($lanes:ty),*) => {$(
        impl Packed<f64> for $lanes {
            #[inline(always)]
            fn splat(x: &f64) -> Self {
                Self::constant(*x)
            }

            #[inline(always)]
            fn place(&mut self, lane: usize, x: &f64) {
                let mut all = self.to_array();
                all[lane] = *x;
                *self = all.into();
            }
        }
    )*};
}

on_lanes!(Lanes, FourLanes);

#[cfg(test)]
mod tests;
