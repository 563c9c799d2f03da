//! The struct's fields: what each one's type says about its shape.

use quote::ToTokens;
use syn::{Expr, ExprLit, GenericArgument, Lit, PathArguments, PathSegment, Type};

use super::name::Name;
use crate::diagnostics::Place;

/// A field, usable as a parameter or not.
#[derive(Clone)]
pub(crate) struct Field {
    pub(crate) name: Name,
    pub(crate) ident: syn::Ident,
    pub(crate) ty: Type,
    /// Where its type stands.
    pub(crate) place: Place,
    /// How to read numbers from it, or why that cannot be done.
    pub(crate) shape: Result<FieldShape, String>,
}

/// The layout of the numbers in a field.
#[derive(Clone)]
pub(crate) struct FieldShape {
    pub(crate) layout: Layout,
    /// The type of each number; none where only `#[parameter(…)]` tells the shape.
    pub(crate) scalar: Option<Type>,
    /// Whether the field is a reference to them.
    pub(crate) is_reference: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Layout {
    Scalar,
    /// `self.a[i]`
    Vector(usize),
    /// `self.a[i][j]`: rows of arrays
    Rows(usize, usize),
    /// `self.a[(i, j)]`: a nalgebra matrix
    Matrix(usize, usize),
}

impl Layout {
    /// The lengths from the outside in: none for a scalar.
    pub(crate) fn lengths(self) -> Vec<usize> {
        match self {
            Self::Scalar => Vec::new(),
            Self::Vector(length) => vec![length],
            Self::Rows(rows, columns) | Self::Matrix(rows, columns) => vec![rows, columns],
        }
    }

    /// How many numbers that is; more than can be counted count as the most.
    pub(crate) fn numbers(self) -> usize {
        self.lengths().into_iter().fold(1, usize::saturating_mul)
    }
}

/// An array in an expression has at most this many numbers.
pub(crate) const LENGTH_LIMIT: usize = 100_000;

impl Field {
    pub(super) fn new(field: &syn::Field, ident: &syn::Ident) -> Self {
        let place = Place::of(&field.ty);
        let shape = shape(&field.ty).and_then(short_enough);
        Self { name: Name::new(ident), ident: ident.clone(), ty: field.ty.clone(), place, shape }
    }
}

fn shape(ty: &Type) -> Result<FieldShape, String> {
    match ty {
        Type::Reference(reference) => Ok(FieldShape { is_reference: true, ..shape(&reference.elem)? }),
        Type::Paren(inner) => shape(&inner.elem),
        Type::Group(inner) => shape(&inner.elem),
        Type::Array(array) => nested(shape(&array.elem)?, length(&array.len)?),
        Type::Path(path) => match path.path.segments.last() {
            Some(segment) => named(ty, segment),
            None => Err(unusable(ty)),
        },
        _ => Err(unusable(ty)),
    }
}

fn short_enough(shape: FieldShape) -> Result<FieldShape, String> {
    match shape.layout.numbers() {
        1..=LENGTH_LIMIT => Ok(shape),
        0 => Err("a field without any number cannot stand in an expression".to_owned()),
        _ => Err(format!("a field of more than {LENGTH_LIMIT} numbers cannot stand in an expression")),
    }
}

fn unusable(ty: &Type) -> String {
    let ty = ty.to_token_stream().to_string().replace(' ', "");
    format!(
        "a field of type `{ty}` cannot stand in an expression: write `f64`, an array or a nalgebra vector or matrix of it, or say its shape with `#[parameter(name: [3])]`"
    )
}

fn nested(inner: FieldShape, length: usize) -> Result<FieldShape, String> {
    let layout = match inner.layout {
        Layout::Scalar => Layout::Vector(length),
        Layout::Vector(columns) => Layout::Rows(length, columns),
        Layout::Rows(..) | Layout::Matrix(..) => {
            return Err("arrays of matrices cannot stand in an expression".to_owned());
        }
    };
    Ok(FieldShape { layout, ..inner })
}

fn named(ty: &Type, segment: &PathSegment) -> Result<FieldShape, String> {
    let name = segment.ident.to_string();
    let arguments: Vec<&GenericArgument> = match &segment.arguments {
        PathArguments::AngleBracketed(arguments) => arguments.args.iter().collect(),
        _ => Vec::new(),
    };
    let layout = match (name.as_str(), &arguments[..]) {
        ("SVector", [_, n]) => Layout::Vector(argument_length(n)?),
        ("SMatrix", [_, rows, columns]) => Layout::Matrix(argument_length(rows)?, argument_length(columns)?),
        (_, [_]) => named_layout(&name).ok_or_else(|| unusable(ty))?,
        (_, []) => Layout::Scalar,
        _ => return Err(unusable(ty)),
    };
    let scalar = match arguments.first() {
        None => ty.clone(),
        Some(GenericArgument::Type(scalar)) => scalar.clone(),
        Some(_) => return Err(unusable(ty)),
    };
    Ok(FieldShape { layout, scalar: Some(scalar), is_reference: false })
}

/// `Vector3`, `Matrix2`, `Matrix2x3`.
fn named_layout(name: &str) -> Option<Layout> {
    let size = |text: &str| text.parse().ok().filter(|size| (1..=6).contains(size));
    if let Some(length) = name.strip_prefix("Vector") {
        return size(length).map(Layout::Vector);
    }
    let sizes = name.strip_prefix("Matrix")?;
    let (rows, columns) = sizes.split_once('x').unwrap_or((sizes, sizes));
    Some(Layout::Matrix(size(rows)?, size(columns)?))
}

fn argument_length(argument: &GenericArgument) -> Result<usize, String> {
    match argument {
        GenericArgument::Const(expression) => length(expression),
        _ => Err(NOT_A_LITERAL.to_owned()),
    }
}

fn length(expression: &Expr) -> Result<usize, String> {
    match expression {
        Expr::Lit(ExprLit { lit: Lit::Int(literal), .. }) => {
            literal.base10_parse().map_err(|_| "this length is too large".to_owned())
        }
        Expr::Group(group) => length(&group.expr),
        _ => Err(NOT_A_LITERAL.to_owned()),
    }
}

pub(super) const NOT_A_LITERAL: &str =
    "the length must be an integer literal: the equations are derived before const generics have values";
