//! Converts polynomials to formulas. Common factors of several terms are taken out where that is shorter.

use std::cell::RefCell;
use std::collections::BTreeSet;

use num_traits::{One, Signed};
use rustc_hash::{FxHashMap, FxHashSet};

use super::super::derived::{function, power};
use super::super::formula::Formula;
use super::super::length::{READABLE, length};
use super::super::page::Page;
use super::atoms::Meaning;
use super::expand::Expansion;
use super::polynomial::{Atom, Monomial, Polynomial, common};
use crate::symbolic::{self, Id, Rational, Scaled};
use crate::variables::Variable;

/// Writes polynomials as formulas.
pub(super) struct Collector<'a, 'p> {
    pub(super) page: &'a Page<'p>,
    pub(super) expansion: &'a Expansion<'a>,
    /// Definitions that depend on neither time nor state.
    pub(super) constants: &'a FxHashSet<Id>,
    pub(super) written: RefCell<FxHashMap<Atom, Formula>>,
}

/// Product number · monomial · quotient that equals the `members`, which are terms of a sum.
struct Group {
    members: Vec<Monomial>,
    number: Rational,
    monomial: Monomial,
    quotient: Polynomial,
    /// Number of symbols that the product saves compared with the sum of the members.
    saving: isize,
    /// Number of symbols of number and monomial.
    size: isize,
}

impl Group {
    /// Sort key: the saving, then the length of the common factor.
    fn worth(&self) -> (isize, isize) {
        (self.saving, self.size)
    }
}

/// Sort key of a term in a sum: multipliers last, plus signs before minus signs, higher degree in the velocities first.
type TermOrder = (bool, bool, Option<Rational>, Monomial);

impl Collector<'_, '_> {
    pub(super) fn sum(&self, polynomial: &Polynomial) -> Formula {
        let mut parts: Vec<(TermOrder, Formula)> = Vec::new();
        let mut rest = polynomial.clone();
        while let Some(group) = self.group(&rest) {
            group.members.iter().for_each(|member| rest.remove(member));
            let place = self.place(&group.members[0], group.number);
            parts.push((place, self.product(group.number, &group.monomial, Some(&group.quotient))));
        }
        let terms =
            rest.terms().map(|(monomial, &c)| (self.place(monomial, c), self.product(c, monomial, None)));
        parts.extend(terms);
        parts.sort_by(|(one, _), (two, _)| one.cmp(two));
        Formula::sum(parts.into_iter().map(|(_, part)| part).collect())
    }

    fn place(&self, monomial: &Monomial, number: Rational) -> TermOrder {
        let speed = self.degree(monomial, is_velocity).map(|degree| -degree);
        let has_multiplier = monomial.factors().iter().any(|(atom, _)| self.is_multiplier(*atom));
        (has_multiplier, number.is_negative() && !has_multiplier, speed, monomial.clone())
    }

    /// Variable of an atom, or all variables in a product of vectors.
    fn variables(&self, atom: Atom) -> &[Variable] {
        match self.expansion.atoms.meaning(atom) {
            Meaning::Variable(variable) => std::slice::from_ref(variable),
            Meaning::Vector(_, variables) => variables,
            _ => &[],
        }
    }

    pub(super) fn variable(&self, atom: Atom) -> Option<Variable> {
        if let [variable] = self.variables(atom) { Some(*variable) } else { None }
    }

    fn is_multiplier(&self, atom: Atom) -> bool {
        matches!(self.variable(atom), Some(Variable::Multiplier(_)))
    }

    pub(super) fn acceleration(&self, atom: Atom) -> Option<usize> {
        match self.variable(atom) {
            Some(Variable::Acceleration(i)) => Some(i),
            _ => None,
        }
    }

    pub(super) fn velocity(&self, atom: Atom) -> Option<usize> {
        match self.variable(atom) {
            Some(Variable::Velocity(i)) => Some(i),
            _ => None,
        }
    }

    /// Returns whether an atom depends on neither time nor state.
    pub(super) fn is_constant(&self, atom: Atom) -> bool {
        let all = |polynomial: &Polynomial| self.are_constant(polynomial);
        match self.expansion.atoms.meaning(atom) {
            Meaning::Variable(variable) => matches!(variable, Variable::Parameter(_)),
            Meaning::Pi | Meaning::Number(_) => true,
            Meaning::Definition(id) => self.constants.contains(id),
            Meaning::Function(_, x) | Meaning::Sum(x) => all(x),
            Meaning::Atan2(x, y) | Meaning::Power(x, y) => all(x) && all(y),
            Meaning::External(_, arguments) => arguments.iter().all(all),
            Meaning::Vector(_, of) => {
                !of.is_empty() && of.iter().all(|variable| matches!(variable, Variable::Parameter(_)))
            }
        }
    }

    fn are_constant(&self, polynomial: &Polynomial) -> bool {
        polynomial
            .terms()
            .all(|(monomial, _)| monomial.factors().iter().all(|(atom, _)| self.is_constant(*atom)))
    }

    fn moving(&self, monomial: &Monomial) -> Monomial {
        monomial.filtered(|atom| !self.is_constant(atom))
    }

    /// Terms that save the most symbols when written as one product.
    fn group(&self, polynomial: &Polynomial) -> Option<Group> {
        let monomials: Vec<&Monomial> = polynomial.terms().map(|(monomial, _)| monomial).collect();
        if monomials.len() < 2 || monomials.len() > LONG {
            return None;
        }
        let alike: BTreeSet<Monomial> = monomials.iter().map(|monomial| self.moving(monomial)).collect();
        let with_equal = alike.iter().filter(|moving| !moving.is_one()).map(|moving| {
            monomials.iter().copied().filter(|monomial| self.moving(monomial) == *moving).collect()
        });
        let pairs = monomials.iter().enumerate();
        let shared: BTreeSet<Monomial> =
            pairs.flat_map(|(i, one)| monomials[i + 1..].iter().map(|two| one.shared(two))).collect();
        let with_shared = shared.iter().map(|shared| {
            monomials.iter().copied().filter(|monomial| monomial.shared(shared) == *shared).collect()
        });
        let groups = with_equal.chain(with_shared).filter_map(|members| self.candidate(polynomial, members));
        groups.reduce(|best, next| if next.worth() > best.worth() { next } else { best })
    }

    /// Factors the sum of these terms of a polynomial into one product. `None` if that saves too few symbols.
    fn candidate(&self, polynomial: &Polynomial, members: Vec<&Monomial>) -> Option<Group> {
        if members.len() < 2 {
            return None;
        }
        let chosen: Polynomial =
            members.iter().filter_map(|&m| Some((m.clone(), polynomial.coefficient(m)?))).collect();
        let (number, monomial) = chosen.content();
        let is_negative = chosen.terms().all(|(_, c)| c.is_negative());
        let number = if is_negative { -number } else { number };
        let quotient = chosen.scaled(&monomial.power(-Rational::one())?, number.recip())?;
        let (monomial, quotient) = self.over_common(monomial, quotient)?;
        let size = self.size(&monomial) + isize::from(!number.abs().is_one());
        let (parentheses, least) = self.parentheses(&monomial, &quotient);
        let saving = (members.len() as isize - 1) * size - parentheses;
        let members = members.into_iter().cloned().collect();
        (saving >= least).then_some(Group { members, number, monomial, quotient, saving, size })
    }

    /// Combines constants over a common denominator: (a m + b)/m for a + b/m.
    fn over_common(
        &self,
        mut monomial: Monomial,
        mut quotient: Polynomial,
    ) -> Option<(Monomial, Polynomial)> {
        if !self.are_constant(&quotient) {
            return Some((monomial, quotient));
        }
        let factors: Vec<(Atom, Rational)> =
            quotient.terms().flat_map(|(monomial, _)| monomial.factors().to_vec()).collect();
        let below: BTreeSet<Atom> =
            factors.iter().filter(|(_, exponent)| exponent.is_negative()).map(|&(atom, _)| atom).collect();
        for atom in below {
            let least = quotient.terms().map(|(monomial, _)| monomial.exponent(atom)).min()?;
            monomial = monomial.times(&Monomial::of(atom, least))?;
            quotient = quotient.scaled(&Monomial::of(atom, -least), Rational::one())?;
        }
        Some((monomial, quotient))
    }

    /// Cost of parentheses around a quotient, and minimum saving, both in symbols. Parentheses around constants and
    /// differences are easier to read than others, and nested fractions harder. Moving factors should stay visible.
    fn parentheses(&self, monomial: &Monomial, quotient: &Polynomial) -> (isize, isize) {
        let has_fraction =
            |(monomial, _): (&Monomial, _)| monomial.factors().iter().any(|(_, e)| e.is_negative());
        match (self.are_constant(quotient), self.moving(monomial).is_one()) {
            _ if monomial.is_one() => (2, 1),
            (true, _) => (1, 0),
            _ if quotient.len() == 2 && quotient.terms().any(has_fraction) => (5, 0),
            (_, true) if self.are_differences(quotient) => (1, 0),
            (_, true) if self.are_alike(quotient) => (2, 0),
            (_, true) => (4, 1),
            (_, false) if self.is_of_coordinates(quotient) => (2, 1),
            (_, false) => (2, 3),
        }
    }

    /// Returns whether all terms have the same degree in the velocities.
    fn are_alike(&self, quotient: &Polynomial) -> bool {
        let mut degrees = quotient.terms().map(|(monomial, _)| self.degree(monomial, is_velocity));
        let first = degrees.next();
        degrees.all(|degree| Some(degree) == first)
    }

    /// Returns whether the polynomial contains coordinates and constants only.
    fn is_of_coordinates(&self, quotient: &Polynomial) -> bool {
        let is_it =
            |atom| matches!(self.variable(atom), Some(Variable::Coordinate(_))) || self.is_constant(atom);
        quotient.terms().all(|(monomial, _)| monomial.factors().iter().all(|&(atom, _)| is_it(atom)))
    }

    /// Returns whether all terms are products of coordinates of one degree with coefficients ±1, such as x₁ − x₂.
    fn are_differences(&self, quotient: &Polynomial) -> bool {
        let is_coordinate = |variable| matches!(variable, Variable::Coordinate(_));
        let mut degrees = quotient.terms().map(|(monomial, c)| {
            let is_it = c.abs().is_one()
                && monomial.factors().iter().all(|(atom, _)| self.variable(*atom).is_some_and(is_coordinate));
            is_it.then(|| self.degree(monomial, is_coordinate)).flatten()
        });
        let first = degrees.next().flatten();
        first.is_some() && degrees.all(|degree| degree == first)
    }

    /// Degree of a monomial in the variables that `counts` selects; `None` if the exponents overflow.
    fn degree(&self, monomial: &Monomial, counts: impl Fn(Variable) -> bool) -> Option<Rational> {
        let count = |atom| self.variables(atom).iter().filter(|variable| counts(**variable)).count();
        monomial.factors().iter().try_fold(Rational::default(), |degree, &(atom, exponent)| {
            symbolic::plus(degree, symbolic::times(exponent, Rational::from_integer(count(atom) as i128))?)
        })
    }

    fn size(&self, monomial: &Monomial) -> isize {
        let sizes =
            monomial.factors().iter().map(|&(atom, exponent)| length(&self.power(atom, exponent.abs())));
        sizes.sum::<usize>() as isize
    }

    /// Product number · monomial · quotient.
    pub(super) fn product(
        &self,
        number: Rational,
        monomial: &Monomial,
        quotient: Option<&Polynomial>,
    ) -> Formula {
        let mut factors: Vec<_> = monomial.factors().to_vec();
        let tens = factors.iter().position(|&(atom, exponent)| self.is_ten(atom) && exponent.is_integer());
        let exponent = tens.map_or(Rational::default(), |place| factors.remove(place).1);
        let number = Scaled { fraction: number, exponent: *exponent.numer() as i32 };
        factors.sort_by_key(|&(atom, _)| self.reading_order(atom));
        let (mut above, mut below, mut place) = (Vec::new(), Vec::new(), 0);
        for (atom, exponent) in factors {
            let power = self.power(atom, exponent.abs());
            let before = if exponent.is_negative() { &mut below } else { &mut above };
            before.push(power);
            // The quotient goes before velocities, accelerations and functions.
            place = if self.reading_order(atom) < (MOVING, 0) { above.len() } else { place };
        }
        if let Some(quotient) = quotient {
            let place = if self.are_constant(quotient) { 0 } else { place };
            above.insert(place, self.sum(quotient));
        }
        Formula::product(number, above, below)
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

    /// Power of an atom with a positive exponent. A half-integer power of a sum of squares becomes a power of a norm,
    /// as in
    /// |r|³.
    fn power(&self, atom: Atom, exponent: Rational) -> Formula {
        if let Meaning::Sum(sum) = self.expansion.atoms.meaning(atom)
            && let Some(norm) = self.squared_norm(sum)
            && let Some(exponent) = symbolic::times(exponent, Rational::from_integer(2))
        {
            return power(norm, exponent);
        }
        power(self.atom(atom), exponent)
    }

    pub(super) fn atom(&self, atom: Atom) -> Formula {
        if let Some(known) = self.written.borrow().get(&atom) {
            return known.clone();
        }
        let formula = self.new_atom(atom);
        self.written.borrow_mut().insert(atom, formula.clone());
        formula
    }

    fn new_atom(&self, atom: Atom) -> Formula {
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
                // Squares of differences are shorter as written.
                let source = self.expansion.atoms.source(atom).filter(|&id| self.keeps_names_of(id));
                let source = source.map(|id| page.derived(id));
                source.filter(|source| length(source) < length(&collected)).unwrap_or(collected)
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

fn is_velocity(variable: Variable) -> bool {
    matches!(variable, Variable::Velocity(_) | Variable::Momentum(_))
}

/// Rank of velocities in [`Collector::reading_order`]; accelerations and functions follow.
const MOVING: u8 = 7;

/// Longest sum, in terms, from which common factors are taken out.
const LONG: usize = 40;

/// Common factor of all terms, restricted to atoms that `may_go` accepts.
pub(super) fn shared(polynomial: &Polynomial, may_go: impl Fn(Atom) -> bool) -> (Rational, Monomial) {
    let (_, monomial) = polynomial.content();
    (common(polynomial.terms().map(|(_, &c)| c)), monomial.filtered(may_go))
}
