//! Arithmetic with numbers of more digits than fit.
//!
//! Such a number is rounded once, to the nearest `f64`, and has an error bound from then on, which sums, products and powers
//! of it inherit. A sum that its bound does not tell from zero is zero, so what cancels exactly still does. Every other number
//! is exact, and no term of it is lost.

use num_traits::{Signed, Zero};
use rustc_hash::FxHashMap;

use super::rational::Rational;
use super::scaled::Scaled;
use super::wide::to_f64;

/// Relative error of a number that was rounded: half a unit in the last place of an `f64`, and again as much between that and
/// its shortest decimal.
const UNIT: f64 = f64::EPSILON;

/// Numerators and denominators of up to six digits are exact: a rounded number that has so few is what was meant.
const SHORT: u128 = 1_000_000;

/// The relative errors of the numbers that are not exact, by their digits.
#[derive(Default, Debug)]
pub(super) struct Roundings(FxHashMap<Rational, f64>);

impl Roundings {
    /// How many numbers are not exact.
    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    pub(super) fn extend(&mut self, other: &Self) {
        other.0.iter().for_each(|(&digits, &error)| self.note_digits(digits, error));
    }

    /// The relative error of a number.
    pub(super) fn error(&self, number: Scaled) -> f64 {
        match self.0.is_empty() {
            true => 0.0,
            false => self.0.get(&digits(number)).copied().unwrap_or(0.0),
        }
    }

    /// Notes the relative error of a number.
    fn note(&mut self, number: Scaled, error: f64) {
        if error > 0.0 {
            self.note_digits(digits(number), error);
        }
    }

    /// A number that comes about again, as c (1/c) c does, is the one that it was: its error does not grow.
    fn note_digits(&mut self, digits: Rational, error: f64) {
        if digits.numer().unsigned_abs().max(digits.denom().unsigned_abs()) >= SHORT {
            self.0.entry(digits).or_insert(error);
        }
    }

    /// The product, rounded where its digits do not fit.
    pub(super) fn times(&mut self, x: Scaled, y: Scaled) -> Option<Scaled> {
        let (product, own) = times(x, y)?;
        let error = own + self.error(x) + self.error(y);
        self.note(product, error);
        Some(product)
    }

    /// The sum, rounded where its digits do not fit and it is not two terms; zero where its error bound does not tell.
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

    /// Notes that `power` is what `value` to this exponent comes to.
    pub(super) fn note_power(&mut self, power: Scaled, value: Rational, exponent: Rational) {
        let error = self.error(value.into()) * to_f64(exponent).abs();
        self.note(power, error);
    }
}

/// A number without its sign and its power of ten.
fn digits(number: Scaled) -> Rational {
    number.apart().unwrap_or(number).fraction.abs()
}

/// The product and the relative error of its rounding; `None` beyond the range of `f64`.
pub(super) fn times(x: Scaled, y: Scaled) -> Option<(Scaled, f64)> {
    x.times(y).map(|product| (product, 0.0)).or_else(|| Some((x.times_rounded(y)?, UNIT)))
}
