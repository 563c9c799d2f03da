//! What is integrated has the integrand for its derivative: by central differences.

use crate::symbolic::{Function, Graph, Id, Rational};

use super::symbol;

/// The central difference of `root` by symbol 0 at x, with symbol 1 at 0.7.
fn slope(graph: &Graph, root: Id, x: f64) -> f64 {
    let at = |x: f64| graph.evaluate(root, |name| if name == symbol(0) { x } else { 0.7 }).value;
    let h = 1e-5;
    (at(x + h) - at(x - h)) / (2.0 * h)
}

#[test]
fn the_derivative_of_an_antiderivative_is_the_integrand() {
    let mut graph = Graph::default();
    let g = &mut graph;
    let [x, y] = [0, 1].map(|i| g.symbol(symbol(i)));
    let (xy, x2, sum) = (g.mul(x, y), g.square(x), g.add(x, y));
    let [sin, cos, exp, sinh, cosh] =
        [Function::Sin, Function::Cos, Function::Exp, Function::Sinh, Function::Cosh]
            .map(|f| g.function(f, xy));
    let (inverse, root, cube) =
        (g.pow(sum, Rational::from_integer(-1)), g.sqrt(sum), g.pow(sum, Rational::from_integer(3)));
    let inside = g.function(Function::Exp, x2);
    let integrands = [
        y,
        x,
        xy,
        x2,
        sin,
        cos,
        exp,
        sinh,
        cosh,
        inverse,
        root,
        cube,
        g.mul(x, inside),
        g.mul(sin, cos),
        g.mul(x2, sum),
        g.mul(sum, exp),
        g.mul(x, cube),
    ];
    let mut found = 0;
    for integrand in integrands {
        let Some(integral) = graph.antiderivative(integrand, symbol(0)) else { continue };
        found += 1;
        for value in [0.3, 1.1] {
            let exact = graph.evaluate(integrand, |name| if name == symbol(0) { value } else { 0.7 }).value;
            let numeric = slope(&graph, integral, value);
            assert!((exact - numeric).abs() < 1e-8 * (1.0 + exact.abs()), "{exact} {numeric}");
        }
    }
    // All but (x + y) exp(x y), which takes integration by parts.
    assert_eq!(found, integrands.len() - 1);
}
