//! Comparisons with defined behaviour for NaN, and the machine epsilon.

use core::cmp::Ordering;

use super::limits::SUM;
use super::parts::Parts;
use super::real::Real;
use super::scalar::Scalar;

/// [`Scalar::sin_cos_of_small`] as a function that is never inlined, for callers where its inlined code would
/// be long.
#[inline(never)]
pub fn sin_cos_of_small<S: Scalar, const K: usize>(angles: [S; K]) -> ([S; K], [S; K]) {
    S::sin_cos_of_small(angles)
}

/// Returns the larger of the two; `a` if one is NaN.
pub(crate) fn larger<T: PartialOrd>(a: T, b: T) -> T {
    if b > a { b } else { a }
}

/// Returns the smaller of the two; `a` if one is NaN.
pub(crate) fn smaller<T: PartialOrd>(a: T, b: T) -> T {
    if b < a { b } else { a }
}

/// Returns the order of two numbers; they count as equal if one is NaN.
pub(crate) fn order<T: PartialOrd>(x: T, y: T) -> Ordering {
    x.partial_cmp(&y).unwrap_or(Ordering::Equal)
}

/// Returns `size` if it is positive, else 1: the unit in which numbers of this size are 1, and zeros stay.
pub(crate) fn unit_of<T: Real>(size: T) -> T {
    if size > T::constant(0.0) { size } else { T::constant(1.0) }
}

/// Returns the largest magnitude in `x`, ignoring NaN.
///
/// Never inlined: rustc did not terminate when LLVM 22 unrolled this along the rows of a matrix of 32 columns
/// (or 40, with `target-cpu=native`). The maximum of a row is then a chain of 32 selections, each of which uses
/// the previous one twice, in a loop of 32 iterations. In loops with a multiple of 8 iterations LLVM looks for
/// cyclic redundancy checks (`HashRecognize`) by following every path through that chain, of which there are
/// 2³².
#[inline(never)]
pub(crate) fn largest<T: Real>(x: &[T]) -> T {
    x.iter().fold(T::constant(0.0), |most, x| larger(most, Scalar::abs(*x)))
}

/// True if `x` is above `bound` or if one of them is NaN: an unknown size counts as large.
pub(crate) fn exceeds<T: Real>(x: T, bound: T) -> bool {
    !matches!(x.partial_cmp(&bound), Some(Ordering::Less | Ordering::Equal))
}

/// True if `x` is known to be at most `bound`: false if one of them is NaN or the bound is infinite.
pub(crate) fn is_within<T: Real>(x: T, bound: T) -> bool {
    x <= bound && bound.is_finite()
}

/// Returns |x| less the round-off of terms of size `terms`, 4 ε `terms`; infinite or NaN if `terms` is.
pub(crate) fn beyond_round_off<T: Real>(x: T, terms: T) -> T {
    let round_off = T::constant(SUM * T::EPSILON) * terms;
    if round_off.is_finite() { Scalar::abs(x) - round_off } else { round_off }
}

/// Returns ε^`exponent`, where ε is the distance from 1 to the next larger number.
pub(crate) fn power_of_epsilon<T: Real>(exponent: f64) -> T {
    Scalar::powf(T::constant(T::EPSILON), T::constant(exponent))
}

/// Returns `value`, or zero where `activity` is zero, lane by lane.
#[inline]
pub fn only_where<T: Scalar>(activity: T, value: T) -> T {
    activity.only_where_not_zero(value)
}

/// Returns the largest power of two up to `x` ≥ 0, 1 for zero. Dividing by it keeps products of numbers of this
/// size in range.
pub(crate) fn power_of_two<T: Real>(x: T) -> T {
    if x == T::constant(0.0) {
        return T::constant(1.0);
    }
    let without_fraction = f64::from_bits(x.to_f64().to_bits() & f64::INFINITY.to_bits());
    T::constant(without_fraction.max(f64::MIN_POSITIVE))
}

/// Sums `count` terms in four partial sums: in a single sum each addition would wait for the previous one.
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

/// True if all numbers are finite.
#[inline(always)]
pub(crate) fn are_finite<T: Parts>(x: &[T]) -> bool {
    // Without branches, so that the compiler tests several numbers at once.
    let all = |x: &[T]| x.iter().fold(true, |all, x| all & x.is_finite());
    let (blocks, rest) = x.as_chunks::<8>();
    if blocks.is_empty() {
        return all(rest);
    }
    // Zero times an infinity or NaN is NaN.
    let zero = T::constant(0.0);
    let mut sums = [zero; 8];
    for block in blocks {
        for (sum, x) in sums.iter_mut().zip(block) {
            *sum = *sum + zero * *x;
        }
    }
    all(&sums) & all(rest)
}

/// Returns √Σx². It neither overflows nor underflows unless the entries do.
pub(crate) fn norm<T: Real>(x: &[T]) -> T {
    let unit = power_of_two(largest(x));
    let square = |x: T| (x / unit) * (x / unit);
    Scalar::sqrt(x.iter().fold(T::constant(0.0), |sum, x| sum + square(*x))) * unit
}

/// Returns Σ xᵢyᵢ, summed in order.
#[inline(always)]
pub(crate) fn dot<T: Scalar>(x: &[T], y: &[T]) -> T {
    x.iter().zip(y).fold(T::constant(0.0), |sum, (x, y)| sum + *x * *y)
}
