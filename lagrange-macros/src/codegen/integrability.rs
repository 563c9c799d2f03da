//! The verdicts on the constraints as constants, and the integrals that were found as a method.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::Emitter;
use super::kernel::Kernel;
use super::shape::Shape;
use crate::mechanics::{Classification, Evidence, Integrals};

impl Emitter<'_> {
    /// The constants of the trait.
    pub(super) fn integrability(&self) -> TokenStream {
        let kinds = &self.equations.integrability;
        let m = kinds.classes.len();
        let classes = kinds.classes.iter().map(|&Classification { integrability, evidence }| {
            let (integrability, evidence) = (format_ident!("{integrability:?}"), self::evidence(evidence));
            quote!(__lagrange::Classification { integrability: __lagrange::Integrability::#integrability, evidence: #evidence })
        });
        let integrals = match kinds.integrals {
            Some(Integrals { count, of, evidence }) => {
                let evidence = self::evidence(evidence);
                quote!(::core::option::Option::Some(__lagrange::Integrals { count: #count, of: #of, evidence: #evidence }))
            }
            None => quote!(::core::option::Option::None),
        };
        quote! {
            const CONSTRAINT_CLASSES: [__lagrange::Classification; #m] = [#(#classes),*];
            const INTEGRALS: ::core::option::Option<__lagrange::Integrals> = #integrals;
        }
    }

    /// The method of the trait; nothing where no integral was found.
    pub(super) fn constraint_integral(&self) -> TokenStream {
        let (n, scalar) = (self.problem.coordinates.len(), self.style.scalar);
        let found = self.equations.integrability.functions.iter().enumerate();
        let arms: Vec<_> = found
            .filter_map(|(index, function)| {
                let Kernel { statements, results, .. } =
                    self.style.kernel(&format!("integral_{index}"), &[(*function)?], &[Shape::Number]);
                Some(quote! {
                    #index => {
                        #statements
                        ::core::option::Option::Some(#(#results)*)
                    }
                })
            })
            .collect();
        if arms.is_empty() {
            return TokenStream::new();
        }
        quote! {
            #[inline]
            #[allow(unused_variables)]
            fn constraint_integral(&self, index: usize, state: &__lagrange::State<#scalar, #n>) -> ::core::option::Option<#scalar> {
                match index {
                    #(#arms)*
                    _ => ::core::option::Option::None,
                }
            }
        }
    }
}

fn evidence(evidence: Evidence) -> TokenStream {
    match evidence {
        Evidence::Proved => quote!(__lagrange::Evidence::Proved),
        Evidence::Held(points) => quote!(__lagrange::Evidence::Held(#points)),
    }
}
