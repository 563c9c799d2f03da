//! Combines products in a sum that differ in one factor, if the sum of the differing factors is no longer than each:
//! (u + v) u s − u v s is u² s.
//!
//! For a Lagrangian with cos(q₁ − q₂), dp/dt and ∂L/∂q have such products of velocities in common. Their combined
//! difference is the form in textbooks.

use num_traits::One;
use rustc_hash::FxHashMap;

use super::graph::{Graph, Id, Node};
use super::rational::{Rational, plus};

/// Largest number of terms of a sum that is searched.
const TERMS: usize = 1000;

/// A product and its coefficient in the sum.
pub(super) type Term = (Id, Rational);
type FactorPowers = Vec<(Id, Rational)>;

/// The products of a sum, indexed by the rest that remains without one factor.
#[derive(Default)]
struct CommonFactors {
    /// `None` for products that were combined into others.
    terms: Vec<Option<Term>>,
    /// For each rest, the indices of the terms that contain it, each with its remaining factor.
    by_rest: FxHashMap<FactorPowers, Vec<(usize, Id)>>,
}

impl Graph {
    /// Combines the products of a sum; returns the sum unchanged if it becomes no shorter.
    pub fn combined(&mut self, sum: Id) -> Id {
        let fault = self.take_fault();
        let combined = self.combine(sum).filter(|_| self.take_fault().is_none());
        fault.map(|fault| self.fail(fault));
        combined.unwrap_or(sum)
    }

    fn combine(&mut self, sum: Id) -> Option<Id> {
        let Node::Sum(terms) = self.node(sum) else { return None };
        let mut waiting: Vec<Term> = terms.iter().rev().copied().collect();
        let (before, mut products) = (waiting.len(), CommonFactors::default());
        while let Some(term) = waiting.pop().filter(|_| before <= TERMS) {
            match products.taken_in(self, term) {
                Some(both) => waiting.push(both),
                None => products.put(self, term),
            }
        }
        let combined = self.sum(products.terms.into_iter().flatten());
        // A combined product may itself be a sum.
        (self.length(combined) < before).then_some(combined)
    }

    /// Each factor of a product with a positive integer exponent, and the product without it.
    fn rests(&self, product: Id) -> Vec<(Id, FactorPowers)> {
        let Node::Product(factors) = self.node(product) else { return Vec::new() };
        let without = |k: usize| {
            let (mut rest, (factor, exponent)) = (factors.to_vec(), factors[k]);
            match exponent.is_one() {
                true => drop(rest.remove(k)),
                false => rest[k].1 = plus(exponent, -Rational::one())?,
            }
            Some((factor, rest))
        };
        let is_whole = |k: &usize| factors[*k].1.is_integer() && factors[*k].1 >= Rational::one();
        (0..factors.len()).filter(is_whole).filter_map(without).collect()
    }

    /// Returns c x + d y if it is exact and no longer than the longer of x and y.
    fn no_longer(&mut self, [x, y]: [Term; 2]) -> Option<Id> {
        let longest = self.length(x.0).max(self.length(y.0));
        let roundings = self.roundings.len();
        let sum = if longest > 1 { self.sum([x, y]) } else { return None };
        let is_exact = self.roundings.len() == roundings;
        (self.take_fault().is_none() && is_exact && self.length(sum) <= longest).then_some(sum)
    }

    /// Number of terms of a factor; 1 if it is not a sum.
    fn length(&self, factor: Id) -> usize {
        match self.node(factor) {
            Node::Sum(terms) => terms.len(),
            _ => 1,
        }
    }
}

impl CommonFactors {
    fn put(&mut self, graph: &Graph, term: Term) {
        for (factor, rest) in graph.rests(term.0) {
            self.by_rest.entry(rest).or_default().push((self.terms.len(), factor));
        }
        self.terms.push(Some(term));
    }

    /// Combines the product with an earlier one, which is removed. `None` if there is no such product.
    fn taken_in(&mut self, graph: &mut Graph, (product, coefficient): Term) -> Option<Term> {
        for (factor, rest) in graph.rests(product) {
            for &(place, other) in self.by_rest.get(&rest).into_iter().flatten() {
                let Some((_, c)) = self.terms[place] else { continue };
                let Some(both) = graph.no_longer([(factor, coefficient), (other, c)]) else { continue };
                self.terms[place] = None;
                let product = graph.product(rest.into_iter().chain([(both, Rational::one())]));
                return Some(match graph.node(product) {
                    Node::Sum(terms) if terms.len() == 1 => terms[0],
                    _ => (product, Rational::one()),
                });
            }
        }
        None
    }
}
