//! Tests whether an expression vanishes: the verdicts.

use proptest::prelude::*;

use super::tree::{Tree, trees};
use super::{Outcome, for_all, graph, rational, symbol, within};
use lagrange_symbolic::{Function, Graph, Id, Verdict};

fn verdict(graph: &mut Graph, root: Id) -> Verdict {
    graph.is_zero(root, within((-1.25, 1.75)))
}

/// Rewrites a tree as the same function of x, y, z: sums are expanded, functions rewritten by identities.
fn rewritten(tree: Tree) -> Tree {
    let two = || Tree::number(2, 1);
    let square = |x: Tree| x.power(rational(2, 1));
    match tree {
        Tree::Product(factors) => multiplied_out(factors),
        Tree::Power(base, exponent) if exponent == rational(2, 1) => {
            multiplied_out(vec![(*base).clone(), *base])
        }
        Tree::Difference(pair) => {
            let [x, y] = *pair;
            Tree::Sum(vec![x, Tree::Product(vec![Tree::number(-1, 1), y])])
        }
        Tree::Function(Function::Sin, x) => {
            let half = x.over(two());
            let parts = [Function::Sin, Function::Cos].map(|f| Tree::function(f, half.clone()));
            Tree::Product([vec![two()], parts.into()].concat())
        }
        Tree::Function(Function::Cos, x) => {
            let sine = Tree::function(Function::Sin, x.over(two()));
            Tree::Difference(Box::new([Tree::number(1, 1), Tree::Product(vec![two(), square(sine)])]))
        }
        Tree::Function(Function::Tan, x) => {
            Tree::function(Function::Sin, (*x).clone()).over(Tree::function(Function::Cos, *x))
        }
        Tree::Function(Function::Cosh, x) => {
            let minus = Tree::Product(vec![Tree::number(-1, 1), (*x).clone()]);
            Tree::Sum(vec![Tree::function(Function::Exp, *x), Tree::function(Function::Exp, minus)])
                .over(two())
        }
        other => other,
    }
}

/// Expands the first sum among the factors.
fn multiplied_out(mut factors: Vec<Tree>) -> Tree {
    let Some(position) = factors.iter().position(|factor| matches!(factor, Tree::Sum(_))) else {
        return Tree::Product(factors);
    };
    let Tree::Sum(terms) = factors.remove(position) else { unreachable!() };
    let product = |term| Tree::Product([vec![term], factors.clone()].concat());
    Tree::Sum(terms.into_iter().map(product).collect())
}

#[test]
fn equal_expressions_are_never_told_apart() {
    for_all(800, 0.6, trees(), |tree| {
        let (mut graph, _) = graph();
        let direct = tree.build(&mut graph);
        let other = tree.map(&mut rewritten).build(&mut graph);
        let difference = graph.sub(direct, other);
        if graph.take_fault().is_some() {
            return Ok(Outcome::Skipped);
        }
        let verdict = verdict(&mut graph, difference);
        prop_assert_ne!(verdict, Verdict::NonZero);
        Ok(if verdict == Verdict::Undecided { Outcome::Skipped } else { Outcome::Checked })
    });
}

#[test]
fn a_small_difference_is_seen() {
    for_all(400, 0.6, (trees(), 0..3_usize), |(tree, index)| {
        let (mut graph, symbols) = graph();
        let direct = tree.build(&mut graph);
        let other = tree.map(&mut rewritten).build(&mut graph);
        let wave = graph.function(Function::Cosh, symbols[index]);
        let difference =
            graph.sum([(direct, rational(1, 1)), (other, rational(-1, 1)), (wave, rational(1, 1_000_000))]);
        let verdict = verdict(&mut graph, difference);
        prop_assert_ne!(verdict, Verdict::Zero);
        let faulty = graph.take_fault().is_some();
        Ok(if verdict == Verdict::NonZero && !faulty { Outcome::Checked } else { Outcome::Skipped })
    });
}

#[test]
fn boundaries_are_looked_through() {
    for_all(500, 0.7, trees(), |tree| {
        let (mut graph, _) = graph();
        let direct = tree.map(&mut without_boundary).build(&mut graph);
        let bounded = tree.map(&mut |tree| tree.defined()).build(&mut graph);
        let difference = graph.sub(direct, bounded);
        if graph.take_fault().is_some() {
            return Ok(Outcome::Skipped);
        }
        prop_assert_eq!(verdict(&mut graph, difference), Verdict::Zero);
        Ok(Outcome::Checked)
    });
}

fn without_boundary(tree: Tree) -> Tree {
    match tree {
        Tree::Defined(inner) => *inner,
        other => other,
    }
}

#[test]
fn verdicts_say_how_sure_they_are() {
    let (mut graph, [x, y, _]) = graph();
    assert_eq!(verdict(&mut graph, Id::ZERO), Verdict::Zero);
    assert_eq!(verdict(&mut graph, x), Verdict::NonZero);
    let (sine, cosine) = (graph.function(Function::Sin, x), graph.function(Function::Cos, x));
    let (sine2, cosine2) = (graph.square(sine), graph.square(cosine));
    let pythagoras =
        graph.sum([(sine2, rational(1, 1)), (cosine2, rational(1, 1)), (Id::ONE, rational(-1, 1))]);
    assert_eq!(verdict(&mut graph, pythagoras), Verdict::Held(8));
    // −1 − x² has no square root.
    let negative = graph.sum([(sine2, rational(-1, 1)), (Id::ONE, rational(-1, 1))]);
    let imaginary = graph.sqrt(negative);
    assert_eq!(verdict(&mut graph, imaginary), Verdict::Undecided);
    // Half of the draws are outside the domain of √y.
    let root = graph.sqrt(y);
    assert_eq!(verdict(&mut graph, root), Verdict::NonZero);
    let held = graph.mul(pythagoras, root);
    assert!(matches!(verdict(&mut graph, held), Verdict::Held(_)));
}

#[test]
fn samples_come_from_the_range_of_each_symbol() {
    let (mut graph, [x, y, _]) = graph();
    let sine = graph.function(Function::Sin, x);
    let angle = graph.function(Function::Asin, sine);
    let difference = graph.sub(angle, x);
    let ranged = |range: (f64, f64)| {
        move |name, draw| within(if name == symbol(0) { range } else { (-1.0, 1.0) })(name, draw)
    };
    assert_eq!(graph.is_zero(difference, ranged((0.5, 1.5))), Verdict::Held(8));
    assert_eq!(graph.is_zero(difference, ranged((2.0, 3.0))), Verdict::NonZero);
    assert_eq!(graph.is_zero(y, ranged((0.5, 1.5))), Verdict::NonZero);
}

/// |x| − x, max(x, 0) − x and √(x²) − x for positive x, and exp(−1000 x), which underflows.
#[test]
fn values_on_one_side_of_a_kink_and_underflows_prove_nothing() {
    let (mut graph, [x, ..]) = graph();
    let square = graph.square(x);
    let far = graph.sum([(x, rational(-1000, 1))]);
    let known = [graph.function(Function::Abs, x), graph.function(Function::Ramp, x), graph.sqrt(square)];
    let mut unknown: Vec<Id> = known.into_iter().map(|value| graph.sub(value, x)).collect();
    unknown.push(graph.function(Function::Exp, far));
    for difference in unknown {
        assert_eq!(graph.is_zero(difference, within((1.0, 2.0))), Verdict::Undecided);
    }
}

/// 1 / (d − x·y), where d is defined as x·y: inlining causes a division by zero, and the result must not count as
/// zero.
#[test]
fn a_hidden_division_by_zero_is_not_zero() {
    let (mut graph, [x, y, _]) = graph();
    let product = graph.mul(x, y);
    let defined = graph.defined(product);
    let nothing = graph.sub(defined, product);
    let inverse = graph.pow(nothing, rational(-1, 1));
    assert_eq!(verdict(&mut graph, inverse), Verdict::Undecided);
    assert_eq!(graph.take_fault(), None);
}
