//! Sums of terms that are positive for all masses, inertias and lengths, in all directions.
//!
//! A mass or a moment of inertia is positive, while a component of a vector may have either sign. So a product that is
//! odd in at most one number, such as m c² or I, counts as positive. A product that is odd in three numbers, such as m
//! c s, does not.

use num_traits::{One, Signed};
use rustc_hash::FxHashMap;

use crate::symbolic::{Function, Graph, Id, Node, Rational};

/// Largest number of products of an expanded expression that is examined.
const LONG: usize = 64;

/// Factors with an odd exponent in a product, sorted, and whether the product has a minus sign.
type OddFactors = (Vec<Id>, bool);

/// Collects the terms of a sum that are surely positive. Definitions that are not surely positive as a whole are
/// searched for such terms.
pub(super) fn positive_terms(graph: &mut Graph, sum: Id) -> Vec<Id> {
    let products = products(graph, sum);
    let is_positive = |id: Id| {
        let products = products.get(&id).and_then(Option::as_ref);
        products.is_some_and(|all| all.iter().all(|(odd, is_negative)| !is_negative && odd.len() <= 1))
    };
    let (mut pending, mut found) = (vec![(sum, Rational::one())], Vec::new());
    while let Some((id, coefficient)) = pending.pop() {
        match graph.node(id) {
            Node::Sum(terms) => pending.extend(terms.iter().map(|&(term, c)| (term, c * coefficient))),
            _ if is_positive(id) && coefficient.is_positive() => found.push((id, coefficient)),
            &Node::Defined(inner) => pending.push((inner, coefficient)),
            _ => {}
        }
    }
    found.into_iter().map(|term| graph.sum([term])).collect()
}

/// For each node of an expression, the distinct products of its expansion; `None` for more than [`LONG`].
fn products(graph: &Graph, root: Id) -> FxHashMap<Id, Option<Vec<OddFactors>>> {
    let mut products: FxHashMap<Id, Option<Vec<OddFactors>>> = FxHashMap::default();
    for id in graph.reachable(&[root]) {
        let of = |id: &Id| products.get(id).cloned().flatten();
        let found = match graph.node(id) {
            Node::Number(x) => Some(vec![(Vec::new(), x.is_negative())]),
            Node::Pi | Node::Function(Function::Abs | Function::Exp | Function::Cosh, _) => Some(number()),
            Node::Defined(inner) => of(inner),
            Node::Sum(terms) => terms.iter().try_fold(Vec::new(), |mut sum, (term, c)| {
                sum.extend(
                    of(term)?.into_iter().map(|(odd, is_negative)| (odd, is_negative != c.is_negative())),
                );
                Some(sum)
            }),
            Node::Product(factors) => factors.iter().try_fold(number(), |product, (factor, e)| match e {
                _ if e.is_one() => Some(multiplied(&product, &of(factor)?)),
                _ if e.is_integer() && e.numer() % 2 != 0 => {
                    Some(multiplied(&product, &[(vec![*factor], false)]))
                }
                _ => Some(product),
            }),
            _ => Some(vec![(vec![id], false)]),
        };
        let short = found.map(|mut found| {
            found.sort_unstable();
            found.dedup();
            found
        });
        products.insert(id, short.filter(|found| found.len() <= LONG));
    }
    products
}

/// A number: one product without odd factors.
fn number() -> Vec<OddFactors> {
    vec![(Vec::new(), false)]
}

fn multiplied(one: &[OddFactors], other: &[OddFactors]) -> Vec<OddFactors> {
    let products = one.iter().flat_map(|(odd, minus)| {
        other.iter().map(move |(too, more)| (in_one_alone(odd, too), minus != more))
    });
    products.collect()
}

/// Factors with an odd exponent in a product, from those of its two operands. A factor in both lists gets an even
/// exponent and is dropped.
fn in_one_alone(one: &[Id], other: &[Id]) -> Vec<Id> {
    let without = |these: &[Id], those: &[Id]| -> Vec<Id> {
        these.iter().copied().filter(|id| !those.contains(id)).collect()
    };
    let mut alone = [without(one, other), without(other, one)].concat();
    alone.sort_unstable();
    alone
}
