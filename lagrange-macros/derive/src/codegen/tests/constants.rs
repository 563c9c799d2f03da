//! Numbers in the emitted code.

use lagrange_random::{Random, cases};

use super::{operations, value};
use crate::symbolic::{Forward, Function, Graph, Id, Rational, Symbol, parse_decimal};

/// Planck's constant and Avogadro's number are the nearest `f64`; powers and products of them are exact to rounding.
#[test]
fn constants_of_nature() {
    let mut graph = Graph::default();
    let [h, n] =
        ["6.62607015e-34", "6.02214076e23"].map(|text| graph.scaled(parse_decimal(text).expect("a number")));
    assert_eq!(value(&graph, h).to_bits(), 6.62607015e-34_f64.to_bits());
    assert_eq!(value(&graph, n).to_bits(), 6.02214076e23_f64.to_bits());
    let (product, root) = (graph.mul(h, n), graph.sqrt(h));
    assert!((value(&graph, product) / (6.62607015e-34 * 6.02214076e23) - 1.0).abs() < 2.0 * f64::EPSILON);
    assert!((value(&graph, root) / 6.62607015e-34_f64.sqrt() - 1.0).abs() < 2.0 * f64::EPSILON);
}

/// Whatever the numbers are: code can be emitted for their sums, products, powers, functions and derivatives.
#[test]
fn extreme_numbers_never_panic() {
    const EXTREMES: [i128; 8] = [1, -1, 2, -3, 1 << 64, -(1 << 126), 10_i128.pow(30), i128::MAX];
    let mut random = Random(1);
    for _ in 0..cases([250, 2_000, 20_000]) {
        let mut graph = Graph::default();
        let symbols = [0, 1, 2].map(|index| Symbol { family: 0, index });
        let mut made = symbols.map(|symbol| graph.symbol(symbol)).to_vec();
        for _ in 0..1 + random.below(13) {
            let [x, y] = [0; 2].map(|_| made[random.below(made.len())]);
            let [p, q] = [0; 2].map(|_| Rational::new(EXTREMES[random.below(8)], EXTREMES[random.below(8)]));
            made.push(match random.below(6) {
                0 | 1 => graph.sum([(x, p), (y, q)]),
                2 => graph.product([(x, p), (y, q)]),
                3 => graph.number(p),
                4 => graph.power(x, y),
                _ => graph.function([Function::Sin, Function::Abs, Function::Ln][random.below(3)], x),
            });
        }
        let root = made[made.len() - 1];
        let mut roots = graph.gradient(root, &symbols);
        roots.push(Forward::along([(symbols[0], Id::ONE)]).of(&mut graph, root));
        operations(&graph, &roots);
    }
}
