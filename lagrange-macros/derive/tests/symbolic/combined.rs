//! Combination of products in a sum that differ in one factor.

use proptest::collection::vec;
use proptest::prelude::*;

use super::tree::{points, trees};
use super::{Outcome, at, for_all, symbol};
use lagrange_symbolic::{Fault, Graph, Id, Node, Rational};

fn symbols<const N: usize>(graph: &mut Graph) -> [Id; N] {
    std::array::from_fn(|k| graph.symbol(symbol(k)))
}

fn terms(graph: &Graph, sum: Id) -> usize {
    match graph.node(sum) {
        Node::Sum(terms) => terms.len(),
        _ => usize::from(sum != Id::ZERO),
    }
}

/// Sums of c x y (u + v) and c x y u, with many products that can be combined.
fn sum(graph: &mut Graph, parts: &[Id], picks: &[(usize, usize, i8)]) -> Id {
    let products: Vec<(Id, Rational)> = picks
        .iter()
        .map(|&(x, y, c)| {
            let [x, y, u, v] = [x, y, x + y, x + 2 * y].map(|k| parts[k % parts.len()]);
            let factor = if c % 2 == 0 { graph.add(u, v) } else { u };
            let product = graph.mul(x, y);
            (graph.mul(product, factor), Rational::from_integer(c.into()))
        })
        .collect();
    graph.sum(products)
}

#[test]
fn no_value_changes_and_no_sum_becomes_longer() {
    let picks = vec((0_usize..4, 0_usize..4, -3_i8..4), 2..9);
    for_all(1500, 0.12, (vec(trees(), 4), picks, points()), |(parts, picks, point)| {
        let mut graph = Graph::default();
        let parts: Vec<Id> = parts.iter().map(|part| part.build(&mut graph)).collect();
        let sum = sum(&mut graph, &parts, &picks);
        let is_faulty = graph.take_fault().is_some();
        let combined = graph.combined(sum);
        if is_faulty || combined == sum {
            return Ok(Outcome::Skipped);
        }
        prop_assert_eq!(graph.take_fault(), None);
        prop_assert!(terms(&graph, combined) < terms(&graph, sum));
        let [before, after] = [sum, combined].map(|root| graph.evaluate(root, at(&point)));
        if !(before.value + after.value + before.error).is_finite() {
            return Ok(Outcome::Skipped);
        }
        let difference = (before.value - after.value).abs();
        prop_assert!(difference <= before.error + after.error, "{before:?} is not {after:?}");
        Ok(Outcome::Checked)
    });
}

#[test]
fn what_cancels_is_gone() {
    let mut graph = Graph::default();
    let [u, v, w, s, t] = symbols(&mut graph);
    let (uv, vw) = (graph.add(u, v), graph.add(v, w));
    let uvw = graph.add(uv, w);
    let mut product = |factors: &[Id]| factors.iter().fold(Id::ONE, |product, &x| graph.mul(product, x));
    let products = [
        ([product(&[u, v, s]), product(&[uv, u, s])], product(&[u, u, s])),
        // The differing factors are v + w and u + v + w; their difference is u.
        ([product(&[vw, u, t]), product(&[uvw, u, t])], product(&[u, u, t])),
        // A factor with a power.
        ([product(&[v, v, s, t]), product(&[uv, v, s, t])], product(&[u, v, s, t])),
    ];
    for ([less, more], left) in products {
        let sum = graph.sub(more, less);
        assert_eq!(graph.combined(sum), left);
    }
}

#[test]
fn what_would_be_longer_stays() {
    let mut graph = Graph::default();
    let [u, v, w, s, t] = symbols(&mut graph);
    let (uv, vw, st) = (graph.add(u, v), graph.add(v, w), graph.add(s, t));
    for (x, y) in [(uv, st), (uv, vw), (u, v)] {
        let products = [x, y].map(|factor| graph.mul(factor, s));
        let sum = graph.total(products);
        assert_eq!(graph.combined(sum), sum);
    }
    // The result is one product, but it is a sum of three terms: (u + v + w) (s + t)/s − (u + v + w) t/s.
    let (uvw, over) = (graph.add(uv, w), graph.div(Id::ONE, s));
    let rest = graph.mul(uvw, over);
    let [more, less] = [st, t].map(|factor| graph.mul(rest, factor));
    let sum = graph.sub(more, less);
    assert_eq!((terms(&graph, sum), graph.combined(sum)), (2, sum));
}

#[test]
fn a_fault_from_before_stays_and_none_is_added() {
    let mut graph = Graph::default();
    let [u, v, s] = symbols(&mut graph);
    let huge = Rational::from_integer(i128::MAX);
    let uv = graph.add(u, v);
    let products = [u, uv].map(|factor| graph.mul(factor, s));
    let sum = graph.sum(products.map(|product| (product, huge)));
    assert_eq!((graph.combined(sum), graph.take_fault()), (sum, None));
    graph.div(u, Id::ZERO);
    graph.combined(sum);
    assert_eq!(graph.take_fault(), Some(Fault::DivisionByZero));
}
