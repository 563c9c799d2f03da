//! Emits the implementations of marker traits.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use crate::mechanics::Marker;
use crate::syntax::Declaration;

/// Emits an empty implementation of each marker trait, with the generics of the implementation of `Lagrangian`.
pub(super) fn markers(
    declaration: &Declaration,
    generics: &syn::Generics,
    markers: &[Marker],
) -> TokenStream {
    let (impl_generics, _, where_clause) = generics.split_for_impl();
    let (_, type_generics, _) = declaration.generics.split_for_impl();
    let ident = &declaration.ident;
    let names = markers.iter().map(|marker| format_ident!("{marker:?}"));
    quote! {
        #(
            #[automatically_derived]
            impl #impl_generics __lagrange::structure::#names for #ident #type_generics #where_clause {}
        )*
    }
}
