//! Emits the facts known about a system as constants, and a method that evaluates its conserved quantities.

use proc_macro2::TokenStream;
use quote::quote;

use super::emitter::{Emitter, Written};
use super::observables::{entry_of, method_name};
use super::shape::ResultShape;
use crate::contract::Method;
use crate::facts::{Conserved, EnergyForm, Evidence, Facts, LinearPart, TotalDerivative};
use crate::mechanics::ConservedKind;
use crate::resolve::Observed;
use crate::symbolic::Id;

impl Emitter<'_> {
    pub(super) fn facts(&self) -> TokenStream {
        let Facts { cyclic, energy_is_conserved, energy_form, linear_part, .. } = self.facts;
        let conserved = self.facts.conserved.iter().map(|Conserved { name, evidence }| {
            let evidence = self::evidence(*evidence);
            quote!(__lagrange::facts::Conserved { name: #name, evidence: #evidence })
        });
        let energy_is_conserved = optional(*energy_is_conserved);
        let energy_form = self::energy_form(*energy_form);
        let totals = self.facts.total_derivatives.iter().map(|TotalDerivative { terms, evidence }| {
            let evidence = self::evidence(*evidence);
            quote!(__lagrange::facts::TotalDerivative { terms: #terms, evidence: #evidence })
        });
        let linear_part = match *linear_part {
            LinearPart::Absent => quote!(Absent),
            LinearPart::Closed(found) => {
                let evidence = evidence(found);
                quote!(Closed(#evidence))
            }
            LinearPart::Open => quote!(Open),
        };
        quote! {
            const FACTS: __lagrange::facts::Facts = __lagrange::facts::Facts {
                cyclic: &[#(#cyclic),*],
                conserved: &[#(#conserved),*],
                energy_is_conserved: #energy_is_conserved,
                energy_form: #energy_form,
                total_derivatives: &[#(#totals),*],
                linear_part: __lagrange::facts::LinearPart::#linear_part,
            };
        }
    }

    /// Emits the method that returns a conserved quantity by its index.
    pub(super) fn conserved_by_index(&self, method: &Method) -> Written {
        let conserved = self.derived.facts.conserved.iter().enumerate();
        let arms = conserved.map(|(index, conserved)| {
            let Written { tokens: value, kernels } = self.conserved_value(index, conserved.quantity);
            let tokens = quote!(#index => ::core::option::Option::Some(#value),);
            Written { tokens, kernels }
        });
        self.by_index(method, arms.collect())
    }

    fn conserved_value(&self, index: usize, quantity: ConservedKind) -> Written {
        let tokens = match quantity {
            ConservedKind::Energy => quote!(__lagrange::Lagrangian::energy(self, state)),
            ConservedKind::Momentum(a) => {
                return self.sum_of_momenta(index, self.derived.equations.momentum[a]);
            }
            ConservedKind::Total(.., [value, _]) => return self.sum_of_momenta(index, value),
            ConservedKind::Observable(observable, entry) => {
                let Observed { label, lengths, .. } = &self.problem.observables[observable];
                let (method, entry) =
                    (method_name(&label.text, label.place.start()), entry_of(lengths, entry));
                quote!(self.#method(state) #entry)
            }
        };
        Written { tokens, kernels: Vec::new() }
    }

    fn sum_of_momenta(&self, index: usize, value: Id) -> Written {
        let kernel = self.style.kernel(&format!("conserved_{index}"), &[value], &[ResultShape::Number]);
        let (statements, results) = (&kernel.statements, &kernel.results);
        let tokens = quote!({ #statements #(#results)* });
        Written { tokens, kernels: vec![kernel] }
    }
}

pub(super) fn evidence(evidence: Evidence) -> TokenStream {
    match evidence {
        Evidence::Proved => quote!(__lagrange::facts::Evidence::Proved),
        Evidence::Held(states) => quote!(__lagrange::facts::Evidence::Held(#states)),
    }
}

fn energy_form(form: EnergyForm) -> TokenStream {
    let form = match form {
        EnergyForm::Sum(found) => {
            let evidence = evidence(found);
            quote!(Sum(#evidence))
        }
        EnergyForm::Even(found) => {
            let evidence = evidence(found);
            quote!(Even(#evidence))
        }
        EnergyForm::Moving => quote!(Moving),
        EnergyForm::Quadratic => quote!(Quadratic),
        EnergyForm::General => quote!(General),
    };
    quote!(__lagrange::facts::EnergyForm::#form)
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
