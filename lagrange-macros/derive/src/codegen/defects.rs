//! Emits a check of matrix parameters: the deviation of each from its stated property, symmetric or a rotation.

use proc_macro2::TokenStream;
use quote::quote;

use super::emitter::Emitter;
use crate::resolve::Entry;
use crate::syntax::Property;

impl Emitter<'_> {
    /// Emits `visit_defects`. `None` if no matrix has a stated property. A property that follows from the type is not
    /// checked.
    pub(super) fn visit_defects(&self) -> Option<TokenStream> {
        let scalar = self.style.types.scalar;
        let visits: Vec<_> = self.matrices().into_iter().map(|first| self.visit_defect(first)).collect();
        (!visits.is_empty()).then(|| {
            quote! {
                fn visit_defects(
                    &self,
                    visit: &mut dyn ::core::ops::FnMut(&'static str, __lagrange::generated::Defect<#scalar>),
                ) {
                    #(#visits)*
                }
            }
        })
    }

    /// Returns the first entry of each matrix in use that has a stated property.
    fn matrices(&self) -> Vec<Entry> {
        let parameters = &self.problem.parameters;
        let said = parameters.entries.iter().filter(|entry| parameters.said(entry.field).is_some());
        let first = |entry: &Entry| {
            let numbers = parameters.size(entry.field).pow(2);
            Entry { number: entry.number - entry.number % numbers, ..*entry }
        };
        let mut matrices: Vec<Entry> = said.map(first).collect();
        matrices.sort_unstable();
        matrices.dedup();
        matrices
    }

    fn visit_defect(&self, first: Entry) -> Option<TokenStream> {
        let parameters = &self.problem.parameters;
        let size = parameters.size(first.field);
        let entry = |number: usize| self.style.number(Entry { number: first.number + number, ..first });
        let rows = (0..size).map(|i| {
            let row = (0..size).map(|j| entry(i * size + j));
            quote!([#(#row),*])
        });
        let name = parameters.matrix_name(first);
        let defect = match parameters.said(first.field)? {
            Property::Symmetric => quote!(asymmetry),
            Property::Rotation => quote!(distortion),
        };
        Some(quote!(visit(#name, __lagrange::generated::#defect([#(#rows),*]));))
    }
}
