//! Tells which variables the factors, terms and sums of a polynomial depend on.

use num_traits::{One, Signed};

use super::atoms::Meaning;
use super::collect::Collector;
use crate::symbolic::{self, Atom, Monomial, Polynomial, Rational};
use crate::variables::Variable;

impl Collector<'_, '_> {
    /// The variable that an atom is, or all variables of the factors if it is a product of vectors.
    pub(super) fn variables(&self, atom: Atom) -> &[Variable] {
        match self.expansion.atoms.meaning(atom) {
            Meaning::Variable(variable) => std::slice::from_ref(variable),
            Meaning::Vector(_, variables) => variables,
            _ => &[],
        }
    }

    pub(super) fn variable(&self, atom: Atom) -> Option<Variable> {
        if let [variable] = self.variables(atom) { Some(*variable) } else { None }
    }

    pub(super) fn is_multiplier(&self, atom: Atom) -> bool {
        matches!(self.variable(atom), Some(Variable::Multiplier(_)))
    }

    pub(super) fn acceleration(&self, atom: Atom) -> Option<usize> {
        self.variables(atom).iter().find_map(|variable| match variable {
            Variable::Acceleration(i) => Some(*i),
            _ => None,
        })
    }

    pub(super) fn velocity(&self, atom: Atom) -> Option<usize> {
        match self.variable(atom) {
            Some(Variable::Velocity(i)) => Some(i),
            _ => None,
        }
    }

    /// Returns whether an atom depends on neither time nor state.
    pub(super) fn is_constant(&self, atom: Atom) -> bool {
        self.depends_on(atom, |variable| matches!(variable, Variable::Parameter(_)))
    }

    /// True if an atom depends on variables alone that `may_occur` accepts.
    fn depends_on(&self, atom: Atom, may_occur: fn(&Variable) -> bool) -> bool {
        let all = |polynomial: &Polynomial| self.consists_of(polynomial, may_occur);
        match self.expansion.atoms.meaning(atom) {
            Meaning::Variable(variable) => may_occur(variable),
            Meaning::Pi | Meaning::Number(_) => true,
            Meaning::Definition(id) => self.constants.contains(id),
            Meaning::Function(_, x) | Meaning::Sum(x) => all(x),
            Meaning::Atan2(x, y) | Meaning::Power(x, y) => all(x) && all(y),
            Meaning::External(_, arguments) => arguments.iter().all(all),
            Meaning::Vector(_, of) => !of.is_empty() && of.iter().all(may_occur),
        }
    }

    pub(super) fn consists_of(&self, polynomial: &Polynomial, may_occur: fn(&Variable) -> bool) -> bool {
        let mut atoms = polynomial.terms().flat_map(|(monomial, _)| monomial.factors());
        atoms.all(|&(atom, _)| self.depends_on(atom, may_occur))
    }

    pub(super) fn are_constant(&self, polynomial: &Polynomial) -> bool {
        self.consists_of(polynomial, |variable| matches!(variable, Variable::Parameter(_)))
    }

    /// Returns whether the polynomial depends on parameters and time only.
    pub(super) fn is_of_time(&self, polynomial: &Polynomial) -> bool {
        self.consists_of(polynomial, |variable| matches!(variable, Variable::Parameter(_) | Variable::Time))
    }

    pub(super) fn moving(&self, monomial: &Monomial) -> Monomial {
        monomial.filtered(|atom| !self.is_constant(atom))
    }

    /// Returns whether all terms have the same degree in the velocities.
    pub(super) fn are_alike(&self, quotient: &Polynomial) -> bool {
        let mut degrees = quotient.terms().map(|(monomial, _)| self.degree(monomial, is_velocity));
        let first = degrees.next();
        degrees.all(|degree| Some(degree) == first)
    }

    /// Returns whether all terms are squares of variables, such as ẋ² + ẏ².
    pub(super) fn are_squares(&self, quotient: &Polynomial) -> bool {
        let two = Rational::from_integer(2);
        quotient.terms().all(|(monomial, &c)| {
            let is_square =
                matches!(monomial.factors(), [(atom, e)] if *e == two && self.variable(*atom).is_some());
            c.is_one() && is_square
        })
    }

    /// Returns whether the polynomial contains coordinates and constants only.
    pub(super) fn is_of_coordinates(&self, quotient: &Polynomial) -> bool {
        let is_it =
            |atom| matches!(self.variable(atom), Some(Variable::Coordinate(_))) || self.is_constant(atom);
        quotient.terms().all(|(monomial, _)| monomial.factors().iter().all(|&(atom, _)| is_it(atom)))
    }

    /// Returns whether the polynomial is x − l, with a coordinate and a constant.
    pub(super) fn is_elongation(&self, quotient: &Polynomial) -> bool {
        let is_name = |(monomial, c): (&Monomial, &Rational)| {
            c.abs().is_one() && matches!(monomial.factors(), [(_, exponent)] if exponent.is_one())
        };
        let moving = quotient.terms().filter(|(monomial, _)| !self.moving(monomial).is_one()).count();
        quotient.len() == 2
            && quotient.terms().all(is_name)
            && moving == 1
            && self.is_of_coordinates(quotient)
    }

    /// Returns whether all terms are products of coordinates of one degree with coefficients ±1, such as x₁ − x₂, or these
    /// times a velocity or momentum each, such as x p_y − y p_x.
    pub(super) fn are_differences(&self, quotient: &Polynomial) -> bool {
        let is_coordinate = |variable| matches!(variable, Variable::Coordinate(_));
        let is_it = |variable| is_coordinate(variable) || is_velocity(variable);
        let mut degrees = quotient.terms().map(|(monomial, c)| {
            let are_it = c.abs().is_one()
                && monomial.factors().iter().all(|(atom, _)| self.variable(*atom).is_some_and(is_it));
            let degrees = [self.degree(monomial, is_coordinate)?, self.degree(monomial, is_velocity)?];
            (are_it && degrees[0].is_positive() && degrees[1] <= Rational::one()).then_some(degrees)
        });
        let first = degrees.next().flatten();
        first.is_some() && degrees.all(|degree| degree == first)
    }

    /// Degree of a monomial in the variables that `counts` selects; `None` if the exponents overflow.
    pub(super) fn degree(&self, monomial: &Monomial, counts: impl Fn(Variable) -> bool) -> Option<Rational> {
        let count = |atom| self.variables(atom).iter().filter(|variable| counts(**variable)).count();
        monomial.factors().iter().try_fold(Rational::default(), |degree, &(atom, exponent)| {
            symbolic::plus(degree, symbolic::times(exponent, Rational::from_integer(count(atom) as i128))?)
        })
    }
}

pub(super) fn is_velocity(variable: Variable) -> bool {
    matches!(variable, Variable::Velocity(_) | Variable::Momentum(_))
}
