//! Random functions that stand in for user-supplied ones: they are consistent with their derivatives.

use super::{graph, symbol};
use lagrange_symbolic::Approximate;
use lagrange_symbolic::{External, Graph, Id};

fn unknown(graph: &mut Graph, output: u32, arguments: [Id; 2]) -> Id {
    graph.external(External {
        function: 0,
        output,
        derivatives: Box::new([]),
        arguments: arguments.into(),
        is_along: false,
    })
}

/// Values of `roots` at x = 0.3, y = −0.7 and z = 0.3 + `shift`.
fn values(graph: &Graph, roots: &[Id], draw: u64, shift: f64) -> Vec<Approximate> {
    graph.sample(roots, draw, |symbol| Approximate::exact([0.3, -0.7, 0.3 + shift][symbol.index as usize]))
}

#[test]
fn their_derivatives_are_theirs() {
    let (mut graph, [_, y, z]) = graph();
    let f = unknown(&mut graph, 0, [z, y]);
    let first = graph.gradient(f, &[symbol(2)])[0];
    let second = graph.gradient(first, &[symbol(2)])[0];
    let third = graph.gradient(second, &[symbol(2)])[0];
    let h = 1e-4;
    for draw in 0..5 {
        let all = [f, first, second, third];
        let [before, here, after] = [-h, 0.0, h].map(|shift| values(&graph, &all, draw, shift));
        for order in 0..3 {
            let difference = (after[order].value - before[order].value) / (2.0 * h);
            // Error of the central difference: h²/6 times the third derivative, below 1e-6 for wave frequencies below
            // 2.
            assert!((difference - here[order + 1].value).abs() < 1e-6, "{order} {difference} {here:?}");
            assert!(here[order + 1].value.abs() > 1e-3 && here[order].error < 1e-12, "{here:?}");
        }
    }
}

#[test]
fn equal_arguments_have_equal_values_and_others_do_not() {
    let (mut graph, [x, y, z]) = graph();
    let [f, same, other, swapped] =
        [(0, [x, y]), (0, [z, y]), (1, [x, y]), (0, [y, x])].map(|(o, of)| unknown(&mut graph, o, of));
    let roots = [f, same, other, swapped];
    let here = values(&graph, &roots, 0, 0.0);
    assert_eq!(here[0].value, here[1].value);
    let redrawn = values(&graph, &roots, 1, 0.0)[0];
    for different in [here[2], here[3], redrawn] {
        assert!((different.value - here[0].value).abs() > 1e-3);
    }
}
