//! Truncated power series over any scalar.

use core::array::from_fn;
use core::ops::{Add, Div, Mul, Neg, Sub};

use super::scalar::Scalar;

/// Maximum number of coefficients of a series.
pub(crate) const ROOM: usize = 31;

/// A truncated power series x₀ + x₁ τ + x₂ τ² + …. [`Taylor`](crate::Taylor) expands a motion by evaluating the
/// user-supplied functions on such series.
///
/// Sums and products are those of series. Every other function uses the recurrence that follows from its
/// differential equation (Griewank and Walther, *Evaluating Derivatives*, table 13.2). Comparisons, `abs`,
/// `min` and `max` depend on the value at τ = 0 only, so a series misses a kink at τ ≠ 0.
///
/// ```
/// use lagrange_core::{PowerSeries, Scalar};
/// let x = PowerSeries::new(&[1.0, 1.0, 0.0, 0.0]);
/// assert_eq!((PowerSeries::constant(1.0) / x).coefficients(), [1.0, -1.0, 1.0, -1.0]);
/// assert_eq!(x.ln().coefficients(), [0.0, 1.0, -1.0 / 2.0, 1.0 / 3.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerSeries<S> {
    /// Coefficients from order 0; zeros from `count` on.
    coefficients: [S; ROOM],
    count: usize,
}

impl<S: Scalar> PowerSeries<S> {
    /// Creates a series from coefficients of order 0, 1, …; coefficients beyond the 31st are dropped.
    pub fn new(coefficients: &[S]) -> Self {
        let count = coefficients.len().min(ROOM);
        let mut all = [S::constant(0.0); ROOM];
        all[..count].copy_from_slice(&coefficients[..count]);
        Self { coefficients: all, count }
    }

    /// Returns the coefficients from order 0.
    pub fn coefficients(&self) -> &[S] {
        &self.coefficients[..self.count]
    }

    /// Returns the coefficient of `order`, zero beyond the known orders.
    pub fn coefficient(&self, order: usize) -> S {
        self.coefficients.get(order).copied().unwrap_or(S::constant(0.0))
    }

    /// Replaces the last coefficient by `coefficient` and appends a zero.
    pub(crate) fn extend(&mut self, coefficient: S) {
        self.coefficients[self.count - 1] = coefficient;
        self.count = (self.count + 1).min(ROOM);
    }

    /// Returns a series of the same length; `next` computes each coefficient from the previous ones.
    #[inline]
    fn defined(&self, next: impl Fn(&[S; ROOM], usize) -> S) -> Self {
        let mut coefficients = [S::constant(0.0); ROOM];
        for k in 0..self.count {
            coefficients[k] = next(&coefficients, k);
        }
        Self { coefficients, count: self.count }
    }

    /// Extends the series to the length of the longer of the two.
    fn beside(&self, other: &Self) -> Self {
        Self { count: self.count.max(other.count), ..*self }
    }

    fn map(&self, f: impl Fn(S) -> S) -> Self {
        self.defined(|_, k| f(self.coefficients[k]))
    }

    /// Solves s′ = c x′ and c′ = `sign` s x′.
    fn pair(&self, (s, c): (S, S), sign: f64) -> (Self, Self) {
        let x = &self.coefficients;
        let (mut sine, mut cosine) = ([S::constant(0.0); ROOM], [S::constant(0.0); ROOM]);
        (sine[0], cosine[0]) = (s, c);
        for k in 1..self.count {
            sine[k] = weighted(x, &cosine, k, 1..=k);
            cosine[k] = S::constant(sign) * weighted(x, &sine, k, 1..=k);
        }
        let of = |coefficients| Self { coefficients, count: self.count };
        (of(sine), of(cosine))
    }

    /// Solves z′ = (1 + `sign` z²) x′.
    fn tangent(&self, value: S, sign: f64) -> Self {
        let (x, sign) = (&self.coefficients, S::constant(sign));
        let mut slope = [S::constant(0.0); ROOM];
        let mut z = slope;
        for k in 0..self.count {
            z[k] = if k == 0 { value } else { weighted(x, &slope, k, 1..=k) };
            let square = convolved(&z, &z, k, 0..=k);
            slope[k] = if k == 0 { S::constant(1.0) + sign * square } else { sign * square };
        }
        Self { coefficients: z, count: self.count }
    }

    /// Solves d z′ = x′.
    fn integral(&self, value: S, d: &Self) -> Self {
        let (x, d) = (&self.coefficients, &d.coefficients);
        self.defined(|z, k| if k == 0 { value } else { quotient(x[k] - weighted(z, d, k, 1..=k - 1), d[0]) })
    }

    /// Returns √(1 − x²) as the root of a product, which does not cancel.
    fn beside_unit(&self) -> Self {
        let one = Self::constant(1.0);
        ((one - *self) * (one + *self)).sqrt()
    }

    /// Solves x z′ = e z x′.
    fn power(&self, value: S, e: S) -> Self {
        let x = &self.coefficients;
        self.defined(|z, k| {
            if k == 0 {
                return value;
            }
            let term = |j: usize| {
                let factor = e * S::constant(j as f64) - S::constant((k - j) as f64);
                factor * x[j] * z[k - j]
            };
            quotient((1..=k).map(term).fold(S::constant(0.0), Add::add), x[0] * S::constant(k as f64))
        })
    }
}

/// Returns x / d, and zero for x = 0 even if d is zero, as for the square root of the constant 0.
fn quotient<S: Scalar>(x: S, d: S) -> S {
    if x == S::constant(0.0) { x } else { x / d }
}

/// Returns Σ x_j y_{k−j} over `range`.
fn convolved<S: Scalar>(
    x: &[S; ROOM],
    y: &[S; ROOM],
    k: usize,
    range: core::ops::RangeInclusive<usize>,
) -> S {
    range.fold(S::constant(0.0), |sum, j| x[j].multiply_add(y[k - j], sum))
}

/// Returns Σ j x_j y_{k−j}/k over `range`.
fn weighted<S: Scalar>(x: &[S; ROOM], y: &[S; ROOM], k: usize, range: core::ops::RangeInclusive<usize>) -> S {
    let sum =
        range.fold(S::constant(0.0), |sum, j| (x[j] * S::constant(j as f64)).multiply_add(y[k - j], sum));
    sum / S::constant(k as f64)
}

macro_rules! by_coefficients {
    ($($operator:ident $method:ident),*) => {
        $(impl<S: Scalar> $operator for PowerSeries<S> {
            type Output = Self;

            #[inline]
            fn $method(self, other: Self) -> Self {
                let coefficients = from_fn(|k| self.coefficients[k].$method(other.coefficients[k]));
                Self { coefficients, ..self.beside(&other) }
            }
        })*
    };
}

by_coefficients!(Add add, Sub sub);

impl<S: Scalar> Mul for PowerSeries<S> {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        let (x, y) = (&self.coefficients, &other.coefficients);
        self.beside(&other).defined(|_, k| convolved(x, y, k, 0..=k))
    }
}

impl<S: Scalar> Div for PowerSeries<S> {
    type Output = Self;

    #[inline]
    fn div(self, other: Self) -> Self {
        let (x, y) = (&self.coefficients, &other.coefficients);
        self.beside(&other).defined(|z, k| {
            let known = if k == 0 { S::constant(0.0) } else { convolved(z, y, k, 0..=k - 1) };
            (x[k] - known) / y[0]
        })
    }
}

impl<S: Scalar> Neg for PowerSeries<S> {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        self.map(Neg::neg)
    }
}

#[diagnostic::do_not_recommend]
impl<S: Scalar> Scalar for PowerSeries<S> {
    #[inline]
    fn constant(x: f64) -> Self {
        Self::new(&[S::constant(x)])
    }

    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        self.pair(self.coefficients[0].sin_cos(), -1.0)
    }

    #[inline]
    fn tan(self) -> Self {
        self.tangent(self.coefficients[0].tan(), 1.0)
    }

    #[inline]
    fn asin(self) -> Self {
        self.integral(self.coefficients[0].asin(), &self.beside_unit())
    }

    #[inline]
    fn acos(self) -> Self {
        self.integral(self.coefficients[0].acos(), &-self.beside_unit())
    }

    #[inline]
    fn atan(self) -> Self {
        self.integral(self.coefficients[0].atan(), &(Self::constant(1.0) + self * self))
    }

    /// Solves (x² + y²) z′ = x y′ − y x′.
    #[inline]
    fn atan2(self, x: Self) -> Self {
        let square = self * self + x * x;
        let (y, x, d) = (&self.coefficients, &x.coefficients, &square.coefficients);
        square.defined(|z, k| {
            if k == 0 {
                return y[0].atan2(x[0]);
            }
            let turn = weighted(y, x, k, 1..=k) - weighted(x, y, k, 1..=k);
            quotient(turn - weighted(z, d, k, 1..=k - 1), d[0])
        })
    }

    #[inline]
    fn sinh(self) -> Self {
        self.pair((self.coefficients[0].sinh(), self.coefficients[0].cosh()), 1.0).0
    }

    #[inline]
    fn cosh(self) -> Self {
        self.pair((self.coefficients[0].sinh(), self.coefficients[0].cosh()), 1.0).1
    }

    #[inline]
    fn tanh(self) -> Self {
        self.tangent(self.coefficients[0].tanh(), -1.0)
    }

    #[inline]
    fn exp(self) -> Self {
        let x = &self.coefficients;
        self.defined(|z, k| if k == 0 { x[0].exp() } else { weighted(x, z, k, 1..=k) })
    }

    #[inline]
    fn ln(self) -> Self {
        self.integral(self.coefficients[0].ln(), &self)
    }

    #[inline]
    fn sqrt(self) -> Self {
        let x = &self.coefficients;
        self.defined(|z, k| match k {
            0 => x[0].sqrt(),
            _ => quotient(x[k] - convolved(z, z, k, 1..=k - 1), z[0] + z[0]),
        })
    }

    #[inline]
    fn abs(self) -> Self {
        let zero = Self::constant(0.0);
        self.select_by_order(zero, -self, zero, self)
    }

    /// An integer exponent up to 8 is a product, which accepts any base.
    #[inline]
    fn powf(self, exponent: Self) -> Self {
        let [e, rest @ ..] = exponent.coefficients;
        if rest.iter().any(|x| *x != S::constant(0.0)) {
            return (exponent * self.ln()).exp();
        }
        let count = exponent.beside(&self).count;
        let product =
            |times: u32| (0..times).fold(Self { count, ..Self::constant(1.0) }, |product, _| product * self);
        match (0..=8).find(|&whole| e == S::constant(f64::from(whole))) {
            Some(whole) => product(whole),
            None => Self { count, ..self }.power(self.coefficients[0].powf(e), e),
        }
    }

    #[inline]
    fn min(self, other: Self) -> Self {
        self.select_by_order(other, self, mean(self, other), other)
    }

    #[inline]
    fn max(self, other: Self) -> Self {
        self.select_by_order(other, other, mean(self, other), self)
    }

    /// Compares the values at τ = 0.
    #[inline]
    fn select_by_order(self, other: Self, less: Self, equal: Self, greater: Self) -> Self {
        let [x, y] = [self.coefficients[0], other.coefficients[0]];
        let all = less.beside(&equal).beside(&greater);
        all.defined(|_, k| {
            x.select_by_order(y, less.coefficients[k], equal.coefficients[k], greater.coefficients[k])
        })
    }

    #[inline]
    fn zero_or_product(self, y: Self) -> Self {
        let (x, y) = (self.beside(&y), &y.coefficients);
        let term = |j: usize, k: usize| x.coefficients[j].zero_or_product(y[k - j]);
        x.defined(|_, k| (0..=k).fold(S::constant(0.0), |sum, j| sum + term(j, k)))
    }
}

fn mean<S: Scalar>(x: PowerSeries<S>, y: PowerSeries<S>) -> PowerSeries<S> {
    (x + y).map(|sum| sum * S::constant(0.5))
}

#[cfg(test)]
mod tests;
