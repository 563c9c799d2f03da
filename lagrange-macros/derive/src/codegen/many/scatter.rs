//! Loops that add values to elements.
//!
//! Contributions of neighbouring iterations to one element are carried in locals, so each element is written once.

use proc_macro2::{Ident, Span, TokenStream};
use quote::{ToTokens, format_ident, quote};

use super::ManyEmitter;
use super::indices::start_name;
use super::windows::Source;
use crate::mechanics::many::Scatter;
use crate::resolve::many::{Affine, Array, Index, Slot, Unknown};
use crate::symbolic::Id;
use crate::syntax::numbers;

/// Slots that address the same element in successive iterations of a loop: `q[i]` and `q[i + 1]`.
struct Ring<'a> {
    /// Slot with the smallest offset. Later iterations do not reach its element.
    last: &'a Slot,
    /// Axis with the index of the loop.
    axis: usize,
    /// For each slot, its offset from `last` and the index of its value.
    members: Vec<(usize, usize)>,
}

impl ManyEmitter<'_> {
    /// Loops that write the values of all scatters to the elements of `cells`. Loops that reach each element of an array exactly once
    /// come first, and assign an array that no earlier loop reached. All other arrays start from zero.
    pub(super) fn scatters(&self, scatters: &[Scatter]) -> TokenStream {
        let arrays = 0..self.problem.many.arrays.len();
        let covered = |scatter: &Scatter| {
            arrays.clone().filter(|&array| self.covers(scatter, array)).collect::<Vec<_>>()
        };
        let mut order: Vec<(&Scatter, Vec<usize>)> =
            scatters.iter().map(|scatter| (scatter, covered(scatter))).collect();
        order.sort_by_key(|(_, covered)| covered.is_empty());
        let mut reached: Vec<usize> = Vec::new();
        for (scatter, sets) in &mut order {
            sets.retain(|array| !reached.contains(array));
            reached.extend(scatter.values.iter().map(|(k, _)| self.problem.many.slots[*k].array));
        }
        let zero = self.style.constant(0.0);
        let is_set = |array: usize| order.iter().any(|(_, sets)| sets.contains(&array));
        let filled = arrays.filter(|&array| !is_set(array)).map(|array| self.fill(array, &zero));
        let loops = order.iter().map(|(scatter, sets)| {
            let slots: Vec<&Slot> =
                scatter.values.iter().map(|(k, _)| &self.problem.many.slots[*k]).collect();
            let emptied = sets.iter().map(|&array| self.fill(array, &zero)).collect();
            let loops = self.scatter_in((scatter, sets, &emptied), &slots, 0);
            quote! { { #loops } }
        });
        quote! { #(#filled)* #(#loops)* }
    }

    /// Sets all coordinates of an array to zero.
    fn fill(&self, array: usize, zero: &TokenStream) -> TokenStream {
        let (start, count) = (start_name(array), self.style.count(&self.problem.many.arrays[array]));
        quote! {
            for cell in &cells[#start..][..#count] {
                cell.set(#zero);
            }
        }
    }

    /// True if a single loop writes each element of an array exactly once.
    fn covers(&self, scatter: &Scatter, array: usize) -> bool {
        let Array { open, lengths, .. } = &self.problem.many.arrays[array];
        let ([range], [length]) = (&scatter.ranges[..], &open[..]) else { return false };
        let slots: Vec<&Slot> = scatter.values.iter().map(|(k, _)| &self.problem.many.slots[*k]).collect();
        let moving: Vec<usize> =
            (0..slots.len()).filter(|&k| slots[k].array == array && depth_of(slots[k]) == 1).collect();
        let rings = rings(&slots, 1);
        (0..numbers(lengths)).all(|number| {
            let own: Vec<usize> = moving.iter().copied().filter(|&k| slots[k].number == number).collect();
            let ring = rings
                .iter()
                .find(|ring| own.iter().any(|&k| ring.members.iter().any(|(_, place)| *place == k)));
            let (first, width) = match (ring, &own[..]) {
                (Some(ring), own) if own.len() == ring.members.len() => (ring.last, carry_count(ring)),
                (None, [k]) => (slots[*k], 0),
                _ => return false,
            };
            let is_first = first.indices == [Index::Affine(Affine::of(Unknown::Level(0)))];
            is_first && range.from == Affine::number(0) && range.to.plus_number(width as i64) == *length
        })
    }

    /// Loops of a scatter from a depth on, with their accumulators. Elements that the loops do not change, and sums that the last
    /// iteration leaves in locals, are written after them.
    fn scatter_in(
        &self,
        (scatter, sets, emptied): (&Scatter, &[usize], &TokenStream),
        slots: &[&Slot],
        level: usize,
    ) -> TokenStream {
        let roots: Vec<Id> = scatter.values.iter().map(|(_, value)| *value).collect();
        let depth = scatter.ranges.len();
        let Some(range) = scatter.ranges.get(level) else {
            return self.round_of_scatter((slots, sets), depth, &roots);
        };
        let rings = if level + 1 == depth { rings(slots, depth) } else { Vec::new() };
        let mark = self.mark();
        let before = self.sums_before(&roots, level);
        let zero = self.style.constant(0.0);
        let own: Vec<usize> = (0..slots.len()).filter(|&k| depth_of(slots[k]) == level).collect();
        let summed = own.iter().map(|&k| sum_name(k));
        let carried = rings.iter().enumerate().flat_map(|(number, ring)| carry_names(number, ring));
        let written = own.iter().map(|&k| self.add(slots[k], &sum_name(k)));
        let left =
            rings.iter().enumerate().map(|(number, ring)| self.left_over(number, ring, sets)).collect();
        let alone = (0..slots.len()).filter(|k| depth_of(slots[*k]) == level + 1 && !is_carried(&rings, *k));
        let targets: Vec<&Slot> = alone.map(|k| slots[k]).chain(rings.iter().map(|ring| ring.last)).collect();
        let inner = || self.scatter_in((scatter, sets, emptied), slots, level + 1);
        let loops = self.one_loop((level, range), (&roots, &targets), inner, [&left, emptied]);
        self.forget(mark);
        quote! {
            #before
            #(let mut #summed = #zero;)*
            #(let mut #carried = #zero;)*
            #loops
            #(#written)*
        }
    }

    /// One iteration of the innermost loop.
    fn round_of_scatter(
        &self,
        (slots, sets): (&[&Slot], &[usize]),
        depth: usize,
        roots: &[Id],
    ) -> TokenStream {
        let (statements, results) = self.values(roots);
        let names = (0..results.len()).map(value_name);
        let rings = if depth > 0 { rings(slots, depth) } else { Vec::new() };
        let alone = (0..slots.len()).filter(|k| depth_of(slots[*k]) == depth && !is_carried(&rings, *k));
        let alone = alone.map(|k| self.write(slots[k], &value_name(k), sets));
        let outer = (0..slots.len()).filter(|&k| depth_of(slots[k]) < depth);
        let (sums, values): (Vec<Ident>, Vec<Ident>) = outer.map(|k| (sum_name(k), value_name(k))).unzip();
        let carried = rings.iter().enumerate().map(|(number, ring)| self.carry(number, ring, sets));
        quote! {
            #statements
            #(let #names = #results;)*
            #(#alone)*
            #(#sums = #sums + #values;)*
            #(#carried)*
        }
    }

    /// Sets an element, if it is in one of these arrays, or adds to it.
    fn write(&self, slot: &Slot, value: &impl ToTokens, sets: &[usize]) -> TokenStream {
        if !sets.contains(&slot.array) {
            return self.add(slot, value);
        }
        let place = self.style.slot_in(Source::Target(slot.array), slot);
        quote! { #place.set(#value); }
    }

    fn add(&self, slot: &Slot, value: &impl ToTokens) -> TokenStream {
        let place = self.style.slot_in(Source::Target(slot.array), slot);
        quote! {
            let cell = &#place;
            cell.set(cell.get() + #value);
        }
    }

    /// Adds the values of an iteration to the carried sums, and writes the element that no later iteration reaches.
    fn carry(&self, number: usize, ring: &Ring, sets: &[usize]) -> TokenStream {
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
        let written = self.write(ring.last, &value(0), sets);
        let zero = self.style.constant(0.0);
        let next = (1..=names.len()).map(|offset| {
            let value = value(offset);
            if value.is_empty() { zero.clone() } else { value }
        });
        quote! { #written #(#names = #next;)* }
    }

    /// Writes the carried sums after the last iteration, with the running index at the end of the range.
    fn left_over(&self, number: usize, ring: &Ring, sets: &[usize]) -> TokenStream {
        let names = carry_names(number, ring);
        let writes = names.iter().enumerate().map(|(offset, name)| {
            let mut slot = ring.last.clone();
            if let Index::Affine(index) = &mut slot.indices[ring.axis] {
                *index = index.plus_number(offset as i64);
            }
            self.write(&slot, name, sets)
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

/// Locals that carry sums to the next iteration: one for each offset below the largest.
fn carry_names(number: usize, ring: &Ring) -> Vec<Ident> {
    (0..carry_count(ring))
        .map(|offset| format_ident!("carried{number}_{offset}", span = Span::mixed_site()))
        .collect()
}

fn carry_count(ring: &Ring) -> usize {
    ring.members.iter().map(|(offset, _)| *offset).max().unwrap_or(0)
}

/// Number of nested loops that determine the element of a slot.
fn depth_of(slot: &Slot) -> usize {
    slot.indices.iter().flat_map(Index::levels).map(|level| level + 1).max().unwrap_or(0)
}

/// Largest offset between carried slots, in elements. Each offset takes one of the 16 vector registers of x86-64; half of them are
/// left for the values of an iteration.
const WIDTH: i64 = 8;

fn is_carried(rings: &[Ring], value: usize) -> bool {
    rings.iter().any(|ring| ring.members.iter().any(|(_, place)| *place == value))
}

/// Groups slots that address the same element in successive iterations of the innermost loop.
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

/// Axis whose index increases by one per iteration of the loop at this depth, the constant of the index, and the slot without it.
fn without_offset(slot: &Slot, level: usize) -> Option<(usize, i64, Slot)> {
    let mut moving = slot.indices.iter().enumerate().filter(|(_, index)| index.levels().contains(&level));
    let (Some((axis, Index::Affine(index))), None) = (moving.next(), moving.next()) else { return None };
    (index.factor(Unknown::Level(level)) == 1).then_some(())?;
    let mut key = slot.clone();
    key.indices[axis] = Index::Affine(Affine { constant: 0, ..index.clone() });
    Some((axis, index.constant, key))
}
