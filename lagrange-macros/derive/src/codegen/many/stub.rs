//! Stubs of systems of any number of bodies, emitted if the derivation failed.

use proc_macro2::TokenStream;
use quote::quote;

use crate::codegen::bounds::bounded_generics;
use crate::codegen::emitter::runtime;
use crate::codegen::observables::method_name;
use crate::resolve::{Observable, Outline};
use crate::syntax::Declaration;

/// Emits implementations that never run, because the errors beside them stop the compilation.
pub(crate) fn stub(declaration: &Declaration, outline: &Outline) -> TokenStream {
    let Outline { scalar, observables, .. } = outline;
    let (runtime, ident) = (runtime(declaration), &declaration.ident);
    let (_, type_generics, where_clause) = declaration.generics.split_for_impl();
    let generics = bounded_generics(declaration, scalar);
    let (impl_generics, _, _) = generics.split_for_impl();
    let state = quote!(&__lagrange::generic::State<#scalar, __lagrange::nalgebra::Dyn>);
    let visibility = &declaration.visibility;
    let observables = observables.iter().map(|Observable { name, lengths, .. }| {
        let method = method_name(&name.text, name.place.start());
        let returns = match lengths[..] {
            [] => quote!(#scalar),
            [rows] => quote!(__lagrange::nalgebra::SVector<#scalar, #rows>),
            [rows, columns, ..] => quote!(__lagrange::nalgebra::SMatrix<#scalar, #rows, #columns>),
        };
        quote! { #visibility fn #method(&self, state: #state) -> #returns { loop {} } }
    });
    let allowed = quote! {
        #[automatically_derived]
        #[allow(unused_variables, dead_code, non_snake_case, clippy::all)]
    };
    quote! {
        const _: () = {
            use #runtime as __lagrange;

            #allowed
            impl #impl_generics __lagrange::System for #ident #type_generics #where_clause {
                type Scalar = #scalar;
                type Length = __lagrange::nalgebra::Dyn;
                type M = __lagrange::nalgebra::Const<0>;
                type Field = __lagrange::motion::ManyBodyField;
                fn length(&self) -> __lagrange::nalgebra::Dyn { loop {} }
                fn accelerations(&self, t: #scalar, q: &[#scalar], v: &[#scalar], a: &mut [#scalar]) { loop {} }
            }

            #allowed
            impl #impl_generics __lagrange::ManyBodies for #ident #type_generics #where_clause {
                const ENERGY_IS_CONSERVED: bool = false;
                const DIGEST: u32 = 0;
                fn write_name(&self, coordinate: usize, to: &mut dyn ::core::fmt::Write) -> ::core::fmt::Result { loop {} }
                fn check(&self) -> ::core::result::Result<(), __lagrange::Error> { loop {} }
                fn visit_numbers(&self, visit: &mut dyn ::core::ops::FnMut(#scalar)) { loop {} }
                fn lagrangian(&self, state: #state) -> #scalar { loop {} }
                fn energy(&self, state: #state) -> #scalar { loop {} }
                fn momenta(&self, state: #state) -> __lagrange::nalgebra::DVector<#scalar> { loop {} }
            }

            #allowed
            impl #impl_generics #ident #type_generics #where_clause {
                #visibility const fn equations() -> __lagrange::facts::Equations {
                    __lagrange::generated::equations([[""; 3]; 3])
                }
                #(#observables)*
            }

            #[automatically_derived]
            impl #impl_generics __lagrange::structure::VelocityFreeForces for #ident #type_generics #where_clause {}
        };
    }
}
