//! Emits observables: a method for each, and one method that returns them by index.

use proc_macro2::{Span, TokenStream};
use quote::quote;

use super::emitter::{Emitter, Written};
use super::shape::ResultShape;
use crate::contract::Method;
use crate::resolve::Observed;
use crate::symbolic::Id;
use crate::variables::Variable;

/// Prefix of the kernel names of observables. No other kernel name has it.
pub(super) const OBSERVABLE: &str = "observable_";

impl Emitter<'_> {
    /// Names of all numbers, in the order of [`observable_by_index`](Self::observable_by_index).
    pub(super) fn observable_names(&self) -> Vec<String> {
        self.problem.observables.iter().flat_map(Observed::names).collect()
    }

    pub(super) fn observable_by_index(&self, method: &Method) -> Written {
        let entries = self.problem.observables.iter().flat_map(|Observed { label, lengths, values }| {
            let method = method_name(&label.text, label.place.start());
            let solution = self.needs_solution(values).then(|| quote!(, solution));
            let call = quote!(self.#method(state #solution));
            (0..values.len()).map(move |k| {
                let entry = entry_of(lengths, k);
                quote!(#call #entry)
            })
        });
        let arms =
            entries.enumerate().map(|(index, value)| quote!(#index => ::core::option::Option::Some(#value),));
        self.by_index(method, Written { tokens: arms.collect(), kernels: Vec::new() })
    }

    fn needs_solution(&self, values: &[Id]) -> bool {
        self.style.graph.symbols(values).any(|symbol| Variable::of(symbol).is_solved())
    }

    /// Emits the method of an observable.
    pub(super) fn observable(&self, Observed { label, lengths, values }: &Observed) -> Written {
        let visibility = &self.declaration.visibility;
        let name = method_name(&label.text, label.place.start());
        let (shape, wrapped) = match lengths[..] {
            [] => (ResultShape::Number, None),
            [length] => (ResultShape::Vector(length), Some(quote!(vector))),
            [rows, ..] => (ResultShape::Matrix(values.len() / rows, rows), Some(quote!(matrix))),
        };
        let kernel =
            self.style.kernel(&format!("{OBSERVABLE}{}", label.text), &by_columns(lengths, values), &[shape]);
        let (statements, results) = (&kernel.statements, &kernel.results);
        let result = match wrapped {
            Some(wrapped) => quote!(#(__lagrange::generated::#wrapped(#results))*),
            None => quote!(#(#results)*),
        };
        let solved = self.needs_solution(values);
        let signature = self.style.types.of_observable(&name, lengths, solved);
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

/// Converts row-major numbers to the column-major order of nalgebra.
fn by_columns(lengths: &[usize], values: &[Id]) -> Vec<Id> {
    let columns = lengths.get(1).copied().unwrap_or(1);
    (0..columns).flat_map(|column| values.iter().skip(column).step_by(columns).copied()).collect()
}

/// Access to a number in a nalgebra matrix, from its row-major index. `None` if the observable is a single number.
pub(super) fn entry_of(lengths: &[usize], number: usize) -> Option<TokenStream> {
    let columns = lengths.get(1).copied().unwrap_or(1);
    let (row, column) = (number / columns, number % columns);
    (!lengths.is_empty()).then(|| quote!(.data.0[#column][#row]))
}

pub(super) fn method_name(text: &str, span: Span) -> syn::Ident {
    // Restore the `r#` of a name that is a keyword.
    let mut name = syn::parse_str::<syn::Ident>(text).unwrap_or_else(|_| syn::Ident::new_raw(text, span));
    name.set_span(span);
    name
}
