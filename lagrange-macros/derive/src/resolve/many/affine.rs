//! Indices and bounds of ranges: whole numbers that are sums of running indices and lengths.

use num_traits::ToPrimitive;

use crate::symbolic::{Graph, Id, Node, Rational, Symbol};
use crate::variables::Variable;

/// A whole number that is known at run time.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(crate) enum Unknown {
    /// Running index of the loop at this depth.
    Level(usize),
    /// Length of arrays, by its index in the list of lengths.
    Length(usize),
}

/// Σ factor · unknown + constant; sorted by unknown, no factor is zero.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
pub(crate) struct Affine {
    pub(crate) terms: Vec<(Unknown, i64)>,
    pub(crate) constant: i64,
}

impl Affine {
    pub(crate) fn number(constant: i64) -> Self {
        Self { terms: Vec::new(), constant }
    }

    pub(crate) fn of(unknown: Unknown) -> Self {
        Self { terms: vec![(unknown, 1)], constant: 0 }
    }

    /// Reads a node of the graph; `None` if it is no sum of whole multiples of indices and lengths.
    pub(crate) fn read(graph: &Graph, id: Id) -> Option<Self> {
        if let Some(number) = graph.as_number(id) {
            return whole(number).map(Self::number);
        }
        match graph.node(id) {
            Node::Symbol(symbol) => unknown(*symbol).map(Self::of),
            Node::Sum(terms) => terms.iter().try_fold(Self::default(), |sum, &(term, factor)| {
                Some(sum.plus(&Self::read(graph, term)?, whole(factor)?))
            }),
            Node::Defined(inner) => Self::read(graph, *inner),
            _ => None,
        }
    }

    /// The number as a node of the graph.
    pub(crate) fn node(&self, graph: &mut Graph) -> Id {
        let constant = (Id::ONE, Rational::from_integer(self.constant.into()));
        let mut terms = vec![constant];
        for &(unknown, factor) in &self.terms {
            terms.push((graph.symbol(symbol(unknown)), Rational::from_integer(factor.into())));
        }
        graph.sum(terms)
    }

    /// This number plus `factor` times another.
    pub(crate) fn plus(&self, other: &Self, factor: i64) -> Self {
        let mut sum = self.clone();
        sum.constant += factor * other.constant;
        for &(unknown, of_other) in &other.terms {
            match sum.terms.binary_search_by_key(&unknown, |(known, _)| *known) {
                Ok(at) => sum.terms[at].1 += factor * of_other,
                Err(at) => sum.terms.insert(at, (unknown, factor * of_other)),
            }
        }
        sum.terms.retain(|(_, factor)| *factor != 0);
        sum
    }

    pub(crate) fn plus_number(&self, number: i64) -> Self {
        Self { constant: self.constant + number, ..self.clone() }
    }

    /// Its value if it contains no unknown.
    pub(crate) fn as_number(&self) -> Option<i64> {
        self.terms.is_empty().then_some(self.constant)
    }

    /// Factor of an unknown, or 0.
    pub(crate) fn factor(&self, unknown: Unknown) -> i64 {
        self.terms.iter().find(|(known, _)| *known == unknown).map_or(0, |(_, factor)| *factor)
    }

    /// The number with an unknown replaced.
    pub(crate) fn with(&self, unknown: Unknown, by: &Self) -> Self {
        let factor = self.factor(unknown);
        self.plus(&Self::of(unknown), -factor).plus(by, factor)
    }

    /// Depths of the loops whose indices it contains, outermost first.
    pub(crate) fn levels(&self) -> impl Iterator<Item = usize> {
        self.terms.iter().filter_map(|(unknown, _)| match unknown {
            Unknown::Level(level) => Some(*level),
            Unknown::Length(_) => None,
        })
    }

    /// Text of the number, from the names of its unknowns: `n - 1 - i`.
    pub(crate) fn text(&self, name: impl Fn(Unknown) -> String) -> String {
        let mut text = String::new();
        let mut push = |factor: i64, what: Option<String>| {
            let sign = match (factor < 0, text.is_empty()) {
                (true, true) => "-",
                (true, false) => " - ",
                (false, true) => "",
                (false, false) => " + ",
            };
            text += sign;
            text += &match (factor.abs(), what) {
                (1, Some(what)) => what,
                (factor, Some(what)) => format!("{factor}*{what}"),
                (number, None) => number.to_string(),
            };
        };
        let (first, last): (Vec<_>, Vec<_>) = self.terms.iter().partition(|(_, factor)| *factor > 0);
        first.iter().for_each(|(unknown, factor)| push(*factor, Some(name(*unknown))));
        if self.constant > 0 {
            push(self.constant, None);
        }
        last.iter().for_each(|(unknown, factor)| push(*factor, Some(name(*unknown))));
        if self.constant < 0 || self.constant == 0 && self.terms.is_empty() {
            push(self.constant, None);
        }
        text
    }
}

fn whole(number: Rational) -> Option<i64> {
    number.is_integer().then(|| number.to_integer().to_i64()).flatten()
}

fn unknown(symbol: Symbol) -> Option<Unknown> {
    match Variable::of(symbol) {
        Variable::Level(level) => Some(Unknown::Level(level)),
        Variable::Length(length) => Some(Unknown::Length(length)),
        _ => None,
    }
}

fn symbol(unknown: Unknown) -> Symbol {
    match unknown {
        Unknown::Level(level) => Variable::Level(level).symbol(),
        Unknown::Length(length) => Variable::Length(length).symbol(),
    }
}
