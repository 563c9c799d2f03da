//! Simplification preserves values.

use proptest::prelude::*;

use super::tree::{points, trees};
use super::{Outcome, at, for_all};
use lagrange_symbolic::Graph;

#[test]
fn the_graph_has_the_value_of_the_tree() {
    for_all(1500, 0.6, (trees(), points()), |(tree, point)| {
        let mut graph = Graph::default();
        let root = tree.build(&mut graph);
        let faulty = graph.take_fault().is_some();
        let Some(reference) = tree.reference(&point, |value| value).filter(|_| !faulty) else {
            return Ok(Outcome::Skipped);
        };
        reference.check(graph.evaluate(root, at(&point)))
    });
}

#[test]
fn looking_through_boundaries_changes_no_value() {
    for_all(500, 0.6, (trees(), points()), |(tree, point)| {
        let mut graph = Graph::default();
        let root = tree.map(&mut |tree| tree.defined()).build(&mut graph);
        let flat = graph.looked_through(root);
        let (with, without) = (graph.evaluate(root, at(&point)), graph.evaluate(flat, at(&point)));
        if graph.take_fault().is_some() || !(with.value + without.value + with.error).is_finite() {
            return Ok(Outcome::Skipped);
        }
        let difference = (with.value - without.value).abs();
        prop_assert!(difference <= with.error + without.error, "{with:?} is not {without:?}");
        Ok(Outcome::Checked)
    });
}
