//! Four numbers in one SIMD register.

use core::array::from_fn;
#[cfg(feature = "std")]
use core::hint::black_box;
use core::ops::Add;

#[cfg(feature = "std")]
use super::quad::Quad;
use super::scalar::Scalar;
#[cfg(feature = "std")]
use super::scalar::same;

/// Four numbers that are computed with at once, `f64` as one vector from first to last: of numbers one by one the compiler
/// would make vectors of its own, across such fours, to suit how the results are used.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Four<T> {
    /// If they are of another type; else zeros, which nothing is computed with in the end.
    apart: [T; 4],
    /// If they are `f64`; else zeros.
    #[cfg(feature = "std")]
    together: Quad,
}

impl<T: Scalar> Four<T> {
    #[inline(always)]
    pub(crate) fn zero() -> Self {
        Self {
            apart: [T::constant(0.0); 4],
            #[cfg(feature = "std")]
            together: Quad::constant(0.0),
        }
    }

    #[inline(always)]
    pub(crate) fn to_array(self) -> [T; 4] {
        #[cfg(feature = "std")]
        if let Some(numbers) = same(hidden(self.together)) {
            return numbers;
        }
        self.apart
    }

    /// `self` · `y` + `z`, rounded as [`Scalar::multiply_add`] is.
    #[inline(always)]
    pub(crate) fn multiply_add(self, y: Self, z: Self) -> Self {
        Self {
            apart: from_fn(|lane| self.apart[lane].multiply_add(y.apart[lane], z.apart[lane])),
            #[cfg(feature = "std")]
            together: Scalar::multiply_add(self.together, y.together, z.together),
        }
    }
}

/// Not looked through: else the numbers, not the vector, are what comes out of branches and loops. By halves: what reads a pair
/// from across the middle of a vector waits until that is in the cache.
#[cfg(feature = "std")]
#[inline(always)]
fn hidden(vector: Quad) -> [f64; 4] {
    let [a, b, c, d] = vector.into();
    let ([a, b], [c, d]) = (black_box([a, b]), black_box([c, d]));
    [a, b, c, d]
}

impl<T: Scalar> From<[T; 4]> for Four<T> {
    #[inline(always)]
    fn from(numbers: [T; 4]) -> Self {
        #[cfg(feature = "std")]
        if let Some(numbers) = same::<_, [f64; 4]>(numbers) {
            return Self { together: numbers.into(), ..Self::zero() };
        }
        let mut four = Self::zero();
        four.apart = numbers;
        four
    }
}

impl<T: Scalar> Add for Four<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            apart: from_fn(|lane| self.apart[lane] + other.apart[lane]),
            #[cfg(feature = "std")]
            together: self.together + other.together,
        }
    }
}
