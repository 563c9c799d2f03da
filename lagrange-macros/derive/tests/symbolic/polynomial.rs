//! Polynomials, compared with the values of the expressions from which they are built.

use proptest::prelude::*;

use super::tree::trees;
use super::{Outcome, at, for_all, graph, rational};
use lagrange_symbolic::{Function, Graph, Id, Polynomials};

fn is_zero(graph: &mut Graph, root: Id) -> bool {
    let mut ring = Polynomials::default();
    let polynomial = ring.of(graph, root).expect("a short one");
    ring.cleared(&[polynomial]).expect("a short one")[0].is_zero()
}

/// (x + y)² − x² − 2 x y − y² vanishes for random x and y. With z added, it vanishes only if z does.
#[test]
fn what_is_zero_has_the_value_zero() {
    for_all(400, 0.6, (trees(), trees(), trees()), |(x, y, z)| {
        let mut graph = Graph::default();
        let [x, y, z] = [x, y, z].map(|tree| tree.build(&mut graph));
        let sum = graph.add(x, y);
        let parts = [(x, x, 1), (x, y, 2), (y, y, 1)].map(|(x, y, c)| (graph.mul(x, y), rational(c, 1)));
        let expanded = graph.sum(parts);
        let square = graph.square(sum);
        let difference = graph.sub(square, expanded);
        if graph.take_fault().is_some() {
            return Ok(Outcome::Skipped);
        }
        let mut ring = Polynomials::default();
        let Some(found) = ring.of(&mut graph, difference).and_then(|found| ring.cleared(&[found])) else {
            return Ok(Outcome::Skipped);
        };
        let more = graph.add(difference, z);
        let value = graph.evaluate(z, at(&[0.7, 0.9, 1.1]));
        if let Some(found) = ring.of(&mut graph, more).and_then(|found| ring.cleared(&[found])) {
            prop_assert!(!(value.excludes_zero() && found[0].is_zero()), "{:?}", found[0]);
        }
        // Roots of one base with different degrees are not compared.
        Ok(if found[0].is_zero() { Outcome::Checked } else { Outcome::Skipped })
    });
}

#[test]
fn quotients_of_products_are_their_factors() {
    for_all(400, 0.4, (trees(), trees()), |(x, y)| {
        let mut graph = Graph::default();
        let [x, y] = [x, y].map(|tree| tree.build(&mut graph));
        let mut ring = Polynomials::default();
        let known = [x, y].map(|id| ring.of(&mut graph, id));
        let [Some(x), Some(y)] = known else { return Ok(Outcome::Skipped) };
        let Some(both) = ring.cleared(&[x, y]) else { return Ok(Outcome::Skipped) };
        let [x, y] = [both[0].clone(), both[1].clone()];
        let Some(product) = ring.times(&x, &y).filter(|_| graph.take_fault().is_none() && !y.is_zero())
        else {
            return Ok(Outcome::Skipped);
        };
        // The quotient may exceed the size limits, or need roots other than square roots.
        let Some(quotient) = ring.quotient(&product, &y) else { return Ok(Outcome::Skipped) };
        prop_assert_eq!(quotient, x);
        Ok(Outcome::Checked)
    });
}

/// A fraction keeps the value of its expression, also where a multiple of x + y − z − ½, which is zero at the point, is added.
#[test]
fn fractions_keep_their_values() {
    for_all(400, 0.4, (trees(), trees()), |(first, second)| {
        let (mut graph, [x, y, z]) = graph();
        let [first, second] = [first, second].map(|tree| tree.build(&mut graph));
        let ratio = graph.div(first, second);
        let zero = graph.sum([
            (x, rational(1, 1)),
            (y, rational(1, 1)),
            (z, rational(-1, 1)),
            (Id::ONE, rational(-1, 2)),
        ]);
        let mut ring = Polynomials::default();
        let zero = ring.of(&mut graph, zero).expect("short");
        for zeros in [vec![], vec![zero]] {
            let Some(fraction) = ring.fraction(&mut graph, ratio, &zeros) else {
                return Ok(Outcome::Skipped);
            };
            let [before, after] = [ratio, fraction].map(|id| graph.evaluate(id, at(&[0.7, 0.9, 1.1])));
            if graph.take_fault().is_some() || !before.value.is_finite() || !after.value.is_finite() {
                return Ok(Outcome::Skipped);
            }
            prop_assert!(!before.minus(after).excludes_zero(), "{before:?} is not {after:?}");
        }
        Ok(Outcome::Checked)
    });
}

/// (x² + x y)/(x (z + 1)) is (x + y)/(z + 1), and x² + y² is c² where this vanishes.
#[test]
fn fractions_are_short() {
    let (mut graph, [x, y, z]) = graph();
    let [first, second] = [(x, x), (x, y)].map(|(x, y)| graph.mul(x, y));
    let above = graph.add(first, second);
    let below = graph.add(z, Id::ONE);
    let below = graph.mul(x, below);
    let ratio = graph.div(above, below);
    let mut ring = Polynomials::default();
    let [sum, rest] = [(x, y), (z, Id::ONE)].map(|(x, y)| graph.add(x, y));
    let expected = graph.div(sum, rest);
    assert_eq!(ring.fraction(&mut graph, ratio, &[]), Some(expected));
    let [x, y, c] = [x, y, z].map(|symbol| graph.square(symbol));
    let square = graph.add(x, y);
    let zero = graph.sub(square, c);
    let zero = ring.of(&mut graph, zero).expect("short");
    assert_eq!(ring.fraction(&mut graph, square, &[zero]), Some(c));
}

#[test]
fn squares_of_sines_and_powers_of_roots_are_rewritten() {
    let (mut graph, [x, y, z]) = graph();
    let angle = graph.mul(x, y);
    let [sin, cos, sinh, cosh] = [Function::Sin, Function::Cos, Function::Sinh, Function::Cosh]
        .map(|function| graph.function(function, angle))
        .map(|value| graph.square(value));
    let circle = graph.total([sin, cos]);
    let circle = graph.sub(circle, Id::ONE);
    let hyperbola = graph.sub(cosh, sinh);
    let hyperbola = graph.sub(hyperbola, Id::ONE);
    assert!(is_zero(&mut graph, circle) && is_zero(&mut graph, hyperbola));
    // (x + z) (x + z)^(−1/2) (z + y)^(−1) ((z + y)/√(x + z)) = 1, once the sums are expanded
    let [first, second] = [(x, z), (z, y)].map(|(x, y)| graph.add(x, y));
    let expanded = [(x, second), (z, second)].map(|(x, y)| graph.mul(x, y));
    let expanded = graph.total(expanded);
    let [root, reciprocal] =
        [(first, rational(-3, 2)), (second, rational(-1, 1))].map(|(x, e)| graph.pow(x, e));
    let product = graph.mul(root, reciprocal);
    let product = graph.mul(product, expanded);
    let other = graph.pow(first, rational(-1, 2));
    let difference = graph.sub(product, other);
    assert!(is_zero(&mut graph, difference));
}

/// 1 − cos² divided by a sine is that sine.
#[test]
fn divisors_may_have_sines() {
    let (mut graph, [x, y, _]) = graph();
    let [sin, cos] = [Function::Sin, Function::Cos].map(|function| graph.function(function, x));
    let square = graph.square(cos);
    let versine = graph.sub(Id::ONE, square);
    let divisor = graph.add(sin, y);
    let product = graph.mul(versine, divisor);
    let mut ring = Polynomials::default();
    let [sin, divisor, product] = [sin, divisor, product].map(|id| ring.of(&mut graph, id).expect("short"));
    let sine_squared = ring.times(&sin, &sin).expect("short");
    assert_eq!(ring.quotient(&product, &divisor), Some(sine_squared));
    let rest = ring.quotient(&product, &sin).expect("a quotient");
    assert_eq!(ring.times(&rest, &sin), Some(product));
    assert_eq!(ring.quotient(&sin, &divisor), None);
}
