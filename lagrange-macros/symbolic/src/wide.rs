//! Fractions, and their products and sums, rounded to the nearest `f64` if they do not fit into `i128`.

use std::cmp::Ordering;

use super::rational::Rational;

/// An unsigned integer of 256 bits. The highest bit is never used: numerators and denominators have 127 bits.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Wide {
    high: u128,
    low: u128,
}

/// The nearest `f64` to x y.
pub(super) fn product(x: Rational, y: Rational) -> f64 {
    let [xs, ys] = [x, y].map(|value| value.numer().unsigned_abs());
    let magnitude = quotient(Wide::product(xs, ys), Wide::product(denominator(x), denominator(y)));
    if (*x.numer() < 0) == (*y.numer() < 0) { magnitude } else { -magnitude }
}

/// The nearest `f64` to x + y.
pub(super) fn sum(x: Rational, y: Rational) -> f64 {
    let part =
        |value: Rational, other: Rational| Wide::product(value.numer().unsigned_abs(), denominator(other));
    let (first, second) = (part(x, y), part(y, x));
    let [x_is_negative, y_is_negative] = [x, y].map(|value| *value.numer() < 0);
    let (is_negative, numerator) = match first.cmp(&second) {
        _ if x_is_negative == y_is_negative => (x_is_negative, first.plus(second)),
        Ordering::Less => (y_is_negative, second.minus(first)),
        _ => (x_is_negative, first.minus(second)),
    };
    let magnitude = quotient(numerator, Wide::product(denominator(x), denominator(y)));
    if is_negative { -magnitude } else { magnitude }
}

/// The nearest `f64` to a fraction.
pub fn to_f64(x: Rational) -> f64 {
    let exact = 1 << f64::MANTISSA_DIGITS;
    let (numerator, denominator) = (x.numer().unsigned_abs(), x.denom().unsigned_abs());
    if numerator <= exact && denominator <= exact {
        return *x.numer() as f64 / *x.denom() as f64;
    }
    product(x, Rational::from_integer(1))
}

fn denominator(x: Rational) -> u128 {
    x.denom().unsigned_abs()
}

/// Quotient by binary long division, with more digits than a mantissa has. The remainder can only break a tie, for
/// which one more digit is enough.
fn quotient(numerator: Wide, denominator: Wide) -> f64 {
    const DIGITS: i32 = 64;
    if numerator.bits() == 0 {
        return 0.0;
    }
    let (mut rest, mut divisor) = (numerator, denominator);
    let exponent = rest.bits() as i32 - divisor.bits() as i32;
    (exponent..0).for_each(|_| rest = rest.doubled());
    (0..exponent).for_each(|_| divisor = divisor.doubled());
    let mut digits = 0_u128;
    for _ in 0..=DIGITS {
        digits *= 2;
        if rest >= divisor {
            digits += 1;
            rest = rest.minus(divisor);
        }
        rest = rest.doubled();
    }
    (digits | u128::from(rest.bits() > 0)) as f64 * 2.0_f64.powi(exponent - DIGITS)
}

impl Wide {
    fn product(x: u128, y: u128) -> Self {
        const HALF: u128 = (1 << 64) - 1;
        let [(a, b), (c, d)] = [x, y].map(|value| (value >> 64, value & HALF));
        let low = b * d;
        let first = a * d + (low >> 64);
        let second = b * c + (first & HALF);
        Self { high: a * c + (first >> 64) + (second >> 64), low: (second << 64) | (low & HALF) }
    }

    fn plus(self, other: Self) -> Self {
        let (low, carry) = self.low.overflowing_add(other.low);
        Self { high: self.high + other.high + u128::from(carry), low }
    }

    /// self − other, for other ≤ self.
    fn minus(self, other: Self) -> Self {
        let (low, borrow) = self.low.overflowing_sub(other.low);
        Self { high: self.high - other.high - u128::from(borrow), low }
    }

    fn doubled(self) -> Self {
        Self { high: (self.high << 1) | (self.low >> 127), low: self.low << 1 }
    }

    /// Number of significant bits.
    fn bits(self) -> u32 {
        match self.high.leading_zeros() {
            128 => 128 - self.low.leading_zeros(),
            zeros => 256 - zeros,
        }
    }
}
