//! The error that `evaluate` states bounds its error.

use proptest::prelude::*;

use super::super::{Function, Graph, Id};
use super::tree::{points, rational_trees, trees};
use super::{Outcome, at, double, for_all, graph, rational, symbol};

/// Values of an expression and of its derivatives, against those of twice the precision.
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
            // The judge itself errs by 1e-24 and more where arguments are huge.
            if !found.error.is_finite() || !distance.is_finite() || found.value.abs() > 1e30 {
                outcome = Outcome::Skipped;
                continue;
            }
            prop_assert!(distance <= found.error + 1e-22, "{found:?} is off by {distance:e}");
        }
        Ok(outcome)
    });
}

/// A bound that is always infinite would hold too.
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

/// Where rounding could have moved the argument across a pole, a kink or a cut, there is no bound.
#[test]
fn no_bound_is_stated_across_a_singularity() {
    let (mut graph, [x, y, _]) = graph();
    // y + x² − x² is y by its form, so a boundary keeps it from being simplified.
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

/// x^1000 underflows: the value 0 must not pass for exact.
#[test]
fn underflow_is_covered() {
    let (mut graph, [x, _, _]) = graph();
    let tiny = graph.pow(x, rational(1000, 1));
    let found = graph.evaluate(tiny, at(&[0.1, 0.0, 0.0]));
    assert!(found.value == 0.0 && found.error > 0.0);
}
