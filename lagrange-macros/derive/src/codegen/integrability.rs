//! Emits the classification of the constraints as constants, and the integrals found as a method.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::emitter::{Emitter, Written};
use super::facts::evidence;
use super::shape::ResultShape;
use crate::contract::Method;
use crate::mechanics::{Classification, Integrals};

impl Emitter<'_> {
    /// Emits the constants `CONSTRAINT_CLASSES` and `INTEGRALS`.
    pub(super) fn integrability(&self) -> TokenStream {
        let kinds = &self.derived.equations.integrability;
        let classes = kinds.classes.iter().map(|&Classification { integrability, evidence }| {
            let (integrability, evidence) = (format_ident!("{integrability:?}"), self::evidence(evidence));
            quote!(__lagrange::facts::Classification { integrability: __lagrange::facts::Integrability::#integrability, evidence: #evidence })
        });
        let integrals = match kinds.integrals {
            Some(Integrals { count, of, evidence }) => {
                let evidence = self::evidence(evidence);
                quote!(::core::option::Option::Some(__lagrange::facts::Integrals { count: #count, of: #of, evidence: #evidence }))
            }
            None => quote!(::core::option::Option::None),
        };
        quote! {
            const CONSTRAINT_CLASSES: &'static [__lagrange::facts::Classification] = &[#(#classes),*];
            const INTEGRALS: ::core::option::Option<__lagrange::facts::Integrals> = #integrals;
        }
    }

    /// Emits the method that evaluates an integral by its index. Empty if no integral was found.
    pub(super) fn constraint_integral(&self, method: &Method) -> Written {
        let found = self.derived.equations.integrability.functions.iter().enumerate();
        let arms = found.filter_map(|(index, function)| {
            let kernel =
                self.style.kernel(&format!("integral_{index}"), &[(*function)?], &[ResultShape::Number]);
            let (statements, results) = (&kernel.statements, &kernel.results);
            let tokens = quote! {
                #index => {
                    #statements
                    ::core::option::Option::Some(#(#results)*)
                }
            };
            Some(Written { tokens, kernels: vec![kernel] })
        });
        let arms: Written = arms.collect();
        if arms.tokens.is_empty() {
            return arms;
        }
        let Written { tokens, kernels } = self.by_index(method, arms);
        Written { tokens: quote!(#[inline] #tokens), kernels }
    }
}
