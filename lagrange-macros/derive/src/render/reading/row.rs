//! Arranges a row of the equations of motion: accelerations on the left, all other terms on the right, divided by the
//! common factor.

use num_traits::{One, Signed, Zero};

use super::super::digits::decimal;
use super::super::formula::Formula;
use super::super::length::length;
use super::atoms::Meaning;
use super::collect::{Collector, taken_out};
use super::dependence::is_velocity;
use crate::symbolic::{self, Atom, Monomial, Polynomial, Rational, common};
use crate::variables::Variable;

/// Maps an atom to the index of its variable if the variable is of a certain kind, such as an acceleration.
type Variables<C> = fn(&C, Atom) -> Option<usize>;

impl Collector<'_, '_> {
    /// Left and right side of the equation `all` = 0 of the velocity `own`, which contains accelerations.
    pub(super) fn row(&self, own: usize, all: &Polynomial) -> Option<[Formula; 2]> {
        let all = self.divided(own, all)?;
        let (mut left, mut right) = (Polynomial::default(), Polynomial::default());
        for (monomial, &c) in all.terms() {
            let (side, c) = if self.is_inertia(monomial) { (&mut left, c) } else { (&mut right, -c) };
            side.push(monomial.clone(), c)?;
        }
        let [by_acceleration, grouped] = [self.collected(&left, Self::acceleration)?, self.sum(&left)];
        // Velocities beside accelerations, as of a relativistic particle, are read in products: ẋ (ẋ ẍ + ẏ ÿ).
        let has_velocity = left.terms().any(|(monomial, _)| self.moved(monomial, Self::velocity).is_some());
        let is_shorter = has_velocity && length(&grouped) < length(&by_acceleration);
        Some([if is_shorter { grouped } else { by_acceleration }, self.force(&right)])
    }

    /// Right side of a row: q (E + ṙ×B), or a sum whose products each contain terms of one degree in the velocities.
    fn force(&self, right: &Polynomial) -> Formula {
        self.lorentz_force(right).unwrap_or_else(|| self.sum_by_degree(right))
    }

    /// A vector of terms with and without a cross product that all contain one factor, such as a charge.
    fn lorentz_force(&self, right: &Polynomial) -> Option<Formula> {
        let (number, charge) = shared(right, |atom| self.is_constant(atom));
        let rest = right.scaled(&charge.power(-Rational::one())?, number.recip())?;
        let contains = |atom| !charge.exponent(atom).is_zero();
        let is_free = rest.terms().all(|(monomial, _)| !self.any(monomial, contains));
        let is_cross = |atom| match self.expansion.atoms.meaning(atom) {
            Meaning::Vector(Formula::Call(name, _), _) => name == "cross",
            _ => false,
        };
        let own = |(monomial, &c): (&Monomial, &Rational)| (monomial.clone(), c);
        let (crossed, others): (Vec<_>, Vec<_>) =
            rest.terms().map(own).partition(|(monomial, _)| self.any(monomial, is_cross));
        if charge.is_one() || !is_free || crossed.is_empty() || others.is_empty() {
            return None;
        }
        let sums = [others, crossed].map(|terms| self.sum(&terms.into_iter().collect()));
        let charge = self.product(number, &charge, &[]);
        Some(Formula::flat_product(
            Rational::one().into(),
            vec![charge, Formula::sum(sums.into())],
            Vec::new(),
        ))
    }

    fn any(&self, monomial: &Monomial, is_it: impl Fn(Atom) -> bool) -> bool {
        monomial.factors().iter().any(|&(atom, _)| is_it(atom))
    }

    fn is_inertia(&self, monomial: &Monomial) -> bool {
        self.moved(monomial, Self::acceleration).is_some()
    }

    /// First factor of a monomial that is a variable of this kind.
    fn moved(&self, monomial: &Monomial, variables: Variables<Self>) -> Option<Atom> {
        monomial.factors().iter().map(|&(atom, _)| atom).find(|&atom| variables(self, atom).is_some())
    }

    /// Collects the terms of a linear polynomial by acceleration or by velocity: Σ coefficient · q̈.
    pub(super) fn collected(&self, linear: &Polynomial, variables: Variables<Self>) -> Option<Formula> {
        let coefficients = self.coefficients(linear, variables)?;
        let terms = coefficients.iter().map(|(atom, coefficient)| self.multiplied(*atom, coefficient));
        let mut terms = terms.collect::<Option<Vec<_>>>()?;
        terms.sort_by_key(Formula::is_negative);
        Some(Formula::sum(terms))
    }

    /// Momentum p = Σ coefficient · q̇ + b.
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

    /// Product coefficient · q̈.
    fn multiplied(&self, atom: Atom, coefficient: &Polynomial) -> Option<Formula> {
        let (number, monomial, quotient) = taken_out(coefficient)?;
        let monomial = monomial.times(&Monomial::of(atom, Rational::one()))?;
        let sums = [(&quotient, false)];
        Some(self.product(number, &monomial, if quotient.len() > 1 { &sums } else { &[] }))
    }

    /// Coefficient of each variable of this kind that occurs, in the order of the variables.
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
        let degree = |polynomial: &Polynomial| {
            polynomial.terms().map(|(monomial, _)| self.degree(monomial, is_velocity)).max()
        };
        coefficients.sort_by_cached_key(|(atom, coefficient)| (variables(self, *atom), degree(coefficient)));
        Some(coefficients)
    }

    /// Divides by the common factor of all terms. In a row with accelerations the factor may contain coordinates: the
    /// division loses only the identity 0 = 0 at the zeros of the factor. The acceleration `own`, or the first one if that is
    /// missing, gets a plus sign.
    fn divided(&self, own: usize, all: &Polynomial) -> Option<Polynomial> {
        let coefficients = self.coefficients(all, Self::acceleration)?;
        let may_go = |atom| match self.variable(atom) {
            Some(
                Variable::Time | Variable::Velocity(_) | Variable::Acceleration(_) | Variable::Multiplier(_),
            ) => false,
            _ => self.is_constant(atom) || !coefficients.is_empty(),
        };
        let (number, monomial) = shared(all, may_go);
        let is_own = |(atom, _): &&(Atom, Polynomial)| self.acceleration(*atom) == Some(own);
        let leading = coefficients.iter().find(is_own).or(coefficients.first());
        let is_turned = leading.is_some_and(|(_, first)| {
            2 * first.terms().filter(|(_, c)| c.is_negative()).count() > first.len()
        });
        let number = if is_turned { -number } else { number };
        let number = symbolic::times(number, self.denominators(all, number)?.recip())?;
        let mut all = all.scaled(&monomial.power(-Rational::one())?, number.recip())?;
        while let Some(quotient) = self.without_sum(&all) {
            all = quotient;
        }
        Some(all)
    }

    /// Least common denominator of a row in which each term has one, such as 6 for ⅓ l θ̈ = ½ g sin θ, or in which those with
    /// accelerations have it, such as 5 for 7/5 ẍ = g sin α; 1 for any other.
    fn denominators(&self, all: &Polynomial, number: Rational) -> Option<Rational> {
        let all = all.scaled(&Monomial::default(), number.recip())?;
        let is_fraction = |c: Rational| !c.is_integer() && decimal(c).is_none();
        let inertia: Polynomial = all
            .terms()
            .filter(|(monomial, _)| self.is_inertia(monomial))
            .map(|(m, &c)| (m.clone(), c))
            .collect();
        let (every, of_inertia) = (all.denominators()?, inertia.denominators()?);
        let is_cleared = all.terms().all(|(_, &c)| is_fraction(c)) || every == of_inertia;
        Some(if is_cleared { every } else { Rational::one() })
    }

    /// Quotient of all terms by a sum that divides them: one of constants and coordinates, or one with functions of these.
    fn without_sum(&self, all: &Polynomial) -> Option<Polynomial> {
        let has_inertia = all.terms().any(|(monomial, _)| self.is_inertia(monomial));
        let is_kept = |atom| match self.variable(atom) {
            Some(Variable::Coordinate(_)) => !has_inertia,
            _ => !self.is_constant(atom),
        };
        let moves = |atom| !self.consists_of(&Polynomial::atom(atom), is_at_rest);
        let quotient = |divisor: Polynomial| {
            all.divided(&if divisor.leads_negative() { divisor.negated() } else { divisor })
        };
        let plain = all.cofactor(is_kept).and_then(quotient);
        plain.or_else(|| all.cofactor(|atom| !has_inertia || moves(atom)).and_then(quotient))
    }
}

/// False for velocities, accelerations and multipliers.
fn is_at_rest(variable: &Variable) -> bool {
    matches!(variable, Variable::Parameter(_) | Variable::Time | Variable::Coordinate(_))
}

/// Common factor of all terms, restricted to atoms that `may_go` accepts.
fn shared(polynomial: &Polynomial, may_go: impl Fn(Atom) -> bool) -> (Rational, Monomial) {
    let (_, monomial) = polynomial.content();
    (common(polynomial.terms().map(|(_, &c)| c)), monomial.filtered(may_go))
}
