//! Values of expressions with sums, and accelerations from forces.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::ManyEmitter;
use super::indices::round;
use crate::codegen::shape::ResultShape;
use crate::mechanics::many::{Guarded, Inertia};
use crate::resolve::many::{Affine, Index, Slot, Unknown, totals};
use crate::symbolic::{Id, Node};
use crate::variables::Variable;

impl ManyEmitter<'_> {
    /// Statements that compute expressions, and the results. Sums in them are loops before them.
    pub(super) fn values(&self, roots: &[Id]) -> (TokenStream, Vec<TokenStream>) {
        let sums = self.sums(totals(self.style.graph, roots));
        let shapes = vec![ResultShape::Number; roots.len()];
        let kernel = self.style.kernel("loop", roots, &shapes);
        let too_long = kernel.refused.map(|count| count.to_string());
        let too_long = too_long.or_else(|| (!kernel.parts.is_empty()).then(|| kernel.doc.clone()));
        self.refused.borrow_mut().extend(too_long);
        let statements = kernel.statements;
        (quote! { #sums #statements }, kernel.results)
    }

    /// Loops that compute these sums, one for each range.
    fn sums(&self, mut pending: Vec<usize>) -> TokenStream {
        let known = &self.problem.many.totals;
        let mut loops = TokenStream::new();
        while let Some(&first) = pending.first() {
            let (level, range) = (known[first].level, &known[first].range);
            let (own, others): (Vec<usize>, Vec<usize>) =
                pending.iter().partition(|&&k| (known[k].level, &known[k].range) == (level, range));
            pending = others;
            let bodies: Vec<Id> = own.iter().map(|&k| known[k].body).collect();
            let names: Vec<&Ident> =
                own.iter().map(|&k| &self.style.names[&Variable::Total(k).symbol()]).collect();
            let (statements, results) = self.values(&bodies);
            let (zero, index, range) = (self.style.constant(0.0), round(level), self.style.range(range));
            loops.extend(quote! {
                #(let mut #names = #zero;)*
                for #index in #range {
                    #statements
                    #(#names = #names + #results;)*
                }
            });
        }
        loops
    }

    /// Loops that replace the forces on all coordinates by the accelerations.
    pub(super) fn solve(&self, block: &Inertia) -> TokenStream {
        if self.is_solved(block) {
            return TokenStream::new();
        }
        let guarded = block.guarded.iter().map(|guarded| self.guarded(guarded));
        let indices: Vec<Index> =
            (0..block.lengths.len()).map(|level| Index::Affine(Affine::of(Unknown::Level(level)))).collect();
        let places: Vec<TokenStream> = block
            .rows
            .iter()
            .map(|&(array, number)| {
                self.style.place_of_slot(&Slot { array, indices: indices.clone(), number })
            })
            .collect();
        let forces = (0..block.rows.len()).map(|row| &self.style.names[&Variable::Forcing(row).symbol()]);
        let (statements, results) = self.values(&block.accelerations);
        let inner = quote! {
            #(#guarded)*
            #(let #forces = a[#places];)*
            #statements
            #(a[#places] = #results;)*
        };
        block.lengths.iter().enumerate().rfold(inner, |inner, (level, length)| {
            let (index, length) = (round(level), self.style.bound(length));
            quote! { for #index in 0..#length { #inner } }
        })
    }

    /// True if the accelerations are the forces.
    fn is_solved(&self, block: &Inertia) -> bool {
        let is_force = |(row, &id): (usize, &Id)| matches!(self.style.graph.node(id), Node::Symbol(symbol) if Variable::of(*symbol) == Variable::Forcing(row));
        block.guarded.is_empty() && block.accelerations.iter().enumerate().all(is_force)
    }

    /// Entries of M that only some elements have.
    fn guarded(&self, Guarded { conditions, values }: &Guarded) -> TokenStream {
        let roots: Vec<Id> = values.iter().map(|(_, value)| *value).collect();
        let names = values.iter().map(|(term, _)| &self.style.names[&Variable::Term(*term).symbol()]);
        let (statements, results) = self.values(&roots);
        let (zero, count) = (self.style.constant(0.0), values.len());
        let conditions = conditions.iter().map(|condition| {
            let (index, range) = (round(condition.level), self.style.range(&condition.range));
            quote!((#range).contains(&#index))
        });
        quote! {
            let [#(#names),*] = if #(#conditions)&&* { #statements [#(#results),*] } else { [#zero; #count] };
        }
    }
}
