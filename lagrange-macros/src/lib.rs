//! The derive macro.
use proc_macro::TokenStream;

/// Derives the equations of motion.
#[proc_macro_derive(Lagrangian, attributes(coordinates, define, lagrangian, constraint, force, dissipation, observable, parameter, lagrange))]
pub fn derive_lagrangian(_input: TokenStream) -> TokenStream {
    TokenStream::new()
}
