//! Scalars as collections of plain numbers, for iterations that end at round-off.

use nalgebra::ComplexField;

use super::limits::{PROGRESS, SUM};
use super::{Dual, Real, Scalar};

/// A scalar whose parts can be compared: the value and the slopes of a dual number, the lanes of a vector.
pub trait Parts: Scalar {
    /// Distance from 1 to the next larger number.
    const EPSILON: f64;

    /// True if the number carries derivatives.
    const HAS_SLOPES: bool;

    /// Returns the magnitude of each part.
    #[must_use]
    fn magnitude(self) -> Self;

    /// Returns the smaller of both numbers, part by part.
    #[must_use]
    fn least(self, other: Self) -> Self;

    /// True if each part is at most `factor` times the same part of `bound`. False for NaN.
    fn is_within(self, factor: f64, bound: Self) -> bool;

    /// True if each value is at most `factor` times that of `bound`, whatever the slopes. False for NaN.
    fn is_value_within(self, factor: f64, bound: Self) -> bool {
        self.is_within(factor, bound)
    }

    /// True if each value is at most `bound`, whatever the slopes. False for NaN.
    fn is_at_most(self, bound: f64) -> bool;

    /// True if each part is finite.
    fn is_finite(self) -> bool;

    /// True if each part of this residual is round-off of terms of the size `terms`, or is no longer smaller than
    /// `before`, the least residual of earlier sweeps.
    fn has_settled(self, before: Self, terms: Self) -> bool;
}

impl<T: Real> Parts for T {
    const EPSILON: f64 = <T as Real>::EPSILON;
    const HAS_SLOPES: bool = false;

    #[inline]
    fn magnitude(self) -> Self {
        Scalar::abs(self)
    }

    #[inline]
    fn least(self, other: Self) -> Self {
        Scalar::min(self, other)
    }

    #[inline]
    fn is_within(self, factor: f64, bound: Self) -> bool {
        self <= T::constant(factor) * bound
    }

    #[inline]
    fn is_at_most(self, bound: f64) -> bool {
        self <= T::constant(bound)
    }

    #[inline]
    fn is_finite(self) -> bool {
        ComplexField::is_finite(&self)
    }

    #[inline]
    fn has_settled(self, before: Self, terms: Self) -> bool {
        self.is_within(SUM * <T as Real>::EPSILON, terms) || !self.is_within(PROGRESS, before)
    }
}

impl<S: Parts> Parts for Dual<S> {
    const EPSILON: f64 = S::EPSILON;
    const HAS_SLOPES: bool = true;

    #[inline]
    fn magnitude(self) -> Self {
        Self { value: self.value.magnitude(), slope: self.slope.magnitude() }
    }

    #[inline]
    fn least(self, other: Self) -> Self {
        Self { value: self.value.least(other.value), slope: self.slope.least(other.slope) }
    }

    #[inline]
    fn is_within(self, factor: f64, bound: Self) -> bool {
        self.value.is_within(factor, bound.value) && self.slope.is_within(factor, bound.slope)
    }

    #[inline]
    fn is_value_within(self, factor: f64, bound: Self) -> bool {
        self.value.is_value_within(factor, bound.value)
    }

    #[inline]
    fn is_at_most(self, bound: f64) -> bool {
        self.value.is_at_most(bound)
    }

    #[inline]
    fn is_finite(self) -> bool {
        self.value.is_finite() && self.slope.is_finite()
    }

    #[inline]
    fn has_settled(self, before: Self, terms: Self) -> bool {
        self.value.has_settled(before.value, terms.value) && self.slope.has_settled(before.slope, terms.slope)
    }
}
