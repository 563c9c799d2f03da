//! Forward and reverse mode, compared with dual numbers, which differentiate numerically.

use num_dual::{Dual64, HyperDual64};

use super::tree::{Reference, SYMBOLS, Tree, points, trees};
use super::{Outcome, at, for_all, graph, rational, symbol};
use lagrange_symbolic::{Forward, Graph, Id};

type Point = [f64; SYMBOLS];

/// Derivative of `tree` at `point` along `direction`; `None` outside the domain.
fn dual(tree: &Tree, point: &Point, direction: &Point) -> Option<Reference> {
    tree.reference(point, |value| value)?;
    let moving: Vec<_> = point.iter().zip(direction).map(|(&x, &rate)| Dual64::new(x, rate)).collect();
    tree.reference(&moving, |value| value.eps)
}

/// Second derivative ∂²/∂x_i∂x_j
fn hyper_dual(tree: &Tree, point: &Point, i: usize, j: usize) -> Option<Reference> {
    tree.reference(point, |value| value)?;
    let unit = |k, axis| if k == axis { 1.0 } else { 0.0 };
    let moving: Vec<_> =
        (0..SYMBOLS).map(|k| HyperDual64::new(point[k], unit(k, i), unit(k, j), 0.0)).collect();
    tree.reference(&moving, |value| value.eps1eps2)
}

fn gradient(graph: &mut Graph, root: Id) -> Vec<Id> {
    graph.gradient(root, &[0, 1, 2].map(symbol))
}

#[test]
fn forward_derivatives_are_those_of_dual_numbers() {
    for_all(1000, 0.6, (trees(), points(), points()), |(tree, point, direction)| {
        let mut graph = Graph::default();
        let root = tree.build(&mut graph);
        let seeds: Vec<_> = direction
            .iter()
            .enumerate()
            .map(|(k, _)| (symbol(k), graph.symbol(symbol(SYMBOLS + k))))
            .collect();
        let rate = Forward::along(seeds).of(&mut graph, root);
        let faulty = graph.take_fault().is_some();
        let Some(reference) = dual(&tree, &point, &direction).filter(|_| !faulty) else {
            return Ok(Outcome::Skipped);
        };
        let extended = [point, direction].concat();
        reference.check(graph.evaluate(rate, at(&extended)))
    });
}

#[test]
fn gradients_are_those_of_dual_numbers_and_of_forward_derivatives() {
    for_all(1000, 0.6, (trees(), points()), |(tree, point)| {
        let mut graph = Graph::default();
        let root = tree.build(&mut graph);
        let reverse = gradient(&mut graph, root);
        let mut outcome = Outcome::Checked;
        for (k, reverse) in reverse.into_iter().enumerate() {
            let forward = Forward::along([(symbol(k), Id::ONE)]).of(&mut graph, root);
            let mut direction = [0.0; SYMBOLS];
            direction[k] = 1.0;
            let faulty = graph.take_fault().is_some();
            let Some(reference) = dual(&tree, &point, &direction).filter(|_| !faulty) else {
                return Ok(Outcome::Skipped);
            };
            for id in [forward, reverse] {
                if let Outcome::Skipped = reference.check(graph.evaluate(id, at(&point)))? {
                    outcome = Outcome::Skipped;
                }
            }
        }
        Ok(outcome)
    });
}

#[test]
fn gradients_of_gradients_are_second_derivatives() {
    for_all(400, 0.5, (trees(), points()), |(tree, point)| {
        let mut graph = Graph::default();
        let root = tree.build(&mut graph);
        let mut outcome = Outcome::Checked;
        for (i, slope) in gradient(&mut graph, root).into_iter().enumerate() {
            for (j, curvature) in gradient(&mut graph, slope).into_iter().enumerate() {
                let faulty = graph.take_fault().is_some();
                let Some(reference) = hyper_dual(&tree, &point, i, j).filter(|_| !faulty) else {
                    return Ok(Outcome::Skipped);
                };
                if let Outcome::Skipped = reference.check(graph.evaluate(curvature, at(&point)))? {
                    outcome = Outcome::Skipped;
                }
            }
        }
        Ok(outcome)
    });
}

#[test]
fn what_is_smooth_at_rest_has_a_derivative_there() {
    let (mut graph, [x, y, _]) = graph();
    let (x2, xy, twice) = (graph.square(x), graph.mul(x, y), graph.sum([(x, rational(2, 1))]));
    let half = rational(1, 2);
    for base in [x2, xy, twice] {
        for exponent in [rational(3, 2), rational(5, 2), rational(7, 3)] {
            let smooth = graph.pow(base, exponent);
            for slope in gradient(&mut graph, smooth) {
                assert_eq!(graph.evaluate(slope, at(&[0.0, 1.0, 1.0])).value, 0.0);
            }
        }
    }
    let (length, y2) = (graph.square(x), graph.square(y));
    let square = graph.add(length, y2);
    let norm = graph.pow(square, half);
    let cube = graph.pow(norm, rational(3, 1));
    for slope in gradient(&mut graph, cube) {
        assert_eq!(graph.evaluate(slope, at(&[0.0; 3])).value, 0.0);
    }
}

/// xˣ and atan2(x, x) have one operand in two places.
#[test]
fn an_operand_in_two_places_counts_for_both() {
    let x = || Tree::Symbol(0);
    let pair = || Box::new([x(), x()]);
    for tree in [Tree::SymbolicPower(pair()), Tree::Atan2(pair()), Tree::Product(vec![x(), x()])] {
        let (mut graph, _) = graph();
        let (point, direction) = ([1.3, 0.0, 0.0], [1.0, 0.0, 0.0]);
        let root = tree.build(&mut graph);
        let reference = dual(&tree, &point, &direction).expect("a smooth function");
        let forward = Forward::along([(symbol(0), Id::ONE)]).of(&mut graph, root);
        for id in [forward, gradient(&mut graph, root)[0]] {
            assert!(matches!(reference.check(graph.evaluate(id, at(&point))), Ok(Outcome::Checked)));
        }
    }
}

#[test]
fn forward_remembers_across_roots_and_new_nodes() {
    let (mut graph, [x, y, _]) = graph();
    let mut along = Forward::along([(symbol(0), Id::ONE)]);
    let square = graph.square(x);
    let slope = along.of(&mut graph, square);
    assert_eq!(slope, graph.sum([(x, rational(2, 1))]));
    let later = graph.mul(square, y);
    let expected = graph.mul(slope, y);
    assert_eq!(along.of(&mut graph, later), expected);
}

#[test]
fn derivatives_keep_boundaries() {
    let (mut graph, [x, y, _]) = graph();
    let inner = graph.mul(x, y);
    let sine = graph.function(lagrange_symbolic::Function::Sin, inner);
    let defined = graph.defined(sine);
    let slope = Forward::along([(symbol(0), Id::ONE)]).of(&mut graph, defined);
    assert!(matches!(graph.node(slope), lagrange_symbolic::Node::Defined(_)));
}
