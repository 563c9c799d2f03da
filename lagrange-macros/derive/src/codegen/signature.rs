//! Signatures of trait methods, with the types of one system.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use crate::contract::{Argument, Dimension, Gives, Method};

/// Number type and dimensions of a system.
#[derive(Clone, Copy)]
pub(super) struct Types<'a> {
    pub(super) scalar: &'a syn::Type,
    /// Number of coordinates. `None` if it is unknown, in a stub.
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

    /// Generic parameter, with its bound, of a method over [`wide`] numbers.
    pub(super) fn over(&self) -> TokenStream {
        let (wide, scalar) = (wide(), self.scalar);
        quote!(<#wide: __lagrange::Broadcast<#scalar>>)
    }

    /// Signature of the method of an observable, a number or an array of these lengths.
    pub(super) fn of_observable(&self, name: &Ident, lengths: &[usize], needs_solution: bool) -> TokenStream {
        let takes =
            &[Argument::System, Argument::State, Argument::Solution][..2 + usize::from(needs_solution)];
        let arguments = takes.iter().map(|&argument| self.argument(argument));
        let returns = match lengths {
            [] => self.returns(Gives::Number),
            [length, ..] => {
                let columns = lengths.get(1).unwrap_or(&1);
                let scalar = self.scalar;
                quote!(__lagrange::nalgebra::SMatrix<#scalar, #length, #columns>)
            }
        };
        quote!(fn #name(#(#arguments),*) -> #returns)
    }

    /// A type of the runtime with these lengths: `State<f64, 2>`. If the number of coordinates is unknown, it is the
    /// type with the length `N` of the stub.
    fn of_lengths(&self, known: &TokenStream, unknown: &str, lengths: &[Dimension]) -> TokenStream {
        let (scalar, unknown) = (self.scalar, format_ident!("{unknown}"));
        let length = |dimension: &Dimension| match dimension {
            Dimension::Coordinates => self.coordinates,
            Dimension::Constraints => Some(self.constraints),
            Dimension::Parameters => Some(self.parameters),
        };
        let lengths = lengths.iter().map(length);
        match lengths.clone().collect::<Option<Vec<_>>>() {
            Some(lengths) => quote!(__lagrange::#known<#scalar, #(#lengths),*>),
            None => {
                let lengths = lengths.map(|length| match length {
                    Some(length) => quote!(__lagrange::nalgebra::Const<#length>),
                    None => quote!(<Self as __lagrange::Lagrangian>::N),
                });
                quote!(__lagrange::generic::#unknown<#scalar, #(#lengths),*>)
            }
        }
    }

    pub(super) fn argument(&self, argument: Argument) -> TokenStream {
        match argument {
            Argument::System => return quote!(&self),
            Argument::MutableSystem => return quote!(&mut self),
            _ => {}
        }
        let (name, ty) = (format_ident!("{}", argument.name()), self.of_argument(argument));
        match argument {
            Argument::Index | Argument::Value => quote!(#name: #ty),
            _ => quote!(#name: &#ty),
        }
    }

    /// Type of an argument, without the reference.
    fn of_argument(&self, argument: Argument) -> TokenStream {
        let scalar = self.scalar;
        match argument {
            Argument::State => self.state(),
            Argument::Solution => self.solution(),
            Argument::Accelerations | Argument::Forcing => self.vector(Dimension::Coordinates),
            Argument::Multipliers | Argument::Bias => self.vector(Dimension::Constraints),
            Argument::Rates => self.vector(Dimension::Parameters),
            Argument::Direction => {
                self.of_lengths(&quote!(Direction), "Direction", &[Dimension::Coordinates])
            }
            Argument::Factor => quote!(Self::Factor),
            Argument::Slopes => quote!(Self::Slopes),
            Argument::ParameterSlopes => quote!(Self::ParameterSlopes),
            Argument::SeriesSlopes => quote!(Self::SeriesSlopes),
            Argument::Sums => quote!(Self::Sums),
            Argument::Terms => quote!(Self::SeriesTerms),
            Argument::Order => quote!([#scalar; 4]),
            Argument::System | Argument::MutableSystem => quote!(Self),
            Argument::Index => quote!(usize),
            Argument::Value => quote!(#scalar),
        }
    }

    fn returns(&self, gives: Gives) -> TokenStream {
        let scalar = self.scalar;
        match gives {
            Gives::Number => quote!(#scalar),
            Gives::Vector(length) => self.vector(length),
            Gives::Matrix(rows, columns) => {
                self.of_lengths(&quote!(nalgebra::SMatrix), "Matrix", &[rows, columns])
            }
            Gives::Solution => self.solution(),
            Gives::Factor => quote!(Self::Factor),
            Gives::Slopes => quote!(Self::Slopes),
            Gives::ParameterSlopes => quote!(Self::ParameterSlopes),
            Gives::SeriesSlopes => quote!(Self::SeriesSlopes),
            Gives::RightHandSides => {
                let [forcing, bias] =
                    [Dimension::Coordinates, Dimension::Constraints].map(|length| self.vector(length));
                quote!(((#forcing, #bias), Self::SeriesTerms))
            }
            Gives::Factors => quote!([Self::Sums; 2]),
            Gives::ResidualChange => self.of_lengths(
                &quote!(ResidualChange),
                "ResidualChange",
                &[Dimension::Coordinates, Dimension::Constraints],
            ),
            Gives::Optional => quote!(::core::option::Option<#scalar>),
            Gives::Success => quote!(bool),
        }
    }

    fn state(&self) -> TokenStream {
        self.of_lengths(&quote!(State), "State", &[Dimension::Coordinates])
    }

    pub(super) fn solution(&self) -> TokenStream {
        self.of_lengths(&quote!(Solution), "Solution", &[Dimension::Coordinates, Dimension::Constraints])
    }

    pub(super) fn vector(&self, length: Dimension) -> TokenStream {
        self.of_lengths(&quote!(nalgebra::SVector), "Vector", &[length])
    }
}
