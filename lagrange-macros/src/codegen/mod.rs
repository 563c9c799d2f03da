//! From what was [derived](Derived) to Rust. Nothing else writes any.

mod accelerations;
mod body;
mod bounds;
mod count;
mod eliminate;
mod facts;
mod integrability;
#[cfg(test)]
mod interpret;
mod kernel;
mod lagrangian;
mod linearized;
mod observables;
mod operation;
mod pack;
mod passes;
mod schedule;
mod shape;
mod signature;
mod stub;
mod style;
mod time;
mod writer;

use proc_macro2::TokenStream;
use quote::quote;

use crate::diagnostics::Diagnostics;
use crate::mechanics::Derived;
#[cfg(test)]
use crate::mechanics::Equations;
use crate::render::Rendered;
use crate::resolve::{Problem, Supplied};
use crate::symbolic::Graph;
#[cfg(test)]
use crate::symbolic::Id;
use crate::syntax::Declaration;
use bounds::FUNCTION_ORDER;
#[cfg(test)]
pub(crate) use count::Count;
use kernel::{Kernel, OPERATION_LIMIT};
pub(crate) use stub::stub;
use style::Style;

/// The implementation of the traits, and a method for each observable; `None` where a function would be too long,
/// which is then reported.
pub(crate) fn implementation(
    declaration: &Declaration,
    graph: &Graph,
    problem: &Problem,
    derived: &Derived,
    rendered: &Rendered,
    diagnostics: &mut Diagnostics,
) -> Option<TokenStream> {
    let emitter = Emitter { declaration, problem, derived, rendered, style: Style::new(graph, problem) };
    for (function, order) in emitter.orders(&[]).into_iter().filter(|(_, order)| *order > FUNCTION_ORDER) {
        let Supplied { name, place, .. } = &problem.functions[function as usize];
        diagnostics.error(*place, format!(
            "the equations need the {order}th derivatives of `{name}`, and functions are differentiated {FUNCTION_ORDER} times at most"
        ));
    }
    let mut tokens = emitter.lagrangian(diagnostics);
    diagnostics.is_empty().then_some(())?;
    tokens.extend(derived.linearization.as_ref().and_then(|linearization| emitter.linearized(linearization)));
    Some(tokens)
}

/// Reports a Lagrangian that is too long for any function, before it is differentiated.
pub(crate) fn refuse_hopeless(graph: &Graph, problem: &Problem, diagnostics: &mut Diagnostics) -> Option<()> {
    let Some(count) = passes::hopeless(graph, problem.lagrangian) else { return Some(()) };
    diagnostics.error(problem.place, too_long(&format!("the Lagrangian takes {count}")));
    None
}

/// A system that is being written.
struct Emitter<'a> {
    declaration: &'a Declaration,
    problem: &'a Problem,
    derived: &'a Derived,
    rendered: &'a Rendered,
    style: Style<'a>,
}

/// Methods, and the kernels in them.
struct Written {
    tokens: TokenStream,
    kernels: Vec<Kernel>,
}

impl FromIterator<Self> for Written {
    fn from_iter<I: IntoIterator<Item = Self>>(all: I) -> Self {
        let (mut tokens, mut kernels) = (TokenStream::new(), Vec::new());
        for written in all {
            tokens.extend(written.tokens);
            kernels.extend(written.kernels);
        }
        Self { tokens, kernels }
    }
}

fn too_long(what: &str) -> String {
    format!(
        "{what}: more than the {OPERATION_LIMIT} that one function may have. Name what recurs with `#[define(…)]`, recursively along chains, so that it is shared, or take coordinates with constraints between them"
    )
}

/// The path of the runtime crate.
fn runtime(declaration: &Declaration) -> TokenStream {
    declaration.options.runtime.clone().unwrap_or_else(|| quote!(::lagrange_core))
}

/// What computing `roots` together takes.
#[cfg(test)]
pub(crate) fn operations(graph: &Graph, roots: &[Id]) -> Count {
    passes::Program::of(graph, roots).count()
}

/// The value of a constant as it is emitted.
#[cfg(test)]
pub(crate) fn value(graph: &Graph, root: Id) -> f64 {
    let program = passes::Program::of(graph, &[root]);
    program.schedule.values(&program.results, |_| f64::NAN)[0]
}

/// What the accelerations take, before the passes and after each, solved by each form of the equations; `None` where
/// that is left to loops.
#[cfg(test)]
pub(crate) fn solving(graph: &Graph, equations: &Equations) -> Vec<Option<Vec<(&'static str, Count)>>> {
    let counts = |form| Some(accelerations::solve(graph, form, equations)?.counts);
    equations.forms.iter().map(counts).collect()
}

/// Accelerations, multipliers and pivot by each form of the equations.
#[cfg(test)]
pub(crate) fn solutions(
    graph: &Graph,
    equations: &Equations,
    input: impl Fn(crate::symbolic::Symbol) -> f64,
) -> Vec<Option<Vec<f64>>> {
    let values = |form| {
        let program = accelerations::solve(graph, form, equations)?.fused();
        Some(
            body::Body::new(&program, &Default::default())
                .values(program.results.len(), &input, |_, _| f64::NAN),
        )
    };
    equations.forms.iter().map(values).collect()
}
