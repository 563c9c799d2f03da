//! Recognizes squares of sums: (p − e A)² in p·p − 2 e p·A + e² A·A, and (x − l)² in x² − 2 l x + l².

use num_traits::{One, Signed, Zero};

use super::super::formula::Formula;
use super::super::length::length;
use super::atoms::Meaning;
use super::collect::{Collector, TermOrder};
use super::dependence::is_velocity;
use super::group::Group;
use super::vectors::VectorTerm;
use crate::symbolic::{self, Monomial, Polynomial, Rational, common, square_root};
use crate::variables::Variable;

impl Collector<'_, '_> {
    /// Groups of three terms that are the square of a sum of two.
    pub(super) fn squares<'s>(&'s self, all: &'s Polynomial) -> impl Iterator<Item = Group> + 's {
        let pairs = all.terms().flat_map(move |one| all.terms().map(move |two| (one, two)));
        pairs
            .filter(|((one, _), (two, _))| one < two)
            .filter_map(move |(one, two)| self.square(all, [one, two]))
    }

    fn square(&self, all: &Polynomial, ends: [(&Monomial, &Rational); 2]) -> Option<Group> {
        let [(one, &c), (two, &d)] = ends;
        (c.is_positive() == d.is_positive()).then_some(())?;
        let middle = one.times(two)?.power(Rational::new_raw(1, 2))?;
        let between = all.coefficient(&middle)?;
        let twice = symbolic::times(between, Rational::new_raw(1, 2))?;
        (symbolic::times(twice, twice)? == symbolic::times(c, d)?).then_some(())?;
        let monomial = one.divisor(two);
        let content = common([c, d].into_iter());
        let root = |c: Rational, number: Rational| square_root(symbolic::times(c.abs(), number.recip())?);
        let number =
            [content, c.abs()].into_iter().find(|&n| root(c, n).is_some() && root(d, n).is_some())?;
        let first = one.over(&monomial)?.power(Rational::new_raw(1, 2))?;
        let second = two.over(&monomial)?.power(Rational::new_raw(1, 2))?;
        [&first, &second].into_iter().all(is_whole).then_some(())?;
        let is_minus = between.is_positive() != c.is_positive();
        let mut quotient = Polynomial::term(first.clone(), root(c, number)?);
        quotient.push(second, signed(root(d, number)?, is_minus))?;
        let leads = self.place(&first, Rational::one())
            < self.place(quotient.terms().map(|(m, _)| m).find(|m| **m != first)?, Rational::one());
        let is_turned =
            self.is_turned(&quotient) || is_minus && !leads && !self.is_turned(&quotient.negated());
        let quotient = if is_turned { quotient.negated() } else { quotient };
        let members = vec![one.clone(), middle.clone(), two.clone()];
        let number = signed(number, c.is_negative());
        let mut group = Group {
            members,
            number,
            monomial,
            quotient,
            is_square: true,
            constants: None,
            saving: 0,
            size: 0,
        };
        let before: isize =
            [(one, c), (&middle, between), (two, d)].into_iter().map(|(m, c)| self.term_length(c, m)).sum();
        group.saving = before + 2 - length(&self.grouped(&group)) as isize;
        (group.saving > 0).then_some(group)
    }

    /// Replaces a·a, a·b and b·b by squares of a + k b.
    pub(super) fn squared(&self, mut terms: Vec<VectorTerm>) -> Vec<VectorTerm> {
        while let Some((members, square)) = self.vector_square(&terms) {
            let mut place = 0;
            terms.retain(|_| {
                place += 1;
                !members.contains(&(place - 1))
            });
            terms.push(square);
        }
        terms
    }

    fn vector_square(&self, terms: &[VectorTerm]) -> Option<([usize; 3], VectorTerm)> {
        let dots: Vec<(usize, [&Formula; 2])> =
            terms.iter().enumerate().filter_map(|(place, term)| Some((place, dot(term)?))).collect();
        let squares = || dots.iter().filter(|(_, [a, b])| a == b);
        let pairs = squares().flat_map(|one| squares().map(move |two| (one, two)));
        for (&(i, [a, _]), &(j, [b, _])) in pairs.filter(|((i, _), (j, _))| i != j) {
            let leads = |at: usize| variables(&terms[at]).iter().any(|&variable| is_velocity(variable));
            if leads(j) && !leads(i) || leads(i) == leads(j) && i > j {
                continue;
            }
            let between = dots.iter().filter(|(_, sides)| *sides == [a, b] || *sides == [b, a]);
            let found = between.into_iter().find_map(|&(k, _)| {
                let factor = factor([&terms[i], &terms[k], &terms[j]])?;
                Some(([i, j, k], factor))
            });
            if let Some((members, (number, monomial))) = found {
                let second = self.multiple(number, &monomial, b);
                let sum = Formula::Sum(vec![a.clone(), second]);
                let two = Formula::Number(Rational::from_integer(2));
                let square = Formula::Power(Box::new(sum), Box::new(two));
                let VectorTerm { coefficient, scalar, .. } = &terms[i];
                let factors = vec![Meaning::Vector(square, variables(&terms[i]).to_vec())];
                return Some((
                    members,
                    VectorTerm { coefficient: *coefficient, scalar: scalar.clone(), factors },
                ));
            }
        }
        None
    }

    /// number · monomial · vector
    fn multiple(&self, number: Rational, monomial: &Monomial, vector: &Formula) -> Formula {
        let factor = self.product(number.abs(), monomial, &[]);
        let product = match factor {
            Formula::Number(value) if value.is_one() => vector.clone(),
            Formula::Product(mut above, below) => {
                above.retain(|factor| *factor != Formula::Number(Rational::one()));
                above.push(vector.clone());
                Formula::Product(above, below)
            }
            factor => Formula::Product(vec![factor, vector.clone()], Vec::new()),
        };
        product.signed(number.is_negative())
    }

    /// A sum with products of vectors in it; `None` if there are none.
    pub(super) fn dotted_sum(&self, all: &Polynomial) -> Option<Formula> {
        let terms = self.squared(self.dotted_terms(all)?);
        let mut parts: Vec<(TermOrder, Formula)> = Vec::new();
        for VectorTerm { coefficient, scalar, factors } in &terms {
            let vectors = factors.iter().filter_map(|factor| match factor {
                Meaning::Vector(written, _) => Some(written.clone()),
                _ => None,
            });
            let vectors: Vec<Formula> = vectors.collect();
            let whole = match &vectors[..] {
                [] => self.product(*coefficient, scalar, &[]),
                [vector] => self.multiple(*coefficient, scalar, vector),
                _ => return None,
            };
            parts.push((self.place(scalar, *coefficient), whole));
        }
        parts.sort_by(|(one, _), (two, _)| one.cmp(two));
        Some(Formula::sum(parts.into_iter().map(|(_, part)| part).collect()))
    }
}

/// True if all exponents are integers.
fn is_whole(monomial: &Monomial) -> bool {
    monomial.factors().iter().all(|(_, exponent)| exponent.is_integer())
}

/// Vectors of a term with a single dot product.
fn dot(term: &VectorTerm) -> Option<[&Formula; 2]> {
    match &term.factors[..] {
        [Meaning::Vector(Formula::Call(name, sides), _)] if name == "dot" => Some([&sides[0], &sides[1]]),
        _ => None,
    }
}

fn variables(term: &VectorTerm) -> &[Variable] {
    match &term.factors[..] {
        [Meaning::Vector(_, variables)] => variables,
        _ => &[],
    }
}

/// Number and monomial k with a·a + 2 k a·b + k² b·b, up to a common factor.
fn factor([one, between, two]: [&VectorTerm; 3]) -> Option<(Rational, Monomial)> {
    let monomial = between.scalar.over(&one.scalar)?;
    let number = symbolic::times(
        between.coefficient,
        symbolic::times(one.coefficient, Rational::from_integer(2))?.recip(),
    )?;
    let is_it = one.scalar.times(&monomial.power(Rational::from_integer(2))?)? == two.scalar
        && symbolic::times(one.coefficient, symbolic::times(number, number)?)? == two.coefficient;
    (is_it && is_whole(&monomial) && !number.is_zero()).then_some((number, monomial))
}

fn signed(number: Rational, is_negative: bool) -> Rational {
    if is_negative { -number } else { number }
}
