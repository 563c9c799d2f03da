//! Windows on arrays: the elements that successive iterations of a loop read or write, as a slice of the length of the loop.
//!
//! rustc then sees that no index of an iteration is out of range.

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{format_ident, quote};

use super::ManyEmitter;
use super::indices::round;
use crate::codegen::style::FunctionContext;
use crate::resolve::many::{FieldElement, Index, Range, Slot, Unknown};
use crate::symbolic::Id;
use crate::syntax::numbers;
use crate::variables::Variable;

/// Slice with one element for each iteration of a loop.
#[derive(Clone)]
pub(in crate::codegen) struct Window {
    source: Source,
    indices: Vec<Index>,
    /// Depth of the loop.
    level: usize,
    name: Ident,
}

/// Array that a window borrows from.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Source {
    /// Coordinates of an array, the argument `q`.
    Coordinates(usize),
    /// Velocities of an array, the argument `v`.
    Velocities(usize),
    /// Results of the function for an array, in `cells`.
    Target(usize),
    /// An open field.
    Field(usize),
}

/// Number of the iteration of the loop at a depth, from 0.
fn step(level: usize) -> Ident {
    format_ident!("step{level}", span = Span::mixed_site())
}

/// Range of the loop at a depth.
pub(super) fn range_name(level: usize) -> Ident {
    format_ident!("range{level}", span = Span::mixed_site())
}

impl FunctionContext<'_> {
    /// An element in its window; `None` if it is in none.
    pub(super) fn in_window(&self, source: Source, indices: &[Index]) -> Option<TokenStream> {
        let windows = self.windows.borrow();
        let window = windows.iter().find(|window| window.source == source && window.indices == indices)?;
        let (name, step) = (&window.name, step(window.level));
        Some(quote!(#name[#step]))
    }

    /// Place expression of a slot.
    pub(super) fn slot_in(&self, source: Source, slot: &Slot) -> TokenStream {
        let number = Literal::usize_unsuffixed(slot.number);
        if let Some(element) = self.in_window(source, &slot.indices) {
            return quote!(#element[#number]);
        }
        let place = self.place_of_slot(slot);
        let all = whole(source);
        quote!(#all[#place])
    }
}

/// Vector that contains a window.
fn whole(source: Source) -> TokenStream {
    match source {
        Source::Coordinates(_) => quote!(q),
        Source::Velocities(_) => quote!(v),
        Source::Target(_) | Source::Field(_) => quote!(cells),
    }
}

impl ManyEmitter<'_> {
    /// Emits a loop over a range: `inner` emits one iteration, `last` follows the loop with the running index at the end of the range,
    /// and `otherwise` replaces both if the range is empty. An iteration computes `roots` and writes `targets`.
    pub(super) fn one_loop(
        &self,
        (level, range): (usize, &Range),
        (roots, targets): (&[Id], &[&Slot]),
        inner: impl FnOnce() -> TokenStream,
        [last, otherwise]: [&TokenStream; 2],
    ) -> TokenStream {
        let known = self.style.windows.borrow().len();
        let windows = self.open_windows(level, roots, targets);
        let inner = inner();
        self.style.windows.borrow_mut().truncate(known);
        let (index, step, bounds, range) =
            (round(level), step(level), range_name(level), self.style.range(range));
        let last = (!last.is_empty()).then(|| {
            quote! {
                let #index: usize = #bounds.end;
                #last
            }
        });
        let otherwise = (!otherwise.is_empty()).then(|| quote! { else { #otherwise } });
        quote! {
            let #bounds: ::core::ops::Range<usize> = #range;
            if !#bounds.is_empty() {
                #windows
                for #step in 0..#bounds.len() {
                    let #index: usize = #bounds.start + #step;
                    #inner
                }
                #last
            }
            #otherwise
        }
    }

    /// Declares the windows of a loop, for use in its body.
    fn open_windows(&self, level: usize, roots: &[Id], targets: &[&Slot]) -> TokenStream {
        let many = &self.problem.many;
        let mut elements: Vec<(Source, Vec<Index>)> = Vec::new();
        let graph = self.style.graph;
        let mut symbols: Vec<_> = graph.symbols(&many.with_bodies_from(graph, roots, level + 1)).collect();
        symbols.sort_unstable();
        for symbol in symbols {
            let element = match Variable::of(symbol) {
                Variable::Coordinate(k) => {
                    (Source::Coordinates(many.slots[k].array), many.slots[k].indices.clone())
                }
                Variable::Velocity(k) => {
                    (Source::Velocities(many.slots[k].array), many.slots[k].indices.clone())
                }
                Variable::Parameter(k) => match self.field_element(k) {
                    Some(FieldElement { field, index }) => (Source::Field(*field), vec![index.clone()]),
                    None => continue,
                },
                _ => continue,
            };
            elements.push(element);
        }
        elements.extend(targets.iter().map(|slot| (Source::Target(slot.array), slot.indices.clone())));
        let mut declarations = TokenStream::new();
        for (source, indices) in elements {
            let is_known = self.style.in_window(source, &indices).is_some();
            if !is_known && runs_along(&indices, level) {
                let number = self.style.windows.borrow().len();
                let name = format_ident!("window{number}", span = Span::mixed_site());
                declarations.extend(self.declaration(level, source, &indices, &name));
                self.style.windows.borrow_mut().push(Window { source, indices, level, name });
            }
        }
        declarations
    }

    /// The element of a field that a parameter is a number of.
    fn field_element(&self, parameter: usize) -> Option<&FieldElement> {
        let field = self.problem.parameters.entries[parameter].field;
        self.problem.many.elements.iter().find(|(_, place)| *place == field).map(|(element, _)| element)
    }

    /// The window, from the element of the first iteration.
    fn declaration(&self, level: usize, source: Source, indices: &[Index], name: &Ident) -> TokenStream {
        let (index, bounds) = (round(level), range_name(level));
        let window = match source {
            Source::Field(field) => {
                let field = self.problem.many.fields[field].field;
                let (system, ident) = (&self.style.system, &self.problem.parameters.fields[field].ident);
                let first = self.style.index(&indices[0]);
                quote!(&#system.#ident[#first..][..#bounds.len()])
            }
            Source::Coordinates(array) | Source::Velocities(array) | Source::Target(array) => {
                let slot = Slot { array, indices: indices.to_vec(), number: 0 };
                let (first, all) = (self.style.place_of_slot(&slot), whole(source));
                let length = Literal::usize_unsuffixed(numbers(&self.problem.many.arrays[array].lengths));
                quote!(__lagrange::generated::window::<_, #length>(&#all[#first..], #bounds.len()))
            }
        };
        quote! {
            let #name = {
                let #index: usize = #bounds.start;
                #window
            };
        }
    }
}

/// True if successive iterations of the loop at this depth use successive elements, known from the loops around it.
fn runs_along(indices: &[Index], level: usize) -> bool {
    let Some((Index::Affine(last), others)) = indices.split_last() else { return false };
    let own = Unknown::Level(level);
    last.factor(own) == 1
        && last.levels().all(|known| known <= level)
        && others.iter().all(|index| index.levels().iter().all(|known| *known < level))
}
