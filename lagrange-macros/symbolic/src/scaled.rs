//! Numbers of any magnitude: fractions, times a power of ten if 128 bits are not enough.
//!
//! Numbers are exact as long as their digits fit. A number with more digits is rounded once, to the nearest `f64`.

use std::cmp::Ordering;

use num_traits::Zero;

use super::rational::{Rational, plus, power, times};
use super::wide::{self, to_f64};

/// `fraction` · 10^`exponent`, within the range of `f64`. The exponent is 0 whenever the number fits into a fraction.
/// Otherwise the fraction is from 1 to 10 (except for fractions of very long numbers), so that equal numbers have
/// equal fields.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Scaled {
    pub fraction: Rational,
    pub exponent: i32,
}

impl From<Rational> for Scaled {
    fn from(fraction: Rational) -> Self {
        Self { fraction, exponent: 0 }
    }
}

impl Scaled {
    /// `fraction` · 10^`exponent`; `None` beyond the range of `f64`.
    pub fn new(fraction: Rational, exponent: i32) -> Option<Self> {
        if exponent == 0 || fraction.is_zero() {
            return Some(fraction.into());
        }
        let scaled = Self { fraction, exponent }.apart()?;
        if let Some(fraction) = ten_to(scaled.exponent).and_then(|scale| times(scaled.fraction, scale)) {
            return Some(fraction.into());
        }
        scaled.to_f64().is_normal().then_some(scaled)
    }

    /// Normalizes the fraction to the range from 1 to 10.
    pub fn apart(self) -> Option<Self> {
        let size = |n: i128| n.unsigned_abs().checked_ilog10().unwrap_or(0) as i32;
        let mut shift = size(*self.fraction.numer()) - size(*self.fraction.denom());
        let shifted = |shift: i32| times(self.fraction, ten_to(-shift)?);
        if shifted(shift).is_some_and(|x| x.numer().unsigned_abs() < x.denom().unsigned_abs()) {
            shift -= 1;
        }
        let (fraction, shift) = shifted(shift).map_or((self.fraction, 0), |fraction| (fraction, shift));
        Some(Self { fraction, exponent: self.exponent.checked_add(shift)? })
    }

    /// Applies `operation` to two numbers without powers of ten; `None` if the result does not fit.
    fn of_fractions(
        self,
        other: Self,
        operation: fn(Rational, Rational) -> Option<Rational>,
    ) -> Option<Self> {
        (self.exponent == 0 && other.exponent == 0).then_some(())?;
        operation(self.fraction, other.fraction).map(Self::from)
    }

    /// Product; `None` if its digits do not fit.
    pub fn times(self, other: Self) -> Option<Self> {
        if let Some(product) = self.of_fractions(other, times) {
            return Some(product);
        }
        if self.fraction.is_zero() || other.fraction.is_zero() {
            return Some(Rational::zero().into());
        }
        let (x, y) = (self.apart()?, other.apart()?);
        Self::new(times(x.fraction, y.fraction)?, x.exponent.checked_add(y.exponent)?)
    }

    /// Sum; `None` if its digits do not fit: 1 + 10⁻⁵⁰ has too many.
    pub fn plus(self, other: Self) -> Option<Self> {
        if let Some(sum) = self.of_fractions(other, plus) {
            return Some(sum);
        }
        let (x, y) = (self.apart()?, other.apart()?);
        let (low, high) = if x.exponent < y.exponent { (x, y) } else { (y, x) };
        let raised = times(high.fraction, ten_to(high.exponent.checked_sub(low.exponent)?)?)?;
        Self::new(plus(low.fraction, raised)?, low.exponent)
    }

    /// Product, its fraction rounded to the nearest `f64`; `None` beyond the range of `f64`.
    pub(super) fn times_rounded(self, other: Self) -> Option<Self> {
        let product = Self::rounded(wide::product(self.fraction, other.fraction))?;
        Self::new(product.fraction, product.exponent.checked_add(self.exponent)?.checked_add(other.exponent)?)
    }

    /// Sum, its fraction rounded to the nearest `f64`; neither addend loses more than one digit. `None` for different
    /// powers of ten: these numbers stay two terms.
    pub(super) fn plus_rounded(self, other: Self) -> Option<Self> {
        let apart = (self.apart()?, other.apart()?);
        (apart.0.exponent == apart.1.exponent).then_some(())?;
        let (x, y) = if self.exponent == other.exponent { (self, other) } else { apart };
        let sum = Self::rounded(wide::sum(x.fraction, y.fraction))?;
        Self::new(sum.fraction, sum.exponent.checked_add(x.exponent)?)
    }

    /// Shortest decimal that parses to this `f64`.
    fn rounded(value: f64) -> Option<Self> {
        parse_exactly(&format!("{value:e}"))
    }

    /// Power; `None` if its digits do not fit.
    pub fn power(self, exponent: i128) -> Option<Self> {
        if self.exponent == 0
            && let Some(fraction) = power(self.fraction, exponent)
        {
            return Some(fraction.into());
        }
        let Self { fraction, exponent: tens } = self.apart()?;
        Self::new(power(fraction, exponent)?, tens.checked_mul(exponent.try_into().ok()?)?)
    }

    pub fn is_integer(self) -> bool {
        self.exponent > 0 || self.exponent == 0 && self.fraction.is_integer()
    }

    /// Value of an integer that fits into `i128`.
    pub fn to_integer(self) -> Option<i128> {
        (self.exponent == 0 && self.is_integer()).then(|| self.fraction.to_integer())
    }

    /// Compares by exponent and absolute value. Any total order that distinguishes all numbers would do.
    pub(super) fn cmp_size(&self, other: &Self) -> Ordering {
        let key = |x: &Self| {
            (x.exponent, x.fraction.numer().unsigned_abs(), -x.fraction.denom(), *x.fraction.numer())
        };
        key(self).cmp(&key(other))
    }

    /// Decimal logarithm of the absolute value.
    pub(super) fn magnitude(self) -> f64 {
        to_f64(self.fraction).abs().log10() + f64::from(self.exponent)
    }

    /// Nearest `f64` for finite decimals and for numbers without a power of ten; otherwise an `f64` with the
    /// error of two roundings.
    pub fn to_f64(self) -> f64 {
        let Self { fraction, exponent } = self;
        let read = |text: String| text.parse::<f64>().unwrap_or(f64::NAN);
        match finite_decimal(fraction) {
            _ if exponent == 0 => to_f64(fraction),
            Some((digits, places)) => read(format!("{digits}e{}", i64::from(exponent) - i64::from(places))),
            // The power of ten alone may be out of range although the number is not.
            None => {
                let digits = format!("{:e}", to_f64(fraction));
                let (digits, tens) = digits.split_once('e').unwrap_or((&digits, "0"));
                read(format!("{digits}e{}", tens.parse::<i64>().unwrap_or(0) + i64::from(exponent)))
            }
        }
    }
}

fn ten_to(exponent: i32) -> Option<Rational> {
    power(Rational::from_integer(10), exponent.into())
}

/// Digits of a finite decimal, and the number of digits after the decimal point.
pub fn finite_decimal(value: Rational) -> Option<(i128, u32)> {
    let (mut rest, mut places) = (*value.denom(), 0);
    while rest % 10 == 0 {
        rest /= 10;
        places += 1;
    }
    while rest > 1 {
        rest /= [2, 5].into_iter().find(|factor| rest % factor == 0)?;
        places += 1;
    }
    let digits = times(value, ten_to(i32::try_from(places).ok()?)?)?;
    Some((digits.to_integer(), places))
}

/// Value of a decimal literal such as `1_000`, `9.81` or `6.62607015e-34`, rounded to the nearest `f64` if its digits
/// do not fit; `None` beyond the range of `f64`.
pub fn parse_decimal(text: &str) -> Option<Scaled> {
    let text = text.replace('_', "");
    parse_exactly(&text)
        .or_else(|| Scaled::rounded(text.parse().ok().filter(|value: &f64| value.is_normal())?))
}

fn parse_exactly(text: &str) -> Option<Scaled> {
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
        None => (text, 0),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let fraction = fraction.trim_end_matches('0');
    let digits = format!("{whole}{fraction}");
    let significant = digits.trim_end_matches('0');
    let zeros = i32::try_from(digits.len() - significant.len()).ok()?;
    let places = i32::try_from(fraction.len()).ok()?;
    let value = match significant {
        "" => 0,
        digits => digits.parse::<i128>().ok()?,
    };
    Scaled::new(Rational::from_integer(value), exponent.checked_add(zeros)?.checked_sub(places)?)
}
