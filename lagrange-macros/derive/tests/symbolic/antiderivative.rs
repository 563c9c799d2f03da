//! Antiderivatives: their derivatives, by central differences, equal the integrands.

use lagrange_symbolic::{Function, Graph, Id, Rational};

use super::symbol;

/// Product (x + y + 1)ᵉ (x + 2 y + 2)ᵉ … of `count` sums, e being `exponent`
fn sums(graph: &mut Graph, count: i128, exponent: i128) -> Id {
    let one = Rational::from_integer(1);
    let [x, y] = [0, 1].map(|i| graph.symbol(symbol(i)));
    let sum = |k| [(x, one), (y, Rational::from_integer(k)), (Id::ONE, Rational::from_integer(k))];
    let factors: Vec<_> =
        (1..=count).map(|k| (graph.sum(sum(k)), Rational::from_integer(exponent))).collect();
    graph.product(factors)
}

/// Expanded, a product of thirty sums of three terms has 3³⁰ terms, and one of ten fourth powers has 15¹⁰.
#[test]
fn what_has_too_many_terms_is_not_multiplied_out() {
    let mut graph = Graph::default();
    for (count, exponent) in [(30, 1), (10, 4)] {
        let product = sums(&mut graph, count, exponent);
        let before = graph.len();
        assert_eq!(graph.antiderivative(product, symbol(0)), None);
        assert!(graph.len() < before + 10_000, "{} nodes after {before}", graph.len());
    }
    for (count, exponent) in [(5, 1), (2, 2)] {
        let product = sums(&mut graph, count, exponent);
        assert!(graph.antiderivative(product, symbol(0)).is_some(), "few terms: {count}, {exponent}");
    }
}

/// a₀ = x + y, aₖ₊₁ = aₖ (aₖ + k): few nodes, but of the order of 2 to the power 2ᵏ terms.
#[test]
fn sums_within_sums_count() {
    let mut graph = Graph::default();
    let [x, y] = [0, 1].map(|i| graph.symbol(symbol(i)));
    let mut product = graph.add(x, y);
    for k in 1..60 {
        let k = graph.integer(k);
        let sum = graph.add(product, k);
        product = graph.mul(product, sum);
    }
    assert_eq!(graph.antiderivative(product, symbol(0)), None);
}

/// Central difference of `root` by symbol 0 at x, with symbol 1 at 0.7.
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
    // All but (x + y) exp(x y), which needs integration by parts.
    assert_eq!(found, integrands.len() - 1);
}
