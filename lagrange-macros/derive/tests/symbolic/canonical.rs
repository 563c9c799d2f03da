//! Equal expressions are one node.

use proptest::prelude::*;

use super::tree::{Tree, trees};
use super::{Outcome, for_all, graph, rational};
use lagrange_symbolic::{Function, Graph, Id, Node};

/// Operands in two random orders.
fn shuffled(operand: impl Strategy<Value = Tree>) -> impl Strategy<Value = (Vec<Tree>, Vec<Tree>)> {
    prop::collection::vec(operand, 2..5)
        .prop_flat_map(|operands| (Just(operands.clone()), Just(operands).prop_shuffle()))
}

#[test]
fn the_order_of_operands_does_not_matter() {
    for_all(400, 0.8, shuffled(trees()), |(one, other)| {
        let mut graph = Graph::default();
        let sums = [&one, &other].map(|trees| Tree::Sum(trees.clone()).build(&mut graph));
        let products = [&one, &other].map(|trees| Tree::Product(trees.clone()).build(&mut graph));
        if graph.take_fault().is_some() {
            return Ok(Outcome::Skipped);
        }
        prop_assert_eq!(sums[0], sums[1]);
        prop_assert_eq!(products[0], products[1]);
        Ok(Outcome::Checked)
    });
}

fn folded(trees: &[Tree], graph: &mut Graph, f: fn(&mut Graph, Id, Id) -> Id) -> Id {
    let ids: Vec<_> = trees.iter().map(|tree| tree.build(graph)).collect();
    ids[1..].iter().fold(ids[0], |left, &right| f(graph, left, right))
}

#[test]
fn the_grouping_of_terms_does_not_matter() {
    for_all(400, 0.8, shuffled(trees()), |(one, other)| {
        let mut graph = Graph::default();
        let sums = [one, other].map(|terms| folded(&terms, &mut graph, Graph::add));
        if graph.take_fault().is_some() {
            return Ok(Outcome::Skipped);
        }
        prop_assert_eq!(sums[0], sums[1]);
        Ok(Outcome::Checked)
    });
}

/// Factors, among them sums whose coefficients differ only in sign. (A product such as `2 (x + 3 y)` keeps its 2
/// inside the sum, so that its grouping matters.)
fn factors() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        3 => (0..3_usize).prop_map(Tree::Symbol),
        2 => (1..5_i128, 1..4_i128).prop_map(|(n, d)| Tree::number(-n, d)),
    ];
    let symbol = || (0..3_usize).prop_map(Tree::Symbol);
    let sum = prop_oneof![
        Just(Tree::Sum(vec![Tree::Symbol(0), Tree::Symbol(1), Tree::number(1, 1)])),
        Just(Tree::Difference(Box::new([Tree::Symbol(0), Tree::Symbol(1)]))),
        Just(Tree::Difference(Box::new([Tree::Symbol(1), Tree::Symbol(0)]))),
        symbol().prop_map(|x| Tree::function(Function::Cos, x)),
    ];
    (prop_oneof![leaf, sum], -2..4_i128).prop_map(|(x, n)| x.power(rational(n, 1)))
}

#[test]
fn the_grouping_of_factors_does_not_matter() {
    for_all(600, 1.0, shuffled(factors()), |(one, other)| {
        let mut graph = Graph::default();
        let products = [one, other].map(|factors| folded(&factors, &mut graph, Graph::mul));
        prop_assert_eq!(products[0], products[1]);
        Ok(Outcome::Checked)
    });
}

#[test]
fn what_cancels_is_gone() {
    for_all(400, 0.8, trees(), |tree| {
        let mut graph = Graph::default();
        let x = tree.build(&mut graph);
        let (difference, minus) = (graph.sub(x, x), graph.neg(x));
        let (twice, back) = (graph.add(x, x), graph.neg(minus));
        let (sum, double) = (graph.add(x, minus), graph.sum([(x, rational(2, 1))]));
        let (square, product) = (graph.square(x), graph.mul(x, x));
        if graph.take_fault().is_some() {
            return Ok(Outcome::Skipped);
        }
        prop_assert_eq!([difference, sum, twice, back], [Id::ZERO, Id::ZERO, double, x]);
        prop_assert_eq!(square, product);
        let ratio = graph.div(x, x);
        if x != Id::ZERO && graph.take_fault().is_none() {
            prop_assert_eq!(ratio, Id::ONE);
        }
        Ok(Outcome::Checked)
    });
}

#[test]
fn signs_leave_odd_and_even_functions() {
    use Function as F;
    for_all(300, 0.8, trees(), |tree| {
        let mut graph = Graph::default();
        let x = tree.build(&mut graph);
        let minus = graph.neg(x);
        for function in [F::Sin, F::Tan, F::Asin, F::Atan, F::Sinh, F::Tanh] {
            let (of_x, of_minus) = (graph.function(function, x), graph.function(function, minus));
            prop_assert_eq!(graph.neg(of_x), of_minus);
        }
        for function in [F::Cos, F::Cosh, F::Abs] {
            prop_assert_eq!(graph.function(function, x), graph.function(function, minus));
        }
        let faulty = graph.take_fault().is_some();
        Ok(if faulty { Outcome::Skipped } else { Outcome::Checked })
    });
}

/// The invariants that `Node` states.
#[test]
fn nodes_are_in_canonical_form() {
    for_all(400, 0.8, trees(), |tree| {
        let mut graph = Graph::default();
        let root = tree.build(&mut graph);
        if graph.take_fault().is_some() {
            return Ok(Outcome::Skipped);
        }
        for id in graph.reachable(&[root]) {
            graph.operands(id, |operand| assert!(operand < id, "operands come first"));
            if let Node::Sum(parts) | Node::Product(parts) = graph.node(id) {
                prop_assert!(parts.is_sorted_by(|x, y| x.0 < y.0), "sorted, none twice");
                prop_assert!(parts.iter().all(|part| part.1 != rational(0, 1)), "no empty part");
            }
            match graph.node(id) {
                Node::Sum(terms) => {
                    let flat = |term| !matches!(graph.node(term), Node::Sum(_));
                    prop_assert!(terms.iter().all(|&(term, _)| flat(term)), "sums do not nest");
                }
                Node::Product(factors) => {
                    let flat =
                        |factor, whole: bool| !(whole && matches!(graph.node(factor), Node::Product(_)));
                    prop_assert!(factors.iter().all(|&(x, e)| flat(x, e.is_integer())), "nor do products");
                }
                _ => {}
            }
        }
        Ok(Outcome::Checked)
    });
}

#[test]
fn squares_of_norms_and_absolute_values_are_squares() {
    let (mut graph, [x, y, _]) = graph();
    let (x2, y2) = (graph.square(x), graph.square(y));
    let dot = graph.add(x2, y2);
    let norm = graph.sqrt(dot);
    assert_eq!(graph.square(norm), dot);
    assert_eq!(graph.mul(norm, norm), dot);
    let size = graph.function(Function::Abs, x);
    assert_eq!(graph.square(size), x2);
    assert_eq!(graph.mul(size, size), x2);
    assert_eq!(graph.function(Function::Abs, size), size);
    let minus = graph.neg(size);
    assert_eq!(graph.function(Function::Abs, minus), size);
    assert_ne!(graph.sqrt(x2), x, "√x² is |x|");
    assert_eq!(graph.sqrt(x2), graph.sqrt(x2));
}

#[test]
fn a_factor_leaves_a_sum_whatever_the_grouping() {
    let (mut graph, [x, y, z]) = graph();
    let (sum, two) = (graph.add(x, y), graph.integer(2));
    let double = graph.mul(two, sum);
    let (left, right) = (graph.mul(double, z), graph.mul(sum, z));
    assert_eq!(left, graph.mul(two, right));
    let (forth, back) = (graph.sub(x, y), graph.sub(y, x));
    assert_eq!(graph.square(forth), graph.square(back));
    let (forth, back) = (graph.mul(forth, z), graph.mul(back, z));
    assert_eq!(graph.neg(forth), back);
}

#[test]
fn products_are_not_expanded() {
    let (mut graph, [x, y, _]) = graph();
    let sum = graph.add(x, y);
    let square = graph.square(sum);
    assert!(matches!(graph.node(square), Node::Product(_)));
}

#[test]
fn boundaries_are_not_flattened() {
    let (mut graph, [x, y, z]) = graph();
    let sum = graph.add(x, y);
    let defined = graph.defined(sum);
    let total = graph.add(defined, z);
    let Node::Sum(terms) = graph.node(total) else { panic!("a sum") };
    assert_eq!(terms.len(), 2);
    assert_ne!(graph.sub(defined, sum), Id::ZERO);
    assert_eq!(graph.defined(defined), defined);
    assert_eq!(graph.defined(x), x);
}

#[test]
fn constants_are_folded() {
    let (mut graph, [x, _, _]) = graph();
    let number = |graph: &mut Graph, n, d| graph.number(rational(n, d));
    let [half, four, ninth] = [(1, 2), (4, 1), (1, 9)].map(|(n, d)| number(&mut graph, n, d));
    assert_eq!(graph.add(half, half), Id::ONE);
    assert_eq!(graph.pow(four, rational(3, 2)), number(&mut graph, 8, 1));
    assert_eq!(graph.sqrt(ninth), number(&mut graph, 1, 3));
    assert_eq!(graph.pow(half, rational(-3, 1)), number(&mut graph, 8, 1));
    let two = graph.integer(2);
    let root = graph.sqrt(two);
    assert_eq!(graph.square(root), two);
    assert_eq!(graph.power(x, two), graph.square(x));
    assert_eq!(graph.power(Id::ONE, x), Id::ONE);
    assert_eq!(graph.pow(x, rational(0, 1)), Id::ONE);
    let minus = graph.integer(-3);
    assert_eq!(graph.function(Function::Abs, minus), graph.integer(3));
}

#[test]
fn quarter_turns_are_exact() {
    let mut graph = Graph::default();
    let pi = graph.pi();
    for (quarters, sine) in [(-3, 1), (-2, 0), (-1, -1), (0, 0), (1, 1), (2, 0), (3, -1), (4, 0), (7, -1)] {
        let angle = graph.sum([(pi, rational(quarters, 2))]);
        assert_eq!(graph.function(Function::Sin, angle), graph.integer(sine), "sin {quarters}π/2");
        let angle = graph.sum([(pi, rational(quarters - 1, 2))]);
        assert_eq!(graph.function(Function::Cos, angle), graph.integer(sine), "cos {}π/2", quarters - 1);
    }
    let third = graph.sum([(pi, rational(1, 3))]);
    assert!(graph.function(Function::Sin, third) > Id::ONE);
}

#[test]
fn inverse_functions_cancel() {
    let (mut graph, [x, _, _]) = graph();
    let (exponential, logarithm) = (graph.function(Function::Exp, x), graph.function(Function::Ln, x));
    assert_eq!(graph.function(Function::Ln, exponential), x);
    assert_eq!(graph.function(Function::Exp, logarithm), x);
}

#[test]
fn every_function_is_found_by_its_name() {
    for name in ["sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "ln", "abs"] {
        assert_eq!(Function::named(name).map(Function::name), Some(name));
    }
    assert_eq!(Function::named("log"), None);
}
