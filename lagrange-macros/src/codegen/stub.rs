//! What is emitted where the derivation failed: a trait implementation of the right sizes, so that the
//! user reads our errors and none that only follow from a missing one.

use proc_macro2::TokenStream;
use quote::quote;

use super::runtime;
use crate::syntax::{Declaration, TargetIndex};

/// An implementation that is never run, because the errors beside it stop the compilation.
pub(crate) fn stub(declaration: &Declaration) -> TokenStream {
    let runtime = runtime(declaration);
    let ident = &declaration.ident;
    let scalar = scalar(declaration);
    let n: usize = declaration.coordinates.iter().map(|coordinate| coordinate.length.unwrap_or(1)).sum();
    let scalars = declaration.constraints.iter();
    let m =
        scalars.filter(|constraint| !matches!(constraint.target.index, TargetIndex::Family { .. })).count();
    let (_, type_generics, where_clause) = declaration.generics.split_for_impl();
    let Ok(scalar_type) = syn::parse2(scalar.clone()) else { return TokenStream::new() };
    let generics = super::bounded_generics(declaration, &scalar_type);
    let (impl_generics, _, _) = generics.split_for_impl();
    quote! {
        const _: () = {
            use #runtime::nalgebra::{SMatrix, SVector};
            use #runtime::{ConstraintKind, Lagrangian, Solution, State};

            #[automatically_derived]
            #[allow(unused_variables, clippy::all)]
            impl #impl_generics Lagrangian<#n, #m> for #ident #type_generics #where_clause {
                type Scalar = #scalar;
                const NAME: &'static str = "";
                const COORDINATES: [&'static str; #n] = [""; #n];
                const CONSTRAINTS: [&'static str; #m] = [""; #m];
                const CONSTRAINT_KINDS: [ConstraintKind; #m] = [ConstraintKind::Holonomic; #m];
                const OBSERVABLES: &'static [&'static str] = &[];
                fn lagrangian(&self, state: &State<#scalar, #n>) -> #scalar { loop {} }
                fn momentum(&self, state: &State<#scalar, #n>) -> SVector<#scalar, #n> { loop {} }
                fn mass_matrix(&self, state: &State<#scalar, #n>) -> SMatrix<#scalar, #n, #n> { loop {} }
                fn forcing(&self, state: &State<#scalar, #n>) -> SVector<#scalar, #n> { loop {} }
                fn constraint_residual(&self, state: &State<#scalar, #n>) -> SVector<#scalar, #m> { loop {} }
                fn constraint_rate(&self, state: &State<#scalar, #n>) -> SVector<#scalar, #m> { loop {} }
                fn constraint_jacobian(&self, state: &State<#scalar, #n>) -> SMatrix<#scalar, #m, #n> { loop {} }
                fn constraint_bias(&self, state: &State<#scalar, #n>) -> SVector<#scalar, #m> { loop {} }
                fn constraint_force(&self, state: &State<#scalar, #n>, multipliers: &SVector<#scalar, #m>) -> SVector<#scalar, #n> { loop {} }
                fn accelerations(&self, state: &State<#scalar, #n>) -> Solution<#scalar, #n, #m> { loop {} }
                fn observable(&self, index: usize, state: &State<#scalar, #n>, solution: &Solution<#scalar, #n, #m>) -> ::core::option::Option<#scalar> { ::core::option::Option::None }
            }
        };
    }
}

/// The scalar as far as it can be guessed: the one asked for, or a type parameter, or `f64`.
fn scalar(declaration: &Declaration) -> TokenStream {
    if let Some(scalar) = &declaration.options.scalar {
        return quote!(#scalar);
    }
    let used = |name: &syn::Ident| {
        declaration.fields.iter().any(|field| match &field.shape {
            Ok(shape) => shape.scalar.as_ref().is_some_and(|scalar| *name == quote!(#scalar).to_string()),
            Err(_) => false,
        })
    };
    match declaration.generics.type_params().find(|parameter| used(&parameter.ident)) {
        Some(parameter) => {
            let ident = &parameter.ident;
            quote!(#ident)
        }
        None => quote!(f64),
    }
}
