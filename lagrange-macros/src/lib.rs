//! Derive macro of `lagrange-core`. Use it through that crate, which re-exports it. The crate `lagrange-derive` does
//! the work; a compiler can load only what stands here.

mod print;

use proc_macro::TokenStream;

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
        contact,
        friction,
        force,
        power,
        dissipation,
        observable,
        conserved,
        parameter,
        lagrange
    )
)]
pub fn derive_lagrangian(input: TokenStream) -> TokenStream {
    let input = input.into();
    let name = print::name(&input);
    let tokens = lagrange_derive::expand(input);
    print::if_asked(&name, &tokens);
    tokens.into()
}
