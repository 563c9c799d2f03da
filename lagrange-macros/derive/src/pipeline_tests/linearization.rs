//! The derivative of the residual along a direction takes linearly many operations. The Jacobian entry by entry
//! takes more, so the directional derivative is emitted instead.

use super::{derived, equations, systems};
use crate::codegen::operations;
use crate::mechanics::Linearization;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id};
use crate::variables::Variable;

const LENGTHS: [usize; 5] = [4, 8, 12, 16, 20];

fn linearization(source: &str) -> (Graph, Problem, Linearization) {
    let (graph, problem, derived) = derived(source);
    (graph, problem, derived.linearization.expect("no fault"))
}

fn count(graph: &Graph, roots: &[Id]) -> usize {
    let count = operations(graph, roots);
    count.arithmetic + count.functions
}

/// ∂R/∂(t, q, q̇), each column as an expression of its own.
fn columns(graph: &mut Graph, problem: &Problem, linearization: &Linearization) -> Vec<Id> {
    let mut all = Vec::new();
    for column in 0..=2 * problem.coordinates.len() {
        let seed = |symbol| match Variable::of(symbol) {
            Variable::Change(i) => Some(if i == column { Id::ONE } else { Id::ZERO }),
            _ => None,
        };
        for root in linearization.by_state.roots() {
            all.push(graph.substituted(root, seed));
        }
    }
    all
}

/// A chain in angles has a dense mass matrix, a chain of rods has constraints.
#[test]
fn the_change_along_a_direction_takes_linearly_many_operations() {
    for (name, system) in [("angles", systems::chain as fn(usize) -> String), ("rods", systems::rods)] {
        let counts = LENGTHS.map(|n| {
            let (graph, _, linearization) = linearization(&system(n));
            count(&graph, &linearization.roots())
        });
        println!("a chain of {LENGTHS:?} in {name}: {counts:?} operations");
        assert!(counts.windows(3).all(|c| c[2] + c[0] == 2 * c[1]), "{counts:?}");
    }
}

/// Newton–Euler inverse dynamics, found from the definitions of the links' velocities. By the entries of M it would
/// take quadratically many operations.
#[test]
fn inverse_dynamics_takes_linearly_many_operations() {
    for (name, system) in [("angles", systems::chain as fn(usize) -> String), ("rods", systems::rods)] {
        let (counts, by_mass): (Vec<usize>, Vec<usize>) = LENGTHS
            .iter()
            .map(|&n| {
                let (graph, _, equations) = equations(&system(n));
                let entries = [equations.mass.concat(), equations.forcing.clone()].concat();
                (count(&graph, &equations.balance), count(&graph, &entries))
            })
            .unzip();
        println!(
            "inverse dynamics of a chain of {LENGTHS:?} in {name}: {counts:?} operations; M and h {by_mass:?}"
        );
        assert!(counts.windows(3).all(|c| c[2] + c[0] == 2 * c[1]), "{counts:?}");
        assert!(counts[4] <= 40 * LENGTHS[4], "{counts:?}");
    }
}

#[test]
fn the_columns_as_formulas_take_quadratically_many() {
    let counts = LENGTHS.map(|n| {
        let (mut graph, problem, linearization) = linearization(&systems::chain(n));
        let columns = columns(&mut graph, &problem, &linearization);
        count(&graph, &columns)
    });
    println!("all columns for a chain of {LENGTHS:?} in angles: {counts:?} operations");
    // More than 3/2 of a count proportional to the length.
    assert!(2 * LENGTHS[2] * counts[4] > 3 * LENGTHS[4] * counts[2], "{counts:?}");
}
