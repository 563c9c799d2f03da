//! The pipeline as a whole, outside of a compiler.

mod counts;
mod determinism;
mod elimination;
mod emitted;
mod integrability;
mod linearization;
mod long;
mod stub;
mod systems;

use proc_macro2::TokenStream;

use crate::diagnostics::Diagnostics;
use crate::mechanics::{self, Equations};
use crate::resolve::{self, Problem};
use crate::symbolic::Graph;
use crate::syntax::{self, Declaration};

fn tokens(source: &str) -> TokenStream {
    source.parse().expect("a struct")
}

/// The declaration and what was wrong with it.
fn declaration(source: &str) -> (Declaration, Diagnostics) {
    let mut diagnostics = Diagnostics::default();
    let input = syn::parse2(tokens(source)).expect("a struct");
    (syntax::declaration(input, &mut diagnostics), diagnostics)
}

/// The stages up to the equations, for a source without errors.
fn equations(source: &str) -> (Graph, Problem, Equations) {
    let (declaration, mut diagnostics) = declaration(source);
    let (mut graph, problem) = resolve::problem(&declaration, &mut diagnostics).expect("no errors");
    let equations = mechanics::derive(&mut graph, &problem, &mut diagnostics).expect("no errors");
    (graph, problem, equations)
}
