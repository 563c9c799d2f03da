//! Reads elements of arrays in loops: indices, bounds of ranges, and inputs.

use std::collections::BTreeSet;

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{format_ident, quote};

use super::windows::Source;
use crate::codegen::style::FunctionContext;
use crate::resolve::Entry;
use crate::resolve::many::{Affine, Array, Index, LengthSource, Range, Slot, Unknown};
use crate::symbolic::Symbol;
use crate::syntax::{FieldShape, numbers};
use crate::variables::Variable;

/// Running index of the loop at a depth, of type `usize`.
pub(super) fn round(level: usize) -> Ident {
    format_ident!("round{level}", span = Span::mixed_site())
}

fn length_name(length: usize) -> Ident {
    format_ident!("length{length}", span = Span::mixed_site())
}

pub(super) fn start_name(array: usize) -> Ident {
    format_ident!("start{array}", span = Span::mixed_site())
}

impl FunctionContext<'_> {
    /// Bindings of the lengths, and of the first coordinate of each array: the statements that every function begins with.
    pub(super) fn lengths(&self) -> TokenStream {
        let lengths = (0..self.problem.many.lengths.len()).map(|k| {
            let (name, value) = (length_name(k), self.length(k));
            quote! { let #name: usize = #value; }
        });
        let mut before: Vec<TokenStream> = Vec::new();
        let starts = self.problem.many.arrays.iter().enumerate().map(|(array, known)| {
            let (name, count) = (start_name(array), self.count(known));
            let value = if before.is_empty() { quote!(0) } else { quote!(#(#before)+*) };
            before = vec![quote!(#name), count];
            quote! { let #name: usize = #value; }
        });
        quote! { #(#lengths)* #(#starts)* }
    }

    fn length(&self, k: usize) -> TokenStream {
        let (system, fields) = (&self.system, &self.problem.parameters.fields);
        match &self.problem.many.lengths[k].source {
            LengthSource::Field(field) => {
                let ident = &fields[*field].ident;
                quote!(#system.#ident)
            }
            LengthSource::Of(field) => {
                let ident = &fields[*field].ident;
                quote!(#system.#ident.len())
            }
            LengthSource::Constant(ident) => quote!(#ident),
        }
    }

    /// Number of the coordinates of an array.
    pub(super) fn count(&self, array: &Array) -> TokenStream {
        let lengths = array.open.iter().map(|length| self.bound(length));
        let inner = Literal::usize_unsuffixed(numbers(&array.lengths));
        quote!(#(#lengths *)* #inner)
    }

    /// Number of all coordinates.
    pub(super) fn count_of_all(&self) -> TokenStream {
        let counts = self.problem.many.coordinates().iter().map(|array| self.count(array));
        quote!(#(#counts)+*)
    }

    /// A whole number that is not negative, of type `usize`.
    pub(super) fn affine(&self, affine: &Affine) -> TokenStream {
        self.whole(affine, &|sum, part| quote!(#sum - #part))
    }

    /// The same, or 0 where it would be negative.
    pub(super) fn bound(&self, affine: &Affine) -> TokenStream {
        self.whole(affine, &|sum, part| quote!((#sum).saturating_sub(#part)))
    }

    /// Positive parts come first, so that no partial sum is negative.
    fn whole(&self, affine: &Affine, minus: &dyn Fn(TokenStream, TokenStream) -> TokenStream) -> TokenStream {
        let part = |(unknown, factor): &(Unknown, i64)| {
            let name = match unknown {
                Unknown::Level(level) => round(*level),
                Unknown::Length(length) => length_name(*length),
            };
            match factor.unsigned_abs() {
                1 => quote!(#name),
                factor => {
                    let factor = Literal::u64_unsuffixed(factor);
                    quote!(#factor * #name)
                }
            }
        };
        let constant = Literal::u64_unsuffixed(affine.constant.unsigned_abs());
        let mut plus: Vec<TokenStream> =
            affine.terms.iter().filter(|(_, factor)| *factor > 0).map(part).collect();
        let mut less: Vec<TokenStream> =
            affine.terms.iter().filter(|(_, factor)| *factor < 0).map(part).collect();
        match affine.constant {
            0 => {}
            1.. => plus.push(quote!(#constant)),
            _ => less.push(quote!(#constant)),
        }
        let sum = if plus.is_empty() { quote!(0usize) } else { quote!(#(#plus)+*) };
        let sum = if less.is_empty() { sum } else { less.into_iter().fold(sum, minus) };
        quote!((#sum))
    }

    pub(super) fn range(&self, range: &Range) -> TokenStream {
        let (from, to) = (self.bound(&range.from), self.bound(&range.to));
        quote!(#from..#to)
    }

    /// Nested loops around statements.
    pub(super) fn nested(&self, ranges: &[Range], inner: TokenStream) -> TokenStream {
        ranges.iter().enumerate().rfold(quote!({ #inner }), |inner, (level, range)| {
            let (index, range) = (round(level), self.range(range));
            quote! { for #index in #range { #inner } }
        })
    }

    pub(super) fn index(&self, index: &Index) -> TokenStream {
        match index {
            Index::Affine(affine) => self.affine(affine),
            Index::Entry(field, path) => {
                let (system, field) = (&self.system, self.problem.many.fields[*field].field);
                let ident = &self.problem.parameters.fields[field].ident;
                let path = path.iter().map(|index| self.affine(index));
                quote!(#system.#ident #([#path])*)
            }
        }
    }

    /// Place of a slot among all coordinates.
    pub(super) fn place_of_slot(&self, Slot { array, indices, number }: &Slot) -> TokenStream {
        let Array { open, lengths, .. } = &self.problem.many.arrays[*array];
        let mut element = quote!(0);
        for (axis, (index, length)) in indices.iter().zip(open).enumerate() {
            let index = self.index(index);
            element = match axis {
                0 => index,
                _ => {
                    let length = self.bound(length);
                    quote!((#element * #length + #index))
                }
            };
        }
        let (inner, number) = (numbers(lengths), Literal::usize_unsuffixed(*number));
        let element = match inner {
            1 => element,
            inner => {
                let inner = Literal::usize_unsuffixed(inner);
                quote!(#element * #inner)
            }
        };
        let start = (*array > 0).then(|| start_name(*array)).into_iter();
        quote!(#(#start +)* #element + #number)
    }

    /// Place expression of a number in an element of a field; `None` if the entry is in no such field.
    fn place_in_element(&self, Entry { field, number }: Entry) -> Option<TokenStream> {
        let (element, _) = self.problem.many.elements.iter().find(|(_, place)| *place == field)?;
        let system = &self.system;
        let ident = &self.problem.parameters.fields[field].ident;
        let window = self.in_window(Source::Field(element.field), std::slice::from_ref(&element.index));
        let element = window.unwrap_or_else(|| {
            let index = self.index(&element.index);
            quote!(#system.#ident[#index])
        });
        let FieldShape { layout, .. } = self.problem.parameters.fields[field].shape.as_ref().ok()?;
        let indices = layout.indices(number);
        let (arrays, inside) = indices.split_at(layout.arrays());
        let literal = |k: &usize| Literal::usize_unsuffixed(*k);
        let arrays = arrays.iter().map(literal);
        let place = quote!(#element #([#arrays])*);
        Some(match inside {
            [k] => {
                let k = literal(&((k + 3) % 4));
                quote!(#place.coords[#k])
            }
            [i, j] => {
                let (i, j) = (literal(i), literal(j));
                quote!(#place[(#i, #j)])
            }
            _ => place,
        })
    }

    /// Bindings of the inputs that a loop body reads. Sums, forces and guarded terms are bound already.
    pub(in crate::codegen) fn inputs_of_loops(&self, used: &BTreeSet<Symbol>) -> TokenStream {
        let lets = used.iter().filter_map(|symbol| {
            let (name, value) = (&self.names[symbol], self.read_in_loop(*symbol)?);
            Some(quote! { let #name = #value; })
        });
        lets.collect()
    }

    fn read_in_loop(&self, symbol: Symbol) -> Option<TokenStream> {
        let slot = |k: usize| &self.problem.many.slots[k];
        let number = |value: TokenStream| {
            let scalar = self.types.scalar;
            quote!(<#scalar as __lagrange::Scalar>::constant(#value as f64))
        };
        Some(match Variable::of(symbol) {
            Variable::Time => quote!(t),
            Variable::Coordinate(k) => self.slot_in(Source::Coordinates(slot(k).array), slot(k)),
            Variable::Velocity(k) => self.slot_in(Source::Velocities(slot(k).array), slot(k)),
            Variable::Parameter(k) => {
                let entry = self.problem.parameters.entries[k];
                self.place_in_element(entry).unwrap_or_else(|| self.parameter(k))
            }
            Variable::Level(level) => {
                let round = round(level);
                number(quote!(#round))
            }
            Variable::Length(length) => {
                let length = length_name(length);
                number(quote!(#length))
            }
            _ => return None,
        })
    }
}
