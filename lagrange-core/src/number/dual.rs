//! Dual numbers over any scalar: a value and its derivative along one direction.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::scalar::Scalar;

// Operations on dual numbers are `#[inline]`, as those on lanes. With `#[inline(always)]` a derived function that is not
// optimized keeps every intermediate result on the stack: 8 MB for second derivatives of a quadruped, 1.2 MB without.

/// `value` + ε `slope` with ε² = 0: a value and its derivative. The components are of any scalar type, also
/// dual numbers themselves.
///
/// Dual numbers differentiate the user-supplied functions of a system. (The dual numbers of other crates are
/// [`Scalar`]s too, but only over floating-point numbers; this type also works over SIMD lanes and nested dual
/// numbers.) Rules: Griewank and Walther, *Evaluating Derivatives*, table 3.3.
///
/// ```
/// use lagrange_core::{Dual, Scalar};
/// let x = Dual { value: 2.0_f64, slope: 1.0 };
/// assert_eq!(x * x * x, Dual { value: 8.0, slope: 12.0 });
/// assert_eq!((x - 1.0) / 2.0, Dual { value: 0.5, slope: 0.5 });
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<S> {
    /// Value.
    pub value: S,
    /// Derivative of the value.
    pub slope: S,
}

impl<S: Scalar> Dual<S> {
    /// Returns f(self), given f(value) and f′(value).
    #[inline]
    fn chain(self, value: S, derivative: S) -> Self {
        Self { value, slope: derivative * self.slope }
    }

    /// Like `chain` for a derivative that may be infinite: a slope of zero stays zero.
    #[inline]
    fn chain_if_moving(self, value: S, derivative: S) -> Self {
        Self { value, slope: self.slope.zero_or_product(derivative) }
    }
}

impl<S: Scalar> Add for Dual<S> {
    type Output = Self;

    #[inline]
    fn add(self, y: Self) -> Self {
        Self { value: self.value + y.value, slope: self.slope + y.slope }
    }
}

impl<S: Scalar> Sub for Dual<S> {
    type Output = Self;

    #[inline]
    fn sub(self, y: Self) -> Self {
        Self { value: self.value - y.value, slope: self.slope - y.slope }
    }
}

impl<S: Scalar> Mul for Dual<S> {
    type Output = Self;

    #[inline]
    fn mul(self, y: Self) -> Self {
        Self { value: self.value * y.value, slope: self.slope * y.value + self.value * y.slope }
    }
}

impl<S: Scalar> Div for Dual<S> {
    type Output = Self;

    #[inline]
    fn div(self, y: Self) -> Self {
        let value = self.value / y.value;
        Self { value, slope: (self.slope - value * y.slope) / y.value }
    }
}

impl<S: Scalar> Neg for Dual<S> {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self { value: -self.value, slope: -self.slope }
    }
}

/// A bare scalar operand is a constant.
impl<S: Scalar> Add<S> for Dual<S> {
    type Output = Self;

    #[inline]
    fn add(self, x: S) -> Self {
        Self { value: self.value + x, ..self }
    }
}

impl<S: Scalar> Sub<S> for Dual<S> {
    type Output = Self;

    #[inline]
    fn sub(self, x: S) -> Self {
        Self { value: self.value - x, ..self }
    }
}

impl<S: Scalar> Mul<S> for Dual<S> {
    type Output = Self;

    #[inline]
    fn mul(self, x: S) -> Self {
        Self { value: self.value * x, slope: self.slope * x }
    }
}

impl<S: Scalar> Div<S> for Dual<S> {
    type Output = Self;

    #[inline]
    fn div(self, x: S) -> Self {
        Self { value: self.value / x, slope: self.slope / x }
    }
}

#[diagnostic::do_not_recommend]
impl<S: Scalar> Scalar for Dual<S> {
    #[inline]
    fn constant(x: f64) -> Self {
        Self { value: S::constant(x), slope: S::constant(0.0) }
    }

    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.value.sin_cos();
        (self.chain(sine, cosine), self.chain(cosine, -sine))
    }

    #[inline]
    fn sin_cos_of_small<const K: usize>(angles: [Self; K]) -> ([Self; K], [Self; K]) {
        let (sines, cosines) = S::sin_cos_of_small(angles.map(|angle| angle.value));
        let sine = |k: usize| angles[k].chain(sines[k], cosines[k]);
        let cosine = |k: usize| angles[k].chain(cosines[k], -sines[k]);
        (core::array::from_fn(sine), core::array::from_fn(cosine))
    }

    #[inline]
    fn small_angles<const K: usize>(angles: [Self; K]) -> [Self; K] {
        let small = S::small_angles(angles.map(|angle| angle.value));
        core::array::from_fn(|k| Self { value: small[k], ..angles[k] })
    }

    #[inline]
    fn tan(self) -> Self {
        let tangent = self.value.tan();
        self.chain(tangent, S::constant(1.0) + tangent * tangent)
    }

    #[inline]
    fn asin(self) -> Self {
        let x = self.value;
        self.chain_if_moving(x.asin(), S::constant(1.0) / beside(x).sqrt())
    }

    #[inline]
    fn acos(self) -> Self {
        let x = self.value;
        self.chain_if_moving(x.acos(), S::constant(-1.0) / beside(x).sqrt())
    }

    #[inline]
    fn atan(self) -> Self {
        let x = self.value;
        self.chain(x.atan(), S::constant(1.0) / (S::constant(1.0) + x * x))
    }

    /// Scaling by the larger magnitude keeps the squares near 1: they neither overflow nor underflow.
    #[inline]
    fn atan2(self, x: Self) -> Self {
        let size = self.value.abs().max(x.value.abs());
        let (sine, cosine) = (self.value / size, x.value / size);
        let turn = (cosine * self.slope - sine * x.slope) / (sine * sine + cosine * cosine);
        Self { value: self.value.atan2(x.value), slope: turn / size }
    }

    #[inline]
    fn sinh(self) -> Self {
        self.chain(self.value.sinh(), self.value.cosh())
    }

    #[inline]
    fn cosh(self) -> Self {
        self.chain(self.value.cosh(), self.value.sinh())
    }

    /// The derivative 1/cosh² is computed as 4 y/(1 + y)² with y = exp(−2 |x|), since 1 − tanh² cancels for
    /// large |x|.
    #[inline]
    fn tanh(self) -> Self {
        let (x, zero, one) = (self.value, S::constant(0.0), S::constant(1.0));
        let y = (S::constant(2.0) * x.select_by_order(zero, x, x, -x)).exp();
        let root = S::constant(2.0) / (one + y);
        self.chain(x.tanh(), y * root * root)
    }

    #[inline]
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.chain(value, value)
    }

    #[inline]
    fn ln(self) -> Self {
        self.chain(self.value.ln(), S::constant(1.0) / self.value)
    }

    #[inline]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain_if_moving(root, S::constant(0.5) / root)
    }

    /// At zero the slope is zero, the mean of the slopes on both sides.
    #[inline]
    fn abs(self) -> Self {
        let zero = S::constant(0.0);
        let slope = self.value.select_by_order(zero, -self.slope, zero, self.slope);
        Self { value: self.value.abs(), slope }
    }

    /// A constant exponent needs no logarithm of the base, so the base may be negative.
    #[inline]
    fn powf(self, exponent: Self) -> Self {
        let value = self.value.powf(exponent.value);
        // x⁰ is 1 everywhere; the general rule would give a slope of 0 · 0⁻¹ at zero.
        let below = self.value.powf(exponent.value - S::constant(1.0));
        let power = self.chain_if_moving(value, exponent.value.zero_or_product(below));
        // No logarithm is needed if the exponent is constant in all lanes.
        if exponent.slope == S::constant(0.0) {
            return power;
        }
        let Self { slope, .. } = exponent.chain_if_moving(value, value * self.value.ln());
        Self { value, slope: power.slope + slope }
    }

    /// The slope is that of the smaller value, the mean of both slopes if the values are equal, and NaN if a
    /// value is NaN.
    #[inline]
    fn min(self, other: Self) -> Self {
        let (x, y) = (self.slope, other.slope);
        let slope = self.value.select_by_order(other.value, x, mean(x, y), y);
        Self { value: self.value.min(other.value), slope }
    }

    /// The slope follows the rule of [`min`](Self::min), for the larger value.
    #[inline]
    fn max(self, other: Self) -> Self {
        let (x, y) = (self.slope, other.slope);
        let slope = self.value.select_by_order(other.value, y, mean(x, y), x);
        Self { value: self.value.max(other.value), slope }
    }

    #[inline]
    fn select_by_order(self, other: Self, less: Self, equal: Self, greater: Self) -> Self {
        let choose = |l: S, e: S, g: S| self.value.select_by_order(other.value, l, e, g);
        Self {
            value: choose(less.value, equal.value, greater.value),
            slope: choose(less.slope, equal.slope, greater.slope),
        }
    }

    // The default of the trait is always inlined.
    #[inline]
    fn multiply_add(self, y: Self, z: Self) -> Self {
        self * y + z
    }

    #[inline]
    fn subtract_product(self, y: Self, z: Self) -> Self {
        z - self * y
    }

    #[inline]
    fn zero_or_product(self, y: Self) -> Self {
        Self {
            value: self.value.zero_or_product(y.value),
            slope: self.slope.zero_or_product(y.value) + self.value.zero_or_product(y.slope),
        }
    }
}

/// 1 − x² as a product: rounding the square would cause cancellation near 1.
#[inline]
fn beside<S: Scalar>(x: S) -> S {
    (S::constant(1.0) - x) * (S::constant(1.0) + x)
}

/// Mean of two numbers, without overflow.
#[inline]
fn mean<S: Scalar>(x: S, y: S) -> S {
    let half = S::constant(0.5);
    x * half + y * half
}

#[cfg(test)]
mod tests;
