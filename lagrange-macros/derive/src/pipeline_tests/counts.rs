//! Differentiation stops at definitions: a chain defined link by link takes linearly many operations.

use expect_test::expect;

use super::{equations, systems};
use crate::codegen::operations;
use crate::symbolic::{Graph, Id, Symbol};
use crate::variables::Variable;

const LENGTHS: [usize; 6] = [4, 8, 12, 16, 20, 24];

/// Cost of computing some expressions.
#[derive(Clone, Copy)]
struct Cost {
    /// Number of + − × ÷ √ and elementary functions.
    operations: usize,
    /// Number of operands of all nodes. The emitted code is shorter where sums share their first terms.
    operands: usize,
}

fn cost(graph: &Graph, roots: &[Id]) -> Cost {
    let count = operations(graph, roots);
    let mut operands = 0;
    for id in graph.reachable(roots) {
        graph.operands(id, |_| operands += 1);
    }
    Cost { operations: count.arithmetic + count.functions, operands }
}

/// Costs of ∂L/∂q̇ and of ∂L/∂q.
fn costs(graph: &mut Graph, lagrangian: Id, n: usize) -> [Cost; 2] {
    [Variable::Velocity, Variable::Coordinate].map(|variable: fn(usize) -> Variable| {
        let symbols: Vec<Symbol> = (0..n).map(|i| variable(i).symbol()).collect();
        let gradient = graph.gradient(lagrangian, &symbols);
        cost(graph, &gradient)
    })
}

/// Returns true if the second differences of a quantity vanish over all lengths.
fn is_linear(costs: &[[Cost; 2]], quantity: impl Fn(&[Cost; 2]) -> usize) -> bool {
    let counts: Vec<_> = costs.iter().map(quantity).collect();
    counts.windows(3).all(|c| c[2] + c[0] == 2 * c[1])
}

#[test]
fn momenta_and_forces_of_a_chain_cost_linearly_many_operations() {
    let (mut bounded, mut flat) = (Vec::new(), Vec::new());
    let mut table = String::from("operations (operands in the graph)\n");
    table += &format!("links {:>12} {:>14} {:>22} {:>14}\n", "p", "∂L/∂q", "p, no boundaries", "∂L/∂q");
    for n in LENGTHS {
        let (mut graph, problem, equations) = equations(&systems::chain(n));
        let lagrangian = problem.lagrangian;
        let of_chain = costs(&mut graph, lagrangian, n);
        assert_eq!(cost(&graph, &equations.momentum).operations, of_chain[0].operations, "this is p");
        let without = graph.looked_through(lagrangian);
        let of_flat = costs(&mut graph, without, n);
        let [p, force, flat_p, flat_force] = [of_chain[0], of_chain[1], of_flat[0], of_flat[1]]
            .map(|cost| format!("{} ({})", cost.operations, cost.operands));
        table += &format!("{n:5} {p:>12} {force:>14} {flat_p:>22} {flat_force:>14}\n");
        bounded.push(of_chain);
        flat.push(of_flat);
    }
    println!("{table}");
    expect![[r#"
        operations (operands in the graph)
        links            p          ∂L/∂q       p, no boundaries          ∂L/∂q
            4     56 (120)       71 (167)               62 (116)       77 (162)
            8    116 (248)      147 (343)              122 (292)      153 (396)
           12    176 (376)      223 (519)              182 (532)      229 (710)
           16    236 (504)      299 (695)              242 (836)     305 (1104)
           20    296 (632)      375 (871)             302 (1204)     381 (1578)
           24    356 (760)     451 (1047)             362 (1636)     457 (2132)
    "#]]
    .assert_eq(&table);
    assert!(is_linear(&bounded, |cost| cost[0].operations), "operations of ∂L/∂q̇");
    assert!(is_linear(&bounded, |cost| cost[1].operations), "operations of ∂L/∂q");
    assert!(is_linear(&bounded, |cost| cost[0].operands) && is_linear(&bounded, |cost| cost[1].operands));
    // With definitions expanded, the number of operands is not linear. That of the emitted code may be, since sums
    // share their first terms.
    assert!(!is_linear(&flat, |cost| cost[0].operands) && !is_linear(&flat, |cost| cost[1].operands));
}
