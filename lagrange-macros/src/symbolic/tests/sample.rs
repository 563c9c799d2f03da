//! Points on surfaces.

use crate::symbolic::{Function, Graph, Sample};

use super::symbol;

#[test]
fn a_point_is_moved_onto_a_surface() {
    let mut graph = Graph::default();
    let [x, y, z] = [0, 1, 2].map(|i| graph.symbol(symbol(i)));
    // x² + y² = 2, twice, and z = sin x.
    let squares = [graph.square(x), graph.square(y), graph.integer(-2)];
    let circle = squares.into_iter().reduce(|sum, term| graph.add(sum, term)).expect("terms");
    let weight = graph.add(z, squares[0]);
    let again = graph.mul(circle, weight);
    let sine = graph.function(Function::Sin, x);
    let sheet = graph.sub(z, sine);
    let mut found = 0;
    for draw in 0..20 {
        let mut sample = Sample::new([0, 1, 2].map(symbol), draw, |_| (0.5, 1.5));
        let unknowns = [0, 1, 2].map(symbol);
        // From far away the second equation of the circle can lead astray; then one draws again.
        if sample.project(&graph, &[circle, again, sheet], &unknowns).is_none() {
            continue;
        }
        found += 1;
        let [x, y, z] = [x, y, z].map(|id| sample.values(&graph, &[id]).expect("a value")[0]);
        // The exact point with the same x is within the bounds that are stated.
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
    let root = graph.add(square, crate::symbolic::Id::ONE);
    let mut sample = Sample::new([symbol(0)], 0, |_| (0.5, 1.5));
    assert!(sample.project(&graph, &[root], &[symbol(0)]).is_none());
}
