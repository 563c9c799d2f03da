//! Shortens polynomials by relations between their terms.

use std::collections::BTreeSet;

use num_traits::Zero;

use crate::symbolic::{Monomial, Polynomial, Rational};

/// A sum of terms that equals another sum. The coefficients are 1, −1 or, in `sum`, 0.
pub(super) struct Relation {
    pub(super) parts: Vec<(Monomial, Rational)>,
    pub(super) sum: Vec<(Monomial, Rational)>,
}

/// Subtracts the multiples of a relation that leave fewer terms.
pub(super) fn reduce(polynomial: &mut Polynomial, relation: &Relation) -> Option<()> {
    let mut cofactors = BTreeSet::new();
    for (monomial, _) in polynomial.terms() {
        for (part, _) in relation.parts.iter().filter(|(part, _)| monomial.shared(part) == *part) {
            cofactors.insert(monomial.over(part)?);
        }
    }
    cofactors.iter().try_for_each(|cofactor| subtract(polynomial, cofactor, relation))
}

/// Subtracts the multiple of cofactor · relation that leaves the fewest terms, if these are fewer than before.
fn subtract(
    polynomial: &mut Polynomial,
    cofactor: &Monomial,
    Relation { parts, sum }: &Relation,
) -> Option<()> {
    let sum = sum.iter().map(|(monomial, c)| (monomial, -c));
    let zero = parts.iter().map(|(monomial, c)| (monomial, *c)).chain(sum);
    let zero = zero.map(|(monomial, c)| Some((monomial.times(cofactor)?, c)));
    let zero = zero.collect::<Option<Vec<(Monomial, Rational)>>>()?;
    let coefficient = |monomial: &Monomial| polynomial.coefficient(monomial).unwrap_or_default();
    let terms = |by: Rational| zero.iter().filter(|(monomial, c)| coefficient(monomial) != by * c).count();
    let multiples = zero[..parts.len()].iter().map(|(monomial, c)| coefficient(monomial) / c);
    let best = multiples.min_by_key(|&by| terms(by))?;
    if terms(best) < terms(Rational::zero()) {
        zero.into_iter().try_for_each(|(monomial, c)| polynomial.push(monomial, -best * c))?;
    }
    Some(())
}
