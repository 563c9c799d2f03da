//! Observables: a method for each, and all of them by index.

use proc_macro2::Span;
use quote::quote;

use super::shape::Shape;
use super::{Emitter, Written};
use crate::contract::Method;
use crate::resolve::Label;
use crate::symbolic::Id;
use crate::variables::Variable;

/// Kernels of observables are called so, and no others.
pub(super) const OBSERVABLE: &str = "observable_";

impl Emitter<'_> {
    /// Flat names, in the order of [`observable_by_index`](Self::observable_by_index).
    pub(super) fn observable_names(&self) -> Vec<String> {
        let names = self.problem.observables.iter().flat_map(|(label, values)| match values.len() {
            1 => vec![label.text.clone()],
            length => (0..length).map(|i| format!("{}[{i}]", label.text)).collect(),
        });
        names.collect()
    }

    pub(super) fn observable_by_index(&self, method: &Method) -> Written {
        let entries = self.problem.observables.iter().flat_map(|(label, values)| {
            let method = method_name(&label.text, label.place.start());
            let solution = self.needs_solution(values).then(|| quote!(, solution));
            let call = quote!(self.#method(state #solution));
            (0..values.len()).map(move |i| match values.len() {
                1 => call.clone(),
                _ => quote!(#call.data.0[0][#i]),
            })
        });
        let arms =
            entries.enumerate().map(|(index, value)| quote!(#index => ::core::option::Option::Some(#value),));
        self.by_index(method, Written { tokens: arms.collect(), kernels: Vec::new() })
    }

    fn needs_solution(&self, values: &[Id]) -> bool {
        self.style.graph.symbols(values).any(|symbol| Variable::of(symbol).is_solved())
    }

    /// The method of an observable.
    pub(super) fn observable(&self, (label, values): &(Label, Vec<Id>)) -> Written {
        let visibility = &self.declaration.visibility;
        let name = method_name(&label.text, label.place.start());
        let shape = if values.len() == 1 { Shape::Number } else { Shape::Vector(values.len()) };
        let kernel = self.style.kernel(&format!("{OBSERVABLE}{}", label.text), values, &[shape]);
        let (statements, results) = (&kernel.statements, &kernel.results);
        let result = match shape {
            Shape::Number => quote!(#(#results)*),
            _ => quote!(#(__lagrange::generated::vector(#results))*),
        };
        let solved = self.needs_solution(values);
        let signature = self.style.types.of_observable(&name, values.len(), solved);
        let multipliers = solved.then(|| quote! { let (accelerations, multipliers) = (&solution.accelerations, &solution.multipliers); });
        let doc = format!("The observable `{}`. {}", label.text, kernel.doc);
        let tokens = quote! {
            #[doc = #doc]
            #[inline]
            #[allow(unused_variables)]
            #visibility #signature {
                #multipliers
                #statements
                #result
            }
        };
        Written { tokens, kernels: vec![kernel] }
    }
}

pub(super) fn method_name(text: &str, span: Span) -> syn::Ident {
    // A name that only `r#` makes an identifier gets it back.
    let mut name = syn::parse_str::<syn::Ident>(text).unwrap_or_else(|_| syn::Ident::new_raw(text, span));
    name.set_span(span);
    name
}
