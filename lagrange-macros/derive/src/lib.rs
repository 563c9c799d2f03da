//! Derives equations of motion from a struct with its Lagrangian: a text or tokens in, a [`System`] out. The derive
//! macro of `lagrange-core` is a shell around this library, which also works outside of a compiler.
//!
//! ```
//! use lagrange_derive::System;
//!
//! let pendulum = System::parse(
//!     "#[coordinates(theta)]
//!      #[lagrangian(m/2 * l^2 * theta_dot^2 + m*g*l*cos(theta))]
//!      struct Pendulum { m: f64, l: f64, g: f64 }",
//! )?;
//! println!("{pendulum}");
//! assert!(pendulum.equations().text().contains("l θ̈ = −g sin θ"));
//! assert!(pendulum.equations().latex().contains(r"l \ddot\theta &= -g \sin \theta"));
//! println!("{}", pendulum.facts());
//! # Ok::<(), lagrange_derive::Refusal>(())
//! ```
//!
//! It is not published yet: `cargo add --path ../lagrange/lagrange-macros/derive` adds it to a project beside the repository.
//!
//! Nothing is read from or written to files, and nothing depends on the time: the crate also runs in a browser
//! (`wasm32-unknown-unknown`). `lagrange_core::language` documents the language of the attributes. The emitted code needs
//! `lagrange-core`; this crate does not.
//!
//! # Stages
//!
//! A pipeline; each stage is a folder with one entry point:
//!
//! ```text
//! tokens ─syntax→ Declaration ─resolve→ Problem ─mechanics→ Derived ─render→ text, LaTeX, MathML ─codegen→ tokens
//! ```
//!
//! All stages share one expression graph, defined in `lagrange-symbolic`: `resolve` creates it, `mechanics` adds nodes, the
//! later stages read it. A stage with errors reports all of them and ends the pipeline.

mod codegen;
mod contract;
mod diagnostics;
pub mod facts;
mod mechanics;
#[cfg(test)]
mod pipeline_tests;
mod refusal;
mod render;
mod resolve;
#[cfg(test)]
mod robustness;
mod syntax;
mod system;
mod variables;

pub use codegen::{Arguments, Elimination, ParameterField, Tape, Tapes, Unsupported};
use diagnostics::{Diagnostics, Place};
use facts::Facts;
use lagrange_symbolic as symbolic;
use proc_macro2::{Span, TokenStream, TokenTree};
pub use refusal::{Diagnostic, Location, Refusal};
use syntax::Declaration;
use system::Derivation;
pub use system::{Constraint, Equations, System};

/// Returns what the derive macro emits: the [tokens](System::tokens) of the system, or its errors as calls of
/// `compile_error!` with a placeholder implementation, which spares the user follow-up errors.
///
/// ```
/// use quote::quote;
///
/// let emitted = lagrange_derive::expand(quote! {
///     #[coordinates(x)]
///     #[lagrangian(m/2 * x_dot^2 - V)]
///     struct Particle { m: f64 }
/// });
/// assert!(emitted.to_string().contains("compile_error"));
/// ```
pub fn expand(input: TokenStream) -> TokenStream {
    match run(input, false) {
        Ok(system) => system.into_tokens(),
        Err(failure) => failure.into_tokens(),
    }
}

/// Errors of an input, and its declaration if it could be read.
struct Failure {
    declaration: Option<Box<Declaration>>,
    errors: Vec<syn::Error>,
}

/// Runs the whole pipeline. Outside of a compiler it is alone, and refuses attributes that nobody knows.
fn run(input: TokenStream, is_alone: bool) -> Result<System, Failure> {
    if let Some(span) = syntax::too_deep(input.clone()) {
        return Err(nests_too_deep(input, span));
    }
    let fail = |error| Failure { declaration: None, errors: vec![error] };
    no_struct(&input).map_or(Ok(()), Err).map_err(fail)?;
    let input = syn::parse2(input).map_err(fail)?;
    let mut diagnostics = Diagnostics::default();
    if is_alone {
        syntax::refuse_unknown(&input, &mut diagnostics);
    }
    let declaration = syntax::declaration(input, &mut diagnostics);
    derive(&declaration, &mut diagnostics)
        .ok_or_else(|| Failure { declaration: Some(declaration.into()), errors: diagnostics.into_errors() })
}

/// Returns an error at the last token if none begins a struct, or what is told to be none.
fn no_struct(input: &TokenStream) -> Option<syn::Error> {
    let begins =
        |token: &TokenTree| ["struct", "enum", "union"].iter().any(|word| token.to_string() == *word);
    let mut last = Span::call_site();
    for token in input.clone() {
        if begins(&token) {
            return None;
        }
        last = token.span();
    }
    let message = "a system is a struct, after its attributes: `#[coordinates(x)] #[lagrangian(m/2 * x_dot^2)] struct Particle { m: f64 }`";
    Some(syn::Error::new(last, message))
}

/// Returns an error at `span`. Input nested this deep would overflow the stack of a recursive parser.
fn nests_too_deep(input: TokenStream, span: Span) -> Failure {
    let limit = syntax::NESTING_LIMIT;
    let message = format!(
        "parentheses nest more than {limit} deep here: name parts of the expression with `#[define(…)]`"
    );
    let rest = syn::parse2(syntax::shallow(input)).ok();
    Failure {
        declaration: rest.map(|rest| syntax::declaration(rest, &mut Diagnostics::default()).into()),
        errors: vec![Place::at(span).error(message)],
    }
}

impl Failure {
    fn into_tokens(self) -> TokenStream {
        match self.declaration {
            Some(declaration) => stub(&declaration, self.errors),
            None => self.errors.into_iter().map(syn::Error::into_compile_error).collect(),
        }
    }
}

/// Returns the errors of a system, and a placeholder implementation.
fn stub(declaration: &Declaration, errors: Vec<syn::Error>) -> TokenStream {
    let outline = resolve::outline(declaration);
    let mut calls = errors.into_iter().flatten().map(syn::Error::into_compile_error);
    let unknown = if outline.coordinates.is_none() { calls.next() } else { None };
    let stub = match declaration.has_open_lengths() {
        true => codegen::many::stub(declaration, &outline),
        false => codegen::stub(declaration, &outline, unknown),
    };
    calls.chain([stub]).collect()
}

fn derive(declaration: &Declaration, diagnostics: &mut Diagnostics) -> Option<System> {
    diagnostics.is_empty().then_some(())?;
    let (mut graph, mut problem) = resolve::problem(declaration, diagnostics)?;
    if problem.many.is_open() {
        let equations = mechanics::many::derive(&mut graph, &mut problem, diagnostics)?;
        let forms = render::render_many(declaration, &graph, &problem, &equations);
        let facts = Facts::of_many(&equations);
        let tokens =
            codegen::many::implementation(declaration, &graph, &problem, &equations, &forms, diagnostics)?;
        let derivation = Derivation { graph, problem, derived: None };
        return Some(System::new(declaration, derivation, facts, forms, tokens));
    }
    codegen::refuse_hopeless(declaration, &graph, &problem, diagnostics)?;
    let derived = mechanics::derive(&mut graph, &problem, diagnostics)?;
    let rendered = render::render(declaration, &graph, &problem, &derived);
    let facts = Facts::new(&problem, &derived, &rendered);
    let tokens =
        codegen::implementation(declaration, &graph, &problem, &derived, &rendered, &facts, diagnostics)?;
    let derivation = Derivation { graph, problem, derived: Some(derived) };
    Some(System::new(declaration, derivation, facts, rendered.forms, tokens))
}
