//! A row of the equations of motion: accelerations to the left, everything else to the right, what all terms have in common
//! divided away.

use std::collections::BTreeMap;

use num_traits::{One, Signed};

use super::super::formula::Formula;
use super::collect::{Collector, shared};
use super::polynomial::{Atom, Monomial, Polynomial};
use crate::symbolic::Rational;
use crate::variables::Variable;

/// The index of an atom that is one of them.
type Variables<C> = fn(&C, Atom) -> Option<usize>;

impl Collector<'_, '_> {
    /// Left and right side of Σ = 0, where Σ has accelerations.
    pub(super) fn row(&self, all: &Polynomial) -> Option<[Formula; 2]> {
        let all = self.divided(all)?;
        let (mut left, mut right) = (Polynomial::default(), Polynomial::default());
        for (monomial, &c) in all.terms() {
            let (side, c) = if self.is_inertia(monomial) { (&mut left, c) } else { (&mut right, -c) };
            side.push(monomial.clone(), c)?;
        }
        Some([self.collected(&left, Self::acceleration)?, self.sum(&right)])
    }

    fn is_inertia(&self, monomial: &Monomial) -> bool {
        self.moved(monomial, Self::acceleration).is_some()
    }

    /// Its first factor that is one of these variables.
    fn moved(&self, monomial: &Monomial, variables: Variables<Self>) -> Option<Atom> {
        monomial.factors().iter().map(|&(atom, _)| atom).find(|&atom| variables(self, atom).is_some())
    }

    /// What is linear in accelerations, or in velocities: Σ coefficient · q̈
    pub(super) fn collected(&self, linear: &Polynomial, variables: Variables<Self>) -> Option<Formula> {
        let coefficients = self.coefficients(linear, variables)?;
        let terms = coefficients.iter().map(|(atom, coefficient)| self.multiplied(*atom, coefficient));
        let mut terms = terms.collect::<Option<Vec<_>>>()?;
        terms.sort_by_key(Formula::is_negative);
        Some(Formula::sum(terms))
    }

    /// p = Σ coefficient · q̇ + b
    pub(super) fn momentum(&self, all: &Polynomial) -> Option<Formula> {
        let (mut moving, mut rest) = (Polynomial::default(), Polynomial::default());
        for (monomial, &c) in all.terms() {
            let is_moving = self.moved(monomial, Self::velocity).is_some();
            (if is_moving { &mut moving } else { &mut rest }).push(monomial.clone(), c)?;
        }
        let parts = [self.collected(&moving, Self::velocity)?, self.sum(&rest)];
        let zero = Formula::sum(Vec::new());
        Some(Formula::sum(parts.into_iter().filter(|part| *part != zero).collect()))
    }

    /// coefficient · q̈
    fn multiplied(&self, atom: Atom, coefficient: &Polynomial) -> Option<Formula> {
        let (number, monomial) = coefficient.content();
        let is_negative = coefficient.terms().all(|(_, c)| c.is_negative());
        let number = if is_negative { -number } else { number };
        let quotient = coefficient.scaled(&monomial.power(-Rational::one())?, number.recip())?;
        let monomial = monomial.times(&Monomial::of(atom, Rational::one()))?;
        Some(self.product(number, &monomial, Some(&quotient).filter(|quotient| quotient.len() > 1)))
    }

    /// Of each of these variables that there is, in their order.
    fn coefficients(
        &self,
        linear: &Polynomial,
        variables: Variables<Self>,
    ) -> Option<Vec<(Atom, Polynomial)>> {
        let mut coefficients: Vec<(Atom, Polynomial)> = Vec::new();
        for (monomial, &c) in linear.terms() {
            let Some(atom) = self.moved(monomial, variables) else { continue };
            let factors = monomial.over(&Monomial::of(atom, Rational::one()))?;
            match coefficients.iter_mut().find(|(known, _)| *known == atom) {
                Some((_, sum)) => sum.push(factors, c)?,
                None => coefficients.push((atom, Polynomial::term(factors, c))),
            }
        }
        coefficients.sort_by_key(|(atom, _)| variables(self, *atom));
        Some(coefficients)
    }

    /// Without what is common to all terms. Where an acceleration is multiplied by it too, that may be a coordinate: nothing
    /// is lost but an identity where it vanishes.
    fn divided(&self, all: &Polynomial) -> Option<Polynomial> {
        let coefficients = self.coefficients(all, Self::acceleration)?;
        let may_go = |atom| match self.variable(atom) {
            Some(
                Variable::Time | Variable::Velocity(_) | Variable::Acceleration(_) | Variable::Multiplier(_),
            ) => false,
            _ => self.is_constant(atom) || !coefficients.is_empty(),
        };
        let (number, monomial) = shared(all, may_go);
        let is_turned = coefficients.first().is_some_and(|(_, first)| {
            2 * first.terms().filter(|(_, c)| c.is_negative()).count() > first.len()
        });
        let number = if is_turned { -number } else { number };
        let mut all = all.scaled(&monomial.power(-Rational::one())?, number.recip())?;
        while let Some(quotient) = self.divisor(&all).and_then(|divisor| all.divided(&divisor)) {
            all = quotient;
        }
        Some(all)
    }

    /// The sum that may be a factor of all terms: the shortest of those that constants and coordinates make with all else equal.
    fn divisor(&self, all: &Polynomial) -> Option<Polynomial> {
        let has_inertia = all.terms().any(|(monomial, _)| self.is_inertia(monomial));
        let is_kept = |atom| match self.variable(atom) {
            Some(Variable::Coordinate(_)) => !has_inertia,
            _ => !self.is_constant(atom),
        };
        let mut factors: BTreeMap<Monomial, Polynomial> = BTreeMap::new();
        for (monomial, &c) in all.terms() {
            let kept = monomial.filtered(is_kept);
            factors.entry(kept.clone()).or_default().push(monomial.over(&kept)?, c)?;
        }
        let shortest =
            factors.into_values().min_by_key(Polynomial::len).filter(|shortest| shortest.len() > 1)?;
        let (number, monomial) = shortest.content();
        let number = if shortest.leads_negative() { -number } else { number };
        shortest.scaled(&monomial.power(-Rational::one())?, number.recip())
    }
}
