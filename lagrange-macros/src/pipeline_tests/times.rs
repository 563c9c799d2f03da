//! What the stages take in a build without optimisation, as users' projects run them.

use std::time::{Duration, Instant};

use super::systems;
use crate::{codegen, diagnostics::Diagnostics, mechanics, resolve, syntax};

struct Times {
    system: String,
    nodes: usize,
    stages: [Duration; 5],
}

fn times(system: String, source: &str) -> Times {
    let mut diagnostics = Diagnostics::default();
    let input = super::tokens(source);
    let start = Instant::now();
    let declaration = syntax::declaration(syn::parse2(input).expect("a struct"), &mut diagnostics);
    let read = start.elapsed();
    let mut problem = resolve::problem(&declaration, &mut diagnostics).expect("no errors");
    let scalar = problem.parameters.scalar(&declaration, &mut diagnostics);
    let resolved = start.elapsed();
    let equations = mechanics::derive(&mut problem, &mut diagnostics).expect("no errors");
    let derived = start.elapsed();
    let facts = mechanics::facts(&mut problem, &equations, &mut diagnostics).expect("no errors");
    let found = start.elapsed();
    let rendered = crate::render::render(&declaration, &mut problem, &equations, &facts);
    codegen::implementation(&declaration, &problem, &equations, &facts, &rendered, &scalar, &mut diagnostics);
    let emitted = start.elapsed();
    let stages = [read, resolved - read, derived - resolved, found - derived, emitted - found];
    Times { system, nodes: problem.graph.len(), stages }
}

/// `cargo test -p lagrange-macros times -- --ignored --nocapture`
#[test]
#[ignore = "a measurement, not a check"]
fn times_of_the_stages() {
    let mut rows: Vec<Times> =
        [12, 24, 40].map(|n| times(format!("{n}-link chain"), &systems::chain(n))).into();
    rows.push(times("50 rods".to_owned(), &systems::rods(50)));
    println!(
        "{:14} {:>7} {:>8} {:>8} {:>9} {:>8} {:>8} {:>8}",
        "", "nodes", "syntax", "resolve", "mechanics", "facts", "codegen", "in all"
    );
    for Times { system, nodes, stages } in rows {
        let [read, resolved, derived, found, emitted] = stages.map(|stage| stage.as_secs_f64() * 1e3);
        let all = read + resolved + derived + found + emitted;
        println!(
            "{system:14} {nodes:7} {read:5.0} ms {resolved:5.0} ms {derived:6.0} ms {found:5.0} ms {emitted:5.0} ms {all:5.0} ms"
        );
    }
}
