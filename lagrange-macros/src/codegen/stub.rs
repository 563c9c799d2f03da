//! What is emitted where the derivation failed: implementations of the right sizes, so that the user reads our errors and
//! none that only follow from missing ones.

use proc_macro2::TokenStream;
use quote::quote;

use super::runtime;
use crate::resolve::{Observable, Outline};
use crate::syntax::Declaration;

/// An implementation that is never run, because the errors beside it stop the compilation.
pub(crate) fn stub(declaration: &Declaration, outline: &Outline) -> TokenStream {
    let runtime = runtime(declaration);
    let ident = &declaration.ident;
    let (scalar, m) = (&outline.scalar, outline.constraints);
    let (_, type_generics, where_clause) = declaration.generics.split_for_impl();
    let mut generics = super::bounded_generics(declaration, scalar);
    let inherent = inherent(declaration, outline, &generics);
    let pack = super::pack::pack(declaration, scalar);
    let n = coordinates(outline);
    if outline.coordinates.is_none() {
        generics.params.push(syn::parse_quote!(const #n: usize));
    }
    let linearized = linearized(declaration, outline, &generics);
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
                const FACTS: __lagrange::Facts = __lagrange::Facts::NONE;
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
                fn conserved(&self, index: usize, state: &__lagrange::State<#scalar, #n>) -> ::core::option::Option<#scalar> { ::core::option::Option::None }
            }

            #linearized
            #inherent
            #pack
        };
    }
}

/// The capability of Jacobians.
fn linearized(declaration: &Declaration, outline: &Outline, generics: &syn::Generics) -> TokenStream {
    let ident = &declaration.ident;
    let (_, type_generics, where_clause) = declaration.generics.split_for_impl();
    let (impl_generics, _, _) = generics.split_for_impl();
    let (n, &Outline { ref scalar, constraints: m, parameters: p, .. }) = (coordinates(outline), outline);
    quote! {
        #[automatically_derived]
        #[allow(unused_variables, clippy::all)]
        impl #impl_generics __lagrange::Linearized<#n, #m, #p> for #ident #type_generics #where_clause {
            const PARAMETERS: [&'static str; #p] = [""; #p];
            fn parameters(&self) -> __lagrange::nalgebra::SVector<#scalar, #p> { loop {} }
            fn set_parameter(&mut self, index: usize, value: #scalar) -> bool { loop {} }
            fn residual_change(&self, state: &__lagrange::State<#scalar, #n>, solution: &__lagrange::Solution<#scalar, #n, #m>, direction: &__lagrange::Direction<#scalar, #n, #p>,) -> __lagrange::ResidualChange<#scalar, #n, #m> { loop {} }
        }
    }
}

/// How many coordinates there are: where not all could be read, as many as the caller thinks.
fn coordinates(outline: &Outline) -> TokenStream {
    match outline.coordinates {
        Some(n) => quote!(#n),
        None => quote!(__N),
    }
}

/// The methods that no trait has: those of the observables, and the equations to read.
fn inherent(declaration: &Declaration, outline: &Outline, generics: &syn::Generics) -> TokenStream {
    let (ident, visibility) = (&declaration.ident, &declaration.visibility);
    let (impl_generics, _, _) = generics.split_for_impl();
    let (_, type_generics, where_clause) = declaration.generics.split_for_impl();
    let observables =
        outline.observables.iter().map(|observable| observable_method(declaration, outline, observable));
    quote! {
        #[automatically_derived]
        #[allow(unused_variables, dead_code, clippy::all)]
        impl #impl_generics #ident #type_generics #where_clause {
            #visibility const fn equations() -> __lagrange::Equations {
                __lagrange::generated::equations("", "")
            }
            #(#observables)*
        }
    }
}

fn observable_method(declaration: &Declaration, outline: &Outline, observable: &Observable) -> TokenStream {
    let (n, &Outline { ref scalar, constraints: m, .. }) = (coordinates(outline), outline);
    let &Observable { ref name, length, needs_solution } = observable;
    let (visibility, method) = (&declaration.visibility, super::method_name(&name.text, name.place.start()));
    let generic = outline.coordinates.is_none().then(|| quote!(<const #n: usize>));
    let solution = needs_solution.then(|| quote!(, solution: &__lagrange::Solution<#scalar, #n, #m>));
    let returns =
        if length == 1 { quote!(#scalar) } else { quote!(__lagrange::nalgebra::SVector<#scalar, #length>) };
    quote! {
        #visibility fn #method #generic(&self, state: &__lagrange::State<#scalar, #n> #solution) -> #returns { loop {} }
    }
}
