//! Numbers with a derivative along one direction, over any scalar.

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::Scalar;

/// `value` + ε `slope` with ε² = 0: a value and its derivative, over any scalar and so over itself.
///
/// The derivatives of the functions that a system is given come from it. (A dual number of another crate is a
/// [`Scalar`] too, but over floating-point numbers only; this one is needed over SIMD lanes and over other dual
/// numbers as well.) Rules: Griewank and Walther, *Evaluating Derivatives*, table 3.3.
///
/// ```
/// use lagrange_core::{Dual, Scalar};
/// let x = Dual { value: 2.0_f64, slope: 1.0 };
/// assert_eq!(x * x * x, Dual { value: 8.0, slope: 12.0 });
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<S> {
    /// The value.
    pub value: S,
    /// Its derivative.
    pub slope: S,
}

impl<S: Scalar> Dual<S> {
    /// f(value), given the derivative of f there.
    #[inline(always)]
    fn chain(self, value: S, derivative: S) -> Self {
        Self { value, slope: derivative * self.slope }
    }
}

impl<S: Scalar> Add for Dual<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, y: Self) -> Self {
        Self { value: self.value + y.value, slope: self.slope + y.slope }
    }
}

impl<S: Scalar> Sub for Dual<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, y: Self) -> Self {
        Self { value: self.value - y.value, slope: self.slope - y.slope }
    }
}

impl<S: Scalar> Mul for Dual<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, y: Self) -> Self {
        Self { value: self.value * y.value, slope: self.slope * y.value + self.value * y.slope }
    }
}

impl<S: Scalar> Div for Dual<S> {
    type Output = Self;

    #[inline(always)]
    fn div(self, y: Self) -> Self {
        let value = self.value / y.value;
        Self { value, slope: (self.slope - value * y.slope) / y.value }
    }
}

impl<S: Scalar> Neg for Dual<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, slope: -self.slope }
    }
}

impl<S: Scalar> Scalar for Dual<S> {
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self { value: S::constant(x), slope: S::constant(0.0) }
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.value.sin_cos();
        (self.chain(sine, cosine), self.chain(cosine, -sine))
    }

    #[inline(always)]
    fn sin(self) -> Self {
        self.sin_cos().0
    }

    #[inline(always)]
    fn cos(self) -> Self {
        self.sin_cos().1
    }

    #[inline(always)]
    fn tan(self) -> Self {
        let tangent = self.value.tan();
        self.chain(tangent, S::constant(1.0) + tangent * tangent)
    }

    #[inline(always)]
    fn asin(self) -> Self {
        let x = self.value;
        self.chain(x.asin(), S::constant(1.0) / (S::constant(1.0) - x * x).sqrt())
    }

    #[inline(always)]
    fn acos(self) -> Self {
        let x = self.value;
        self.chain(x.acos(), -(S::constant(1.0) / (S::constant(1.0) - x * x).sqrt()))
    }

    #[inline(always)]
    fn atan(self) -> Self {
        let x = self.value;
        self.chain(x.atan(), S::constant(1.0) / (S::constant(1.0) + x * x))
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let radius2 = self.value * self.value + x.value * x.value;
        let slope = (x.value * self.slope - self.value * x.slope) / radius2;
        Self { value: self.value.atan2(x.value), slope }
    }

    #[inline(always)]
    fn sinh(self) -> Self {
        self.chain(self.value.sinh(), self.value.cosh())
    }

    #[inline(always)]
    fn cosh(self) -> Self {
        self.chain(self.value.cosh(), self.value.sinh())
    }

    #[inline(always)]
    fn tanh(self) -> Self {
        let tangent = self.value.tanh();
        self.chain(tangent, S::constant(1.0) - tangent * tangent)
    }

    #[inline(always)]
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.chain(value, value)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        self.chain(self.value.ln(), S::constant(1.0) / self.value)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, S::constant(0.5) / root)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let value = self.value.abs();
        self.chain(value, self.value / value)
    }

    /// For a constant exponent no logarithm is taken of the base, which may then be negative.
    #[inline(always)]
    fn powf(self, exponent: Self) -> Self {
        let zero = S::constant(0.0);
        let value = self.value.powf(exponent.value);
        let mut slope = zero;
        // x⁰ is 1 everywhere; by the rule its slope at zero would be 0 · 0⁻¹.
        if self.slope != zero && exponent.value != zero {
            slope = exponent.value * self.value.powf(exponent.value - S::constant(1.0)) * self.slope;
        }
        if exponent.slope != zero {
            slope = slope + value * self.value.ln() * exponent.slope;
        }
        Self { value, slope }
    }

    /// As [`min`](Self::min).
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        -(-self).min(-other)
    }

    /// The smaller value; its slope is that of the smaller where they differ, and their mean where they agree.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self.value == other.value {
            return (self + other) * Self::constant(0.5);
        }
        // (x + y − |x − y|)/2 decides lane by lane.
        (self + other - (self - other).abs()) * Self::constant(0.5)
    }
}

#[cfg(test)]
mod tests;
