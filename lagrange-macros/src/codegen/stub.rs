//! What is emitted where the derivation failed: a trait implementation of the right sizes, so that the
//! user reads our errors and none that only follow from a missing one.

use proc_macro2::{Span, TokenStream};
use quote::{ToTokens, quote};
use syn::Ident;

use super::runtime;
use crate::resolve::{RESERVED, is_no_number};
use crate::syntax::{Declaration, Expression, Kind, Named, TargetIndex};

/// An implementation that is never run, because the errors beside it stop the compilation.
pub(crate) fn stub(declaration: &Declaration) -> TokenStream {
    let runtime = runtime(declaration);
    let ident = &declaration.ident;
    let scalar = scalar(declaration);
    let scalars = declaration.constraints.iter();
    let m =
        scalars.filter(|constraint| !matches!(constraint.target.index, TargetIndex::Family { .. })).count();
    let (_, type_generics, where_clause) = declaration.generics.split_for_impl();
    let Ok(scalar_type) = syn::parse2(scalar.clone()) else { return TokenStream::new() };
    let mut generics = super::bounded_generics(declaration, &scalar_type);
    let methods = observables(declaration, &scalar, &generics);
    let pack = super::pack::pack(declaration, &scalar_type);
    let n = coordinates(declaration, &mut generics);
    let linearized = linearized(declaration, &scalar, [&n, &quote!(#m)], &generics);
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
            #methods
            #pack
        };
    }
}

/// The capability of Jacobians, with all numbers in the fields for parameters.
fn linearized(
    declaration: &Declaration,
    scalar: &TokenStream,
    [n, m]: [&TokenStream; 2],
    generics: &syn::Generics,
) -> TokenStream {
    let ident = &declaration.ident;
    let (_, type_generics, where_clause) = declaration.generics.split_for_impl();
    let (impl_generics, _, _) = generics.split_for_impl();
    let shapes = declaration.fields.iter().filter_map(|field| field.shape.as_ref().ok());
    let p: usize = shapes.map(|shape| shape.layout.numbers()).sum();
    quote! {
        #[automatically_derived]
        #[allow(unused_variables, clippy::all)]
        impl #impl_generics __lagrange::Linearized<#n, #m, #p> for #ident #type_generics #where_clause {
            const PARAMETERS: [&'static str; #p] = [""; #p];
            fn parameters(&self) -> __lagrange::nalgebra::SVector<#scalar, #p> { loop {} }
            fn set_parameter(&mut self, index: usize, value: #scalar) -> bool { loop {} }
            fn residual_change(&self, state: &__lagrange::State<#scalar, #n>, solution: &__lagrange::Solution<#scalar, #n, #m>, direction: &__lagrange::Direction<#scalar, #n, #p>) -> __lagrange::ResidualChange<#scalar, #n, #m> { loop {} }
        }
    }
}

/// How many coordinates there are: where the attribute could not be read, as many as the caller thinks.
fn coordinates(declaration: &Declaration, generics: &mut syn::Generics) -> TokenStream {
    if declaration.coordinates.is_empty() {
        let n = Ident::new("N", Span::mixed_site());
        generics.params.push(syn::parse_quote!(const #n: usize));
        return quote!(#n);
    }
    let n: usize = declaration.coordinates.iter().map(|coordinate| coordinate.length.unwrap_or(1)).sum();
    quote!(#n)
}

/// The methods of the observables, of signatures guessed from how they are written.
fn observables(declaration: &Declaration, scalar: &TokenStream, generics: &syn::Generics) -> TokenStream {
    let (ident, visibility) = (&declaration.ident, &declaration.visibility);
    let (impl_generics, _, _) = generics.split_for_impl();
    let (_, type_generics, where_clause) = declaration.generics.split_for_impl();
    let (n, m) = (Ident::new("N", Span::mixed_site()), Ident::new("M", Span::mixed_site()));
    let mut known: Vec<(&str, bool)> = Vec::new();
    let mut methods = TokenStream::new();
    for Named { name, value, .. } in &declaration.observables {
        if RESERVED.contains(&name.text.as_str()) || known.iter().any(|(known, _)| *known == name.text) {
            continue;
        }
        let solved = needs_solution(value, &known);
        known.push((&name.text, solved));
        let method = super::method_name(&name.text, name.place.start());
        let solution = solved.then(|| quote!(, solution: &Solution<#scalar, #n, #m>));
        let m = solved.then(|| quote!(, const #m: usize));
        let returns = match &value.kind {
            Kind::Vector(items) if !items.is_empty() => {
                let length = items.len();
                quote!(SVector<#scalar, #length>)
            }
            _ => scalar.clone(),
        };
        methods.extend(quote! {
            #visibility fn #method<const #n: usize #m>(&self, state: &State<#scalar, #n> #solution) -> #returns { loop {} }
        });
    }
    quote! {
        #[automatically_derived]
        #[allow(unused_variables, dead_code, clippy::all)]
        impl #impl_generics #ident #type_generics #where_clause { #methods }
    }
}

/// Whether accelerations or multipliers seem to occur in an observable.
fn needs_solution(value: &Expression, known: &[(&str, bool)]) -> bool {
    let (mut solved, mut rate, mut velocity) = (false, false, false);
    value.names(&mut |name| {
        let text = name.text.as_str();
        solved |= text == "lambda" || text.ends_with("_ddot") || known.contains(&(text, true));
        rate |= text == "der";
        velocity |= text.ends_with("_dot");
    });
    solved || rate && velocity
}

/// The scalar as far as it can be guessed: the one asked for, or a type parameter, or `f64`.
fn scalar(declaration: &Declaration) -> TokenStream {
    if let Some(scalar) = &declaration.options.scalar
        && !is_no_number(&scalar.to_token_stream().to_string())
    {
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
