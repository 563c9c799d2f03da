//! Length of a formula, as a measure of its legibility.

use num_traits::One;

use super::formula::Formula;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Rational};

/// Longest formula, in symbols, that is legible.
pub(super) const READABLE: u64 = 250;

/// Number of symbols in a formula. A name, a number, an operator, an exponent or a pair of parentheses counts as one.
pub(super) fn length(formula: &Formula) -> usize {
    let all = |parts: &[Formula]| parts.iter().map(length).sum::<usize>();
    match formula {
        Formula::Number(_) | Formula::Scaled(_) | Formula::Pi | Formula::Name { .. } => 1,
        Formula::Multiplier(_) | Formula::Running { .. } | Formula::Member(..) => 1,
        Formula::Entry(whole, _) | Formula::Transpose(whole) => length(whole),
        Formula::Negative(inner) => 1 + length(inner),
        Formula::Sum(terms) => {
            let terms = terms.iter().enumerate();
            terms.map(|(i, term)| length(term) + usize::from(i > 0 && !term.is_negative())).sum()
        }
        Formula::Product(above, below) => {
            let factors = above.iter().chain(below);
            let is_apart = |factor: &&Formula| {
                matches!(factor, Formula::Sum(_) | Formula::Product(..) | Formula::Negative(_))
            };
            let parentheses = factors.filter(is_apart).count();
            all(above) + all(below) + parentheses + usize::from(!below.is_empty())
        }
        Formula::Power(base, exponent) => {
            length(base) + length(exponent) + usize::from(matches!(**base, Formula::Sum(_)))
        }
        Formula::Root(inner) => 1 + length(inner),
        Formula::Call(_, arguments) => 1 + all(arguments),
        Formula::SumOver { body, .. } | Formula::SumWhere { body, .. } => 3 + length(body),
        Formula::Vector(items) => 1 + all(items),
        Formula::Derivative { argument, .. } => 2 + length(argument),
        Formula::Partial { by, arguments, .. } => 1 + by.len() + all(arguments),
    }
}

/// Number of symbols of 1/(…).
pub(super) fn divisor_length(formula: &Formula) -> usize {
    length(&Formula::flat_product(Rational::one().into(), Vec::new(), vec![formula.clone()]))
}

/// Number of symbols of each node written out. Shared nodes count at each use.
pub(super) fn symbols(graph: &Graph, problem: &Problem) -> Vec<u64> {
    let mut symbols = Vec::with_capacity(graph.len());
    for id in graph.ids() {
        let mut size = 1_u64;
        if !problem.names.contains_key(&id) {
            graph.operands(id, |operand| size = size.saturating_add(symbols[operand.index()]));
        }
        symbols.push(size);
    }
    symbols
}
