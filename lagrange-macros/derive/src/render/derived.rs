//! Converts nodes of the graph to formulas. Definitions appear by name.

use num_traits::{One, Signed};

use super::formula::Formula;
use super::length::READABLE;
use super::page::Page;
use crate::resolve::many::Unknown;
use crate::symbolic::{Function, Id, Node, Rational, Scaled, times};
use crate::variables::Variable;

impl Page<'_> {
    /// Sums of nodes as they are computed, or the total number of symbols if that exceeds [`READABLE`].
    pub(super) fn computed<const K: usize>(&self, sums: [&[Id]; K]) -> Result<[Formula; K], u64> {
        let read = |id: &Id| self.derived.read.get(id).copied().unwrap_or(*id);
        let symbols = sums
            .concat()
            .iter()
            .map(read)
            .fold(0, |sum: u64, id| sum.saturating_add(self.symbols[id.index()]));
        let sum = |parts: &[Id]| Formula::sum(parts.iter().map(|part| self.derived(read(part))).collect());
        if symbols > READABLE { Err(symbols) } else { Ok(sums.map(sum)) }
    }

    pub(super) fn derived(&self, id: Id) -> Formula {
        let all = |ids: &[Id]| ids.iter().map(|&id| self.derived(id)).collect();
        match self.graph.node(id) {
            Node::Number(value) => Formula::number((*value).into()),
            Node::Pi => Formula::Pi,
            Node::Symbol(symbol) => self.variable(Variable::of(*symbol)),
            Node::Sum(terms) => {
                let order = terms.iter().copied();
                let mut order: Vec<(Id, Rational)> = order.collect();
                order.sort_by_cached_key(|(term, _)| (self.leads[term.index()], self.first_rank(*term)));
                self.derived_sum(&order)
            }
            Node::Product(_) => self.derived_term(id, Rational::one()),
            Node::Function(name, x) => function(*name, self.derived(*x)),
            Node::External(external) => self.supplied(external, all(&external.arguments)),
            Node::Atan2(y, x) => Formula::Call("atan2".to_owned(), all(&[*y, *x])),
            Node::Power(base, exponent) => {
                Formula::Power(Box::new(self.derived(*base)), Box::new(self.derived(*exponent)))
            }
            Node::Defined(inner) => match self.problem.names.get(&id) {
                Some(name) => Formula::labelled(name, 0),
                None => self.entries.get(&id).cloned().unwrap_or_else(|| self.derived(*inner)),
            },
        }
    }

    /// Sum of terms in this order, but for those with a minus sign, which follow the others.
    fn derived_sum(&self, terms: &[(Id, Rational)]) -> Formula {
        let mut terms: Vec<_> = terms.iter().map(|&(term, c)| self.derived_term(term, c)).collect();
        terms.sort_by_key(Formula::is_negative);
        // Nested sums are not flattened: parentheses show the terms that a definition groups.
        if terms.len() == 1 { terms.remove(0) } else { Formula::Sum(terms) }
    }

    /// Base of an even power: the sign of a sum is that of its leading term, as in (x − l)².
    fn derived_square(&self, base: Id) -> Formula {
        let Node::Sum(terms) = self.graph.node(base) else { return self.derived(base) };
        let leading = terms.iter().min_by_key(|(term, _)| self.leads[term.index()]);
        let is_turned = leading.is_some_and(|(_, c)| c.is_negative()) && terms.len() > 1;
        let mut order: Vec<(Id, Rational)> =
            terms.iter().map(|&(term, c)| (term, if is_turned { -c } else { c })).collect();
        order.sort_by_key(|(term, _)| self.leads[term.index()]);
        self.derived_sum(&order)
    }

    /// Product coefficient · term.
    fn derived_term(&self, term: Id, coefficient: Rational) -> Formula {
        let graph = self.graph;
        let Node::Product(factors) = graph.node(term) else {
            let above = if term == Id::ONE { Vec::new() } else { vec![self.derived(term)] };
            return Formula::flat_product(coefficient.into(), above, Vec::new());
        };
        let coefficient = Scaled { fraction: coefficient, exponent: graph.power_of_ten(factors) };
        let mut factors: Vec<_> = factors.to_vec();
        factors.retain(|&factor| !graph.is_power_of_ten(factor));
        factors.sort_by_key(|&(factor, _)| self.reading_order(factor));
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for (factor, exponent) in factors {
            let (power, is_below) = self.derived_power(factor, exponent);
            let side = if is_below { &mut below } else { &mut above };
            match power {
                Formula::Product(factors, divisors) if divisors.is_empty() => side.extend(factors),
                power => side.push(power),
            }
        }
        Formula::flat_product(coefficient, above, below)
    }

    /// Power of a node, without the sign of its exponent, and whether it is a divisor.
    fn derived_power(&self, base: Id, exponent: Rational) -> (Formula, bool) {
        let root = self.roots.iter().find(|root| root.base == base).map(|root| (&root.name, root.is_below));
        let root = root.or_else(|| self.norms.get(&base).map(|norm| (norm, false)));
        match (root.filter(|_| *exponent.denom() == 2), times(exponent, Rational::from_integer(2))) {
            (Some((name, is_below)), Some(twice)) => {
                (power(name.clone(), twice.abs()), twice.is_negative() != is_below)
            }
            _ => {
                let is_even = exponent.is_integer() && exponent.numer() % 2 == 0;
                let base = if is_even { self.derived_square(base) } else { self.derived(base) };
                let base = if is_even { base.sign_and_magnitude().1 } else { base };
                (power_of_product(base, exponent.abs()), exponent.is_negative())
            }
        }
    }

    /// Sort key of factors: parameters, then multipliers, definitions, coordinates, velocities, accelerations,
    /// functions.
    fn reading_order(&self, factor: Id) -> (u8, u32) {
        match self.graph.node(factor) {
            Node::Symbol(symbol) => match Variable::of(*symbol) {
                Variable::Parameter(k) => (0, self.ranks[k] as u32),
                Variable::Switch(_) => (0, u32::MAX),
                Variable::Multiplier(_) => (1, symbol.index),
                Variable::Time => (3, 0),
                Variable::Coordinate(_) => (4, symbol.index),
                Variable::Velocity(_) => (7, symbol.index),
                _ => (8, symbol.index),
            },
            Node::Pi => (0, 0),
            Node::Sum(_) if self.is_of_parameters(factor) => (0, 0),
            Node::Defined(_) => (2, factor.index() as u32),
            Node::Function(function, _) => (9 + *function as u8, factor.index() as u32),
            _ => (6, factor.index() as u32),
        }
    }

    /// Least rank of the parameters in a node.
    fn first_rank(&self, id: Id) -> Option<usize> {
        let rank = |symbol| match Variable::of(symbol) {
            Variable::Parameter(k) => Some(self.ranks[k]),
            _ => None,
        };
        self.graph.symbols(&[id]).filter_map(rank).min()
    }

    fn is_of_parameters(&self, id: Id) -> bool {
        self.graph.symbols(&[id]).all(|symbol| matches!(Variable::of(symbol), Variable::Parameter(_)))
    }

    fn whole_number(&self, unknown: Unknown) -> Formula {
        Formula::labelled(&self.problem.many.name(unknown), 0)
    }

    pub(super) fn variable(&self, variable: Variable) -> Formula {
        let coordinate = |i: usize, dots: usize| match self.problem.coordinates.get(i) {
            Some(coordinate) => Formula::labelled(&coordinate.text, dots),
            None => Formula::labelled(&self.angular_velocity(i), dots.saturating_sub(1)),
        };
        match variable {
            Variable::Time => Formula::labelled("t", 0),
            Variable::Coordinate(i) => coordinate(i, 0),
            Variable::Velocity(i) => coordinate(i, 1),
            Variable::Acceleration(i) => coordinate(i, 2),
            Variable::Multiplier(a) => Formula::Multiplier(self.problem.multiplier(a).text.clone()),
            Variable::Parameter(k) => Formula::labelled(&self.problem.parameters.name(k), 0),
            Variable::Switch(k) => Formula::labelled(&self.problem.parameters.name_of_switch(k), 0),
            Variable::Level(level) => self.whole_number(Unknown::Level(level)),
            Variable::Length(length) => self.whole_number(Unknown::Length(length)),
            Variable::Total(k) => self.totals[k].clone(),
            Variable::Momentum(i) => self.momentum_name(&self.problem.coordinates[i].text, 0),
            // All other variables occur in generated functions only, never in an equation.
            only_emitted => Formula::labelled(&format!("{only_emitted:?}"), 0),
        }
    }
}

/// The call f(x).
pub(super) fn function(function: Function, x: Formula) -> Formula {
    match function {
        Function::Ramp => Formula::Call("max".to_owned(), vec![x, Formula::sum(Vec::new())]),
        function => Formula::Call(function.name().to_owned(), vec![x]),
    }
}

/// Power of each factor, if these are names of quantities and functions of them.
fn power_of_product(base: Formula, exponent: Rational) -> Formula {
    let is_number = |factor: &Formula| matches!(factor, Formula::Number(_) | Formula::Scaled(_));
    match base {
        Formula::Product(factors, below)
            if below.is_empty() && exponent.is_integer() && !factors.iter().any(is_number) =>
        {
            Formula::Product(factors.into_iter().map(|factor| power(factor, exponent)).collect(), below)
        }
        base => power(base, exponent),
    }
}

pub(super) fn power(base: Formula, exponent: Rational) -> Formula {
    if exponent.is_one() {
        return base;
    }
    if exponent == Rational::new_raw(1, 2) {
        return Formula::Root(Box::new(base));
    }
    Formula::Power(Box::new(base), Box::new(Formula::Number(exponent)))
}
