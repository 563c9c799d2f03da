//! Comparisons that know what they do with NaN, and the round-off unit.

use core::cmp::Ordering;

use crate::{Real, Scalar};

/// The larger of the two; where one is NaN, `a`.
pub(crate) fn larger<T: Real>(a: T, b: T) -> T {
    if b > a { b } else { a }
}

/// The smaller of the two; where one is NaN, `a`.
pub(crate) fn smaller<T: Real>(a: T, b: T) -> T {
    if b < a { b } else { a }
}

/// Whether `x` is above `bound`, or one of them NaN: what is not known to be small counts as large.
pub(crate) fn exceeds<T: Real>(x: T, bound: T) -> bool {
    !matches!(x.partial_cmp(&bound), Some(Ordering::Less | Ordering::Equal))
}

/// ε to this power, ε the distance from 1 to the next larger number.
pub(crate) fn power_of_epsilon<T: Real>(exponent: f64) -> T {
    Scalar::powf(T::constant(T::EPSILON), T::constant(exponent))
}

/// `value`, or zero where `activity` is zero.
#[inline]
pub fn only_where<T: Scalar>(activity: T, value: T) -> T {
    if activity == T::constant(0.0) { activity } else { value }
}
