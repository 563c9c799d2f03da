//! Emits the parts of the equations of motion that the runtime puts together if constraints can be switched off.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::emitter::{Emitter, Written};
use super::kernel::Part;
use super::shape::ResultShape;
use super::signature::{Types, wide};
use crate::contract::{Argument, Dimension};
use crate::mechanics::{Row, RowGroup, SwitchedEquations};
use crate::resolve::Entry;
use crate::symbolic::Id;

impl Row {
    /// Its numbers, in the order of the runtime.
    fn all(&self) -> impl Iterator<Item = Id> {
        let push = self.push.iter().flatten();
        self.jacobian.iter().chain(push).chain(&self.numbers).copied()
    }
}

impl Emitter<'_> {
    /// Items of the trait `Switched`.
    pub(super) fn switched(&self, switched: &SwitchedEquations) -> Written {
        let groups = &switched.groups;
        let (n, m) = (self.problem.coordinates.len(), self.problem.constraints.len());
        let count: usize = groups.iter().flat_map(|group| &group.rows).map(|row| row.all().count()).sum();
        let held = n.min(m);
        let factor = &self.style.factor;
        let rows = Self::rows(groups);
        let switches = groups.iter().enumerate().filter_map(|(k, group)| {
            let is_on = self.is_on(group.entry?);
            Some(quote!(#k => #is_on,))
        });
        let Written { tokens: arms, mut kernels } = self.groups(groups);
        let solving = self.inertia();
        kernels.extend(solving.kernels);
        let mass = &self.derived.equations.mass;
        let places = (0..n).flat_map(|i| (0..n).map(move |k| [i, k]));
        let places: Vec<[usize; 2]> = places.filter(|&[i, k]| mass[i][k] != Id::ZERO).collect();
        let masses: Vec<Id> = places.iter().map(|&[i, k]| mass[i][k]).collect();
        let masses = self.style.kernel("masses", &masses, &[ResultShape::Vector(masses.len())]);
        let (count_of_masses, find_masses, found) = (places.len(), &masses.statements, &masses.results);
        let places = places.iter().map(|[i, k]| quote!([#i, #k]));
        let (solving, state, scalar) =
            (solving.tokens, self.style.types.argument(Argument::State), self.style.types.scalar);
        let tokens = quote! {
            type Inertia = #factor;
            type Numbers = __lagrange::nalgebra::Const<#count>;
            type Held = __lagrange::nalgebra::Const<#held>;
            const GROUPS: &'static [&'static [__lagrange::generated::ConstraintRow]] = &[#(&[#rows]),*];

            #[inline]
            fn may_hold(&self, group: usize) -> bool {
                match group {
                    #(#switches)*
                    _ => true,
                }
            }

            #[inline]
            #[allow(unused_variables)]
            fn rows(&self, group: usize, #state, numbers: &mut __lagrange::generated::Array<#scalar, Self::Numbers>) {
                match group {
                    #arms
                    _ => {}
                }
            }

            type Masses = __lagrange::nalgebra::Const<#count_of_masses>;
            const MASSES: &'static [[usize; 2]] = &[#(#places),*];

            #[allow(unused_variables)]
            fn masses(&self, #state) -> __lagrange::generated::Array<#scalar, Self::Masses> {
                #find_masses
                (#(#found)*).into()
            }

            #solving
        };
        kernels.push(masses);
        Written { tokens, kernels }
    }

    fn is_on(&self, entry: Entry) -> TokenStream {
        let place = self.style.place_of_state(entry);
        quote!(__lagrange::generated::Switch::is_on(&#place))
    }

    /// Whether a constraint holds that can be switched off.
    pub(super) fn any_holds(&self) -> TokenStream {
        let groups = self.derived.equations.switched.iter().flat_map(|switched| &switched.groups);
        let on = groups.filter_map(|group| Some(self.is_on(group.entry?)));
        let frictions = self.problem.frictions.iter().filter(|friction| friction.contact.is_none());
        let keeps = frictions.map(|friction| {
            let place = self.style.place_of_state(friction.entry);
            quote!(__lagrange::generated::keeps(&#place))
        });
        let all = on.chain(keeps);
        quote!(#(#all)||*)
    }

    /// The rows of each group, without their numbers.
    fn rows(groups: &[RowGroup]) -> Vec<TokenStream> {
        let mut start = 0;
        let mut row = |row: &Row| {
            let (Row { constraint, columns, .. }, pushes, from) = (row, row.push.is_some(), start);
            start += row.all().count();
            let fields =
                quote!(constraint: #constraint, columns: &[#(#columns),*], pushes: #pushes, start: #from);
            quote!(__lagrange::generated::ConstraintRow { #fields })
        };
        let group = |group: &RowGroup| {
            let rows = group.rows.iter().map(&mut row);
            quote!(#(#rows),*)
        };
        groups.iter().map(group).collect()
    }

    /// Arms that store the numbers of each group. Each is a function by itself: the time to compile a function grows faster than
    /// its length.
    fn groups(&self, groups: &[RowGroup]) -> Written {
        let (mut start, context) = (0, self.style.of_parts());
        let state = self.style.types.argument(Argument::State);
        let arm = |(k, group): (usize, &RowGroup)| {
            let numbers: Vec<Id> = group.rows.iter().flat_map(Row::all).collect();
            let from = start;
            start += numbers.len();
            let shape = [ResultShape::Vector(numbers.len())];
            let mut kernel = context.kernel(&format!("rows_{k}"), &numbers, &shape);
            let name = format_ident!("__rows_{k}_all");
            let (module, scalar) = (context.module_of(&name), self.style.types.scalar);
            let (statements, results) = (&kernel.statements, &kernel.results);
            let part = Part {
                doc: kernel.doc.clone(),
                generics: None,
                arguments: quote!(#state, numbers: &mut [#scalar]),
                body: quote!(#statements numbers.copy_from_slice(#(&#results)*);),
                module,
                name,
            };
            let Part { module, name, .. } = &part;
            let tokens =
                quote!(#k => #module::Part::<Self>::#name(self, state, &mut numbers[#from..#start]),);
            kernel.parts.push(part);
            Written { tokens, kernels: vec![kernel] }
        };
        groups.iter().enumerate().map(arm).collect()
    }

    /// Methods that factorize the mass matrix, and solve with it.
    fn inertia(&self) -> Written {
        let (factorization, factor) = self.factorization("inertia");
        let (solution, solved) = self.solution("solve_inertia", &quote!(__lagrange::generated::vector([])));
        let wide = wide();
        let (types, n, over) = (self.style.types, self.problem.coordinates.len(), self.style.types.over());
        let over_wide = Types { scalar: &wide, ..types };
        let [state, forcing] = [types.argument(Argument::State), over_wide.argument(Argument::Forcing)];
        let vector = types.vector(Dimension::Coordinates);
        let [factorizing, solving] = [&factorization, &solution].map(|kernel| &kernel.statements);
        let [doc_of_factor, doc_of_solution] = [&factorization, &solution].map(|kernel| &kernel.doc);
        let tokens = quote! {
            #[doc = #doc_of_factor]
            #[inline]
            #[allow(unused_variables)]
            fn inertia(&self, #state) -> (Self::Inertia, #vector) {
                #factorizing
                #factor
            }

            #[doc = #doc_of_solution]
            #[inline]
            #[allow(unused_variables)]
            fn solve_inertia #over(&self, factor: &Self::Inertia, #forcing) -> __lagrange::Solution<#wide, #n, 0> {
                #solving
                #solved
            }
        };
        Written { tokens, kernels: vec![factorization, solution] }
    }
}
