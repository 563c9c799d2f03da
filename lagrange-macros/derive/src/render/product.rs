//! Products without products in them: p²/(2 (m l²)) reads as p²/(2 m l²), and m ((l + x)²)² as m (l + x)⁴.

use num_traits::{One, Zero};

use super::derived::power;
use super::formula::Formula;
use super::length::length;
use crate::symbolic::{Rational, Scaled, plus, times};

/// Number · Π base ^ exponent, without zero exponents.
struct Factors {
    number: Scaled,
    powers: Vec<(Formula, Rational)>,
}

impl Formula {
    /// Product number · above / below. Factors that are products or powers are taken apart, and equal ones put together.
    pub(super) fn flat_product(number: Scaled, above: Vec<Self>, below: Vec<Self>) -> Self {
        let mut factors = Factors { number, powers: Vec::new() };
        above.into_iter().for_each(|factor| factors.multiply(factor, Rational::one()));
        below.into_iter().for_each(|factor| factors.multiply(factor, -Rational::one()));
        let (above, below): (Vec<_>, Vec<_>) =
            factors.powers.into_iter().partition(|(_, exponent)| *exponent > Rational::zero());
        let powers = |side: Vec<(Self, Rational)>| {
            let power = |(base, exponent): (Self, Rational)| power(base, num_traits::abs(exponent));
            side.into_iter().map(power).collect()
        };
        Self::product(factors.number, powers(above), powers(below))
    }

    /// A fraction of a sum, as the sum of the fractions of its terms if these cancel to no more symbols: p²/(2 A) + q²/(2 C) for
    /// (C p² + A q²)/(2 A C).
    pub(super) fn by_terms(self) -> Self {
        let Self::Product(above, below) = &self else { return self };
        let (sums, others): (Vec<&Self>, Vec<&Self>) =
            above.iter().partition(|factor| matches!(factor, Self::Sum(_)));
        let [Self::Sum(terms)] = sums[..] else { return self };
        let fraction = |term: &Self| {
            let above = others.iter().copied().chain([term]).cloned().collect();
            Self::flat_product(Rational::one().into(), above, below.clone())
        };
        let apart = Self::Sum(terms.iter().map(fraction).collect());
        if !below.is_empty() && length(&apart) <= length(&self) { apart } else { self }
    }
}

impl Factors {
    /// Multiplies by factor ^ exponent. Only integer powers are taken apart: √(x²) is not x.
    fn multiply(&mut self, factor: Formula, exponent: Rational) {
        match factor {
            Formula::Negative(inner) if exponent.is_integer() => {
                let is_odd = exponent.numer() % 2 != 0;
                self.number.fraction = if is_odd { -self.number.fraction } else { self.number.fraction };
                self.multiply(*inner, exponent);
            }
            Formula::Product(above, below) if exponent.is_integer() => {
                above.into_iter().for_each(|factor| self.multiply(factor, exponent));
                below.into_iter().for_each(|factor| self.multiply(factor, -exponent));
            }
            Formula::Number(value) if exponent.is_integer() => self.scale(value, exponent),
            Formula::Power(base, inner) => match (*inner, exponent.is_integer()) {
                (Formula::Number(inner), true) if times(inner, exponent).is_some() => {
                    self.multiply(*base, inner * exponent);
                }
                (inner, _) => self.join(Formula::Power(base, Box::new(inner)), exponent),
            },
            factor => self.join(factor, exponent),
        }
    }

    fn scale(&mut self, value: Rational, exponent: Rational) {
        let power = Scaled::from(value).power(*exponent.numer());
        match power.and_then(|power| self.number.times(power)) {
            Some(number) => self.number = number,
            None => self.join(Formula::Number(value), exponent),
        }
    }

    fn join(&mut self, base: Formula, exponent: Rational) {
        let known = self.powers.iter().position(|(known, _)| *known == base);
        let joined = known.and_then(|place| Some((place, plus(self.powers[place].1, exponent)?)));
        let exponent = joined.map_or(exponent, |(place, sum)| {
            self.powers.remove(place);
            sum
        });
        if !exponent.is_zero() {
            self.powers.push((base, exponent));
        }
    }
}
