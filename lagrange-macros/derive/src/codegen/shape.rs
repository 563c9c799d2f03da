//! Shapes of the results of functions.

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{format_ident, quote};

#[derive(Clone, Copy)]
pub(super) enum ResultShape {
    Number,
    Vector(usize),
    /// Array of arrays: their number, and the length of each.
    Matrix(usize, usize),
}

impl ResultShape {
    pub(super) fn length(self) -> usize {
        match self {
            Self::Number => 1,
            Self::Vector(length) => length,
            Self::Matrix(arrays, entries) => arrays * entries,
        }
    }

    /// Emits the next values as a literal of this shape.
    pub(super) fn literal(self, values: &mut impl Iterator<Item = TokenStream>) -> TokenStream {
        let mut vector = |length| {
            let values = values.by_ref().take(length);
            quote!([#(#values),*])
        };
        match self {
            Self::Number => values.take(1).collect(),
            Self::Vector(length) => vector(length),
            Self::Matrix(arrays, entries) => {
                let arrays = (0..arrays).map(|_| vector(entries));
                quote!([#(#arrays),*])
            }
        }
    }

    /// Array type of this shape. A number is an array of length 1.
    fn array(self, scalar: &syn::Type) -> TokenStream {
        match self {
            Self::Number => quote!([#scalar; 1]),
            Self::Vector(length) => quote!([#scalar; #length]),
            Self::Matrix(arrays, entries) => quote!([[#scalar; #entries]; #arrays]),
        }
    }

    /// Array of this shape filled with one value.
    fn filled(self, value: &TokenStream) -> TokenStream {
        match self {
            Self::Number => quote!([#value]),
            Self::Vector(length) => quote!([#value; #length]),
            Self::Matrix(arrays, entries) => quote!([[#value; #entries]; #arrays]),
        }
    }

    /// Place expression of an entry of the array.
    fn place(self, array: &Ident, index: usize) -> TokenStream {
        let literal = Literal::usize_unsuffixed;
        match self {
            Self::Number | Self::Vector(_) => {
                let index = literal(index);
                quote!(#array[#index])
            }
            Self::Matrix(_, entries) => {
                let (outer, inner) = (literal(index / entries), literal(index % entries));
                quote!(#array[#outer][#inner])
            }
        }
    }
}

/// Arrays into which a function writes its results, one per shape.
pub(super) struct ResultArrays<'s> {
    pub(super) names: Vec<Ident>,
    shapes: &'s [ResultShape],
}

impl<'s> ResultArrays<'s> {
    pub(super) fn new(shapes: &'s [ResultShape]) -> Self {
        let name = |k| format_ident!("entries{k}", span = Span::mixed_site());
        Self { names: (0..shapes.len()).map(name).collect(), shapes }
    }

    pub(super) fn declarations(&self, zero: &TokenStream) -> TokenStream {
        let (names, values) = (&self.names, self.shapes.iter().map(|shape| shape.filled(zero)));
        quote! { #(let mut #names = #values;)* }
    }

    pub(super) fn types(&self, scalar: &syn::Type) -> Vec<TokenStream> {
        self.shapes.iter().map(|shape| shape.array(scalar)).collect()
    }

    /// Place expression of a result, by its index among all results.
    pub(super) fn place(&self, mut index: usize) -> TokenStream {
        for (name, shape) in self.names.iter().zip(self.shapes) {
            if index < shape.length() {
                return shape.place(name, index);
            }
            index -= shape.length();
        }
        TokenStream::new()
    }

    /// Expressions of the whole results, one per shape.
    pub(super) fn results(&self) -> Vec<TokenStream> {
        let shapes = self.names.iter().zip(self.shapes);
        let result = |(name, shape): (&Ident, &ResultShape)| match shape {
            ResultShape::Number => shape.place(name, 0),
            ResultShape::Vector(_) | ResultShape::Matrix(..) => quote!(#name),
        };
        shapes.map(result).collect()
    }
}
