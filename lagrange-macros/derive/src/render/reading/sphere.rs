//! Reduces polynomials by |q|² = 1 and q·q̇ = 0 of quaternions.

use num_traits::{One, Zero};

use super::atoms::{Atoms, Meaning};
use super::relation::{Relation, reduce};
use crate::symbolic::{Monomial, Polynomial, Rational};
use crate::variables::Variable;

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
        let products = [0, 1, 2, 3].map(|k| Monomial::product(q[k], v[k]));
        let relation = |parts: [Monomial; 4], sum| {
            let parts = parts.into_iter().map(|part| (part, one)).collect();
            Relation { parts, sum: vec![(Monomial::default(), sum)] }
        };
        let relations = [relation(squares, one), relation(products, Rational::zero())];
        loop {
            let before = reduced.len();
            relations.iter().try_for_each(|relation| reduce(&mut reduced, relation))?;
            if reduced.len() == before {
                return Some(reduced);
            }
        }
    }
}
