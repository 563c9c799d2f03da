//! Emits systems whose numbers of bodies are known at run time: loops over elements.

mod band;
mod checks;
mod constraints;
mod indices;
mod methods;
mod recursion;
mod scatter;
mod stub;
mod values;
mod windows;

use proc_macro2::TokenStream;
use quote::quote;

use super::bounds::bounded_generics;
use super::emitter::{runtime, too_long};
use super::style::FunctionContext;
use crate::diagnostics::Diagnostics;
use crate::mechanics::many::{ManyEquations, Recursion};
use crate::render::Forms;
use crate::resolve::Problem;
use crate::symbolic::Graph;
use crate::syntax::Declaration;
pub(crate) use stub::stub;
pub(super) use windows::Window;

/// System to be emitted.
pub(super) struct ManyEmitter<'a> {
    declaration: &'a Declaration,
    problem: &'a Problem,
    equations: &'a ManyEquations,
    style: FunctionContext<'a>,
    /// Sums that enclosing statements compute.
    known: std::cell::RefCell<Vec<usize>>,
    /// Operation counts of loop bodies that are too long.
    refused: std::cell::RefCell<Vec<String>>,
}

/// Emits the trait implementations and a method for each observable. Reports bodies of loops that are too long and returns
/// `None`.
pub(crate) fn implementation(
    declaration: &Declaration,
    graph: &Graph,
    problem: &Problem,
    equations: &ManyEquations,
    forms: &Forms,
    diagnostics: &mut Diagnostics,
) -> Option<TokenStream> {
    let terms = equations.inertia.iter().flat_map(|block| &block.guarded).flat_map(|guarded| &guarded.values);
    let of_recursion = equations.recursion.iter().map(Recursion::terms);
    let terms = terms.map(|(term, _)| term + 1).chain(of_recursion).max().unwrap_or(0);
    let style = FunctionContext::new(graph, (&declaration.ident, problem), (Some(0), 0), 0, [0, terms]);
    let emitter = ManyEmitter {
        declaration,
        problem,
        equations,
        style,
        known: Default::default(),
        refused: Default::default(),
    };
    let tokens = emitter.implementations(forms);
    let refused = emitter.refused.into_inner();
    if let Some(first) = refused.first() {
        diagnostics
            .error(problem.place, too_long(declaration, &format!("one round of a loop takes {first}")));
        return None;
    }
    Some(tokens)
}

impl ManyEmitter<'_> {
    fn implementations(&self, forms: &Forms) -> TokenStream {
        let (ident, scalar) = (&self.declaration.ident, self.style.types.scalar);
        let generics = bounded_generics(self.declaration, scalar);
        let (impl_generics, type_generics, where_clause) = generics.split_for_impl();
        let runtime = runtime(self.declaration);
        let (system, bodies) = (self.system(), self.many_bodies());
        let inherent = self.inherent();
        let extension = self.extension(
            &quote!(impl #impl_generics __Extended<#scalar> for #ident #type_generics #where_clause),
        );
        let equations = super::lagrangian::equations(&self.declaration.visibility, forms);
        let doc = &forms[0][2];
        let allowed = quote!(#[allow(
            clippy::all, clippy::pedantic, clippy::nursery, unused_parens, unused_variables, dead_code, non_snake_case
        )]);
        let marker = self.equations.forces_are_free_of_velocities.then(|| {
            quote! {
                #[automatically_derived]
                impl #impl_generics __lagrange::structure::VelocityFreeForces for #ident #type_generics #where_clause {}
            }
        });
        quote! {
            const _: () = {
                // Import a single name that users will not choose.
                use #runtime as __lagrange;

                #extension

                #[automatically_derived]
                #allowed
                impl #impl_generics __lagrange::System for #ident #type_generics #where_clause {
                    #system
                }

                #[automatically_derived]
                #allowed
                impl #impl_generics __lagrange::ManyBodies for #ident #type_generics #where_clause {
                    #bodies
                }

                #[doc = #doc]
                #[automatically_derived]
                #allowed
                impl #impl_generics #ident #type_generics #where_clause {
                    #equations
                    #inherent
                }

                #marker
            };
        }
    }
}
