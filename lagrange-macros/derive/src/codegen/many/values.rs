//! Values of expressions with sums, and accelerations from forces.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::ManyEmitter;
use super::indices::round;
use super::windows::Source;
use crate::codegen::passes::Program;
use crate::codegen::shape::ResultShape;
use crate::codegen::solving::solve;
use crate::mechanics::many::{Guarded, Inertia};
use crate::resolve::many::{Affine, Index, Range, Slot, Total, Unknown, totals};
use crate::symbolic::Id;
use crate::variables::Variable;

impl ManyEmitter<'_> {
    /// Statements that compute expressions, and the results. Sums in them are loops before them.
    pub(super) fn values(&self, roots: &[Id]) -> (TokenStream, Vec<TokenStream>) {
        self.results(roots, &Program::of(self.style.graph, roots))
    }

    /// The same for a program in terms of some expressions.
    pub(super) fn results(&self, roots: &[Id], program: &Program) -> (TokenStream, Vec<TokenStream>) {
        let mark = self.mark();
        let sums = self.sums_before(roots, usize::MAX);
        let kernel = self.style.write("loop", program, &vec![ResultShape::Number; program.results.len()]);
        let too_long = kernel.refused.map(|count| count.to_string());
        let too_long = too_long.or_else(|| (!kernel.parts.is_empty()).then(|| kernel.doc.clone()));
        self.refused.borrow_mut().extend(too_long);
        let statements = kernel.statements;
        self.forget(mark);
        (quote! { #sums #statements }, kernel.results)
    }

    /// Loops for the sums in these expressions that no earlier statement computes, if at most `depth` loop indices determine them.
    /// The sums count as computed until [`forget`](Self::forget).
    pub(super) fn sums_before(&self, roots: &[Id], depth: usize) -> TokenStream {
        let is_new = |k: &usize| !self.known.borrow().contains(k) && self.depth_of_sum(*k) <= depth;
        let new: Vec<usize> = totals(self.style.graph, roots).into_iter().filter(is_new).collect();
        let sums = self.sums(new.clone());
        self.known.borrow_mut().extend(new);
        sums
    }

    /// Number of sums computed so far.
    pub(super) fn mark(&self) -> usize {
        self.known.borrow().len()
    }

    /// Ends the scope of the sums computed since a mark.
    pub(super) fn forget(&self, mark: usize) {
        self.known.borrow_mut().truncate(mark);
    }

    /// Number of loops whose indices a sum depends on.
    fn depth_of_sum(&self, k: usize) -> usize {
        let Total { level, range, body } = &self.problem.many.totals[k];
        let (many, graph) = (&self.problem.many, self.style.graph);
        let bodies = many.with_bodies_from(graph, &[*body], level + 1);
        let (others, within): (Vec<usize>, Vec<usize>) =
            totals(graph, &bodies).into_iter().partition(|&k| many.totals[k].level <= *level);
        let ranges = within.into_iter().map(|k| &many.totals[k].range).chain([range]);
        let bounds = ranges.flat_map(|range| range.from.levels().chain(range.to.levels()));
        let levels =
            self.problem.levels(graph, &bodies).into_iter().chain(bounds).filter(|outer| outer < level);
        let others = others.into_iter().map(|k| self.depth_of_sum(k));
        levels.map(|outer| outer + 1).chain(others).max().unwrap_or(0)
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
            let zero = self.style.constant(0.0);
            let mark = self.mark();
            let before = self.sums_before(&bodies, level);
            let round = || {
                let (statements, results) = self.values(&bodies);
                quote! { #statements #(#names = #names + #results;)* }
            };
            let sum = self.one_loop(
                (level, range),
                (&bodies, &[]),
                round,
                [&TokenStream::new(), &TokenStream::new()],
            );
            self.forget(mark);
            loops.extend(quote! { #(let mut #names = #zero;)* { #before #sum } });
        }
        loops
    }

    /// Loops that replace the forces on all coordinates by the accelerations.
    pub(super) fn solve(&self, block: &Inertia) -> TokenStream {
        if self.is_solved(block) {
            return TokenStream::new();
        }
        let indices: Vec<Index> =
            (0..block.lengths.len()).map(|level| Index::Affine(Affine::of(Unknown::Level(level)))).collect();
        let slot = |&(array, number): &(usize, usize)| Slot { array, indices: indices.clone(), number };
        let slots: Vec<Slot> = block.rows.iter().map(slot).collect();
        self.over_elements(block, &slots, 0)
    }

    /// Loops over the elements along the axes from this one on.
    fn over_elements(&self, block: &Inertia, slots: &[Slot], axis: usize) -> TokenStream {
        let Some(length) = block.lengths.get(axis) else { return self.solve_element(block, slots) };
        let range = Range::up_to(length);
        let (roots, targets) = (block.equations.forms[0].matrix.concat(), slots.iter().collect::<Vec<_>>());
        let inner = || self.over_elements(block, slots, axis + 1);
        let loops = self.one_loop(
            (axis, &range),
            (&roots, &targets),
            inner,
            [&TokenStream::new(), &TokenStream::new()],
        );
        quote! { { #loops } }
    }

    /// Replaces the forces on one element by its accelerations.
    fn solve_element(&self, block: &Inertia, slots: &[Slot]) -> TokenStream {
        let guarded = block.guarded.iter().map(|guarded| self.guarded(guarded));
        let places: Vec<TokenStream> =
            slots.iter().map(|slot| self.style.slot_in(Source::Target(slot.array), slot)).collect();
        let forces = (0..slots.len()).map(|row| &self.style.names[&Variable::Forcing(row).symbol()]);
        let (equations, form) = (&block.equations, &block.equations.forms[0]);
        let Some(program) = solve(self.style.graph, form, equations) else {
            self.refused
                .borrow_mut()
                .push(format!("the elimination of {} coordinates", equations.coordinates));
            return TokenStream::new();
        };
        let (statements, results) = self.results(&form.matrix.concat(), &program.fused());
        let accelerations = &results[..slots.len()];
        quote! {
            #(#guarded)*
            #(let #forces = #places.get();)*
            #statements
            #(#places.set(#accelerations);)*
        }
    }

    /// True if the accelerations are the forces.
    fn is_solved(&self, block: &Inertia) -> bool {
        let form = &block.equations.forms[0];
        form.alone.iter().zip(&form.linear).all(|(quotient, force)| *quotient == Some(*force))
    }

    /// Entries of M that only some elements have.
    pub(super) fn guarded(&self, Guarded { conditions, values }: &Guarded) -> TokenStream {
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
