//! Loops that add values to elements.
//!
//! What neighbouring rounds add to one element is carried from round to round in locals, so that each element is written once.

use proc_macro2::{Ident, Span, TokenStream};
use quote::{ToTokens, format_ident, quote};

use super::ManyEmitter;
use super::indices::round;
use crate::mechanics::many::Scatter;
use crate::resolve::many::{Affine, Index, Range, Slot, Unknown};
use crate::symbolic::Id;

/// Slots that are one element of an array in successive rounds of a loop, with the places of their values.
struct Ring<'a> {
    /// The slot of the least offset: its element is not reached by later rounds.
    last: &'a Slot,
    /// Axis with the index of the loop.
    axis: usize,
    /// Offset from the least one, and place of the value, of each slot.
    members: Vec<(usize, usize)>,
}

impl ManyEmitter<'_> {
    /// Loops that add the values of a scatter to the elements of a vector of all coordinates.
    pub(super) fn scatter(&self, target: &TokenStream, scatter: &Scatter) -> TokenStream {
        let roots: Vec<Id> = scatter.values.iter().map(|(_, value)| *value).collect();
        let (statements, results) = self.values(&roots);
        let names = (0..results.len()).map(value_name);
        let slots: Vec<&Slot> = scatter.values.iter().map(|(k, _)| &self.problem.many.slots[*k]).collect();
        let depth = scatter.ranges.len();
        let rings = if depth > 0 { rings(&slots, depth) } else { Vec::new() };
        let alone = (0..slots.len()).filter(|k| depth_of(slots[*k]) == depth && !is_carried(&rings, *k));
        let alone = alone.map(|k| self.add(target, slots[k], &value_name(k)));
        let outer = (0..slots.len()).filter(|&k| depth_of(slots[k]) < depth);
        let (sums, values): (Vec<Ident>, Vec<Ident>) = outer.map(|k| (sum_name(k), value_name(k))).unzip();
        let carried = rings.iter().enumerate().map(|(number, ring)| self.carry(target, number, ring));
        let round = quote! {
            #statements
            #(let #names = #results;)*
            #(#alone)*
            #(#sums = #sums + #values;)*
            #(#carried)*
        };
        let loops = (0..depth).rev().fold(round, |round, level| {
            let rings = if level + 1 == depth { &rings[..] } else { &[] };
            self.one_loop(target, (level, &scatter.ranges[level]), (&slots, rings), &round)
        });
        quote! { { #loops } }
    }

    /// A loop, with the locals that it sums in, and what is written after it: elements that it does not change, and what its
    /// last round has left.
    fn one_loop(
        &self,
        target: &TokenStream,
        (level, range): (usize, &Range),
        (slots, rings): (&[&Slot], &[Ring]),
        inner: &TokenStream,
    ) -> TokenStream {
        let (zero, index, end) = (self.style.constant(0.0), round(level), self.style.bound(&range.to));
        let range = self.style.range(range);
        let own = (0..slots.len()).filter(|&k| depth_of(slots[k]) == level).collect::<Vec<_>>();
        let summed = own.iter().map(|&k| sum_name(k));
        let carried = rings.iter().enumerate().flat_map(|(number, ring)| carry_names(number, ring));
        let written = own.iter().map(|&k| self.add(target, slots[k], &sum_name(k)));
        let left = rings.iter().enumerate().map(|(number, ring)| self.left_over(target, number, ring));
        let left = (!rings.is_empty()).then(|| {
            quote! {
                if !range.is_empty() {
                    let #index: usize = #end;
                    #(#left)*
                }
            }
        });
        quote! {
            #(let mut #summed = #zero;)*
            #(let mut #carried = #zero;)*
            let range = #range;
            for #index in range.clone() { #inner }
            #left
            #(#written)*
        }
    }

    fn add(&self, target: &TokenStream, slot: &Slot, value: &impl ToTokens) -> TokenStream {
        let place = self.style.place_of_slot(slot);
        quote! { let place = #place; #target[place] = #target[place] + #value; }
    }

    /// Adds the values of a round to what earlier rounds have left, and writes the element that no later round reaches.
    fn carry(&self, target: &TokenStream, number: usize, ring: &Ring) -> TokenStream {
        let names = carry_names(number, ring);
        let value = |offset: usize| {
            let own = ring
                .members
                .iter()
                .filter(|(known, _)| *known == offset)
                .map(|(_, place)| value_name(*place));
            let carried = names.get(offset);
            let parts: Vec<TokenStream> =
                carried.into_iter().map(|name| quote!(#name)).chain(own.map(|name| quote!(#name))).collect();
            quote!(#(#parts)+*)
        };
        let written = self.add(target, ring.last, &value(0));
        let zero = self.style.constant(0.0);
        let next = (1..=names.len()).map(|offset| {
            let value = value(offset);
            if value.is_empty() { zero.clone() } else { value }
        });
        quote! { #written #(#names = #next;)* }
    }

    /// Writes what the last round has left, where the running index is the end of the range.
    fn left_over(&self, target: &TokenStream, number: usize, ring: &Ring) -> TokenStream {
        let names = carry_names(number, ring);
        let writes = names.iter().enumerate().map(|(offset, name)| {
            let mut slot = ring.last.clone();
            if let Index::Affine(index) = &mut slot.indices[ring.axis] {
                *index = index.plus_number(offset as i64);
            }
            self.add(target, &slot, name)
        });
        writes.collect()
    }
}

fn value_name(place: usize) -> Ident {
    format_ident!("value{place}", span = Span::mixed_site())
}

fn sum_name(place: usize) -> Ident {
    format_ident!("sum{place}", span = Span::mixed_site())
}

/// Locals that carry sums from round to round: one for each offset but the largest, whose element no earlier round has reached.
fn carry_names(number: usize, ring: &Ring) -> Vec<Ident> {
    let most = ring.members.iter().map(|(offset, _)| *offset).max().unwrap_or(0);
    (0..most).map(|offset| format_ident!("carried{number}_{offset}", span = Span::mixed_site())).collect()
}

/// Number of loops that have to be entered before the element of a slot is known.
fn depth_of(slot: &Slot) -> usize {
    slot.indices.iter().flat_map(Index::levels).map(|level| level + 1).max().unwrap_or(0)
}

/// Largest distance of slots that are carried: locals for more would spill.
const WIDTH: i64 = 8;

fn is_carried(rings: &[Ring], value: usize) -> bool {
    rings.iter().any(|ring| ring.members.iter().any(|(_, place)| *place == value))
}

/// Groups of slots that are one element in successive rounds of the innermost of so many loops.
fn rings<'a>(slots: &[&'a Slot], depth: usize) -> Vec<Ring<'a>> {
    let mut groups: Vec<(Slot, usize, Vec<(i64, usize)>)> = Vec::new();
    for (k, slot) in slots.iter().enumerate() {
        let Some((axis, offset, key)) = without_offset(slot, depth - 1) else { continue };
        match groups.iter_mut().find(|(known, ..)| *known == key) {
            Some((.., members)) => members.push((offset, k)),
            None => groups.push((key, axis, vec![(offset, k)])),
        }
    }
    let ring = |(_, axis, mut members): (Slot, usize, Vec<(i64, usize)>)| {
        members.sort_unstable();
        let (least, last) = members[0];
        let most = members[members.len() - 1].0;
        let members = members.into_iter().map(|(offset, place)| ((offset - least) as usize, place)).collect();
        (1..=WIDTH).contains(&(most - least)).then_some(Ring { last: slots[last], axis, members })
    };
    groups.into_iter().filter_map(ring).collect()
}

/// Axis whose index grows with the loop at this depth by one in each round, its constant, and the slot without it.
fn without_offset(slot: &Slot, level: usize) -> Option<(usize, i64, Slot)> {
    let mut moving = slot.indices.iter().enumerate().filter(|(_, index)| index.levels().contains(&level));
    let (Some((axis, Index::Affine(index))), None) = (moving.next(), moving.next()) else { return None };
    (index.factor(Unknown::Level(level)) == 1).then_some(())?;
    let mut key = slot.clone();
    key.indices[axis] = Index::Affine(Affine { constant: 0, ..index.clone() });
    Some((axis, index.constant, key))
}
