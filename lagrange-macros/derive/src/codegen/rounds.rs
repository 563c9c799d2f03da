//! Emits loops: iterations of the same statements with different numbers.

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{format_ident, quote};

use super::body::{Given, Rounds, SlotSequence};
use super::inputs::Varying;
use super::style::FunctionContext;
use crate::resolve::Entry;
use crate::symbolic::Symbol;
use crate::variables::Variable;

impl FunctionContext<'_> {
    pub(super) fn rounds(&self, Rounds { count, given }: &Rounds, statements: &TokenStream) -> TokenStream {
        let (round, given) = (counter(), given.iter().enumerate());
        let (before, within): (Vec<_>, Vec<_>) = given.map(|(k, given)| self.given(k, given)).unzip();
        quote! {
            #(#before)*
            for #round in 0..#count {
                #(#within)*
                #statements
            }
        }
    }

    /// Emits the definition of an input of an iteration: a statement before the loop, if needed, and one inside.
    fn given(&self, k: usize, given: &Given) -> (Option<TokenStream>, TokenStream) {
        let (name, round) = (name(k), counter());
        match given {
            Given::SpillSlots(series) => {
                let value = waiting(*series);
                (None, quote!(let #name = #value;))
            }
            Given::Inputs(symbols) => match self.in_array(symbols) {
                Some(value) => (None, quote!(let #name = #value;)),
                None => {
                    let values = symbols.iter().map(|&symbol| self.read(symbol));
                    (Some(quote!(let #name = [#(#values),*];)), quote!(let #name = #name[#round];))
                }
            },
        }
    }

    /// Name of an input in expressions.
    pub(super) fn input(&self, symbol: Symbol) -> Ident {
        match Variable::of(symbol) {
            Variable::Given(k) => name(k),
            _ => self.names[&symbol].clone(),
        }
    }

    /// Expression of an input that lies at a constant stride in one array, else `None`.
    fn in_array(&self, symbols: &[Symbol]) -> Option<TokenStream> {
        let entries: Option<Vec<Entry>> = symbols.iter().map(|&symbol| self.entry(symbol)).collect();
        if let Some(entries) = entries {
            return self.in_field(&entries);
        }
        let arrays: Option<Vec<_>> = symbols.iter().map(|&symbol| self.array(symbol)).collect();
        let (arrays, places): (Vec<_>, Vec<_>) = arrays?.into_iter().unzip();
        let are_one = arrays.iter().all(|array| array.to_string() == arrays[0].to_string());
        let (array, index) = (&arrays[0], index(SlotSequence::through(&places)?));
        are_one.then(|| self.widened(symbols[0], &quote!(#array[#index])))
    }

    fn entry(&self, symbol: Symbol) -> Option<Entry> {
        match Variable::of(symbol) {
            Variable::Parameter(k) => Some(self.problem.parameters.entries[k]),
            _ => None,
        }
    }

    /// Expression of numbers of one field that differ in one index only, else `None`.
    fn in_field(&self, entries: &[Entry]) -> Option<TokenStream> {
        let (first, parameters) = (entries[0], &self.problem.parameters);
        if entries.iter().any(|entry| entry.field != first.field) {
            return None;
        }
        let all: Vec<Vec<usize>> = entries.iter().map(|entry| parameters.indices(*entry)).collect();
        let mut differing = (0..all[0].len()).filter(|&k| all.iter().any(|one| one[k] != all[0][k]));
        let (place, None) = (differing.next()?, differing.next()) else { return None };
        let places: Vec<usize> = all.iter().map(|one| one[place]).collect();
        let index = index(SlotSequence::through(&places)?);
        let is_outside = place < parameters.arrays(first.field);
        is_outside.then(|| self.number_of_rounds(first, Some(&Varying { place, index })))
    }
}

fn name(k: usize) -> Ident {
    format_ident!("given{k}", span = Span::mixed_site())
}

fn counter() -> Ident {
    Ident::new("round", Span::mixed_site())
}

/// Spill slot; in a loop, the slot of the current iteration.
pub(super) fn waiting(series: SlotSequence) -> TokenStream {
    let index = index(series);
    quote!(waiting[#index])
}

fn index(SlotSequence { first, step }: SlotSequence) -> TokenStream {
    let (round, first, size) =
        (counter(), Literal::usize_unsuffixed(first), Literal::usize_unsuffixed(step.unsigned_abs()));
    match step {
        0 => quote!(#first),
        1 => quote!(#first + #round),
        -1 => quote!(#first - #round),
        _ if step > 0 => quote!(#first + #size * #round),
        _ => quote!(#first - #size * #round),
    }
}
