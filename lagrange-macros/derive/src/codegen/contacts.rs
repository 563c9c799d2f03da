//! Emits the contacts and friction: which constraints they are, their fields, and their laws.

use proc_macro2::TokenStream;
use quote::quote;

use super::emitter::{Emitter, Written};
use super::shape::ResultShape;
use crate::contract::{FRICTION_LIMIT, Method, RESTITUTION, SLIDING_FRICTION};
use crate::resolve::Entry;
use crate::symbolic::Id;
use crate::syntax::ImpactLaw;
use crate::variables::Variable;

impl Emitter<'_> {
    /// Items of the trait `Contacts`. `None` if there are no contacts and no friction.
    pub(super) fn contacts(&self) -> Option<Written> {
        let (contacts, frictions) = (&self.problem.contacts, &self.problem.frictions);
        (!contacts.is_empty() || !frictions.is_empty()).then_some(())?;
        let rows = contacts.iter().map(|contact| contact.row);
        let impacts = contacts.iter().map(|contact| match contact.impact {
            ImpactLaw::Newton => quote!(__lagrange::contact::ImpactLaw::Newton),
            ImpactLaw::Poisson => quote!(__lagrange::contact::ImpactLaw::Poisson),
        });
        let (read, set): (Vec<TokenStream>, Vec<TokenStream>) = self
            .by_place(contacts.iter().map(|contact| contact.entry), |place| {
                (quote!(::core::option::Option::Some(#place)), quote!(#place = state))
            });
        let (read_friction, set_friction): (Vec<TokenStream>, Vec<TokenStream>) =
            self.by_place(frictions.iter().map(|friction| friction.entry), |place| {
                let friction = quote!(__lagrange::generated::FrictionState);
                (quote!(#friction::friction(&#place)), quote!(#friction::set_friction(&mut #place, state)))
            });
        let rows_of_friction = frictions.iter().map(|friction| {
            let (row, count) = (friction.row, friction.sliding.len());
            let contact = match friction.contact {
                Some(contact) => quote!(::core::option::Option::Some(#contact)),
                None => quote!(::core::option::Option::None),
            };
            let has_constant_limit = self.is_constant(friction.bounds[0]);
            let fields =
                quote!(row: #row, count: #count, contact: #contact, has_constant_limit: #has_constant_limit);
            quote!(__lagrange::contact::FrictionRows { #fields })
        });
        let limits = frictions.iter().map(|friction| friction.bounds[0]).collect();
        let sliding = frictions.iter().map(|friction| friction.bounds[1]).collect();
        let laws = [
            self.law(&RESTITUTION, contacts.iter().map(|contact| contact.restitution).collect()),
            self.law(&FRICTION_LIMIT, limits),
            self.law(&SLIDING_FRICTION, sliding),
        ];
        let Written { tokens: laws, kernels } = laws.into_iter().collect();
        let tokens = quote! {
            const CONTACTS: &'static [usize] = &[#(#rows),*];
            const IMPACT_LAWS: &'static [__lagrange::contact::ImpactLaw] = &[#(#impacts),*];
            const FRICTIONS: &'static [__lagrange::contact::FrictionRows] = &[#(#rows_of_friction),*];

            #[allow(unused_variables, unreachable_code)]
            fn contact(&self, index: usize) -> ::core::option::Option<__lagrange::contact::Contact> {
                match index {
                    #(#read)*
                    _ => ::core::option::Option::None,
                }
            }

            #[allow(unused_variables, unreachable_code)]
            fn set_contact(&mut self, index: usize, state: __lagrange::contact::Contact) -> bool {
                match index {
                    #(#set)*
                    _ => return false,
                }
                true
            }

            #[allow(unused_variables, unreachable_code)]
            fn friction(&self, index: usize) -> ::core::option::Option<__lagrange::contact::Friction> {
                match index {
                    #(#read_friction)*
                    _ => ::core::option::Option::None,
                }
            }

            #[allow(unused_variables, unreachable_code)]
            fn set_friction(&mut self, index: usize, state: __lagrange::contact::Friction) -> bool {
                match index {
                    #(#set_friction)*
                    _ => return false,
                }
                true
            }

            #laws
        };
        Some(Written { tokens, kernels })
    }

    /// Arms that read and set what entries of fields keep, by index.
    fn by_place(
        &self,
        entries: impl Iterator<Item = Entry>,
        access: impl Fn(TokenStream) -> (TokenStream, TokenStream),
    ) -> (Vec<TokenStream>, Vec<TokenStream>) {
        let arms = entries.enumerate().map(|(k, entry)| {
            let (read, set) = access(self.style.place_of_state(entry));
            (quote!(#k => #read,), quote!(#k => #set,))
        });
        arms.unzip()
    }

    /// First constraint whose friction slides, as a multiple of a multiplier. `None` if there is no such friction.
    pub(super) fn slides(&self) -> Option<TokenStream> {
        let frictions = self.problem.frictions.iter().filter(|friction| friction.contact.is_some());
        let arms = frictions.map(|friction| {
            let (row, place) = (friction.row, self.style.place_of_state(friction.entry));
            quote! {
                if __lagrange::generated::FrictionState::slides(&#place) {
                    return ::core::option::Option::Some(#row);
                }
            }
        });
        let arms: Vec<TokenStream> = arms.collect();
        (!arms.is_empty()).then(|| {
            quote! {
                const HAS_FRICTION: bool = true;

                fn slides(&self) -> ::core::option::Option<usize> {
                    #(#arms)*
                    ::core::option::Option::None
                }
            }
        })
    }

    /// That some friction acts along two velocities. `None` if none does.
    pub(super) fn planar_friction(&self) -> Option<TokenStream> {
        let is_planar = self.problem.frictions.iter().any(|friction| friction.sliding.len() == 2);
        is_planar.then(|| {
            quote!(
                const HAS_PLANAR_FRICTION: bool = true;
            )
        })
    }

    /// True if an expression depends on parameters alone.
    fn is_constant(&self, expression: Id) -> bool {
        let is_parameter = |symbol| matches!(Variable::of(symbol), Variable::Parameter(_));
        self.style.graph.symbols(&[expression]).all(is_parameter)
    }

    /// Method that returns the number of each contact or friction by its index.
    fn law(&self, method: &Method, numbers: Vec<Id>) -> Written {
        let arms = numbers.into_iter().enumerate().map(|(k, number)| {
            let shape = [ResultShape::Number];
            let kernel = self.style.kernel(&format!("{}_{k}", method.name), &[number], &shape);
            let (statements, results) = (&kernel.statements, &kernel.results);
            let tokens = quote!(#k => ::core::option::Option::Some({ #statements #(#results)* }),);
            Written { tokens, kernels: vec![kernel] }
        });
        self.by_index(method, arms.collect())
    }
}
