//! What is known of the system, as constants, and the values of what is conserved.

use proc_macro2::TokenStream;
use quote::quote;

use super::kernel::Kernel;
use super::shape::Shape;
use super::{Emitter, method_name};
use crate::mechanics::{Evidence, LinearPart, Quantity};

impl Emitter<'_> {
    pub(super) fn facts(&self) -> TokenStream {
        let facts = self.facts;
        let cyclic = facts.cyclic.iter().map(|&a| &self.problem.coordinates[a].text);
        let conserved = facts.conserved.iter().map(|conserved| {
            let (name, evidence) = (&conserved.name, evidence(conserved.evidence));
            quote!(__lagrange::Conserved { name: #name, evidence: #evidence })
        });
        let energy = facts.conserved.iter().find(|conserved| conserved.quantity == Quantity::Energy);
        let energy_is_conserved = optional(energy.map(|energy| energy.evidence));
        let energy_is_t_plus_u = optional(facts.energy_is_t_plus_u);
        let totals =
            self.rendered.total_derivatives.iter().zip(&facts.total_derivatives).map(|(terms, total)| {
                let evidence = evidence(total.evidence);
                quote!(__lagrange::TotalDerivative { terms: #terms, evidence: #evidence })
            });
        let linear_part = match facts.linear_part {
            LinearPart::Absent => quote!(Absent),
            LinearPart::Closed(found) => {
                let evidence = evidence(found);
                quote!(Closed(#evidence))
            }
            LinearPart::Open => quote!(Open),
        };
        quote! {
            const FACTS: __lagrange::Facts = __lagrange::Facts {
                cyclic: &[#(#cyclic),*],
                conserved: &[#(#conserved),*],
                energy_is_conserved: #energy_is_conserved,
                energy_is_t_plus_u: #energy_is_t_plus_u,
                total_derivatives: &[#(#totals),*],
                linear_part: __lagrange::LinearPart::#linear_part,
            };
        }
    }

    /// The conserved quantity of an index.
    pub(super) fn conserved_by_index(&self) -> TokenStream {
        let (n, scalar) = (self.problem.coordinates.len(), self.style.scalar);
        let arms = self.facts.conserved.iter().enumerate().map(|(index, conserved)| {
            let value = self.conserved_value(conserved.quantity);
            quote!(#index => ::core::option::Option::Some(#value),)
        });
        quote! {
            #[allow(unused_variables)]
            fn conserved(&self, index: usize, state: &__lagrange::State<#scalar, #n>) -> ::core::option::Option<#scalar> {
                match index {
                    #(#arms)*
                    _ => ::core::option::Option::None,
                }
            }
        }
    }

    fn conserved_value(&self, quantity: Quantity) -> TokenStream {
        match quantity {
            Quantity::Energy => quote!(__lagrange::Lagrangian::energy(self, state)),
            Quantity::Momentum(a) => {
                let momentum = [self.equations.momentum[a]];
                let Kernel { statements, results, .. } =
                    self.style.kernel(&format!("momentum_{a}"), &momentum, &[Shape::Number]);
                quote!({ #statements #(#results)* })
            }
            Quantity::Observable(observable, entry) => {
                let (label, values) = &self.problem.observables[observable];
                let method = method_name(&label.text, label.place.start());
                let entry = (values.len() > 1).then(|| quote!(.data.0[0][#entry]));
                quote!(self.#method(state) #entry)
            }
        }
    }
}

fn evidence(evidence: Evidence) -> TokenStream {
    match evidence {
        Evidence::Proved => quote!(__lagrange::Evidence::Proved),
        Evidence::Held(states) => quote!(__lagrange::Evidence::Held(#states)),
    }
}

fn optional(found: Option<Evidence>) -> TokenStream {
    match found {
        Some(found) => {
            let evidence = evidence(found);
            quote!(::core::option::Option::Some(#evidence))
        }
        None => quote!(::core::option::Option::None),
    }
}
