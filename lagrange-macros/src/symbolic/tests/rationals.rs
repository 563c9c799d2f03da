//! Decimal literals in, the nearest f64 out.

use proptest::prelude::*;

use super::super::{Rational, parse_decimal, to_f64};
use super::{Outcome, for_all};

/// `-12_345.678e9` and the like: signless, as the tokens are.
fn decimals(exponent: std::ops::Range<i32>) -> impl Strategy<Value = String> {
    let digits = |length| proptest::string::string_regex(&format!("[0-9]{{1,{length}}}")).expect("a pattern");
    (digits(20), prop::option::of(digits(14)), prop::option::of(exponent), any::<bool>()).prop_map(
        |(whole, fraction, exponent, upper)| {
            let fraction = fraction.map(|digits| format!(".{digits}")).unwrap_or_default();
            let e = if upper { 'E' } else { 'e' };
            let exponent = exponent.map(|exponent| format!("{e}{exponent}")).unwrap_or_default();
            format!("{whole}{fraction}{exponent}")
        },
    )
}

#[test]
fn a_literal_becomes_the_nearest_f64() {
    for_all(3000, 0.6, decimals(-26..26), |text| {
        let Some(value) = parse_decimal(&text) else { return Ok(Outcome::Skipped) };
        prop_assert_eq!(to_f64(value), text.parse::<f64>().expect("a number"), "{}", text);
        Ok(Outcome::Checked)
    });
}

#[test]
fn a_literal_of_any_size_is_exact_or_refused() {
    for_all(2000, 0.0, decimals(-300..300), |text| {
        if let Some(value) = parse_decimal(&text) {
            prop_assert_eq!(to_f64(value), text.parse::<f64>().expect("a number"), "{}", text);
        }
        Ok(Outcome::Checked)
    });
}

#[test]
fn literals_are_exact() {
    let cases = [
        ("1_000", (1000, 1)),
        ("9.81", (981, 100)),
        ("5.", (5, 1)),
        ("0.50", (1, 2)),
        ("6.02e23", (602_000_000_000_000_000_000_000, 1)),
        ("1.380649e-23", (1_380_649, 10_i128.pow(29))),
        ("2E3", (2000, 1)),
        ("1e+2", (100, 1)),
        ("0e0", (0, 1)),
        ("1.0000000000000000000000000000000000000000000", (1, 1)),
        ("170141183460469231731687303715884105727", (i128::MAX, 1)),
    ];
    for (text, (numerator, denominator)) in cases {
        assert_eq!(parse_decimal(text), Some(Rational::new(numerator, denominator)), "{text}");
    }
    for text in
        ["170141183460469231731687303715884105728", "1e39", "1e-39", "1e300", "1e-300", "1e99999999999"]
    {
        assert_eq!(parse_decimal(text), None, "{text}");
    }
}

/// The decimal expansion, which ends where the denominator is a product of twos and fives.
fn expansion(numerator: i128, denominator: i128) -> String {
    let mut text = format!("{}.", numerator / denominator);
    let mut rest = numerator % denominator;
    while rest != 0 {
        rest *= 10;
        text.push_str(&(rest / denominator).to_string());
        rest %= denominator;
    }
    text
}

/// Fractions that lie by a hair beside the middle of two neighbours in f64.
#[test]
fn fractions_are_rounded_once() {
    let mantissa = (1_i128 << 53..1 << 54).prop_map(|m| m | 1);
    for_all(2000, 1.0, (mantissa, 0..50_u32, 0..7_u32, -1..=1_i128), |(middle, shift, fives, hair)| {
        let scale = 5_i128.pow(fives);
        let (numerator, denominator) = (middle * scale + hair, scale << shift);
        let expected: f64 = expansion(numerator, denominator).parse().expect("a number");
        for (sign, expected) in [(1, expected), (-1, -expected)] {
            let value = Rational::new(sign * numerator, denominator);
            prop_assert_eq!(to_f64(value), expected, "{}", value);
        }
        Ok(Outcome::Checked)
    });
}

/// A hair that shows only past the fortieth digit.
#[test]
fn a_very_thin_hair_counts() {
    let (numerator, denominator) = (((1_i128 << 53) + 1) * 5_i128.pow(30) + 1, 5_i128.pow(30));
    let expected: f64 = expansion(numerator, denominator).parse().expect("a number");
    assert_eq!(to_f64(Rational::new(numerator, denominator)), expected);
    assert_eq!(expected, 9_007_199_254_740_994.0);
    let tiny = Rational::new((1 << 54) + 1, 1 << 124);
    assert_eq!(to_f64(tiny), f64::from_bits(0x3b90_0000_0000_0000));
}

#[test]
fn the_largest_fractions_have_values() {
    assert_eq!(to_f64(Rational::new(i128::MAX, 1)), 2.0_f64.powi(127));
    assert_eq!(to_f64(Rational::new(-i128::MAX, 1)), -(2.0_f64.powi(127)));
    assert_eq!(to_f64(Rational::new(1, i128::MAX)), 2.0_f64.powi(-127));
    assert_eq!(to_f64(Rational::new(i128::MAX - 1, i128::MAX)), 1.0);
    assert_eq!(to_f64(Rational::new(0, 1)).to_bits(), 0);
}
