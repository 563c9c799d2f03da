//! Tests of the whole pipeline, outside of a compiler.

mod bodies;
mod completion;
mod consistency;
mod counts;
mod determinism;
mod differential;
mod dissipation;
mod doubling;
mod elimination;
mod emitted;
mod in_turn;
mod integrability;
mod linearization;
mod literals;
mod long;
mod markers;
mod nested;
mod sizes;
mod stages;
mod stub;
mod suggestions;
mod systems;
mod textbook;
mod trees;

use proc_macro2::TokenStream;

use crate::diagnostics::Diagnostics;
use crate::mechanics::{self, Derived, Equations};
use crate::resolve::{self, Problem};
use crate::symbolic::Graph;
use crate::syntax::{self, Declaration};

fn tokens(source: &str) -> TokenStream {
    source.parse().expect("a struct")
}

/// Returns the declaration, with the errors in it.
fn declaration(source: &str) -> (Declaration, Diagnostics) {
    let mut diagnostics = Diagnostics::default();
    let input = syn::parse2(tokens(source)).expect("a struct");
    (syntax::declaration(input, &mut diagnostics), diagnostics)
}

/// Runs the stages up to mechanics on a source without errors.
fn derived(source: &str) -> (Graph, Problem, Derived) {
    let (declaration, mut diagnostics) = declaration(source);
    let found = resolve::problem(&declaration, &mut diagnostics).and_then(|(mut graph, problem)| {
        let derived = mechanics::derive(&mut graph, &problem, &mut diagnostics)?;
        Some((graph, problem, derived))
    });
    found.unwrap_or_else(|| panic!("{source}: {:?}", diagnostics.into_errors()))
}

/// Like [`derived`], but returns only the equations of motion of the derived system.
fn equations(source: &str) -> (Graph, Problem, Equations) {
    let (graph, problem, derived) = derived(source);
    (graph, problem, derived.equations)
}
