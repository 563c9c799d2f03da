//! Comparisons that know what they do with NaN, and the round-off unit.

use core::cmp::Ordering;

use super::real::Real;
use super::scalar::Scalar;

/// [`Scalar::sin_cos_of_small`] as a function of its own, for where there would be much of its code in line.
#[inline(never)]
pub fn sin_cos_of_small<S: Scalar, const K: usize>(angles: [S; K]) -> ([S; K], [S; K]) {
    S::sin_cos_of_small(angles)
}

/// The larger of the two; where one is NaN, `a`.
pub(crate) fn larger<T: PartialOrd>(a: T, b: T) -> T {
    if b > a { b } else { a }
}

/// The smaller of the two; where one is NaN, `a`.
pub(crate) fn smaller<T: PartialOrd>(a: T, b: T) -> T {
    if b < a { b } else { a }
}

/// The largest magnitude among these; a NaN is passed over.
///
/// Never inlined: rustc did not end where LLVM 22 unrolled this along the rows of a matrix of 32 columns (or 40, with
/// `target-cpu=native`). The maximum of a row is then a chain of 32 selections, each of which needs the one before it twice,
/// in a loop of 32 rounds; and in a loop of a multiple of 8 rounds LLVM looks for cyclic redundancy checks (`HashRecognize`)
/// by following every path through that chain, of which there are 2³².
#[inline(never)]
pub(crate) fn largest<T: Real>(x: &[T]) -> T {
    x.iter().fold(T::constant(0.0), |most, x| larger(most, Scalar::abs(*x)))
}

/// Whether `x` is above `bound`, or one of them NaN: what is not known to be small counts as large.
pub(crate) fn exceeds<T: Real>(x: T, bound: T) -> bool {
    !matches!(x.partial_cmp(&bound), Some(Ordering::Less | Ordering::Equal))
}

/// Whether `x` is known to be at most `bound`: not where one of them is NaN, nor where the bound is infinite.
pub(crate) fn is_within<T: Real>(x: T, bound: T) -> bool {
    x <= bound && bound.is_finite()
}

/// What of `x` is more than round-off of terms of this size; infinite where the size is.
pub(crate) fn beyond_round_off<T: Real>(x: T, terms: T) -> T {
    let round_off = T::constant(4.0 * T::EPSILON) * terms;
    if round_off.is_finite() { Scalar::abs(x) - round_off } else { round_off }
}

/// ε to this power, ε the distance from 1 to the next larger number.
pub(crate) fn power_of_epsilon<T: Real>(exponent: f64) -> T {
    Scalar::powf(T::constant(T::EPSILON), T::constant(exponent))
}

/// `value`, or zero where `activity` is zero, lane by lane.
#[inline]
pub fn only_where<T: Scalar>(activity: T, value: T) -> T {
    activity.only_where_not_zero(value)
}

/// A power of two not far below `x` ≥ 0, by which to divide before numbers of its size are multiplied; 1 for zero.
pub(crate) fn power_of_two<T: Real>(x: T) -> T {
    if x == T::constant(0.0) {
        return T::constant(1.0);
    }
    let without_fraction = f64::from_bits(x.to_f64().to_bits() & f64::INFINITY.to_bits());
    T::constant(without_fraction.max(f64::MIN_POSITIVE))
}

/// The sum of so many terms, in four parts side by side: one after the other, each waits for the one before.
#[inline(always)]
pub(crate) fn sum<T: Scalar>(count: usize, term: impl Fn(usize) -> T) -> T {
    let mut parts = [T::constant(0.0); 4];
    for first in (0..count / 4).map(|block| 4 * block) {
        for (k, part) in parts.iter_mut().enumerate() {
            *part = *part + term(first + k);
        }
    }
    let [a, b, c, d] = parts;
    (count / 4 * 4..count).fold((a + b) + (c + d), |sum, i| sum + term(i))
}

/// √Σx², which neither overflows nor vanishes unless the numbers do.
pub(crate) fn norm<T: Real>(x: &[T]) -> T {
    let unit = power_of_two(largest(x));
    let square = |x: T| (x / unit) * (x / unit);
    Scalar::sqrt(x.iter().fold(T::constant(0.0), |sum, x| sum + square(*x))) * unit
}
