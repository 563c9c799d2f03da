//! Sums nested by shared prefixes.

use proptest::collection::vec;
use proptest::prelude::*;

use super::tree::{points, trees};
use super::{Outcome, at, for_all, symbol};
use lagrange_symbolic::{Graph, Id, Node};

/// Σ (Σ of the terms in a set)² over the sets, each given by the bits of a mask.
fn squares(graph: &mut Graph, terms: &[Id], sets: &[u32]) -> Id {
    let mut squares = Vec::new();
    for set in sets {
        let members = terms.iter().enumerate().filter(|(k, _)| set >> k & 1 == 1).map(|(_, &term)| term);
        let sum = graph.total(members.collect::<Vec<_>>());
        let sum = graph.defined(sum);
        squares.push(graph.square(sum));
    }
    graph.total(squares)
}

/// Largest number of terms of a sum that is a definition.
fn longest(graph: &Graph, root: Id) -> usize {
    let terms = |id: Id| match graph.node(id) {
        Node::Defined(inner) => match graph.node(*inner) {
            Node::Sum(terms) => terms.len(),
            _ => 1,
        },
        _ => 0,
    };
    graph.reachable(&[root]).into_iter().map(terms).max().unwrap_or(0)
}

fn nested(terms: usize, sets: &[u32]) -> Option<(Graph, Id)> {
    let mut graph = Graph::default();
    let terms: Vec<Id> = (0..terms).map(|k| graph.symbol(symbol(k))).collect();
    let root = squares(&mut graph, &terms, sets);
    let (nested, new) = graph.nested(root, &[root])?;
    Some((nested, new[&root]))
}

#[test]
fn no_value_changes() {
    for_all(500, 0.3, (vec(trees(), 6), vec(1_u32..64, 2..9), points()), |(terms, sets, point)| {
        let mut graph = Graph::default();
        let terms: Vec<Id> = terms.iter().map(|term| term.build(&mut graph)).collect();
        let root = squares(&mut graph, &terms, &sets);
        let is_faulty = graph.take_fault().is_some();
        let Some((nested, new)) = graph.nested(root, &[root]).filter(|_| !is_faulty) else {
            return Ok(Outcome::Skipped);
        };
        let (before, after) = (graph.evaluate(root, at(&point)), nested.evaluate(new[&root], at(&point)));
        if !(before.value + after.value + before.error).is_finite() {
            return Ok(Outcome::Skipped);
        }
        let difference = (before.value - after.value).abs();
        prop_assert!(difference <= before.error + after.error, "{before:?} is not {after:?}");
        Ok(Outcome::Checked)
    });
}

/// The result is independent of the order of the sums, and of the end at which they grow.
#[test]
fn of_a_chain_every_sum_is_the_one_before_and_a_term() {
    let upwards: Vec<u32> = (1..=20).map(|n| (1 << n) - 1).collect();
    let downwards: Vec<u32> = (0..20).map(|n| ((1 << 20) - 1) >> n << n).collect();
    let shuffled: Vec<u32> = (0..20).map(|k| upwards[k * 7 % 20]).collect();
    for sets in [upwards, downwards, shuffled] {
        let (graph, root) = nested(20, &sets).expect("much in common");
        assert_eq!(longest(&graph, root), 2);
    }
}

#[test]
fn branches_share_their_trunk_though_it_has_no_name() {
    let (graph, root) =
        nested(9, &[0b0_0000_1111, 0b0_0011_0111, 0b0_1100_0111, 0b1_0000_0111]).expect("a trunk");
    assert_eq!(longest(&graph, root), 3);
}

#[test]
fn sums_that_have_little_in_common_stay() {
    assert!(nested(6, &[0b000011, 0b000110, 0b001100, 0b011000]).is_none());
    // Sharing saves one addition, but costs one definition.
    assert!(nested(6, &[0b000111, 0b001011]).is_none());
    assert!(nested(6, &[0b000111, 0b001011, 0b000011]).is_some());
}
