//! User-supplied functions: their partial derivatives by position, and equality of their values.

use proptest::prelude::*;

use super::tree::trees;
use super::{Outcome, for_all, graph, rational, symbol, within};
use lagrange_symbolic::{External, Forward, Function, Graph, Id, Node, Verdict};

/// Partial derivative of result `output` of function 0 by the positions `derivatives`.
fn partial(graph: &mut Graph, output: u32, derivatives: &[u32], arguments: &[Id]) -> Id {
    graph.external(External {
        function: 0,
        output,
        derivatives: derivatives.into(),
        arguments: arguments.into(),
        is_along: false,
    })
}

fn gradient(graph: &mut Graph, root: Id) -> Vec<Id> {
    graph.gradient(root, &[0, 1, 2].map(symbol))
}

fn difference_is(graph: &mut Graph, a: Id, b: Id) -> Verdict {
    let difference = graph.sub(a, b);
    graph.is_zero(difference, within((-1.25, 1.75)))
}

#[test]
fn the_order_of_differentiation_does_not_matter() {
    let (mut graph, arguments) = graph();
    let f = partial(&mut graph, 0, &[], &arguments);
    let slopes = gradient(&mut graph, f);
    let hessian: Vec<_> = slopes.iter().map(|&slope| gradient(&mut graph, slope)).collect();
    for (i, row) in hessian.iter().enumerate() {
        for (j, &second) in row.iter().enumerate() {
            assert_eq!(second, hessian[j][i]);
            let by = [i.min(j) as u32, i.max(j) as u32];
            assert_eq!(second, partial(&mut graph, 0, &by, &arguments));
            let third = gradient(&mut graph, second);
            assert_eq!(third[2], partial(&mut graph, 0, &[by[0], by[1], 2], &arguments));
        }
    }
}

/// ∂/∂x f(g, h) = f₀ g′ + f₁ h′, in both modes, where f₀ and f₁ are taken at (g, h).
#[test]
fn the_chain_rule_goes_through_the_arguments() {
    for_all(400, 0.5, (trees(), trees()), |(g, h)| {
        let mut graph = Graph::default();
        let arguments = [g.build(&mut graph), h.build(&mut graph)];
        let f = partial(&mut graph, 0, &[], &arguments);
        let reverse = gradient(&mut graph, f);
        for (k, &reverse) in reverse.iter().enumerate() {
            let mut along = Forward::along([(symbol(k), Id::ONE)]);
            let forward = along.of(&mut graph, f);
            let terms = [0, 1].map(|position| {
                let slope = partial(&mut graph, 0, &[position], &arguments);
                let inner = along.of(&mut graph, arguments[position as usize]);
                (graph.mul(slope, inner), rational(1, 1))
            });
            let expected = graph.sum(terms);
            if graph.take_fault().is_some() {
                return Ok(Outcome::Skipped);
            }
            for derivative in [reverse, forward] {
                match difference_is(&mut graph, derivative, expected) {
                    Verdict::NonZero => prop_assert!(false, "∂/∂{k} of f({g:?}, {h:?})"),
                    Verdict::Undecided => return Ok(Outcome::Skipped),
                    Verdict::Zero | Verdict::Held(_) => {}
                }
            }
        }
        Ok(Outcome::Checked)
    });
}

/// d/dx f(x, x) = f₀(x, x) + f₁(x, x), and d²/dx² f(x, x) = f₀₀ + 2 f₀₁ + f₁₁.
#[test]
fn an_argument_in_two_places_counts_for_both() {
    let (mut graph, [x, ..]) = graph();
    let f = partial(&mut graph, 0, &[], &[x, x]);
    let [f0, f1, f00, f01, f11] =
        [&[0][..], &[1], &[0, 0], &[0, 1], &[1, 1]].map(|by| partial(&mut graph, 0, by, &[x, x]));
    let first = graph.add(f0, f1);
    let one = rational(1, 1);
    let second = graph.sum([(f00, one), (f01, rational(2, 1)), (f11, one)]);
    let mut along = Forward::along([(symbol(0), Id::ONE)]);
    assert_eq!(along.of(&mut graph, f), first);
    assert_eq!(along.of(&mut graph, first), second);
    assert_eq!(gradient(&mut graph, f)[0], first);
    assert_eq!(gradient(&mut graph, first)[0], second);
}

#[test]
fn a_function_does_not_change_with_what_it_is_not_given() {
    let (mut graph, [x, y, _]) = graph();
    let constant = graph.integer(3);
    let f = partial(&mut graph, 0, &[], &[x, constant]);
    assert_eq!(gradient(&mut graph, f)[1..], [Id::ZERO; 2]);
    let mut along = Forward::along([(symbol(1), Id::ONE)]);
    assert_eq!(along.of(&mut graph, f), Id::ZERO);
    // A constant argument has no derivative, but keeps its position.
    let slope = partial(&mut graph, 0, &[0], &[x, constant]);
    assert_eq!(gradient(&mut graph, f)[0], slope);
    assert_ne!(slope, partial(&mut graph, 0, &[0], &[constant, x]));
    assert_ne!(f, partial(&mut graph, 0, &[], &[y, constant]));
}

#[test]
fn derivatives_keep_the_boundaries_in_arguments() {
    let (mut graph, [x, y, _]) = graph();
    let product = graph.mul(x, y);
    let named = graph.defined(product);
    let f = partial(&mut graph, 0, &[], &[named]);
    let slope = partial(&mut graph, 0, &[0], &[named]);
    let expected = {
        let rate = graph.defined(y);
        graph.mul(slope, rate)
    };
    assert_eq!(Forward::along([(symbol(0), Id::ONE)]).of(&mut graph, f), expected);
    let boundary = graph.defined(f);
    let rate = Forward::along([(symbol(0), Id::ONE)]).of(&mut graph, boundary);
    assert!(matches!(graph.node(rate), Node::Defined(_)));
}

#[test]
fn equal_arguments_have_equal_values() {
    let (mut graph, [x, y, _]) = graph();
    let (sum, reversed) = (graph.add(x, y), graph.add(y, x));
    let named = graph.defined(sum);
    let calls = [sum, reversed, named].map(|argument| partial(&mut graph, 0, &[], &[argument]));
    let rates = calls.map(|call| gradient(&mut graph, call)[0]);
    for [first, other] in
        calls.map(|call| [calls[0], call]).into_iter().chain(rates.map(|rate| [rates[0], rate]))
    {
        let verdict = difference_is(&mut graph, first, other);
        assert!(matches!(verdict, Verdict::Zero | Verdict::Held(_)), "{verdict:?}");
    }
}

/// (f + 1)² − f² − 2f − 1 is zero for every f, but not zero by its form.
#[test]
fn identities_hold_whatever_the_function_is() {
    let (mut graph, arguments) = graph();
    let f = partial(&mut graph, 0, &[], &arguments);
    let more = graph.add(f, Id::ONE);
    let (square_of_more, square, one) = (graph.square(more), graph.square(f), rational(1, 1));
    let rest = graph.sum([(square, one), (f, rational(2, 1)), (Id::ONE, one)]);
    assert!(matches!(difference_is(&mut graph, square_of_more, rest), Verdict::Held(_)));
}

#[test]
fn what_may_differ_is_told_apart() {
    let (mut graph, [x, y, z]) = graph();
    let sine = graph.function(Function::Sin, x);
    let f = partial(&mut graph, 0, &[], &[x, y]);
    let others = [
        partial(&mut graph, 0, &[], &[y, x]),
        partial(&mut graph, 0, &[], &[x, z]),
        partial(&mut graph, 0, &[], &[sine, y]),
        partial(&mut graph, 1, &[], &[x, y]),
        partial(&mut graph, 0, &[0], &[x, y]),
        partial(&mut graph, 0, &[1], &[x, y]),
        graph.external(External {
            function: 1,
            output: 0,
            derivatives: Box::default(),
            arguments: [x, y].into(),
            is_along: false,
        }),
        Id::ZERO,
    ];
    for other in others {
        assert_eq!(difference_is(&mut graph, f, other), Verdict::NonZero, "{:?}", graph.node(other));
    }
}

/// f(x (y + 1)) and f(x y + x) are two nodes with the same value.
#[test]
fn arguments_that_are_equal_in_value_give_equal_values() {
    let (mut graph, [x, y, _]) = graph();
    let sum = graph.add(y, Id::ONE);
    let factored = graph.mul(x, sum);
    let product = graph.mul(x, y);
    let expanded = graph.add(product, x);
    for derivatives in [&[][..], &[0], &[0, 0]] {
        let [one, other] = [factored, expanded].map(|x| partial(&mut graph, 0, derivatives, &[x]));
        assert_ne!(one, other);
        assert!(matches!(difference_is(&mut graph, one, other), Verdict::Held(_)));
        let shifted = graph.add(expanded, Id::ONE);
        let elsewhere = partial(&mut graph, 0, derivatives, &[shifted]);
        assert_eq!(difference_is(&mut graph, one, elsewhere), Verdict::NonZero);
    }
}
