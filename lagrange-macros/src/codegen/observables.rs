//! Observables: a method for each, and all of them by index.

use proc_macro2::{Span, TokenStream};
use quote::quote;

use super::Emitter;
use super::kernel::Kernel;
use super::shape::Shape;
use crate::resolve::Label;
use crate::symbolic::Id;
use crate::variables::Variable;

impl Emitter<'_> {
    /// Flat names, in the order of [`observable_by_index`](Self::observable_by_index).
    pub(super) fn observable_names(&self) -> Vec<String> {
        let names = self.problem.observables.iter().flat_map(|(label, values)| match values.len() {
            1 => vec![label.text.clone()],
            length => (0..length).map(|i| format!("{}[{i}]", label.text)).collect(),
        });
        names.collect()
    }

    pub(super) fn observable_by_index(&self) -> TokenStream {
        let (n, m, scalar) =
            (self.problem.coordinates.len(), self.problem.constraints.len(), self.style.scalar);
        let mut index = 0_usize;
        let mut arms = Vec::new();
        for (label, values) in &self.problem.observables {
            let method = method_name(&label.text, label.place.start());
            let call = if self.needs_solution(values) {
                quote!(self.#method(state, solution))
            } else {
                quote!(self.#method(state))
            };
            for i in 0..values.len() {
                let value = if values.len() == 1 { call.clone() } else { quote!(#call.data.0[0][#i]) };
                arms.push(quote!(#index => ::core::option::Option::Some(#value),));
                index += 1;
            }
        }
        quote! {
            #[allow(unused_variables)]
            fn observable(&self, index: usize, state: &__lagrange::State<#scalar, #n>, solution: &__lagrange::Solution<#scalar, #n, #m>) -> ::core::option::Option<#scalar> {
                match index {
                    #(#arms)*
                    _ => ::core::option::Option::None,
                }
            }
        }
    }

    fn needs_solution(&self, values: &[Id]) -> bool {
        self.style.graph.symbols(values).any(|symbol| Variable::of(symbol).is_solved())
    }

    pub(super) fn observable_methods(&self) -> TokenStream {
        self.problem.observables.iter().map(|(label, values)| self.observable_method(label, values)).collect()
    }

    fn observable_method(&self, label: &Label, values: &[Id]) -> TokenStream {
        let (n, m, scalar) =
            (self.problem.coordinates.len(), self.problem.constraints.len(), self.style.scalar);
        let visibility = &self.declaration.visibility;
        let name = method_name(&label.text, label.place.start());
        let length = values.len();
        let shape = if length == 1 { Shape::Number } else { Shape::Vector(length) };
        let Kernel { statements, results, doc } = self.style.kernel(&label.text, values, &[shape]);
        let (returns, result) = match shape {
            Shape::Number => (quote!(#scalar), quote!(#(#results)*)),
            _ => (
                quote!(__lagrange::nalgebra::SVector<#scalar, #length>),
                quote!(#(__lagrange::generated::vector(#results))*),
            ),
        };
        let solved = self.needs_solution(values);
        let solution = solved.then(|| quote!(, solution: &__lagrange::Solution<#scalar, #n, #m>));
        let multipliers = solved.then(|| quote! { let multipliers = &solution.multipliers; });
        let doc = format!("The observable `{}`. {}", label.text, doc);
        quote! {
            #[doc = #doc]
            #[inline]
            #[allow(unused_variables)]
            #visibility fn #name(&self, state: &__lagrange::State<#scalar, #n> #solution) -> #returns {
                #multipliers
                #statements
                #result
            }
        }
    }
}

pub(super) fn method_name(text: &str, span: Span) -> syn::Ident {
    // A name that only `r#` makes an identifier gets it back.
    let mut name = syn::parse_str::<syn::Ident>(text).unwrap_or_else(|_| syn::Ident::new_raw(text, span));
    name.set_span(span);
    name
}
