//! Emits Rust code for the [derived](Derived) equations. No other module emits code.

mod accelerations;
mod body;
mod bounds;
mod contacts;
mod count;
mod defects;
mod eliminate;
mod emitter;
mod evaluation;
mod facts;
mod forces;
mod inputs;
mod integrability;
mod kernel;
mod lagrangian;
mod linearized;
pub(crate) mod many;
mod markers;
mod members;
mod moving;
mod observables;
mod operation;
mod pack;
mod passes;
mod rounds;
mod schedule;
mod series;
mod shape;
mod signature;
mod slopes;
mod solving;
mod stub;
mod style;
mod switched;
#[cfg(test)]
mod tests;
mod time;
mod tree;
mod writer;

use proc_macro2::TokenStream;

use crate::diagnostics::Diagnostics;
use crate::facts::Facts;
use crate::mechanics::Derived;
use crate::render::Rendered;
use crate::resolve::{Problem, Supplied};
use crate::symbolic::Graph;
use crate::syntax::Declaration;
use bounds::FUNCTION_ORDER;
#[cfg(test)]
pub(crate) use count::Count;
use emitter::{Emitter, too_long};
pub use evaluation::{Arguments, Elimination, ParameterField, Tape, Tapes, Unsupported};
use linearized::Changing;
use series::TaylorPrograms;
use solving::Solving;
pub(crate) use stub::stub;
use style::FunctionContext;
#[cfg(test)]
pub(crate) use tests::{apply, operations, solutions, solutions_by, solving, values};

/// Emits the trait implementations and a method for each observable. Reports functions that are too long and returns
/// `None`.
pub(crate) fn implementation(
    declaration: &Declaration,
    graph: &Graph,
    problem: &Problem,
    derived: &Derived,
    rendered: &Rendered,
    facts: &Facts,
    diagnostics: &mut Diagnostics,
) -> Option<TokenStream> {
    let solving = Solving::of(graph, &derived.equations);
    let changing = derived
        .linearization
        .as_ref()
        .map(|linearization| Changing::new(graph, linearization, &derived.equations.forcing));
    let series = TaylorPrograms::new(graph, &derived.equations);
    let slopes =
        changing.as_ref().map_or(0, Changing::slopes).max(series.as_ref().map_or(0, TaylorPrograms::slopes));
    let more = derived.equations.switched.as_ref().map_or(0, |_| derived.equations.forcing.len());
    let numbers = solving.factoring.as_ref().map(|[factor, _]| factor.results.len() - more);
    let constraints = match &derived.equations.switched {
        Some(_) => 0,
        None => problem.constraints.len(),
    };
    let sums = series.as_ref().map_or([0; 2], |series| [series.sums, series.terms]);
    let style =
        FunctionContext::new(graph, (&declaration.ident, problem), (numbers, constraints), slopes, sums);
    let emitter = Emitter { declaration, problem, derived, rendered, facts, solving, style };
    for (function, order) in emitter.orders(&[]).into_iter().filter(|(_, order)| *order > FUNCTION_ORDER) {
        let Supplied { name, place, .. } = &problem.functions[function as usize];
        diagnostics.error(*place, format!(
            "the equations need the {order}th derivatives of `{name}`, and functions are differentiated {FUNCTION_ORDER} times at most"
        ));
    }
    let mut tokens = emitter.lagrangian(diagnostics);
    diagnostics.is_empty().then_some(())?;
    if let Some((linearization, changing)) = derived.linearization.as_ref().zip(changing) {
        tokens.extend(emitter.linearized(linearization, &changing));
        tokens.extend(emitter.force_derivatives(linearization, &changing));
    }
    tokens.extend(series.as_ref().map(|series| emitter.taylor_series(series)));
    Some(tokens)
}

/// Reports a Lagrangian that is far too long, before it is differentiated.
pub(crate) fn refuse_hopeless(
    declaration: &Declaration,
    graph: &Graph,
    problem: &Problem,
    diagnostics: &mut Diagnostics,
) -> Option<()> {
    let Some(count) = passes::hopeless(graph, problem.lagrangian) else { return Some(()) };
    diagnostics.error(problem.place, too_long(declaration, &format!("the Lagrangian takes {count}")));
    None
}
