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
            use #runtime as __lagrange;

            #[automatically_derived]
            #[allow(unused_variables, clippy::all)]
            impl #impl_generics __lagrange::Lagrangian<#n, #m> for #ident #type_generics #where_clause {
                type Scalar = #scalar;
                const NAME: &'static str = "";
                const COORDINATES: [&'static str; #n] = [""; #n];
                const CONSTRAINTS: [&'static str; #m] = [""; #m];
                const CONSTRAINT_KINDS: [__lagrange::ConstraintKind; #m] = [__lagrange::ConstraintKind::Holonomic; #m];
                const OBSERVABLES: &'static [&'static str] = &[];
                fn lagrangian(&self, state: &__lagrange::State<#scalar, #n>) -> #scalar { loop {} }
                fn energy(&self, state: &__lagrange::State<#scalar, #n>) -> #scalar { loop {} }
                fn momentum_rate(&self, state: &__lagrange::State<#scalar, #n>) -> __lagrange::nalgebra::SVector<#scalar, #n> { loop {} }
                fn momentum(&self, state: &__lagrange::State<#scalar, #n>) -> __lagrange::nalgebra::SVector<#scalar, #n> { loop {} }
                fn mass_matrix(&self, state: &__lagrange::State<#scalar, #n>) -> __lagrange::nalgebra::SMatrix<#scalar, #n, #n> { loop {} }
                fn forcing(&self, state: &__lagrange::State<#scalar, #n>) -> __lagrange::nalgebra::SVector<#scalar, #n> { loop {} }
                fn constraint_residual(&self, state: &__lagrange::State<#scalar, #n>) -> __lagrange::nalgebra::SVector<#scalar, #m> { loop {} }
                fn constraint_rate(&self, state: &__lagrange::State<#scalar, #n>) -> __lagrange::nalgebra::SVector<#scalar, #m> { loop {} }
                fn constraint_jacobian(&self, state: &__lagrange::State<#scalar, #n>) -> __lagrange::nalgebra::SMatrix<#scalar, #m, #n> { loop {} }
                fn constraint_bias(&self, state: &__lagrange::State<#scalar, #n>) -> __lagrange::nalgebra::SVector<#scalar, #m> { loop {} }
                fn constraint_force(&self, state: &__lagrange::State<#scalar, #n>, multipliers: &__lagrange::nalgebra::SVector<#scalar, #m>) -> __lagrange::nalgebra::SVector<#scalar, #n> { loop {} }
                fn accelerations(&self, state: &__lagrange::State<#scalar, #n>) -> __lagrange::Solution<#scalar, #n, #m> { loop {} }
                fn observable(&self, index: usize, state: &__lagrange::State<#scalar, #n>, solution: &__lagrange::Solution<#scalar, #n, #m>) -> ::core::option::Option<#scalar> { ::core::option::Option::None }
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
