//! Stubs, emitted if the derivation failed: implementations with the right dimensions. They prevent follow-up errors
//! about missing implementations.

use proc_macro2::TokenStream;
use quote::quote;

use super::bounds::bounded_generics;
use super::emitter::runtime;
use super::markers::markers;
use super::moving::moving;
use super::observables::method_name;
use super::pack::pack;
use super::signature::{Types, wide};
use crate::contract::{
    Argument, Dimension, FRICTION_LIMIT, LAGRANGIAN, LINEARIZED, Method, RESTITUTION, SLIDING_FRICTION,
    STATE_DERIVATIVES, TAYLOR_SERIES,
};
use crate::mechanics::Marker;
use crate::resolve::{Observable, Outline};
use crate::syntax::{Declaration, Law};

/// Emits implementations that never run, because the errors beside them stop the compilation.
///
/// If the number of coordinates is unknown, the call of `compile_error!` in `unknown` stands for it: rustc reports the
/// error there, and accepts any number in its place.
pub(crate) fn stub(
    declaration: &Declaration,
    outline: &Outline,
    unknown: Option<TokenStream>,
) -> TokenStream {
    let &Outline { ref scalar, coordinates, constraints, parameters, ref observables } = outline;
    let types = Types { scalar, coordinates, constraints, parameters };
    let (runtime, ident) = (runtime(declaration), &declaration.ident);
    let n = coordinates.map_or(quote!({ #unknown }), |n| quote!(#n));
    let (_, type_generics, where_clause) = declaration.generics.split_for_impl();
    let generics = bounded_generics(declaration, scalar);
    let (impl_generics, _, _) = generics.split_for_impl();
    let never = |method: &Method| {
        let signature = types.signature(method);
        quote! { #signature { loop {} } }
    };
    let (of_lagrangian, of_linearized) = (LAGRANGIAN.iter().map(never), LINEARIZED.iter().map(never));
    let of_state_derivatives = STATE_DERIVATIVES.iter().map(never);
    let of_taylor_series = TAYLOR_SERIES.iter().map(never);
    let has_contacts =
        declaration.constraints.iter().any(|constraint| !matches!(constraint.law, Law::Equation));
    let contacts = has_contacts.then(|| {
        let laws = [RESTITUTION, FRICTION_LIMIT, SLIDING_FRICTION];
        let laws = laws.iter().map(never);
        let wide = wide();
        let over_wide = Types { scalar: &wide, constraints: 0, ..types };
        let (state, over) = (types.argument(Argument::State), types.over());
        let [vector, forcing] = [types.vector(Dimension::Coordinates), over_wide.argument(Argument::Forcing)];
        let solution = over_wide.solution();
        let [direction, change] = [over_wide.argument(Argument::Direction), over_wide.vector(Dimension::Coordinates)];
        quote! {
            #[automatically_derived]
            #[allow(unused_variables, clippy::all)]
            impl #impl_generics __lagrange::generated::Switched for #ident #type_generics #where_clause {
                type Inertia = ();
                type Numbers = __lagrange::nalgebra::Const<0>;
                type Held = __lagrange::nalgebra::Const<0>;
                type Masses = __lagrange::nalgebra::Const<0>;
                const GROUPS: &'static [&'static [__lagrange::generated::ConstraintRow]] = &[];
                const MASSES: &'static [[usize; 2]] = &[];
                fn may_hold(&self, group: usize) -> bool { loop {} }
                fn rows(&self, group: usize, #state, numbers: &mut __lagrange::generated::Array<#scalar, Self::Numbers>) { loop {} }
                fn masses(&self, #state) -> __lagrange::generated::Array<#scalar, Self::Masses> { loop {} }
                fn inertia(&self, #state) -> (Self::Inertia, #vector) { loop {} }
                fn solve_inertia #over(&self, inertia: &Self::Inertia, #forcing) -> #solution { loop {} }
            }

            #[automatically_derived]
            #[allow(unused_variables, clippy::all)]
            impl #impl_generics __lagrange::contact::ForceDerivatives for #ident #type_generics #where_clause {
                type ForceSlopes = ();
                const FORCE_ARGUMENTS: &'static [usize] = &[];
                fn force_slopes(&self, #state) -> Self::ForceSlopes { loop {} }
                fn force_change_with #over(&self, slopes: &Self::ForceSlopes, #direction) -> #change { loop {} }
            }

            #[automatically_derived]
            #[allow(unused_variables, clippy::all)]
            impl #impl_generics __lagrange::contact::Contacts for #ident #type_generics #where_clause {
                const CONTACTS: &'static [usize] = &[];
                const IMPACT_LAWS: &'static [__lagrange::contact::ImpactLaw] = &[];
                fn contact(&self, index: usize) -> ::core::option::Option<__lagrange::contact::Contact> { loop {} }
                fn set_contact(&mut self, index: usize, state: __lagrange::contact::Contact) -> bool { loop {} }
                const FRICTIONS: &'static [__lagrange::contact::FrictionRows] = &[];
                fn friction(&self, index: usize) -> ::core::option::Option<__lagrange::contact::Friction> { loop {} }
                fn set_friction(&mut self, index: usize, state: __lagrange::contact::Friction) -> bool { loop {} }
                #(#laws)*
            }
        }
    });
    let visibility = &declaration.visibility;
    let observables = observables.iter().map(|Observable { name, lengths, needs_solution }| {
        let method = method_name(&name.text, name.place.start());
        let signature = types.of_observable(&method, lengths, *needs_solution);
        quote! { #visibility #signature { loop {} } }
    });
    let (markers, pack) = (markers(declaration, &generics, &Marker::ALL), pack(declaration, scalar));
    let moving = moving(scalar, constraints);
    quote! {
        const _: () = {
            use #runtime as __lagrange;

            #[automatically_derived]
            #[allow(clippy::all)]
            impl #impl_generics __lagrange::System for #ident #type_generics #where_clause {
                #moving
            }

            #[automatically_derived]
            #[allow(unused_variables, clippy::all)]
            impl #impl_generics __lagrange::Lagrangian for #ident #type_generics #where_clause {
                type Factor = ();
                type N = __lagrange::nalgebra::Const<#n>;
                const NAME: &'static str = "";
                const COORDINATES: &'static [&'static str] = &[];
                const CONSTRAINTS: &'static [&'static str] = &[];
                const CONSTRAINT_KINDS: &'static [__lagrange::ConstraintKind] = &[];
                const OBSERVABLES: &'static [&'static str] = &[];
                const FACTS: __lagrange::facts::Facts = __lagrange::facts::Facts::NONE;
                #(#of_lagrangian)*
            }

            #[automatically_derived]
            #[allow(unused_variables, clippy::all)]
            impl #impl_generics __lagrange::StateDerivatives for #ident #type_generics #where_clause {
                type Slopes = ();
                #(#of_state_derivatives)*
            }

            #[automatically_derived]
            #[allow(unused_variables, clippy::all)]
            impl #impl_generics __lagrange::Linearized for #ident #type_generics #where_clause {
                type P = __lagrange::nalgebra::Const<#parameters>;
                type ParameterSlopes = ();
                const PARAMETERS: &'static [&'static str] = &[];
                #(#of_linearized)*
            }

            #[automatically_derived]
            #[allow(unused_variables, clippy::all)]
            impl #impl_generics __lagrange::TaylorSeries for #ident #type_generics #where_clause {
                type SeriesSlopes = [#scalar; 0];
                type Sums = [#scalar; 0];
                type SeriesTerms = [#scalar; 0];
                #(#of_taylor_series)*
            }

            #[automatically_derived]
            #[allow(unused_variables, dead_code, non_snake_case, clippy::all)]
            impl #impl_generics #ident #type_generics #where_clause {
                #visibility const fn equations() -> __lagrange::facts::Equations {
                    __lagrange::generated::equations([[""; 3]; 3])
                }
                #(#observables)*
            }

            #contacts
            #markers
            #pack
        };
    }
}
