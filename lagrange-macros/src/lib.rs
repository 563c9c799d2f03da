//! The derive macro of `lagrange-core`: use it from there.
//!
//! A pipeline, each stage a folder with one way in:
//!
//! ```text
//! tokens ─syntax→ Declaration ─resolve→ Problem ─mechanics→ Derived ─render→ text, LaTeX, MathML ─codegen→ tokens
//! ```
//!
//! `symbolic` is the ground floor: the expressions of all stages are nodes of one graph, which `resolve` begins,
//! `mechanics` adds to, and the stages after it read. Every stage stops if anything was wrong, with all errors at once.

mod codegen;
mod contract;
mod diagnostics;
mod mechanics;
#[cfg(test)]
mod pipeline_tests;
mod print;
mod render;
mod resolve;
#[cfg(test)]
mod robustness;
#[cfg(test)]
mod rounds;
mod symbolic;
mod syntax;
mod variables;

use diagnostics::{Diagnostics, Place};
use proc_macro2::{Span, TokenStream};
use syntax::Declaration;

/// Derives the equations of motion of a mechanical system from the Lagrangian, the coordinates and the
/// constraints stated in attributes on a struct, whose fields are the parameters.
///
/// The crate `lagrange-core`, which re-exports this macro, documents the language of the attributes.
#[proc_macro_derive(
    Lagrangian,
    attributes(
        coordinates,
        define,
        function,
        frame,
        lagrangian,
        constraint,
        force,
        power,
        dissipation,
        observable,
        conserved,
        parameter,
        lagrange
    )
)]
pub fn derive_lagrangian(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    expand(input.into()).into()
}

/// The whole pipeline. It runs outside of a compiler too.
fn expand(input: TokenStream) -> TokenStream {
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
        None => {
            let mut tokens = diagnostics.into_tokens();
            tokens.extend(stub(&declaration));
            tokens
        }
    }
}

/// What nests too deep cannot even be read without recursion.
fn nests_too_deep(input: TokenStream, span: Span) -> TokenStream {
    let limit = syntax::NESTING_LIMIT;
    let message = format!(
        "parentheses nest more than {limit} deep here: name parts of the expression with `#[define(…)]`"
    );
    let mut tokens = Place::at(span).error(message).to_compile_error();
    if let Ok(rest) = syn::parse2(syntax::shallow(input)) {
        let declaration = syntax::declaration(rest, &mut Diagnostics::default());
        tokens.extend(stub(&declaration));
    }
    tokens
}

/// What stands in for a system with something wrong in it.
fn stub(declaration: &Declaration) -> TokenStream {
    codegen::stub(declaration, &resolve::outline(declaration))
}

fn derive(declaration: &Declaration, diagnostics: &mut Diagnostics) -> Option<TokenStream> {
    diagnostics.is_empty().then_some(())?;
    let (mut graph, problem) = resolve::problem(declaration, diagnostics)?;
    codegen::refuse_hopeless(&graph, &problem, diagnostics)?;
    let derived = mechanics::derive(&mut graph, &problem, diagnostics)?;
    let rendered = render::render(declaration, &graph, &problem, &derived);
    let tokens = codegen::implementation(declaration, &graph, &problem, &derived, &rendered, diagnostics)?;
    print::if_asked(declaration, &tokens);
    Some(tokens)
}
