//! Emits the contacts: which constraints they are, their fields, and their restitution.

use proc_macro2::TokenStream;
use quote::quote;

use super::emitter::{Emitter, Written};
use super::shape::ResultShape;
use crate::contract::RESTITUTION;

impl Emitter<'_> {
    /// Items of the trait `Contacts`. `None` if there are no contacts.
    pub(super) fn contacts(&self) -> Option<Written> {
        let contacts = &self.problem.contacts;
        let rows = contacts.iter().map(|contact| contact.row);
        let places = contacts.iter().map(|contact| self.style.place_of_switch(contact.switch));
        let (read, set): (Vec<TokenStream>, Vec<TokenStream>) = places
            .enumerate()
            .map(|(k, place)| {
                (quote!(#k => ::core::option::Option::Some(#place),), quote!(#k => #place = contact,))
            })
            .unzip();
        let Written { tokens: restitution, kernels } = self.restitution();
        let tokens = quote! {
            const CONTACTS: &'static [usize] = &[#(#rows),*];

            fn contact(&self, index: usize) -> ::core::option::Option<__lagrange::contact::Contact> {
                match index {
                    #(#read)*
                    _ => ::core::option::Option::None,
                }
            }

            fn set_contact(&mut self, index: usize, contact: __lagrange::contact::Contact) -> bool {
                match index {
                    #(#set)*
                    _ => return false,
                }
                true
            }

            #restitution
        };
        (!contacts.is_empty()).then_some(Written { tokens, kernels })
    }

    fn restitution(&self) -> Written {
        let arms = self.problem.contacts.iter().enumerate().map(|(k, contact)| {
            let shape = [ResultShape::Number];
            let kernel = self.style.kernel(&format!("restitution_{k}"), &[contact.restitution], &shape);
            let (statements, results) = (&kernel.statements, &kernel.results);
            let tokens = quote!(#k => ::core::option::Option::Some({ #statements #(#results)* }),);
            Written { tokens, kernels: vec![kernel] }
        });
        self.by_index(&RESTITUTION, arms.collect())
    }
}
