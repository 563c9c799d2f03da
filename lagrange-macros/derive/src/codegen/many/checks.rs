//! Checks of lengths and indices, names of coordinates, and the numbers of all fields.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::ManyEmitter;
use crate::resolve::many::{Affine, Array, Demand, Index, OpenField, Unknown};
use crate::syntax::numbers;

impl ManyEmitter<'_> {
    pub(super) fn write_name(&self) -> TokenStream {
        let lengths = self.style.lengths();
        let arrays = self.problem.many.coordinates().iter().map(|array| {
            let (count, written) = (self.style.count(array), self.written(array));
            quote! {
                let count: usize = #count;
                if rest < count {
                    return #written;
                }
                rest -= count;
            }
        });
        quote! {
            fn write_name(&self, coordinate: usize, to: &mut dyn ::core::fmt::Write) -> ::core::fmt::Result {
                #lengths
                let mut rest = coordinate;
                #(#arrays)*
                ::core::result::Result::Ok(())
            }
        }
    }

    /// Writes the name of the coordinate `rest` of an array.
    fn written(&self, Array { name, open, lengths, .. }: &Array) -> TokenStream {
        let known = lengths.iter().map(|&length| {
            let length = Literal::usize_unsuffixed(length);
            quote!(#length)
        });
        let all: Vec<TokenStream> = open.iter().map(|length| self.style.bound(length)).chain(known).collect();
        let index = |axis: usize| {
            let (length, behind) = (&all[axis], &all[axis + 1..]);
            quote!(rest / (1 #(* #behind)*) % #length)
        };
        let indices = (0..all.len()).map(index);
        let format = format!("{name}{}", "[{}]".repeat(all.len()));
        quote!(::core::write!(to, #format, #(#indices),*))
    }

    pub(super) fn check(&self) -> TokenStream {
        let lengths = self.style.lengths();
        let fields = self.problem.many.fields.iter().map(|field| self.check_length(field));
        let demands = self.problem.many.demands.iter().map(|demand| self.check_demand(demand));
        quote! {
            fn check(&self) -> ::core::result::Result<(), __lagrange::Error> {
                #lengths
                #(#fields)*
                #(#demands)*
                ::core::result::Result::Ok(())
            }
        }
    }

    fn check_length(&self, OpenField { field, length, .. }: &OpenField) -> TokenStream {
        let field = &self.problem.parameters.fields[*field];
        let (ident, name) = (&field.ident, &field.name.text);
        let (of, expected) =
            (length.text(|unknown| self.problem.many.name(unknown)), self.style.bound(length));
        quote! {
            if self.#ident.len() != #expected {
                return ::core::result::Result::Err(__lagrange::Error::FieldLength {
                    field: #name, found: self.#ident.len(), expected: #expected, of: #of,
                });
            }
        }
    }

    /// Checks an index in all iterations of its loops.
    fn check_demand(&self, Demand { name, ranges, index, within }: &Demand) -> TokenStream {
        let (from, to) = (self.style.bound(&within.from), self.style.bound(&within.to));
        let (value, is_wrong, error) = match index {
            Index::Affine(affine) => (
                self.signed(affine),
                quote!(!(#from as i64..#to as i64).contains(&value)),
                quote!(ElementMissing { array: #name, index: value, from: #from, to: #to }),
            ),
            Index::Entry(field, path) => {
                let field = &self.problem.parameters.fields[self.problem.many.fields[*field].field].name.text;
                let entry = self.style.affine(&path[0]);
                let error = quote!(FieldIndex { field: #field, entry: #entry, index: value, length: #to });
                (self.style.index(index), quote!(value >= #to), error)
            }
        };
        let inner = quote! {
            let value = #value;
            if #is_wrong {
                return ::core::result::Result::Err(__lagrange::Error::#error);
            }
        };
        self.style.nested(ranges, inner)
    }

    /// A whole number of type `i64`, which may be negative.
    fn signed(&self, affine: &Affine) -> TokenStream {
        let parts = affine.terms.iter().map(|(unknown, factor)| {
            let one = self.style.affine(&Affine::of(*unknown));
            let factor = Literal::i64_suffixed(*factor);
            quote!((#factor) * #one as i64)
        });
        let constant = Literal::i64_suffixed(affine.constant);
        quote!(#(#parts +)* (#constant))
    }

    pub(super) fn visit_numbers(&self) -> TokenStream {
        let scalar = self.style.types.scalar;
        let is_virtual = |field: usize| self.problem.many.elements.iter().any(|(_, place)| *place == field);
        let entries = &self.problem.parameters.entries;
        let single =
            self.problem.parameters.by_field().into_iter().filter(|&k| !is_virtual(entries[k].field));
        let single = single.map(|k| self.style.parameter(k));
        let whole = |number: TokenStream| quote!(<#scalar as __lagrange::Scalar>::constant(#number as f64));
        let lengths = (0..self.problem.many.lengths.len())
            .map(|k| whole(self.style.affine(&Affine::of(Unknown::Length(k)))));
        let fields = self.problem.many.fields.iter().map(|field| {
            let ident = &self.problem.parameters.fields[field.field].ident;
            let Ok(shape) = &field.element else { return TokenStream::new() };
            let numbers = (0..numbers(&shape.layout.lengths)).map(|number| {
                let indices = shape.layout.indices(number);
                let (arrays, inside) = indices.split_at(shape.layout.arrays());
                let element = quote!(element #([#arrays])*);
                let number = match inside {
                    [k] => {
                        let k = (k + 3) % 4;
                        quote!(#element.coords[#k])
                    }
                    [i, j] => quote!(#element[(#i, #j)]),
                    _ if arrays.is_empty() => quote!((*element)),
                    _ => element,
                };
                if field.is_table { whole(number) } else { number }
            });
            quote! { for element in self.#ident.iter() { #(visit(#numbers);)* } }
        });
        let starts = self.style.lengths();
        quote! {
            fn visit_numbers(&self, visit: &mut dyn ::core::ops::FnMut(#scalar)) {
                #starts
                #(visit(#single);)*
                #(visit(#lengths);)*
                #(#fields)*
            }
        }
    }
}
