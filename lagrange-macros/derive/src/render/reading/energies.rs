//! Writes energies: kinetic and potential energy apart, and each product with one term of the sum that it stands for.

use super::super::formula::Formula;
use super::atoms::Meaning;
use super::collect::{Collector, TermOrder};
use super::dependence::is_velocity;
use super::group::Group;
use crate::symbolic::{Atom, Monomial, Polynomial, Rational};

impl Collector<'_, '_> {
    /// Sum of the terms of an energy, from the highest degree in the velocities or momenta down. Only squares, such as
    /// (p − e A)², contain terms of different degrees.
    pub(super) fn energy(&self, polynomial: &Polynomial) -> Formula {
        let mut rest = polynomial.clone();
        let mut parts = Vec::new();
        while let Some(square) = self.mixed_square(&rest) {
            square.members.iter().for_each(|member| rest.remove(member));
            let places = square.members.iter().map(|member| self.place(member, square.number));
            parts.extend(places.min().map(|place| (place, self.grouped(&square))));
        }
        self.in_order_of_degree(parts, &rest)
    }

    /// Like [`energy`](Self::energy), with squares multiplied out where they contain terms of different degrees.
    pub(super) fn energy_by_degree(&self, polynomial: &Polynomial) -> Formula {
        self.in_order_of_degree(Vec::new(), polynomial)
    }

    fn in_order_of_degree(&self, mut parts: Vec<(TermOrder, Formula)>, rest: &Polynomial) -> Formula {
        let degrees = self.by_degree(rest);
        parts.extend(degrees.iter().flat_map(|part| self.parts(part, |group| !self.joins_energies(group))));
        parts.sort_by(|(one, _), (two, _)| (one.2, one).cmp(&(two.2, two)));
        Formula::sum(parts.into_iter().map(|(_, part)| part).collect())
    }

    /// Square that saves the most symbols, of those whose terms have different degrees.
    fn mixed_square(&self, polynomial: &Polynomial) -> Option<Group> {
        let degree = |monomial: &Monomial| self.degree(monomial, is_velocity);
        let is_mixed =
            |group: &Group| group.members.iter().any(|member| degree(member) != degree(&group.members[0]));
        self.squares(polynomial).filter(is_mixed).max_by_key(Group::worth)
    }

    /// True for a product of constants with energies that each have parameters of their own, as m R (½ R ω² sin² θ + g cos θ)
    /// and ½ (m₁ ẋ₁² + m₂ ẋ₂²): books write these one by one, but for terms over a sum.
    fn joins_energies(&self, Group { monomial, quotient, is_square, .. }: &Group) -> bool {
        let has_parameters = |monomial: &Monomial| self.moving(monomial) != *monomial;
        let is_sum =
            |&(atom, _): &(Atom, Rational)| matches!(self.expansion.atoms.meaning(atom), Meaning::Sum(_));
        let mut moving = quotient.terms().map(|(monomial, _)| self.moving(monomial));
        let first = moving.next();
        !is_square
            && self.moving(monomial).is_one()
            && !monomial.factors().iter().any(is_sum)
            && moving.any(|other| Some(other) != first)
            && quotient.terms().all(|(monomial, _)| has_parameters(monomial))
    }
}
