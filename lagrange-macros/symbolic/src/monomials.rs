//! Sums of products of powers, with rational coefficients and rational exponents.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

use num_traits::{One, Signed, Zero};

use crate::{Rational, plus, times};

/// Indivisible factor: a name, or a function of an argument. Its user knows its meaning.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Atom(pub u32);

/// Π atom ^ exponent, sorted by atom, without zero exponents.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
pub struct Monomial(Vec<(Atom, Rational)>);

impl Monomial {
    pub fn of(atom: Atom, exponent: Rational) -> Self {
        Self(vec![(atom, exponent)])
    }

    /// Product of two different atoms.
    pub fn product(one: Atom, other: Atom) -> Self {
        let [first, second] = if one < other { [one, other] } else { [other, one] };
        Self(vec![(first, Rational::one()), (second, Rational::one())])
    }

    pub fn factors(&self) -> &[(Atom, Rational)] {
        &self.0
    }

    pub fn is_one(&self) -> bool {
        self.0.is_empty()
    }

    pub fn exponent(&self, atom: Atom) -> Rational {
        let place = self.0.binary_search_by_key(&atom, |&(known, _)| known);
        place.map_or(Rational::zero(), |place| self.0[place].1)
    }

    pub fn times(&self, other: &Self) -> Option<Self> {
        let mut factors = self.0.clone();
        for &(atom, exponent) in &other.0 {
            match factors.binary_search_by_key(&atom, |&(known, _)| known) {
                Ok(place) => factors[place].1 = plus(factors[place].1, exponent)?,
                Err(place) => factors.insert(place, (atom, exponent)),
            }
        }
        factors.retain(|(_, exponent)| !exponent.is_zero());
        Some(Self(factors))
    }

    pub fn power(&self, exponent: Rational) -> Option<Self> {
        let factors = self.0.iter().map(|&(atom, inner)| Some((atom, times(inner, exponent)?)));
        factors.collect::<Option<_>>().map(Self)
    }

    pub fn has_divisor(&self) -> bool {
        self.0.iter().any(|(_, exponent)| exponent.is_negative())
    }

    /// Returns whether all exponents are negative.
    pub fn is_divisor(&self) -> bool {
        self.0.iter().all(|(_, exponent)| exponent.is_negative())
    }

    pub fn over(&self, other: &Self) -> Option<Self> {
        self.times(&other.power(-Rational::one())?)
    }

    /// Common factor of two monomials: for each atom with exponents of the same sign in both, the smaller power.
    pub fn shared(&self, other: &Self) -> Self {
        let factors = self.0.iter().filter_map(|&(atom, one)| {
            let two = other.exponent(atom);
            let exponent = if one.abs() < two.abs() { one } else { two };
            (one.is_positive() == two.is_positive() && !two.is_zero()).then_some((atom, exponent))
        });
        Self(factors.collect())
    }

    /// Divisor of two monomials that leaves no negative exponents: for each atom, the smaller exponent of the two.
    pub fn divisor(&self, other: &Self) -> Self {
        let atoms: BTreeSet<Atom> = self.0.iter().chain(&other.0).map(|&(atom, _)| atom).collect();
        let smaller = atoms.into_iter().map(|atom| (atom, self.exponent(atom).min(other.exponent(atom))));
        Self(smaller.filter(|(_, exponent)| !exponent.is_zero()).collect())
    }

    /// Lexicographic order of the exponents, which multiplication preserves.
    fn by_powers(&self, other: &Self) -> Ordering {
        let atoms = self.0.iter().chain(&other.0).map(|&(atom, _)| atom);
        let differ = |atom: &Atom| self.exponent(*atom) != other.exponent(*atom);
        let first = atoms.filter(differ).min();
        first.map_or(Ordering::Equal, |atom| self.exponent(atom).cmp(&other.exponent(atom)))
    }

    /// Product of the factors whose atoms `keep` accepts.
    pub fn filtered(&self, keep: impl Fn(Atom) -> bool) -> Self {
        Self(self.0.iter().copied().filter(|&(atom, _)| keep(atom)).collect())
    }
}

/// Σ coefficient · monomial, without zero coefficients.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
pub struct Polynomial(BTreeMap<Monomial, Rational>);

impl Polynomial {
    pub fn number(value: Rational) -> Self {
        Self::term(Monomial::default(), value)
    }

    pub fn atom(atom: Atom) -> Self {
        Self::term(Monomial::of(atom, Rational::one()), Rational::one())
    }

    pub fn term(monomial: Monomial, coefficient: Rational) -> Self {
        Self([(monomial, coefficient)].into_iter().filter(|(_, c)| !c.is_zero()).collect())
    }

    pub fn terms(&self) -> impl ExactSizeIterator<Item = (&Monomial, &Rational)> {
        self.0.iter()
    }

    pub fn len(&self) -> usize {
        self.0.len()
    }

    pub fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// Monomial and coefficient, if the polynomial has a single term.
    pub fn single(&self) -> Option<(&Monomial, Rational)> {
        self.0.iter().next().filter(|_| self.len() == 1).map(|(monomial, &c)| (monomial, c))
    }

    pub fn coefficient(&self, monomial: &Monomial) -> Option<Rational> {
        self.0.get(monomial).copied()
    }

    /// Adds a term; `None` if the coefficient overflows.
    pub fn push(&mut self, monomial: Monomial, coefficient: Rational) -> Option<()> {
        let sum = plus(self.coefficient(&monomial).unwrap_or_default(), coefficient)?;
        if sum.is_zero() {
            self.0.remove(&monomial)
        } else {
            self.0.insert(monomial, sum)
        };
        Some(())
    }

    pub fn remove(&mut self, monomial: &Monomial) {
        self.0.remove(monomial);
    }

    /// Adds factor · other; `None` if a coefficient overflows.
    pub fn add(&mut self, other: &Self, factor: Rational) -> Option<()> {
        other.0.iter().try_for_each(|(monomial, &c)| self.push(monomial.clone(), times(c, factor)?))
    }

    pub fn negated(&self) -> Self {
        Self(self.0.iter().map(|(monomial, &c)| (monomial.clone(), -c)).collect())
    }

    /// Multiplies by one term.
    pub fn scaled(&self, monomial: &Monomial, coefficient: Rational) -> Option<Self> {
        let terms = self.0.iter().map(|(own, &c)| Some((own.times(monomial)?, times(c, coefficient)?)));
        terms.collect::<Option<_>>().map(Self)
    }

    pub fn times(&self, other: &Self) -> Option<Self> {
        let mut product = Self::default();
        for (monomial, &c) in &other.0 {
            product.add(&self.scaled(monomial, c)?, Rational::one())?;
        }
        Some(product)
    }

    /// Returns whether the first nonconstant term is negative. This holds for exactly one of p and −p.
    pub fn leads_negative(&self) -> bool {
        let lead = self.0.iter().find(|(monomial, _)| !monomial.is_one()).or_else(|| self.0.iter().next());
        lead.is_some_and(|(_, c)| c.is_negative())
    }

    /// The shortest sum, of two terms at least, that one product of factors that `is_kept` accepts is multiplied by; without
    /// common factors, and with a positive first term.
    pub fn cofactor(&self, is_kept: impl Fn(Atom) -> bool) -> Option<Self> {
        let mut cofactors: BTreeMap<Monomial, Self> = BTreeMap::new();
        for (monomial, &c) in self.terms() {
            let kept = monomial.filtered(&is_kept);
            cofactors.entry(kept.clone()).or_default().push(monomial.over(&kept)?, c)?;
        }
        let shortest = cofactors.into_values().min_by_key(Self::len).filter(|shortest| shortest.len() > 1)?;
        let (number, monomial) = shortest.content();
        let number = if shortest.terms().next()?.1.is_negative() { -number } else { number };
        shortest.scaled(&monomial.power(-Rational::one())?, number.recip())
    }

    /// Positive common factor of all coefficients, and common factor of all monomials.
    pub fn content(&self) -> (Rational, Monomial) {
        let number = common(self.0.values().copied());
        let mut monomials = self.0.keys();
        let first = monomials.next().cloned().unwrap_or_default();
        (number, monomials.fold(first, |shared, monomial| shared.shared(monomial)))
    }

    pub fn has_fraction(&self) -> bool {
        self.0.keys().any(Monomial::has_divisor)
    }

    /// Least common denominator of all coefficients; `None` if it overflows.
    pub fn denominators(&self) -> Option<Rational> {
        let common = |least: i128, c: &Rational| (least / divisor(least, *c.denom())).checked_mul(*c.denom());
        self.0.values().try_fold(1, common).map(Rational::from_integer)
    }

    /// Term with the greatest monomial.
    fn lead(&self) -> Option<(&Monomial, Rational)> {
        let greatest = self.0.iter().max_by(|(one, _), (two, _)| one.by_powers(two));
        greatest.map(|(monomial, &c)| (monomial, c))
    }

    /// Quotient, if the division is exact: long division by the greatest monomials.
    pub fn divided(&self, divisor: &Self) -> Option<Self> {
        let (lead, by) = divisor.lead()?;
        let (mut rest, mut quotient) = (self.clone(), Self::default());
        for _ in 0..self.len() {
            let Some((monomial, c)) = rest.lead() else { break };
            let (monomial, c) = (monomial.over(lead)?, times(c, by.recip())?);
            rest.add(&divisor.scaled(&monomial, c)?, -Rational::one())?;
            quotient.push(monomial, c)?;
        }
        rest.is_zero().then_some(quotient)
    }
}

impl FromIterator<(Monomial, Rational)> for Polynomial {
    /// The monomials must differ from each other.
    fn from_iter<I: IntoIterator<Item = (Monomial, Rational)>>(terms: I) -> Self {
        Self(terms.into_iter().collect())
    }
}

/// Greatest common divisor of the numerators over that of the denominators: all coefficients are multiples of it, with
/// no larger numerators or denominators than before. Examples: 2 for 4 and 6, ½ for ½ and 3/2, 1 for ½ and 1.
pub fn common(coefficients: impl Iterator<Item = Rational>) -> Rational {
    let (above, below) = coefficients
        .fold((0, 0), |(above, below), c| (divisor(*c.numer(), above), divisor(*c.denom(), below)));
    if above == 0 { Rational::one() } else { Rational::new(above, below) }
}

/// Greatest common divisor by Euclid's algorithm.
fn divisor(x: i128, y: i128) -> i128 {
    if y == 0 { x.abs() } else { divisor(y, x % y) }
}
