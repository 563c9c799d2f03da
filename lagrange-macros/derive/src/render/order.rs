//! Puts sums in the order, and differences in the direction, in which the user wrote them.

use super::formula::Formula;
use super::letters::PageQuantity;
use super::page::Page;
use crate::syntax::{Declaration, Expression, Kind};

impl Page<'_> {
    /// Terms of the sums in the declaration, and of those with momenta in place of velocities: x p_y − y p_x for x ẏ − y ẋ.
    pub(super) fn written_sums(&self) -> Vec<Vec<Formula>> {
        let Declaration { lagrangian, defines, dissipation, forces, constraints, .. } = self.declaration;
        let mut pending: Vec<&Expression> = lagrangian.iter().chain(dissipation).collect();
        pending.extend(defines.iter().map(|define| &define.body));
        pending.extend(forces.iter().map(|force| &force.value));
        pending.extend(constraints.iter().flat_map(|constraint| [&constraint.left, &constraint.right]));
        let mut sums = Vec::new();
        while let Some(expression) = pending.pop() {
            if let (Kind::Sum(_), Formula::Sum(terms)) = (&expression.kind, self.written(expression)) {
                let with_momenta: Vec<Formula> = terms.iter().map(|term| self.with_momenta(term)).collect();
                sums.extend(Some(with_momenta).filter(|with_momenta| *with_momenta != terms));
                sums.push(terms);
            }
            pending.extend(expression.parts());
        }
        sums
    }

    /// Like [`found`](Self::found), but for a factor: the force k (x₁ − x₂) keeps its direction if x₂ − x₁ is written.
    pub(super) fn directed(&self, terms: &[Formula]) -> Option<(bool, Vec<Formula>)> {
        let is_coordinate = |term: &Formula| match term.sign_and_magnitude().1 {
            Formula::Name { base, dots: 0, .. } => {
                let names = self.problem.coordinates.iter().map(|label| label.text.split('[').next());
                names.into_iter().any(|name| name == Some(&base))
            }
            _ => false,
        };
        self.found(terms).filter(|(is_turned, _)| !is_turned || !terms.iter().all(is_coordinate))
    }

    /// The terms of a sum as the user ordered them, with the signs of the user, and whether these are the opposite ones.
    fn found(&self, terms: &[Formula]) -> Option<(bool, Vec<Formula>)> {
        let known = || self.sums.iter().filter(|sum| sum.len() == terms.len());
        [false, true].into_iter().find_map(|is_turned| {
            let terms: Vec<Formula> = terms.iter().map(|term| term.clone().signed(is_turned)).collect();
            let own = |written: &Formula| terms.iter().find(|term| term.is_product_like(written)).cloned();
            let ordered = known().find_map(|sum| sum.iter().map(own).collect::<Option<Vec<Formula>>>())?;
            Some((is_turned, ordered))
        })
    }

    /// The terms of which the user wrote two or more in one sum, in the order of that sum whatever their signs, as those of U,
    /// which L has with the other sign. A sum does not come to begin with a minus sign.
    fn partly_ordered(&self, terms: Vec<Formula>) -> Vec<Formula> {
        let place = |sum: &[Formula], term: &Formula| {
            sum.iter().position(|written| term.magnitude().is_product_like(written.magnitude()))
        };
        let known = |sum: &Vec<Formula>| terms.iter().filter(|term| place(sum, term).is_some()).count();
        let Some(sum) = self.sums.iter().rev().max_by_key(|sum| known(sum)).filter(|sum| known(sum) > 1)
        else {
            return terms;
        };
        let mut found: Vec<Formula> =
            terms.iter().filter(|term| place(sum, term).is_some()).cloned().collect();
        found.sort_by_key(|term| place(sum, term));
        let mut found = found.into_iter();
        let ordered = terms.iter().map(|term| match place(sum, term) {
            Some(_) => found.next().unwrap_or_else(|| term.clone()),
            None => term.clone(),
        });
        let ordered: Vec<Formula> = ordered.collect();
        if ordered[0].is_negative() && !terms[0].is_negative() { terms } else { ordered }
    }

    /// The factors, with the parameters among them in the order in which the user multiplies them, as m g l.
    fn by_rank(&self, mut factors: Vec<Formula>) -> Vec<Formula> {
        let rank = |factor: &Formula| match factor {
            Formula::Power(base, _) => self.ranks_by_name.get(base.as_ref()),
            other => self.ranks_by_name.get(other),
        };
        let places: Vec<usize> =
            (0..factors.len()).filter(|&place| rank(&factors[place]).is_some()).collect();
        let mut sorted: Vec<Formula> = places.iter().map(|&place| factors[place].clone()).collect();
        sorted.sort_by_key(|factor| rank(factor).copied());
        places.into_iter().zip(sorted).for_each(|(place, factor)| factors[place] = factor);
        factors
    }

    /// The formula with all sums in it that the user wrote.
    pub(super) fn as_written(&self, formula: Formula) -> Formula {
        let all = |parts: Vec<Formula>| parts.into_iter().map(|part| self.as_written(part)).collect();
        match formula {
            Formula::Sum(terms) => {
                let terms: Vec<Formula> = all(terms);
                let found = self.found(&terms).filter(|(is_turned, _)| !is_turned);
                Formula::Sum(found.map_or_else(|| self.partly_ordered(terms), |(_, ordered)| ordered))
            }
            Formula::Product(above, below) => {
                let mut is_negative = false;
                let mut factors = |factors: Vec<Formula>| {
                    let factors = factors.into_iter().map(|factor| self.as_written(factor));
                    let turned = factors.map(|factor| self.turned(factor, |terms| self.directed(terms)));
                    turned.map(|(sign, factor)| (is_negative ^= sign, factor).1).collect()
                };
                let (above, below) = (factors(above), factors(below));
                Formula::Product(self.by_rank(above), self.by_rank(below)).signed(is_negative)
            }
            Formula::Power(base, exponent) => {
                let is_even = matches!(*exponent, Formula::Number(n) if n.is_integer() && n.numer() % 2 == 0);
                let base = self.as_written(*base);
                let base = if is_even { self.turned(base, |terms| self.found(terms)).1 } else { base };
                Formula::Power(Box::new(base), exponent)
            }
            Formula::Negative(inner) => self.as_written(*inner).negated(),
            Formula::Root(inner) => Formula::Root(Box::new(self.as_written(*inner))),
            Formula::Call(name, arguments) => Formula::Call(name, all(arguments)),
            other => other,
        }
    }

    /// Replaces each velocity by the momentum of its coordinate: the order of a sum in L then serves for H.
    fn with_momenta(&self, formula: &Formula) -> Formula {
        let all = |parts: &[Formula]| parts.iter().map(|part| self.with_momenta(part)).collect();
        match formula {
            Formula::Name { base, dots: 1, indices } => {
                let base = self.letters.text_of(PageQuantity::Momentum, base);
                Formula::Name { base, dots: 0, indices: indices.clone() }
            }
            Formula::Negative(inner) => Formula::Negative(Box::new(self.with_momenta(inner))),
            Formula::Product(above, below) => Formula::Product(all(above), all(below)),
            other => other.clone(),
        }
    }

    /// Sign and magnitude of a factor, with a sum as `found` gives it.
    fn turned(
        &self,
        factor: Formula,
        found: impl Fn(&[Formula]) -> Option<(bool, Vec<Formula>)>,
    ) -> (bool, Formula) {
        match factor {
            Formula::Sum(terms) => match found(&terms) {
                Some((is_turned, ordered)) => (is_turned, Formula::Sum(ordered)),
                None => (false, Formula::Sum(terms)),
            },
            factor => factor.sign_and_magnitude(),
        }
    }
}

impl Formula {
    fn magnitude(&self) -> &Self {
        if let Self::Negative(inner) = self { inner } else { self }
    }

    /// True for equal formulas, and for products of the same factors in any order.
    fn is_product_like(&self, other: &Self) -> bool {
        let same = |one: &[Self], other: &[Self]| {
            one.len() == other.len() && one.iter().all(|factor| other.contains(factor))
        };
        match (self, other) {
            (Self::Negative(one), Self::Negative(other)) => one.is_product_like(other),
            (Self::Product(above, below), Self::Product(above_other, below_other)) => {
                same(above, above_other) && same(below, below_other)
            }
            _ => self == other,
        }
    }
}
