//! Signatures of trait methods, with the types of one system.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use crate::contract::{Argument, Dimension, Gives, Method};

/// Number type and dimensions of a system.
#[derive(Clone, Copy)]
pub(super) struct Types<'a> {
    pub(super) scalar: &'a syn::Type,
    /// Number of coordinates. `None` if it is unknown; the stubs are then generic over it.
    pub(super) coordinates: Option<usize>,
    pub(super) constraints: usize,
    pub(super) parameters: usize,
}

/// Type parameter for numbers into which scalars of the system broadcast.
pub(super) fn wide() -> syn::Type {
    syn::parse_quote!(__S)
}

impl Types<'_> {
    pub(super) fn signature(&self, method: &Method) -> TokenStream {
        let name = format_ident!("{}", method.name);
        let wide = wide();
        let types = if method.is_wide { Types { scalar: &wide, ..*self } } else { *self };
        let generics = method.is_wide.then(|| self.over());
        let arguments = method.takes.iter().map(|&argument| types.argument(argument));
        let returns = types.returns(method.gives);
        quote!(fn #name #generics(#(#arguments),*) -> #returns)
    }

    /// Generic parameter of a method that accepts such numbers.
    pub(super) fn over(&self) -> TokenStream {
        let (wide, scalar) = (wide(), self.scalar);
        quote!(<#wide: __lagrange::Broadcast<#scalar>>)
    }

    /// Signature of the method of an observable, a number or an array of these lengths.
    pub(super) fn of_observable(&self, name: &Ident, lengths: &[usize], needs_solution: bool) -> TokenStream {
        let takes =
            &[Argument::System, Argument::State, Argument::Solution][..2 + usize::from(needs_solution)];
        let arguments = takes.iter().map(|&argument| self.argument(argument));
        let generic = self.open().map(|n| quote!(<#n>));
        let returns = match lengths {
            [] => self.returns(Gives::Number),
            [length, ..] => {
                let columns = lengths.get(1).unwrap_or(&1);
                self.matrix(&quote!(#length), &quote!(#columns))
            }
        };
        quote!(fn #name #generic(#(#arguments),*) -> #returns)
    }

    /// Number of coordinates as a const generic parameter. `None` if the number is known.
    pub(super) fn open(&self) -> Option<TokenStream> {
        let [n, ..] = self.dimensions();
        self.coordinates.is_none().then(|| quote!(const #n: usize))
    }

    /// Dimensions N, M and P as tokens.
    pub(super) fn dimensions(&self) -> [TokenStream; 3] {
        let (m, p) = (self.constraints, self.parameters);
        [self.coordinates.map_or_else(|| quote!(__N), |n| quote!(#n)), quote!(#m), quote!(#p)]
    }

    fn dimension(&self, dimension: Dimension) -> TokenStream {
        let [n, m, p] = self.dimensions();
        match dimension {
            Dimension::Coordinates => n,
            Dimension::Constraints => m,
            Dimension::Parameters => p,
        }
    }

    pub(super) fn argument(&self, argument: Argument) -> TokenStream {
        let (scalar, [n, m, p]) = (self.scalar, self.dimensions());
        let ty = match argument {
            Argument::System => return quote!(&self),
            Argument::MutableSystem => return quote!(&mut self),
            Argument::State => quote!(&__lagrange::State<#scalar, #n>),
            Argument::Solution => quote!(&__lagrange::Solution<#scalar, #n, #m>),
            Argument::Accelerations => quote!(&__lagrange::nalgebra::SVector<#scalar, #n>),
            Argument::Multipliers => quote!(&__lagrange::nalgebra::SVector<#scalar, #m>),
            Argument::Direction => quote!(&__lagrange::Direction<#scalar, #n>),
            Argument::Rates => quote!(&__lagrange::nalgebra::SVector<#scalar, #p>),
            Argument::Factor => quote!(&Self::Factor),
            Argument::Slopes => quote!(&Self::Slopes),
            Argument::ParameterSlopes => quote!(&Self::ParameterSlopes),
            Argument::SeriesSlopes => quote!(&Self::SeriesSlopes),
            Argument::Sums => quote!(&Self::Sums),
            Argument::Terms => quote!(&Self::SeriesTerms),
            Argument::Order => quote!(&[#scalar; 4]),
            Argument::Forcing => quote!(&__lagrange::nalgebra::SVector<#scalar, #n>),
            Argument::Bias => quote!(&__lagrange::nalgebra::SVector<#scalar, #m>),
            Argument::Index => quote!(usize),
            Argument::Value => quote!(#scalar),
        };
        let name = format_ident!("{}", argument.name());
        quote!(#name: #ty)
    }

    fn returns(&self, gives: Gives) -> TokenStream {
        let (scalar, [n, m, _]) = (self.scalar, self.dimensions());
        match gives {
            Gives::Number => quote!(#scalar),
            Gives::Vector(length) => self.vector(&self.dimension(length)),
            Gives::Matrix(rows, columns) => self.matrix(&self.dimension(rows), &self.dimension(columns)),
            Gives::Solution => quote!(__lagrange::Solution<#scalar, #n, #m>),
            Gives::Factor => quote!(Self::Factor),
            Gives::Slopes => quote!(Self::Slopes),
            Gives::ParameterSlopes => quote!(Self::ParameterSlopes),
            Gives::SeriesSlopes => quote!(Self::SeriesSlopes),
            Gives::RightHandSides => {
                let [forcing, bias] = [n, m].map(|length| self.vector(&length));
                quote!(((#forcing, #bias), Self::SeriesTerms))
            }
            Gives::Factors => quote!([Self::Sums; 2]),
            Gives::ResidualChange => quote!(__lagrange::ResidualChange<#scalar, #n, #m>),
            Gives::Optional => quote!(::core::option::Option<#scalar>),
            Gives::Success => quote!(bool),
        }
    }

    fn matrix(&self, rows: &TokenStream, columns: &TokenStream) -> TokenStream {
        let scalar = self.scalar;
        quote!(__lagrange::nalgebra::SMatrix<#scalar, #rows, #columns>)
    }

    fn vector(&self, length: &TokenStream) -> TokenStream {
        let scalar = self.scalar;
        quote!(__lagrange::nalgebra::SVector<#scalar, #length>)
    }
}
