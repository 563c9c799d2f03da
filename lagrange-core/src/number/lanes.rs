//! Numbers that are computed with at once.

use core::ops::{Add, Div, Mul, Neg, Sub};

#[cfg(target_feature = "avx512f")]
use super::eight::Eight;
use super::quad::Quad;
use super::scalar::Scalar;

/// `f64` side by side in the lanes of a vector, on which the equations of as many systems are evaluated at once.
///
/// No lane depends on another: what comes out of a lane is bit for bit what comes out with anything else beside it.
/// Sines and cosines are within 3·10⁻¹⁶ of those of the standard library, and NaN for angles of 10⁸ and more: there
/// vectors lose digits, and an [`Ensemble`](crate::Ensemble) takes the step of that member alone.
///
/// The vectors are those of the crate `wide`, which uses AVX2 and FMA, or AVX-512, where the compiler is told that they
/// exist: `RUSTFLAGS="-C target-cpu=native"` or `"-C target-feature=+avx2,+fma"`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LanesOf<V>(V);

/// As many lanes as are best for systems: four, or eight with AVX-512.
#[cfg(not(target_feature = "avx512f"))]
pub type Lanes = LanesOf<Quad>;
/// As many lanes as are best for systems: four, or eight with AVX-512.
#[cfg(target_feature = "avx512f")]
pub type Lanes = LanesOf<Eight>;

/// As many lanes as are best for directions of one system, which seldom has many.
pub type FourLanes = LanesOf<Quad>;

/// A vector of `f64`.
pub trait Vector: Scalar {
    /// `self` where `chosen` is positive, `other` elsewhere.
    #[must_use]
    fn select(self, chosen: Self, other: Self) -> Self;
}

/// Beyond, the reduction of an angle to the first octant loses digits, which it does in three parts of π/2.
const LARGEST_ANGLE: f64 = 1e8;

macro_rules! lanes {
    ($vector:ty, $count:literal) => {
        impl LanesOf<$vector> {
            /// How many there are.
            pub const COUNT: usize = $count;

            /// The numbers in all lanes.
            #[inline(always)]
            pub fn to_array(self) -> [f64; $count] {
                self.0.into()
            }
        }

        impl From<[f64; $count]> for LanesOf<$vector> {
            #[inline(always)]
            fn from(all: [f64; $count]) -> Self {
                Self(all.into())
            }
        }
    };
}

lanes!(Quad, 4);
#[cfg(target_feature = "avx512f")]
lanes!(Eight, 8);

impl<V: Vector> LanesOf<V> {
    /// `self` where `chosen` is positive, `other` elsewhere.
    #[inline(always)]
    pub(crate) fn select(self, chosen: Self, other: Self) -> Self {
        Self(self.0.select(chosen.0, other.0))
    }
}

macro_rules! operators {
    ($($operator:ident $method:ident),*) => {
        $(impl<V: $operator<Output = V>> $operator for LanesOf<V> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        })*
    };
}

operators!(Add add, Sub sub, Mul mul, Div div);

impl<V: Neg<Output = V>> Neg for LanesOf<V> {
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

impl<V: Vector> Scalar for LanesOf<V> {
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self(V::constant(x))
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.0.sin_cos();
        let (left, nan) = (Self::constant(LARGEST_ANGLE) - self.abs(), Self::constant(f64::NAN));
        (Self(sin).select(left, nan), Self(cos).select(left, nan))
    }

    lane_by_lane! {
        tan(), asin(), acos(), atan(), atan2(x), sinh(), cosh(), tanh(), exp(), ln(), sqrt(), abs(),
        powf(exponent), min(other), max(other), by_order(other, less, equal, greater),
        multiply_add(y, z), subtract_product(y, z),
    }
}

#[cfg(test)]
mod tests;
