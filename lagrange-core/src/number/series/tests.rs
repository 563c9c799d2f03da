//! Compares the sum of each series at small τ with the function of the summed argument.

use super::{PowerSeries, ROOM};
use crate::number::Scalar;

/// 0.7 + 0.3 τ − 0.2 τ² + 0.1 τ³
fn argument() -> PowerSeries<f64> {
    let mut coefficients = [0.0; ROOM];
    coefficients[..4].copy_from_slice(&[0.7, 0.3, -0.2, 0.1]);
    PowerSeries::new(&coefficients)
}

fn sum(series: &PowerSeries<f64>, tau: f64) -> f64 {
    series.coefficients().iter().rev().fold(0.0, |sum, c| sum * tau + c)
}

#[track_caller]
fn assert_is(series: PowerSeries<f64>, expected: impl Fn(f64) -> f64) {
    assert_eq!(series.coefficients().len(), ROOM);
    for tau in [-0.15, -0.05, 0.0, 0.08, 0.2] {
        let (ours, expected) = (sum(&series, tau), expected(sum(&argument(), tau)));
        assert!((ours - expected).abs() < 4e-15 * expected.abs().max(1.0), "at {tau}: {ours} {expected}");
    }
}

#[test]
fn functions_of_a_series_add_up_to_functions_of_its_sum() {
    let x = argument();
    assert_is(x.sin(), f64::sin);
    assert_is(x.cos(), f64::cos);
    assert_is(x.tan(), f64::tan);
    assert_is(x.asin(), f64::asin);
    assert_is(x.acos(), f64::acos);
    assert_is(x.atan(), f64::atan);
    assert_is(x.sinh(), f64::sinh);
    assert_is(x.cosh(), f64::cosh);
    assert_is(x.tanh(), f64::tanh);
    assert_is(x.exp(), f64::exp);
    assert_is(x.ln(), f64::ln);
    assert_is(x.sqrt(), f64::sqrt);
    assert_is((-x).abs(), f64::abs);
    assert_is(x / x.sin(), |x| x / x.sin());
    assert_is(x.sin() * x - x.exp(), |x| x.sin() * x - x.exp());
    assert_is(x.atan2(x.cos()), |x| x.atan2(x.cos()));
    assert_is(x.atan2(-x.cos()), |x| x.atan2(-x.cos()));
}

#[test]
fn powers_by_every_kind_of_exponent() {
    let x = argument();
    let constant = PowerSeries::<f64>::constant;
    for exponent in [0.0, 1.0, 3.0, 8.0, 9.0, 0.5, -2.0, 2.7] {
        assert_is(x.powf(constant(exponent)), |x| x.powf(exponent));
    }
    assert_is(x.powf(x.sin()), |x| x.powf(x.sin()));
    // (x − 0.7)³ with a base that is zero at τ = 0, and with a negative base.
    let base = x - constant(0.7);
    assert_is(base.powf(constant(3.0)), |x| (x - 0.7).powi(3));
    assert_is((base - x).powf(constant(3.0)), |_| -0.343);
}

#[test]
fn comparisons_go_by_the_value_at_the_start() {
    let (x, one) = (argument(), PowerSeries::constant(1.0));
    assert_eq!((x.min(one), x.max(x.exp())), (x, x.exp()));
    assert_eq!(x.max(one).coefficients()[..2], [1.0, 0.0]);
    assert_is(x.min(x), |x| x);
    let nan = PowerSeries::constant(f64::NAN);
    assert!(x.min(nan).coefficients()[0].is_nan());
}

/// Zero times infinity.
#[test]
fn what_is_zero_stays_so() {
    let nothing = PowerSeries::<f64>::constant(0.0);
    let product = nothing.zero_or_product(PowerSeries::constant(f64::INFINITY));
    assert_eq!(product, nothing);
}
