//! Converts polynomials to formulas. Common factors of several terms are taken out where that is shorter.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use num_traits::{One, Signed};
use rustc_hash::{FxHashMap, FxHashSet};

use super::super::derived::{function, power};
use super::super::formula::Formula;
use super::super::length::{READABLE, length};
use super::super::page::Page;
use super::super::roots::NamedRoot;
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

/// Product number · monomial · quotient, or number · monomial · quotient², that equals the `members`, which are terms of a
/// sum.
pub(super) struct Group {
    pub(super) members: Vec<Monomial>,
    pub(super) number: Rational,
    pub(super) monomial: Monomial,
    pub(super) quotient: Polynomial,
    pub(super) is_square: bool,
    /// A second sum that the product has as a factor, of constants.
    pub(super) constants: Option<Polynomial>,
    /// Number of symbols that the product saves compared with the sum of the members.
    pub(super) saving: isize,
    /// Number of symbols of number and monomial.
    pub(super) size: isize,
}

impl Group {
    /// Sort key: the saving, then the length of the common factor.
    pub(super) fn worth(&self) -> (isize, isize) {
        (self.saving, self.size)
    }
}

/// Sort key of a term in a sum: multipliers last, plus signs before minus signs, higher degree in the velocities first
/// (lower beside accelerations), squares before products, and in the order of the velocities.
pub(super) type TermOrder = (bool, bool, Option<Rational>, usize, Monomial, Monomial);

impl Collector<'_, '_> {
    pub(super) fn sum(&self, polynomial: &Polynomial) -> Formula {
        in_order(self.parts(polynomial, |_| true))
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

    /// Terms of a sum, some of them products of several terms that `may_be` accepts, with their places.
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

    /// Returns whether an atom depends on variables that `may_occur` accepts only.
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

    fn consists_of(&self, polynomial: &Polynomial, may_occur: fn(&Variable) -> bool) -> bool {
        let mut atoms = polynomial.terms().flat_map(|(monomial, _)| monomial.factors());
        atoms.all(|&(atom, _)| self.depends_on(atom, may_occur))
    }

    fn are_constant(&self, polynomial: &Polynomial) -> bool {
        self.consists_of(polynomial, |variable| matches!(variable, Variable::Parameter(_)))
    }

    /// Returns whether the polynomial depends on parameters and time only.
    fn is_of_time(&self, polynomial: &Polynomial) -> bool {
        self.consists_of(polynomial, |variable| matches!(variable, Variable::Parameter(_) | Variable::Time))
    }

    pub(super) fn moving(&self, monomial: &Monomial) -> Monomial {
        monomial.filtered(|atom| !self.is_constant(atom))
    }

    /// Terms that save the most symbols when written as one product that `may_be` accepts.
    fn group(&self, polynomial: &Polynomial, may_be: impl Fn(&Group) -> bool) -> Option<Group> {
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
        groups
            .chain(self.squares(polynomial))
            .filter(may_be)
            .reduce(|best, next| if next.worth() > best.worth() { next } else { best })
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
        let quotient = chosen.scaled(&monomial.power(-Rational::one())?, number.recip())?;
        let has_plus =
            polynomial.terms().any(|(monomial, c)| c.is_positive() && !members.contains(&monomial));
        let is_turned = is_negative
            || self.is_turned(&quotient)
            || self.is_subtracted(&quotient)
            || has_plus && self.leads_subtracted(&quotient);
        let (number, quotient) = if is_turned { (-number, quotient.negated()) } else { (number, quotient) };
        if self.are_unlike(&monomial, &quotient) {
            return None;
        }
        let (number, monomial, quotient) = self.over_common(number, monomial, quotient)?;
        let is_fraction =
            monomial.has_divisor() && self.moving(&monomial).is_divisor() && !quotient.has_fraction();
        let size = self.size(&monomial) + isize::from(!number.abs().is_one()) + isize::from(is_fraction);
        let (parentheses, least) = self.parentheses(&monomial, &quotient);
        let saving = (members.len() as isize - 1) * size - parentheses;
        let members = members.into_iter().cloned().collect();
        let is_square = false;
        let mut group =
            Group { members, number, monomial, quotient, is_square, constants: None, saving, size };
        self.factor(&mut group);
        (group.saving >= least).then_some(group)
    }

    /// Splits a sum of constants off the quotient of a group, as in (1 − μ) (x + μ).
    fn factor(&self, group: &mut Group) {
        let Some(constants) = self.constant_factor(&group.quotient) else { return };
        let Some(quotient) = group.quotient.divided(&constants).filter(|quotient| quotient.len() > 1) else {
            return;
        };
        let flat = |sum: &Polynomial| {
            let terms = sum.terms().map(|(monomial, &c)| self.term_length(c.abs(), monomial) + 1);
            terms.sum::<isize>()
        };
        let [before, first, second] = [&group.quotient, &constants, &quotient].map(flat);
        if before > first + second + 1 {
            let is_turned = quotient.terms().all(|(_, c)| c.is_negative()) || self.is_turned(&quotient);
            let quotient = if is_turned { quotient.negated() } else { quotient };
            group.number = if is_turned { -group.number } else { group.number };
            group.saving += before - first - second - 1;
            (group.constants, group.quotient) = (Some(constants), quotient);
        }
    }

    /// The shortest sum of constants that one moving factor is multiplied by, with a positive first term.
    fn constant_factor(&self, sum: &Polynomial) -> Option<Polynomial> {
        let mut parts: BTreeMap<Monomial, Polynomial> = BTreeMap::new();
        for (monomial, &c) in sum.terms() {
            let moving = self.moving(monomial);
            parts.entry(moving.clone()).or_default().push(monomial.over(&moving)?, c)?;
        }
        let shortest =
            parts.into_values().min_by_key(Polynomial::len).filter(|shortest| shortest.len() > 1)?;
        let (number, monomial) = shortest.content();
        let number = if shortest.terms().next()?.1.is_negative() { -number } else { number };
        shortest.scaled(&monomial.power(-Rational::one())?, number.recip())
    }

    /// True for a sum of constants of different degrees that a coordinate is multiplied by, such as the one of a spring and
    /// the one of a centrifugal force, (m ω² − k) x. Numbers have any degree.
    fn are_unlike(&self, monomial: &Monomial, quotient: &Polynomial) -> bool {
        let is_moving = |atom: Atom| {
            self.variables(atom).iter().any(|&variable| {
                is_velocity(variable)
                    || matches!(variable, Variable::Acceleration(_) | Variable::Multiplier(_))
            })
        };
        if !self.are_constant(quotient) || monomial.factors().iter().any(|&(atom, _)| is_moving(atom)) {
            return false;
        }
        let degree = |monomial: &Monomial| {
            monomial.factors().iter().try_fold(Rational::default(), |sum, &(_, e)| symbolic::plus(sum, e))
        };
        let degrees: BTreeSet<Option<Rational>> =
            quotient.terms().map(|(monomial, _)| degree(monomial)).collect();
        degrees.len() > 1 && quotient.terms().all(|(monomial, _)| !monomial.is_one())
    }

    /// True for the negative of a sum that the user wrote, and for x − l in other cases: a coordinate with a minus sign, and
    /// constants beside it.
    pub(super) fn is_turned(&self, quotient: &Polynomial) -> bool {
        let is_known = self.page.sums.iter().any(|sum| sum.len() == quotient.len());
        let terms =
            || quotient.terms().map(|(monomial, &c)| self.product(c, monomial, &[])).collect::<Vec<_>>();
        if let Some((is_turned, _)) = is_known.then(|| self.page.directed(&terms())).flatten() {
            return is_turned;
        }
        let is_coordinate = |monomial: &Monomial| match monomial.factors() {
            [(atom, exponent)] => {
                exponent.is_one() && matches!(self.variable(*atom), Some(Variable::Coordinate(_)))
            }
            _ => false,
        };
        let (coordinates, others): (Vec<_>, Vec<_>) =
            quotient.terms().partition(|(monomial, _)| is_coordinate(monomial));
        let are_constant = others.iter().all(|(monomial, _)| self.moving(monomial).is_one());
        matches!(coordinates[..], [(_, c)] if c.is_negative()) && are_constant && !others.is_empty()
    }

    /// True for a γ² cos(γ t) − g: a constant with a minus sign, and terms that depend on time.
    fn is_subtracted(&self, quotient: &Polynomial) -> bool {
        let mut constants =
            quotient.terms().filter(|(monomial, _)| self.moving(monomial).is_one()).peekable();
        constants.peek().is_some()
            && self.is_of_time(quotient)
            && !self.are_constant(quotient)
            && constants.all(|(_, c)| c.is_negative())
    }

    /// True for −p₁ + p₂ cos θ, whose first momentum has a minus sign.
    fn leads_subtracted(&self, quotient: &Polynomial) -> bool {
        let is_momentum = |variable| matches!(variable, Variable::Momentum(_));
        let leading = quotient.terms().min_by_key(|(monomial, _)| self.place(monomial, Rational::one()));
        leading.is_some_and(|(monomial, c)| {
            c.is_negative() && self.degree(monomial, is_momentum).is_some_and(|degree| degree.is_positive())
        })
    }

    /// Combines constants over a common denominator, (a m + b)/m for a + b/m, and the terms of a numerator over a sum,
    /// (b x + a y)/(a b (l + m)) for (x/a + y/b)/(l + m).
    fn over_common(
        &self,
        mut number: Rational,
        mut monomial: Monomial,
        mut quotient: Polynomial,
    ) -> Option<(Rational, Monomial, Polynomial)> {
        if !self.are_constant(&quotient) {
            let has_sum = quotient.terms().any(|(monomial, _)| self.is_over_sum(monomial));
            if !quotient.has_fraction() || has_sum || !self.is_over_sum(&monomial) {
                return Some((number, monomial, quotient));
            }
            let denominators = quotient.denominators()?;
            number = symbolic::times(number, denominators.recip())?;
            quotient = quotient.scaled(&Monomial::default(), denominators)?;
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
        Some((number, monomial, quotient))
    }

    /// Returns whether a sum without a name divides.
    fn is_over_sum(&self, monomial: &Monomial) -> bool {
        let is_sum = |atom| matches!(self.expansion.atoms.meaning(atom), Meaning::Sum(_));
        monomial.factors().iter().any(|&(atom, exponent)| {
            exponent.is_negative() && is_sum(atom) && !self.expansion.roots.contains_key(&atom)
        })
    }

    /// Cost of parentheses around a quotient, and minimum saving, both in symbols. Parentheses around constants and
    /// differences are easier to read than others, and nested fractions harder. Moving factors should stay visible.
    fn parentheses(&self, monomial: &Monomial, quotient: &Polynomial) -> (isize, isize) {
        match (self.are_constant(quotient), self.moving(monomial).is_one()) {
            _ if monomial.is_one() => (2, 1),
            (true, _) => (1, 0),
            _ if self.is_of_time(quotient) => (1, 0),
            _ if quotient.len() == 2 && quotient.has_fraction() => (5, 0),
            // A fraction bar groups the terms.
            _ if monomial.is_divisor() && !quotient.has_fraction() => (1, 1),
            (_, true) if self.are_differences(quotient) || self.is_elongation(quotient) => (1, 0),
            (_, true) if self.are_alike(quotient) => (2, 0),
            (_, true) => (4, 1),
            (_, false) if !self.is_of_coordinates(quotient) => (2, 3),
            (_, false) if quotient.len() == 2 && self.are_differences(quotient) => (1, 0),
            (_, false) => (2, 1),
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

    /// Returns whether the polynomial is x − l, with a coordinate and a constant.
    fn is_elongation(&self, quotient: &Polynomial) -> bool {
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
    fn are_differences(&self, quotient: &Polynomial) -> bool {
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

    fn size(&self, monomial: &Monomial) -> isize {
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
            _ => (self.unnamed(atom, exponent.abs()), exponent.is_negative()),
        }
    }

    /// Power of an atom with a positive exponent. A half-integer power of a sum of squares becomes a power of a norm,
    /// as in
    /// |r|³.
    pub(super) fn unnamed(&self, atom: Atom, exponent: Rational) -> Formula {
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
                let dotted = self.dotted_sum(terms).filter(|dotted| length(dotted) <= length(&collected));
                let collected = dotted.unwrap_or(collected);
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

fn in_order(mut parts: Vec<(TermOrder, Formula)>) -> Formula {
    parts.sort_by(|(one, _), (two, _)| one.cmp(two));
    Formula::sum(parts.into_iter().map(|(_, part)| part).collect())
}

pub(super) fn is_velocity(variable: Variable) -> bool {
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
