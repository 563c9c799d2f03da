//! Arithmetic with numbers that have too many digits for exact fractions.
//!
//! Such a number is rounded once, to the nearest `f64`. From then on it has an error bound, which sums, products and
//! powers inherit. A sum within its error bound is zero, so that exact cancellation is preserved. All other numbers
//! are exact, and none of their terms is lost.

use num_traits::{Signed, Zero};
use rustc_hash::FxHashMap;

use super::rational::Rational;
use super::scaled::Scaled;
use super::wide::to_f64;

/// Relative error of a rounded number: half a unit in the last place of an `f64`, and as much again between the `f64`
/// and its shortest decimal.
const UNIT: f64 = f64::EPSILON;

/// Numbers with numerator and denominator below this bound, at most six digits, count as exact: a rounded number that
/// short is taken as intended.
const SHORT: u128 = 1_000_000;

/// Relative errors of the inexact numbers, by digits (without sign and power of ten).
#[derive(Default, Debug)]
pub(super) struct Roundings(FxHashMap<Rational, f64>);

impl Roundings {
    /// Number of distinct inexact numbers whose relative error is recorded.
    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    pub(super) fn extend(&mut self, other: &Self) {
        other.0.iter().for_each(|(&digits, &error)| self.note_digits(digits, error));
    }

    /// Relative error of a number; 0 for exact numbers.
    pub(super) fn error(&self, number: Scaled) -> f64 {
        match self.0.is_empty() {
            true => 0.0,
            false => self.0.get(&digits(number)).copied().unwrap_or(0.0),
        }
    }

    /// Records the relative error of a number.
    fn note(&mut self, number: Scaled, error: f64) {
        if error > 0.0 {
            self.note_digits(digits(number), error);
        }
    }

    /// Records an error unless one is known: a number that occurs again, as in c (1/c) c, keeps its first error.
    fn note_digits(&mut self, digits: Rational, error: f64) {
        if digits.numer().unsigned_abs().max(digits.denom().unsigned_abs()) >= SHORT {
            self.0.entry(digits).or_insert(error);
        }
    }

    /// Product, rounded if its digits do not fit; `None` beyond the range of `f64`.
    pub(super) fn times(&mut self, x: Scaled, y: Scaled) -> Option<Scaled> {
        let (product, own) = times(x, y)?;
        let error = own + self.error(x) + self.error(y);
        self.note(product, error);
        Some(product)
    }

    /// Sum, rounded if its digits do not fit; zero if it is within its error bound. `None` if the numbers must stay
    /// two terms.
    pub(super) fn plus(&mut self, x: Scaled, y: Scaled) -> Option<Scaled> {
        let (sum, own) = match x.plus(y) {
            Some(sum) => (sum, 0.0),
            None => (x.plus_rounded(y)?, UNIT),
        };
        let inherited = [x, y].map(|part| (self.error(part), part));
        if own == 0.0 && inherited.iter().all(|(error, _)| *error == 0.0) {
            return Some(sum);
        }
        let error: f64 = inherited.iter().map(|(error, part)| error * part.to_f64().abs()).sum();
        let size = sum.to_f64().abs();
        if size <= error {
            return Some(Rational::zero().into());
        }
        self.note(sum, own + error / size);
        Some(sum)
    }

    /// Records the error of `power`, which is `value` to the given exponent.
    pub(super) fn note_power(&mut self, power: Scaled, value: Rational, exponent: Rational) {
        let error = self.error(value.into()) * to_f64(exponent).abs();
        self.note(power, error);
    }
}

/// The number without sign and power of ten.
fn digits(number: Scaled) -> Rational {
    number.apart().unwrap_or(number).fraction.abs()
}

/// Product and the relative error of its rounding; `None` beyond the range of `f64`.
pub(super) fn times(x: Scaled, y: Scaled) -> Option<(Scaled, f64)> {
    x.times(y).map(|product| (product, 0.0)).or_else(|| Some((x.times_rounded(y)?, UNIT)))
}
