//! Derives equations of motion from a struct with its Lagrangian. The derive macro of `lagrange-core` is a shell
//! around this library, which also works outside of a compiler.
//!
//! A pipeline; each stage is a folder with one entry point:
//!
//! ```text
//! tokens ─syntax→ Declaration ─resolve→ Problem ─mechanics→ Derived ─render→ text, LaTeX, MathML ─codegen→ tokens
//! ```
//!
//! All stages share one expression graph, defined in `symbolic`: `resolve` creates it, `mechanics` adds nodes, the
//! later stages read it. A stage with errors reports all of them and ends the pipeline.

mod codegen;
mod contract;
mod diagnostics;
mod mechanics;
#[cfg(test)]
mod pipeline_tests;
mod render;
mod resolve;
#[cfg(test)]
mod robustness;
mod symbolic;
mod syntax;
mod variables;

use diagnostics::{Diagnostics, Place};
use proc_macro2::{Span, TokenStream};
use syntax::Declaration;

/// Runs the whole pipeline.
pub fn expand(input: TokenStream) -> TokenStream {
    let mut diagnostics = Diagnostics::default();
    if let Some(span) = syntax::too_deep(input.clone()) {
        return nests_too_deep(input, span);
    }
    let input = match syn::parse2(input) {
        Ok(input) => input,
        Err(error) => return error.to_compile_error(),
    };
    let declaration = syntax::declaration(input, &mut diagnostics);
    match derive(&declaration, &mut diagnostics) {
        Some(tokens) => tokens,
        None => stub(&declaration, diagnostics.into_errors()),
    }
}

/// Returns an error at `span` and a stub. Input nested this deep would overflow the stack of a recursive parser.
fn nests_too_deep(input: TokenStream, span: Span) -> TokenStream {
    let limit = syntax::NESTING_LIMIT;
    let message = format!(
        "parentheses nest more than {limit} deep here: name parts of the expression with `#[define(…)]`"
    );
    let error = Place::at(span).error(message);
    match syn::parse2(syntax::shallow(input)) {
        Ok(rest) => stub(&syntax::declaration(rest, &mut Diagnostics::default()), vec![error]),
        Err(_) => error.to_compile_error(),
    }
}

/// Returns the errors of a system, and a placeholder implementation.
fn stub(declaration: &Declaration, errors: Vec<syn::Error>) -> TokenStream {
    let outline = resolve::outline(declaration);
    let mut calls = errors.into_iter().flatten().map(syn::Error::into_compile_error);
    let unknown = if outline.coordinates.is_none() { calls.next() } else { None };
    let stub = codegen::stub(declaration, &outline, unknown);
    calls.chain([stub]).collect()
}

fn derive(declaration: &Declaration, diagnostics: &mut Diagnostics) -> Option<TokenStream> {
    diagnostics.is_empty().then_some(())?;
    let (mut graph, problem) = resolve::problem(declaration, diagnostics)?;
    codegen::refuse_hopeless(&graph, &problem, diagnostics)?;
    let derived = mechanics::derive(&mut graph, &problem, diagnostics)?;
    let rendered = render::render(declaration, &graph, &problem, &derived);
    codegen::implementation(declaration, &graph, &problem, &derived, &rendered, diagnostics)
}
