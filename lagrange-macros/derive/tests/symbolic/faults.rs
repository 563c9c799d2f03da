//! Failures of exact arithmetic: each is reported as a fault and never panics.

use proptest::prelude::*;

use super::{Outcome, for_all, graph, rational, symbol, value, within};
use lagrange_symbolic::{Fault, Forward, Function, Graph, Id, Rational};

const EXTREMES: [i128; 12] = [
    0,
    1,
    -1,
    2,
    -3,
    1 << 64,
    -(1 << 64),
    1 << 126,
    -(1 << 126),
    1_000_000_000_000_000_000_000_000_000_000,
    i128::MAX,
    -i128::MAX,
];

/// One operation to add as a node; its operands are earlier nodes, given by index.
#[derive(Clone, Copy, Debug)]
struct Step {
    kind: u8,
    at: [usize; 2],
    by: [Rational; 2],
}

fn extreme() -> impl Strategy<Value = Rational> {
    let pool = || prop::sample::select(&EXTREMES[..]);
    (pool(), pool().prop_filter("a denominator", |d| *d != 0)).prop_map(|(n, d)| Rational::new(n, d))
}

fn steps() -> impl Strategy<Value = Vec<Step>> {
    let step = (0..8_u8, [0..64_usize, 0..64], [extreme(), extreme()]);
    prop::collection::vec(step.prop_map(|(kind, at, by)| Step { kind, at, by }), 1..14)
}

fn take(step: Step, graph: &mut Graph, made: &[Id]) -> Id {
    let [x, y] = step.at.map(|at| made[at % made.len()]);
    let functions = [Function::Sin, Function::Cos, Function::Abs, Function::Ln, Function::Atan];
    match step.kind {
        0 | 1 => graph.sum([(x, step.by[0]), (y, step.by[1])]),
        2 | 3 => graph.product([(x, step.by[0]), (y, step.by[1])]),
        4 => graph.number(step.by[0]),
        5 => graph.power(x, y),
        6 => graph.defined(x),
        _ => graph.function(functions[step.at[1] % functions.len()], x),
    }
}

#[test]
fn extreme_numbers_never_panic() {
    for_all(3000, 0.0, steps(), |steps| {
        let (mut graph, symbols) = graph();
        let mut made = symbols.to_vec();
        for step in steps {
            let id = take(step, &mut graph, &made);
            made.push(id);
        }
        let root = made[made.len() - 1];
        let slopes = graph.gradient(root, &[0, 1, 2].map(symbol));
        let rate = Forward::along([(symbol(0), Id::ONE)]).of(&mut graph, root);
        let flat = graph.looked_through(root);
        graph.is_zero(root, within((-1.0, 1.0)));
        for id in [slopes, vec![root, rate, flat]].concat() {
            graph.evaluate(id, |_| 0.5);
        }
        Ok(Outcome::Checked)
    });
}

fn fault(f: impl FnOnce(&mut Graph, [Id; 3]) -> Id) -> Option<Fault> {
    let (mut graph, symbols) = graph();
    f(&mut graph, symbols);
    graph.take_fault()
}

#[test]
fn what_does_not_fit_overflows() {
    let huge = rational(10_i128.pow(30), 1);
    let third = rational(1, 3);
    let largest = rational(i128::MAX, 1);
    let cases: [fn(&mut Graph, Id) -> Id; 2] = [
        |graph, x| graph.product([(x, rational(i128::MAX, 1)), (x, rational(i128::MAX, 1))]),
        |graph, _| graph.number(Rational::from_integer(i128::MIN)),
    ];
    for case in cases {
        assert_eq!(fault(|graph, [x, ..]| case(graph, x)), Some(Fault::Overflow));
    }
    let power = |base: Rational, exponent: Rational| {
        fault(|graph, _| {
            let base = graph.number(base);
            graph.pow(base, exponent)
        })
    };
    assert_eq!(power(third, rational(500, 1)), Some(Fault::Overflow));
    assert_eq!(power(rational(2, 1), huge), Some(Fault::Overflow));
    assert_eq!(power(rational(10, 1), rational(309, 1)), Some(Fault::Overflow));
    // A power with too many digits stays unevaluated.
    assert_eq!(power(largest, rational(2, 1)), None);
    assert_eq!(power(third, rational(200, 1)), None);
    assert_eq!(power(rational(10, 1), rational(308, 1)), None);
    assert_eq!(power(rational(-1, 1), huge), None);
    assert_eq!(power(rational(1, 1), huge), None);
    assert_eq!(fault(|graph, [x, ..]| graph.pow(x, huge)), None);
}

/// (−2)^127 fits into an i128, but its negative does not: the power stays unevaluated.
#[test]
fn the_negative_of_a_number_fits_too() {
    let (mut graph, _) = graph();
    let base = graph.integer(-2);
    let power = graph.pow(base, rational(127, 1));
    let negative = graph.neg(power);
    assert_eq!(value(&graph, negative), 2.0_f64.powi(127));
    assert_eq!(graph.take_fault(), None);
}

#[test]
fn minus_one_to_a_huge_power_has_its_parity() {
    let (mut graph, _) = graph();
    let minus_one = graph.integer(-1);
    let huge = 10_i128.pow(30);
    assert_eq!(graph.pow(minus_one, rational(huge, 1)), Id::ONE);
    assert_eq!(graph.pow(minus_one, rational(huge + 1, 1)), minus_one);
    assert_eq!(graph.pow(minus_one, rational(-huge - 1, 1)), minus_one);
}

#[test]
fn division_by_zero_is_noticed() {
    assert_eq!(fault(|graph, [x, ..]| graph.div(x, Id::ZERO)), Some(Fault::DivisionByZero));
    let hidden = fault(|graph, [x, y, _]| {
        let (xy, yx) = (graph.mul(x, y), graph.mul(y, x));
        let nothing = graph.sub(xy, yx);
        graph.pow(nothing, rational(-1, 2))
    });
    assert_eq!(hidden, Some(Fault::DivisionByZero));
    assert_eq!(fault(|graph, [x, ..]| graph.div(Id::ZERO, x)), None);
}

#[test]
fn the_first_fault_stays_until_it_is_taken() {
    let (mut graph, [x, _, _]) = graph();
    graph.div(x, Id::ZERO);
    graph.pow(x, rational(i128::MAX, 1));
    assert_eq!(graph.take_fault(), Some(Fault::DivisionByZero));
    assert_eq!(graph.take_fault(), None);
}

#[test]
fn runaway_expressions_stop_at_the_limit() {
    let (mut graph, _) = graph();
    for index in 0..Graph::LIMIT {
        graph.symbol(symbol(index));
    }
    assert_eq!(graph.take_fault(), Some(Fault::TooLarge));
    assert_eq!(graph.len(), Graph::LIMIT);
}
