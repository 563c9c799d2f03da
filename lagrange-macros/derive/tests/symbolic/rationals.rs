//! Decimal literals: each becomes the nearest f64.

use proptest::prelude::*;

use super::{Outcome, for_all, graph, rational, value};
use lagrange_symbolic::{Graph, Id, Rational, Scaled, parse_decimal, to_f64};

/// Decimals such as `12_345.678e9`, without sign, as tokens have none.
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

/// Tests all literals within the normal range of f64.
#[test]
fn a_literal_becomes_the_nearest_f64() {
    for_all(6000, 0.9, decimals(-330..330), |text| {
        let expected = text.parse::<f64>().expect("a number");
        let Some(value) = parse_decimal(&text) else {
            prop_assert!(!expected.is_normal(), "{}", text);
            return Ok(Outcome::Skipped);
        };
        prop_assert_eq!(value.to_f64().to_bits(), expected.to_bits(), "{}", text);
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
        assert_eq!(parse_decimal(text), Some(Rational::new(numerator, denominator).into()), "{text}");
    }
    for (text, (numerator, denominator), exponent) in [
        ("1e39", (1, 1), 39),
        ("1e-39", (1, 1), -39),
        ("100000000000000000000000000000000000000000", (1, 1), 41),
        ("0.0000000000000000000000000000000006626070150", (662_607_015, 100_000_000), -34),
        ("6.62607015e-34", (662_607_015, 100_000_000), -34),
        ("662607015e-42", (662_607_015, 100_000_000), -34),
        ("1.7e308", (17, 10), 308),
    ] {
        let fraction = Rational::new(numerator, denominator);
        assert_eq!(parse_decimal(text), Some(Scaled { fraction, exponent }), "{text}");
    }
    // Literals with more digits than fit are rounded to the nearest f64.
    assert_eq!(
        parse_decimal("170141183460469231731687303715884105728").map(Scaled::to_f64),
        Some(2.0_f64.powi(127))
    );
    let refused = ["1.8e308", "1e-308", "5e-324", "1e-400", "1e99999999999"];
    for text in refused {
        assert_eq!(parse_decimal(text), None, "{text}");
    }
}

/// Decimal expansion; it is finite if the denominator is a product of twos and fives.
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

/// Fractions that differ very little from the midpoint of two adjacent f64.
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

/// A difference from the midpoint that appears only after the fortieth digit.
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

/// The power of ten is below the normal range of f64, the number itself is not.
#[test]
fn what_is_in_range_is_exact_whatever_its_power_of_ten_is() {
    let fraction = Rational::new(i128::MAX, 8_160_523_013_533_753_617_575_794_477_336);
    let value = Scaled { fraction, exponent: -312 }.to_f64();
    assert!((value / 2.084_929_889_644_327_4e-305 - 1.0).abs() < 2.0 * f64::EPSILON, "{value:e}");
    let value = Scaled { fraction: Rational::new(1, 3 * 10_i128.pow(20)), exponent: 315 }.to_f64();
    assert!((value / (1e295 / 3.0) - 1.0).abs() < 2.0 * f64::EPSILON, "{value:e}");
}

fn read(graph: &mut Graph, text: &str) -> Id {
    graph.scaled(parse_decimal(text).expect("a number"))
}

/// Planck, Boltzmann, Avogadro: powers, quotients, roots and sums of the constants, compared with f64.
#[test]
fn constants_of_nature() {
    let (mut graph, [x, ..]) = graph();
    let [h, k, n, c] =
        ["6.62607015e-34", "1.380649e-23", "6.02214076e23", "299792458"].map(|text| read(&mut graph, text));
    assert_eq!(value(&graph, h).to_bits(), 6.62607015e-34_f64.to_bits());
    assert_eq!(value(&graph, n).to_bits(), 6.02214076e23_f64.to_bits());
    let (squared, gas) = (graph.square(h), graph.mul(k, n));
    let pi = graph.pi();
    let radiation = graph.product([
        (h, rational(-3, 1)),
        (c, rational(-2, 1)),
        (k, rational(4, 1)),
        (pi, rational(5, 1)),
    ]);
    let sum = graph.add(Id::ONE, h);
    let root = graph.sqrt(h);
    for (id, expected) in [
        (squared, 6.62607015e-34_f64.powi(2)),
        (gas, 1.380649e-23 * 6.02214076e23),
        (
            radiation,
            1.380649e-23_f64.powi(4) * std::f64::consts::PI.powi(5)
                / (6.62607015e-34_f64.powi(3) * 299_792_458.0_f64.powi(2)),
        ),
        (sum, 1.0),
        (root, 6.62607015e-34_f64.sqrt()),
    ] {
        // One rounding for each of at most 20 operations.
        assert!((value(&graph, id) / expected - 1.0).abs() < 20.0 * f64::EPSILON, "{expected:e}");
    }
    assert!(graph.take_fault().is_none());
    // Exact numbers stay exact, like terms are collected, and tiny numbers are not zero.
    let twice = graph.sum([(h, rational(1, 1)), (h, rational(1, 1))]);
    assert_eq!(twice, read(&mut graph, "1.32521403e-33"));
    assert_eq!(graph.sum([(h, rational(3, 1)), (h, rational(-3, 1))]), Id::ZERO);
    assert_eq!(graph.sub(sum, Id::ONE), h);
    assert_eq!(graph.sub(sum, h), Id::ONE);
    assert_eq!(graph.div(h, h), Id::ONE);
    assert_eq!(graph.div(squared, h), h);
    let (one, other) = (graph.mul(squared, x), graph.mul(h, x));
    assert_eq!(graph.mul(h, other), one);
    assert_eq!(gas, graph.number(Rational::new(831_446_261_815_324, 100_000_000_000_000)));
    assert_ne!(graph.add(sum, x), graph.add(Id::ONE, x));
}

/// Sums and products of numbers of any magnitude, compared with a computation in sufficiently many digits.
#[test]
fn scaled_numbers_compute_as_floating_point_does() {
    let number = || (1..1_000_000_i128, -90..90_i32);
    for_all(4000, 0.9, (number(), number(), number()), |numbers| {
        let (mut graph, [x, ..]) = graph();
        let ((a, ea), (b, eb), (c, ec)) = numbers;
        let [p, q, r] = [(a, ea), (b, eb), (c, ec)].map(|(digits, exponent)| {
            graph.scaled(Scaled::new(rational(digits, 1), exponent).expect("in range"))
        });
        let [u, v, w] = [(a, ea), (b, eb), (c, ec)]
            .map(|(digits, exponent)| format!("{digits}e{exponent}").parse::<f64>().expect("a number"));
        // (p + q) r = p r + q r, term by term, in any order.
        let (pr, qr) = (graph.mul(p, r), graph.mul(q, r));
        let (one, other) = (graph.add(pr, qr), graph.add(qr, pr));
        prop_assert_eq!(one, other);
        let all = graph.sum([(one, rational(1, 1)), (pr, rational(-1, 1)), (qr, rational(-1, 1))]);
        prop_assert_eq!(all, Id::ZERO);
        let (px, qx) = (graph.mul(p, x), graph.mul(q, x));
        let along = graph.sum([(px, rational(1, 1)), (qx, rational(1, 1))]);
        prop_assert_eq!(graph.sum([(along, rational(1, 1)), (px, rational(-1, 1))]), qx);
        if graph.take_fault().is_some() {
            return Ok(Outcome::Skipped);
        }
        let expected = u * w + v * w;
        prop_assert!(
            (value(&graph, one) / expected - 1.0).abs() < 8.0 * f64::EPSILON,
            "{} {}",
            value(&graph, one),
            expected
        );
        Ok(Outcome::Checked)
    });
}
