//! Exact numbers: every literal is one until it is emitted.

use num_rational::Ratio;
use num_traits::{CheckedMul, One, Zero};

/// A fraction of two `i128`, in lowest terms, its denominator positive.
pub(crate) type Rational = Ratio<i128>;

/// The value of a decimal literal such as `1_000`, `9.81` or `6.02e23`; `None` where it does not fit.
pub(crate) fn parse_decimal(text: &str) -> Option<Rational> {
    let text = text.replace('_', "");
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
        None => (text.as_str(), 0),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = format!("{whole}{fraction}").parse::<i128>().ok()?;
    let shift = exponent.checked_sub(i32::try_from(fraction.len()).ok()?)?;
    Rational::from_integer(digits).checked_mul(&power(Rational::from_integer(10), shift.into())?)
}

/// `base` to an integer power; `None` where it does not fit, and for zero to a negative one.
pub(crate) fn power(base: Rational, exponent: i128) -> Option<Rational> {
    if base.is_one() || exponent == 0 {
        return Some(Rational::one());
    }
    if base.is_zero() {
        return (exponent > 0).then(Rational::zero);
    }
    let base = if exponent < 0 { base.recip() } else { base };
    let exponent = usize::try_from(exponent.unsigned_abs()).ok()?;
    num_traits::checked_pow(base, exponent)
}

/// The exact square root, if there is one.
pub(crate) fn square_root(x: Rational) -> Option<Rational> {
    let root = |n: i128| {
        let guess = (n as f64).sqrt().round() as i128;
        (guess.checked_mul(guess)? == n).then_some(guess)
    };
    if *x.numer() < 0 {
        return None;
    }
    Some(Rational::new_raw(root(*x.numer())?, root(*x.denom())?))
}

/// The nearest `f64`, by way of 40 decimal digits so that it is rounded once.
pub(crate) fn to_f64(x: Rational) -> f64 {
    let exact = 1_i128 << f64::MANTISSA_DIGITS;
    if x.numer().abs() <= exact && *x.denom() <= exact {
        return *x.numer() as f64 / *x.denom() as f64;
    }
    decimal(x).parse().unwrap_or(f64::NAN)
}

fn decimal(x: Rational) -> String {
    let (numerator, denominator) = (x.numer().unsigned_abs(), x.denom().unsigned_abs());
    let sign = if *x.numer() < 0 { "-" } else { "" };
    let mut text = format!("{sign}{}.", numerator / denominator);
    let mut rest = numerator % denominator;
    let mut significant = 0;
    while rest != 0 && significant < 40 && text.len() < 400 {
        let digit = ten_times_over(&mut rest, denominator);
        significant += u32::from(digit != 0 || significant > 0);
        text.push(char::from(b'0' + digit));
    }
    text
}

/// The digit ⌊10 rest / denominator⌋, leaving the remainder in `rest`; `10 * rest` itself may not fit.
fn ten_times_over(rest: &mut u128, denominator: u128) -> u8 {
    let (mut digit, mut sum) = (0, 0_u128);
    for _ in 0..10 {
        if sum >= denominator - *rest {
            sum -= denominator - *rest;
            digit += 1;
        } else {
            sum += *rest;
        }
    }
    *rest = sum;
    digit
}
