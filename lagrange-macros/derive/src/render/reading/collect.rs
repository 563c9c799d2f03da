//! Converts polynomials to formulas.

use std::cell::RefCell;
use std::collections::BTreeMap;

use num_traits::{One, Signed};
use rustc_hash::{FxHashMap, FxHashSet};

use super::super::derived::{function, power};
use super::super::formula::Formula;
use super::super::length::{READABLE, divisor_length, length};
use super::super::page::Page;
use super::super::roots::NamedRoot;
use super::atoms::Meaning;
use super::dependence::is_velocity;
use super::expand::Expansion;
use super::group::Group;
use crate::symbolic::{self, Atom, Id, Monomial, Polynomial, Rational, Scaled};
use crate::variables::Variable;

/// Writes polynomials as formulas.
pub(super) struct Collector<'a, 'p> {
    pub(super) page: &'a Page<'p>,
    pub(super) expansion: &'a Expansion<'a>,
    /// Definitions that depend on neither time nor state.
    pub(super) constants: &'a FxHashSet<Id>,
    /// Powers of atoms that were written before.
    pub(super) powers: RefCell<FxHashMap<(Atom, Rational), Formula>>,
    /// Whether the user wrote these sums, or their negatives.
    pub(super) directions: RefCell<FxHashMap<Polynomial, Option<bool>>>,
}

/// Sort key of a term in a sum: multipliers last, plus signs before minus signs, higher degree in the velocities first
/// (lower beside accelerations), squares before products, and in the order of the velocities.
pub(super) type TermOrder = (bool, bool, Option<Rational>, usize, Monomial, Monomial);

impl Collector<'_, '_> {
    pub(super) fn sum(&self, polynomial: &Polynomial) -> Formula {
        in_order(self.parts(polynomial, |_| true))
    }

    /// The sum, with its common factors before it.
    pub(super) fn factored(&self, polynomial: &Polynomial) -> Formula {
        match taken_out(polynomial) {
            Some((number, monomial, rest)) if rest.len() > 1 => {
                self.product(number, &monomial, &[(&rest, false)])
            }
            _ => self.sum(polynomial),
        }
    }

    /// Sum in which no product contains terms of different degrees in the velocities: Coriolis and centrifugal forces
    /// stay apart.
    pub(super) fn sum_by_degree(&self, polynomial: &Polynomial) -> Formula {
        let degrees = self.by_degree(polynomial);
        in_order(degrees.iter().flat_map(|part| self.parts(part, |_| true)).collect())
    }

    /// Parts of equal degree in the velocities, from the lowest degree up.
    pub(super) fn by_degree(&self, polynomial: &Polynomial) -> Vec<Polynomial> {
        let mut degrees: BTreeMap<Option<Rational>, Polynomial> = BTreeMap::new();
        for (monomial, &c) in polynomial.terms() {
            let part = degrees.entry(self.degree(monomial, is_velocity)).or_default();
            let added = part.push(monomial.clone(), c);
            debug_assert!(added.is_some(), "each monomial occurs once");
        }
        degrees.into_values().collect()
    }

    /// Formulas of the terms of a sum, with their places in it. Terms that share factors become one product if `may_be` accepts
    /// their group.
    pub(super) fn parts(
        &self,
        polynomial: &Polynomial,
        may_be: impl Fn(&Group) -> bool,
    ) -> Vec<(TermOrder, Formula)> {
        let mut parts: Vec<(TermOrder, Formula)> = Vec::new();
        let mut rest = polynomial.clone();
        while let Some(group) = self.group(&rest, &may_be) {
            group.members.iter().for_each(|member| rest.remove(member));
            let places = group.members.iter().map(|member| self.place(member, group.number));
            parts.extend(places.min().map(|place| (place, self.grouped(&group))));
        }
        let terms =
            rest.terms().map(|(monomial, &c)| (self.place(monomial, c), self.product(c, monomial, &[])));
        parts.extend(terms);
        parts
    }

    pub(super) fn grouped(&self, group: &Group) -> Formula {
        let Group { number, monomial, quotient, is_square, constants, .. } = group;
        let constants = constants.iter().map(|sum| (sum, false));
        let sums: Vec<(&Polynomial, bool)> = constants.chain([(quotient, *is_square)]).collect();
        self.product(*number, monomial, &sums)
    }

    pub(super) fn term_length(&self, number: Rational, monomial: &Monomial) -> isize {
        length(&self.product(number, monomial, &[])) as isize
    }

    pub(super) fn place(&self, monomial: &Monomial, number: Rational) -> TermOrder {
        let is_inertia = monomial.factors().iter().any(|(atom, _)| self.acceleration(*atom).is_some());
        // A Lorentz factor is a function of the velocities.
        let is_lorentz =
            |atom| self.expansion.roots.get(&atom).is_some_and(|&place| self.page.roots[place].is_below);
        let has_lorentz = monomial.factors().iter().any(|&(atom, _)| is_lorentz(atom));
        let degree = self.degree(monomial, is_velocity);
        let degree = degree.and_then(|degree| symbolic::plus(degree, i128::from(has_lorentz).into()));
        let speed = degree.map(|degree| if is_inertia { degree } else { -degree });
        let velocities = monomial.filtered(|atom| self.variable(atom).is_some_and(is_velocity));
        let count = velocities.factors().len();
        let has_multiplier = monomial.factors().iter().any(|(atom, _)| self.is_multiplier(*atom));
        (has_multiplier, number.is_negative() && !has_multiplier, speed, count, velocities, monomial.clone())
    }

    pub(super) fn size(&self, monomial: &Monomial) -> isize {
        let sizes = monomial.factors().iter().map(|&(atom, exponent)| length(&self.power(atom, exponent).0));
        sizes.sum::<usize>() as isize
    }

    /// Product number · monomial · sums, each of which may be squared.
    pub(super) fn product(
        &self,
        number: Rational,
        monomial: &Monomial,
        sums: &[(&Polynomial, bool)],
    ) -> Formula {
        let mut factors: Vec<_> = monomial.factors().to_vec();
        let tens = factors.iter().position(|&(atom, exponent)| self.is_ten(atom) && exponent.is_integer());
        let exponent = tens.map_or(Rational::default(), |place| factors.remove(place).1);
        let number = Scaled { fraction: number, exponent: *exponent.numer() as i32 };
        factors.sort_by_key(|&(atom, _)| self.reading_order(atom));
        let (mut above, mut below, mut place, mut orders) = (Vec::new(), Vec::new(), 0, Vec::new());
        for (atom, exponent) in factors {
            let (power, is_below) = self.power(atom, exponent);
            let side = if is_below { &mut below } else { &mut above };
            side.push(power);
            orders.extend(Some(self.reading_order(atom)).filter(|_| !is_below));
            // The quotient goes before velocities, accelerations and functions.
            place = if self.reading_order(atom) < (MOVING, 0) { above.len() } else { place };
        }
        for &(sum, is_square) in sums {
            // Constants go before the first of their parameters: (m₁ + m₂) g and m (ω₀² + Ω²).
            let first = self.first_order(sum);
            let of_constants = || orders.iter().filter(|&&order| Some(order) < first).count();
            let at = if self.are_constant(sum) { of_constants() } else { place };
            let exponent = Rational::from_integer(if is_square { 2 } else { 1 });
            above.insert(at, power(self.sum(sum), exponent));
            place += 1;
        }
        Formula::flat_product(number, above, below)
    }

    /// Least sort key of the factors in a sum; `None` if a term is a number.
    fn first_order(&self, sum: &Polynomial) -> Option<(u8, usize)> {
        let first =
            |monomial: &Monomial| monomial.factors().iter().map(|&(atom, _)| self.reading_order(atom)).min();
        sum.terms().map(|(monomial, _)| first(monomial)).min().flatten()
    }

    fn is_ten(&self, atom: Atom) -> bool {
        *self.expansion.atoms.meaning(atom) == Meaning::Number(Rational::from_integer(10))
    }

    /// Sort key of factors: parameters, then multipliers, definitions, coordinates, velocities, accelerations,
    /// functions.
    fn reading_order(&self, atom: Atom) -> (u8, usize) {
        let first = atom.0 as usize;
        match (self.expansion.atoms.meaning(atom), self.variable(atom)) {
            (Meaning::Variable(Variable::Parameter(k)), _) => (1, self.page.ranks[*k]),
            (_, Some(Variable::Parameter(_))) => (1, first),
            (_, Some(Variable::Multiplier(a))) => (2, a),
            (_, Some(Variable::Time)) => (4, 0),
            (_, Some(Variable::Coordinate(i))) => (5, i),
            (_, Some(Variable::Velocity(i) | Variable::Momentum(i))) => (MOVING, i),
            (_, Some(Variable::Acceleration(i))) => (8, i),
            (Meaning::Pi | Meaning::Number(_), _) => (0, first),
            (Meaning::Definition(id), _) => (3, id.index()),
            (Meaning::Function(function, _), _) => (9 + *function as u8, first),
            (Meaning::Vector(Formula::Call(name, _), _), _) if name == "dot" => (4, first),
            (Meaning::Vector(..), _) => (u8::MAX, first),
            _ => (6, first),
        }
    }

    /// Power of an atom, without the sign of its exponent, and whether it is a divisor. A power of a named root is written
    /// by the name.
    fn power(&self, atom: Atom, exponent: Rational) -> (Formula, bool) {
        let root = self.expansion.roots.get(&atom).map(|&place| &self.page.roots[place]);
        match (root, symbolic::times(exponent, Rational::from_integer(2))) {
            (Some(NamedRoot { name, is_below, .. }), Some(twice)) => {
                (power(name.clone(), twice.abs()), twice.is_negative() != *is_below)
            }
            _ if exponent.is_negative() => {
                let of_norm = self.power_of_norm(atom, exponent.abs());
                (of_norm.unwrap_or_else(|| self.unnamed(atom, exponent.abs())), true)
            }
            _ => (self.unnamed(atom, exponent), false),
        }
    }

    /// Power of an atom with a positive exponent. A half-integer power of a sum of squares becomes a power of a norm,
    /// as in
    /// |r|³.
    pub(super) fn unnamed(&self, atom: Atom, exponent: Rational) -> Formula {
        if let Some(known) = self.powers.borrow().get(&(atom, exponent)) {
            return known.clone();
        }
        let power = self.new_power(atom, exponent);
        self.powers.borrow_mut().insert((atom, exponent), power.clone());
        power
    }

    fn new_power(&self, atom: Atom, exponent: Rational) -> Formula {
        if let Meaning::Sum(sum) = self.expansion.atoms.meaning(atom)
            && let Some(norm) = self.squared_norm(sum)
            && let Some(exponent) = symbolic::times(exponent, Rational::from_integer(2))
        {
            return power(norm, exponent);
        }
        // The square of a vector is written (p − e A)², other powers as those of its norm.
        if !exponent.is_one()
            && let Some(power) = self.power_of_norm(atom, exponent)
        {
            return power;
        }
        let written = self.atom(atom);
        match self.expansion.atoms.meaning(atom) {
            Meaning::Sum(sum) if exponent.is_integer() => {
                let factored = self.factored(sum);
                let is_short = divisor_length(&factored) <= divisor_length(&written);
                power(if is_short { factored } else { written }, exponent)
            }
            _ => power(written, exponent),
        }
    }

    /// Integer power of a sum that is the square of a vector or its negative, written as a power of the norm: |a − b|⁶ for the third
    /// power of (a − b)².
    fn power_of_norm(&self, atom: Atom, exponent: Rational) -> Option<Formula> {
        let Meaning::Sum(sum) = self.expansion.atoms.meaning(atom) else { return None };
        let (is_negative, square) = self.dotted_sum(sum)?.sign_and_magnitude();
        let Formula::Power(vector, two) = square else { return None };
        let is_square = *two == Formula::Number(Rational::from_integer(2)) && exponent.is_integer();
        let twice = symbolic::times(exponent, Rational::from_integer(2)).filter(|_| is_square)?;
        let norm = Formula::Call("norm".to_owned(), vec![*vector]);
        Some(power(norm, twice).signed(is_negative && exponent.numer() % 2 != 0))
    }

    pub(super) fn atom(&self, atom: Atom) -> Formula {
        let page = self.page;
        match self.expansion.atoms.meaning(atom) {
            Meaning::Variable(variable) => page.variable(*variable),
            Meaning::Pi => Formula::Pi,
            Meaning::Number(value) => Formula::number((*value).into()),
            Meaning::Definition(id) => page.derived(*id),
            Meaning::Function(name, x) => function(*name, self.sum(x)),
            Meaning::Atan2(y, x) => Formula::Call("atan2".to_owned(), vec![self.sum(y), self.sum(x)]),
            Meaning::Power(x, y) => Formula::Power(Box::new(self.sum(x)), Box::new(self.sum(y))),
            Meaning::External(function, arguments) => {
                page.supplied(function, arguments.iter().map(|x| self.sum(x)).collect())
            }
            Meaning::Vector(written, _) => written.clone(),
            Meaning::Sum(terms) => {
                let collected = self.sum(terms);
                let collected = match self.dotted_sum(terms) {
                    Some(dotted) => shorter(dotted, collected),
                    None => collected,
                };
                // Squares of differences are shorter as written.
                let source = self.expansion.atoms.source(atom).filter(|&id| self.keeps_names_of(id));
                let source = source.map(|id| page.derived(id));
                source.into_iter().fold(collected, shorter)
            }
        }
    }

    /// Returns whether every name in an expression is a definition that keeps its name.
    fn keeps_names_of(&self, id: Id) -> bool {
        let Page { graph, problem, .. } = self.page;
        let mut pending = vec![id];
        while let Some(id) = pending.pop() {
            match (self.expansion.names.contains(&id), problem.names.contains_key(&id)) {
                (true, _) => {}
                (false, true) => return false,
                (false, false) if self.page.symbols[id.index()] > READABLE => return false,
                (false, false) => graph.operands(id, |operand| pending.push(operand)),
            }
        }
        true
    }
}

/// Splits common factors from a sum: number, monomial and quotient. The number is negative if all terms are.
pub(super) fn taken_out(polynomial: &Polynomial) -> Option<(Rational, Monomial, Polynomial)> {
    let (number, monomial) = polynomial.content();
    let is_negative = polynomial.terms().all(|(_, c)| c.is_negative());
    let number = if is_negative { -number } else { number };
    let quotient = polynomial.scaled(&monomial.power(-Rational::one())?, number.recip())?;
    Some((number, monomial, quotient))
}

fn in_order(mut parts: Vec<(TermOrder, Formula)>) -> Formula {
    parts.sort_by(|(one, _), (two, _)| one.cmp(two));
    Formula::sum(parts.into_iter().map(|(_, part)| part).collect())
}

/// Rank of velocities in [`Collector::reading_order`]; accelerations and functions follow.
const MOVING: u8 = 7;

/// The shorter formula; the first in a tie.
fn shorter(one: Formula, other: Formula) -> Formula {
    if length(&one) <= length(&other) { one } else { other }
}
