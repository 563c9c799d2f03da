//! Queries about the emitted code for tests of the pipeline, without a compiler.

mod constants;
mod interpret;

use super::body::FunctionBody;
use super::count::Count;
use super::operation::Call;
use super::passes::Program;
use super::solving::solve;
use crate::mechanics::Equations;
use crate::symbolic::{Graph, Id, Symbol};
pub(crate) use interpret::functions::apply;

/// Operation count of computing `roots` together.
pub(crate) fn operations(graph: &Graph, roots: &[Id]) -> Count {
    Program::of(graph, roots).count()
}

/// Value of a constant after compilation.
fn value(graph: &Graph, root: Id) -> f64 {
    values(graph, &[root], |_| f64::NAN)[0]
}

/// Values of expressions, as the program emitted for them computes them.
pub(crate) fn values(graph: &Graph, roots: &[Id], input: impl Fn(Symbol) -> f64) -> Vec<f64> {
    let program = Program::of(graph, roots);
    program.schedule.values(&program.results, input)
}

/// Operation counts of the accelerations as derived and after each pass, for each form of the equations. `None` for a
/// form that is solved in loops.
pub(crate) fn solving(graph: &Graph, equations: &Equations) -> Vec<Option<Vec<(&'static str, Count)>>> {
    let counts = |form| Some(solve(graph, form, &equations.linear)?.counts);
    equations.linear.forms.iter().map(counts).collect()
}

/// Accelerations, multipliers and pivot, for each form of the equations.
pub(crate) fn solutions(
    graph: &Graph,
    equations: &Equations,
    input: impl Fn(Symbol) -> f64,
) -> Vec<Option<Vec<f64>>> {
    solutions_by(graph, equations, input, |_, _, _, _| f64::NAN)
}

/// As [`solutions`], with user-supplied functions. `function` gets the index of the function, its partial
/// derivatives, the arguments, and the index of the result.
pub(crate) fn solutions_by(
    graph: &Graph,
    equations: &Equations,
    input: impl Fn(Symbol) -> f64,
    function: impl Fn(u32, &[u32], &[f64], u32) -> f64,
) -> Vec<Option<Vec<f64>>> {
    let function =
        |call: &Call<f64>, output| function(call.function, &call.derivatives, &call.arguments, output);
    let values = |form| {
        let program = solve(graph, form, &equations.linear)?.fused();
        Some(FunctionBody::new(&program, &Default::default()).values(program.results.len(), &input, function))
    };
    equations.linear.forms.iter().map(values).collect()
}
