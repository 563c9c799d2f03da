//! Error bounds of `evaluate`: the actual error is within the bound.

use proptest::prelude::*;

use super::tree::{points, rational_trees, trees};
use super::{Outcome, at, double, for_all, graph, rational, symbol};
use lagrange_symbolic::{Function, Graph, Id};

/// Compares values of an expression and of its derivatives with values in twice the precision.
#[test]
fn bounds_hold() {
    for_all(1500, 0.6, (prop_oneof![2 => trees(), 1 => rational_trees()], points()), |(tree, point)| {
        let mut graph = Graph::default();
        let root = tree.build(&mut graph);
        let slopes = graph.gradient(root, &[0, 1, 2].map(symbol));
        if graph.take_fault().is_some() {
            return Ok(Outcome::Skipped);
        }
        let mut outcome = Outcome::Checked;
        for id in [vec![root], slopes].concat() {
            let found = graph.evaluate(id, at(&point));
            let distance = double::value(&graph, id, at(&point)).distance(found.value);
            // The reference itself has errors of 1e-24 and more for huge arguments.
            if !found.error.is_finite() || !distance.is_finite() || found.value.abs() > 1e30 {
                outcome = Outcome::Skipped;
                continue;
            }
            prop_assert!(distance <= found.error + 1e-22, "{found:?} is off by {distance:e}");
        }
        Ok(outcome)
    });
}

/// Infinite bounds would pass the test above: most bounds must be tight.
#[test]
fn bounds_are_close() {
    for_all(1000, 0.6, (trees(), points()), |(tree, point)| {
        let mut graph = Graph::default();
        let root = tree.build(&mut graph);
        let found = graph.evaluate(root, at(&point));
        let close = found.error <= 1e-10 * (1.0 + found.value.abs());
        Ok(if close && graph.take_fault().is_none() { Outcome::Checked } else { Outcome::Skipped })
    });
}

/// The bound is infinite if rounding could move the argument across a pole, a kink or a branch cut.
#[test]
fn no_bound_is_stated_across_a_singularity() {
    let (mut graph, [x, y, _]) = graph();
    // y + x² − x² simplifies to y; the definition prevents that.
    let big = graph.pow(x, rational(2, 1));
    let big = graph.defined(big);
    let sum = graph.add(big, y);
    let sum = graph.defined(sum);
    let blurred = graph.sub(sum, big);
    let inverse = graph.pow(blurred, rational(-1, 1));
    let root = graph.sqrt(blurred);
    let logarithm = graph.function(Function::Ln, blurred);
    let minus_one = graph.integer(-1);
    let angle = graph.atan2(blurred, minus_one);
    let shifted = graph.sub(blurred, Id::ONE);
    let arcsine = graph.function(Function::Asin, shifted);
    let point = [1e8, 1e-9, 0.0];
    for singular in [inverse, root, logarithm, angle, arcsine] {
        let found = graph.evaluate(singular, at(&point));
        assert!(!found.error.is_finite(), "{:?}: {found:?}", graph.node(singular));
    }
}

/// x^1000 underflows: its value 0 must not count as exact.
#[test]
fn underflow_is_covered() {
    let (mut graph, [x, _, _]) = graph();
    let tiny = graph.pow(x, rational(1000, 1));
    let found = graph.evaluate(tiny, at(&[0.1, 0.0, 0.0]));
    assert!(found.value == 0.0 && found.error > 0.0);
}
