//! Reduces polynomials by |q|² = 1 and q·q̇ = 0 of quaternions.

use std::collections::BTreeSet;

use num_traits::{One, Zero};

use super::atoms::{Atoms, Meaning};
use super::polynomial::{Atom, Monomial, Polynomial};
use crate::symbolic::Rational;
use crate::variables::Variable;

/// Four monomials, and their sum, which is zero or one.
type Relation = ([Monomial; 4], Rational);

impl Atoms {
    /// The polynomial where the four coordinates from `first` on have the length 1: powers of |q| are one, and multiples of
    /// |q|² − 1 and q·q̇ are subtracted where that leaves fewer terms.
    pub(super) fn on_sphere(&mut self, polynomial: Polynomial, first: usize) -> Option<Polynomial> {
        let one = Rational::one();
        let [q, v] = [Variable::Coordinate, Variable::Velocity].map(|variable: fn(usize) -> Variable| {
            [0, 1, 2, 3].map(|k| self.atom(Meaning::Variable(variable(first + k))))
        });
        let squares = q.map(|q| Monomial::of(q, Rational::from_integer(2)));
        let length = self.atom(Meaning::Sum(squares.iter().map(|square| (square.clone(), one)).collect()));
        let mut reduced = Polynomial::default();
        for (monomial, &c) in polynomial.terms() {
            reduced.push(monomial.filtered(|atom| atom != length), c)?;
        }
        let by_one = |atom: Atom| Monomial::of(atom, one);
        let rates = [0, 1, 2, 3].map(|k| by_one(q[k]).times(&by_one(v[k])).unwrap_or_default());
        let relations = [(squares, one), (rates, Rational::zero())];
        loop {
            let before = reduced.len();
            relations.iter().try_for_each(|relation| reduce(&mut reduced, relation))?;
            if reduced.len() == before {
                return Some(reduced);
            }
        }
    }
}

/// Subtracts the multiples of a relation that leave fewer terms.
fn reduce(polynomial: &mut Polynomial, relation: &Relation) -> Option<()> {
    let mut cofactors = BTreeSet::new();
    for (monomial, _) in polynomial.terms() {
        for part in relation.0.iter().filter(|part| monomial.shared(part) == **part) {
            cofactors.insert(monomial.over(part)?);
        }
    }
    cofactors.iter().try_for_each(|cofactor| subtract(polynomial, cofactor, relation))
}

/// Subtracts the multiple of cofactor · relation that leaves the fewest terms, if these are fewer than before.
fn subtract(polynomial: &mut Polynomial, cofactor: &Monomial, (parts, sum): &Relation) -> Option<()> {
    let products: Vec<Monomial> = parts.iter().map(|part| part.times(cofactor)).collect::<Option<_>>()?;
    let coefficient = |monomial: &Monomial| polynomial.coefficient(monomial).unwrap_or_default();
    let known: Vec<Rational> = products.iter().map(coefficient).collect();
    let beside = coefficient(cofactor);
    let terms = |c: Rational| {
        let left = known.iter().filter(|&&of_part| of_part != c).count();
        left + usize::from(beside != -c * sum)
    };
    let best = known.iter().copied().min_by_key(|&c| terms(c))?;
    if terms(best) < terms(Rational::zero()) {
        products.into_iter().try_for_each(|product| polynomial.push(product, -best))?;
        polynomial.push(cofactor.clone(), best * sum)?;
    }
    Some(())
}
