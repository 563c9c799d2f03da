//! Takes common factors out of the terms of a sum where that is shorter.

use std::collections::BTreeSet;

use num_traits::{One, Signed};

use super::atoms::Meaning;
use super::collect::Collector;
use super::dependence::is_velocity;
use crate::symbolic::{self, Atom, Monomial, Polynomial, Rational};
use crate::variables::Variable;

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
    /// Key by which the best group is found: the symbols saved, then those of the common factor.
    pub(super) fn worth(&self) -> (isize, isize) {
        (self.saving, self.size)
    }
}

/// Longest sum, in terms, from which common factors are taken out.
const LONG: usize = 40;

impl Collector<'_, '_> {
    /// Terms that save the most symbols when written as one product that `may_be` accepts.
    pub(super) fn group(&self, polynomial: &Polynomial, may_be: impl Fn(&Group) -> bool) -> Option<Group> {
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
        self.take_half(&mut group)?;
        (group.saving >= least).then_some(group)
    }

    /// Splits a sum of constants off the quotient of a group, as in (1 − μ) (x + μ).
    fn factor(&self, group: &mut Group) {
        let Some(constants) = group.quotient.cofactor(|atom| !self.is_constant(atom)) else { return };
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

    /// Takes ½ out of a sum that moves if half of its terms have it, ½ m (1 + 4 c² r²) for m (½ + 2 c² r²), and puts it under the
    /// bar of a sum: books write it once. Sums of terms of different degrees in the momenta stay: p − ½ e B x.
    fn take_half(&self, group: &mut Group) -> Option<()> {
        let (two, quotient) = (Rational::from_integer(2), &group.quotient);
        if self.are_constant(quotient) || !self.are_alike(quotient) || quotient.denominators()? != two {
            return Some(());
        }
        let is_sum = |atom| matches!(self.expansion.atoms.meaning(atom), Meaning::Sum(_));
        let mut factors = group.monomial.factors().iter();
        let has_bar = factors.any(|&(atom, e)| is_sum(atom) && e.is_negative() && e.is_integer());
        let halves = quotient.terms().filter(|(_, c)| !c.is_integer()).count();
        if has_bar || 2 * halves >= quotient.len() {
            group.quotient = quotient.scaled(&Monomial::default(), two)?;
            group.number = symbolic::times(group.number, two.recip())?;
        }
        Some(())
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
            _ if self.is_known(quotient) => (1, 0),
            _ if monomial.is_one() && self.are_squares(quotient) => (1, 0),
            _ if monomial.is_one() => (2, 1),
            (true, _) => (1, 0),
            _ if self.is_of_time(quotient) => (1, 0),
            _ if quotient.len() == 2 && quotient.has_fraction() => {
                (4 + isize::from(monomial.has_divisor()), 0)
            }
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

    /// Whether a sum is the negative of one that the user wrote; `None` if the user wrote neither.
    fn direction(&self, sum: &Polynomial) -> Option<bool> {
        if let Some(known) = self.directions.borrow().get(sum) {
            return *known;
        }
        let may_be = self.page.sums.iter().any(|written| written.len() == sum.len());
        let terms = || sum.terms().map(|(monomial, &c)| self.product(c, monomial, &[])).collect::<Vec<_>>();
        let direction =
            may_be.then(|| self.page.directed(&terms())).flatten().map(|(is_turned, _)| is_turned);
        self.directions.borrow_mut().insert(sum.clone(), direction);
        direction
    }

    fn is_known(&self, quotient: &Polynomial) -> bool {
        self.direction(quotient).is_some()
    }

    /// True for the negative of a sum that the user wrote, and for x − l in other cases: a coordinate with a minus sign, and
    /// constants beside it.
    pub(super) fn is_turned(&self, quotient: &Polynomial) -> bool {
        if let Some(is_turned) = self.direction(quotient) {
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
}
