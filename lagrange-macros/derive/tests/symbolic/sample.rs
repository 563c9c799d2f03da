//! Projection of random points onto surfaces.

use lagrange_symbolic::{Function, Graph, Id, Rational, Sample};

use super::{symbol, within};

#[test]
fn a_point_is_moved_onto_a_surface() {
    let mut graph = Graph::default();
    let [x, y, z] = [0, 1, 2].map(|i| graph.symbol(symbol(i)));
    // x² + y² = 2, stated twice, and z = sin x.
    let squares = [graph.square(x), graph.square(y), graph.integer(-2)];
    let circle = squares.into_iter().reduce(|sum, term| graph.add(sum, term)).expect("terms");
    let weight = graph.add(z, squares[0]);
    let again = graph.mul(circle, weight);
    let sine = graph.function(Function::Sin, x);
    let sheet = graph.sub(z, sine);
    let mut found = 0;
    for draw in 0..20 {
        let mut sample = Sample::new([0, 1, 2].map(symbol), draw, within((0.5, 1.5)));
        let unknowns = [0, 1, 2].map(symbol);
        // Far from the circle, its second equation can make the iteration fail; another point is then drawn.
        let slopes = [circle, again, sheet].map(|root| graph.gradient(root, &unknowns));
        let slopes = slopes.each_ref().map(Vec::as_slice);
        if sample.project(&graph, &[circle, again, sheet], &slopes, &unknowns).is_none() {
            continue;
        }
        found += 1;
        let [x, y, z] = [x, y, z].map(|id| sample.values(&graph, &[id])[0]);
        // The exact point with the same x is within the error bounds.
        assert!(((2.0 - x.value * x.value).sqrt() - y.value).abs() < y.error, "{x:?} {y:?}");
        assert!((x.value.sin() - z.value).abs() < z.error, "{x:?} {z:?}");
        assert!(y.error < 1e-12 && z.error < 1e-12);
    }
    assert!(found >= 10, "only {found} of 20 points");
}

#[test]
fn where_there_is_no_surface_there_is_no_point() {
    let mut graph = Graph::default();
    let x = graph.symbol(symbol(0));
    let square = graph.square(x);
    let root = graph.add(square, Id::ONE);
    let mut sample = Sample::new([symbol(0)], 0, within((0.5, 1.5)));
    let slope = graph.gradient(root, &[symbol(0)]);
    assert!(sample.project(&graph, &[root], &[&slope], &[symbol(0)]).is_none());
}

/// Where surfaces touch, the common points are determined only to the square root of the rounding error.
#[test]
fn where_surfaces_touch_there_is_no_point() {
    let mut graph = Graph::default();
    let [x, y] = [0, 1].map(|i| graph.symbol(symbol(i)));
    // x² + y² = 1 and x² + 2 y² = 1.
    let [x2, y2] = [x, y].map(|id| graph.square(id));
    let one = Rational::from_integer(1);
    let surfaces = [1, 2].map(|k| graph.sum([(x2, one), (y2, Rational::from_integer(k)), (Id::ONE, -one)]));
    let unknowns = [0, 1].map(symbol);
    let slopes = surfaces.map(|root| graph.gradient(root, &unknowns));
    let slopes = slopes.each_ref().map(Vec::as_slice);
    for draw in 0..20 {
        let mut sample = Sample::new(unknowns, draw, within((0.5, 1.5)));
        assert!(sample.project(&graph, &surfaces, &slopes, &unknowns).is_none());
    }
}
