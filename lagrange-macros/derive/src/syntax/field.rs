//! Fields of the struct, and the shapes that follow from their types.

use quote::ToTokens;
use syn::{Expr, ExprLit, GenericArgument, Lit, PathArguments, PathSegment, Type};

use super::expression::Expression;
use super::name::Name;
use crate::diagnostics::Place;

/// A field of the struct, or a number inside a field that is a struct. Its type may or may not be usable as a
/// parameter.
#[derive(Clone)]
pub(crate) struct Field {
    pub(crate) name: Name,
    pub(crate) ident: syn::Ident,
    /// Path of members from the field to this number, outermost first; empty for the field itself.
    pub(crate) members: Vec<Segment>,
    pub(crate) ty: Type,
    /// Location of the type.
    pub(crate) place: Place,
    /// Layout of the numbers in the field, or the reason why the type is not usable.
    pub(crate) shape: Result<FieldShape, String>,
}

/// Member access `.m`, after `after` array indices.
#[derive(Clone)]
pub(crate) struct Segment {
    pub(crate) name: Name,
    pub(crate) ident: syn::Ident,
    pub(crate) after: usize,
}

/// The layout of the numbers in a field.
#[derive(Clone)]
pub(crate) struct FieldShape {
    pub(crate) layout: Layout,
    /// Type of each number. `None` if only `#[parameter(…)]` states the shape.
    pub(crate) scalar: Option<Type>,
    /// True if the field is a reference.
    pub(crate) is_reference: bool,
}

/// Nested arrays. Numbers are enumerated in row-major order.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Layout {
    /// Lengths, outermost first; empty for a single number.
    pub(crate) lengths: Vec<usize>,
    pub(crate) inside: Inside,
}

/// Type of the innermost array, which determines how a number is accessed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Inside {
    /// `a[i][j]`
    Array,
    /// `a[(i, j)]`: a nalgebra matrix
    Matrix,
    /// As `Matrix`, but single entries cannot be assigned.
    Rotation,
    /// `a.coords[(i + 3) % 4]`: a nalgebra quaternion, which stores the real part last
    Quaternion,
    /// As `Quaternion`, but single components cannot be assigned.
    UnitQuaternion,
}

/// Property of a matrix.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Property {
    Symmetric,
    Rotation,
}

impl Layout {
    pub(crate) fn array(lengths: impl Into<Vec<usize>>) -> Self {
        Self { lengths: lengths.into(), inside: Inside::Array }
    }

    pub(super) fn matrix(rows: usize, columns: usize) -> Self {
        Self { lengths: vec![rows, columns], inside: Inside::Matrix }
    }

    pub(super) fn rotation(size: usize) -> Self {
        Self { inside: Inside::Rotation, ..Self::matrix(size, size) }
    }

    pub(super) fn quaternion(inside: Inside) -> Self {
        Self { lengths: vec![4], inside }
    }

    /// Returns this layout nested in arrays of the given lengths.
    pub(crate) fn within(&self, lengths: &[usize]) -> Self {
        Self { lengths: [lengths, &self.lengths].concat(), ..*self }
    }

    pub(crate) fn is_scalar(&self) -> bool {
        self.lengths.is_empty()
    }

    /// Number of scalars; saturates on overflow.
    pub(crate) fn numbers(&self) -> usize {
        numbers(&self.lengths)
    }

    /// Length of the innermost array; 1 for a number.
    pub(crate) fn size(&self) -> usize {
        self.lengths.last().copied().unwrap_or(1)
    }

    /// Number of array indices, which precede the indices inside a matrix or a quaternion.
    pub(crate) fn arrays(&self) -> usize {
        let inside = match self.inside {
            Inside::Array => 0,
            Inside::Matrix | Inside::Rotation => 2,
            Inside::Quaternion | Inside::UnitQuaternion => 1,
        };
        self.lengths.len() - inside
    }

    /// Returns the indices of a number, from its position in row-major order.
    pub(crate) fn indices(&self, mut number: usize) -> Vec<usize> {
        let index = |length: &usize| {
            let index = number % length;
            number /= length;
            index
        };
        let mut indices: Vec<usize> = self.lengths.iter().rev().map(index).collect();
        indices.reverse();
        indices
    }
}

/// Number of scalars in nested arrays of these lengths; saturates on overflow.
pub(crate) fn numbers(lengths: &[usize]) -> usize {
    lengths.iter().copied().fold(1, usize::saturating_mul)
}

/// Lengths of an array, outermost first: those that are known when the program runs, then those of one element.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lengths {
    pub(crate) open: Vec<Expression>,
    pub(crate) known: Vec<usize>,
}

/// Maximum number of scalars in an array that an expression uses.
pub(crate) const LENGTH_LIMIT: usize = 100_000;

impl Field {
    pub(super) fn new(field: &syn::Field, ident: &syn::Ident) -> Self {
        let place = Place::of(&field.ty);
        let shape = shape(&field.ty).and_then(short_enough);
        let (name, ty) = (Name::new(ident), field.ty.clone());
        Self { name, ident: ident.clone(), members: Vec::new(), ty, place, shape }
    }

    /// Name of the field in expressions, without indices.
    pub(crate) fn text(&self) -> String {
        let members = self.members.iter().map(|member| member.name.text.as_str());
        [self.name.text.as_str()].into_iter().chain(members).collect::<Vec<_>>().join(".")
    }
}

/// Splits a type into array lengths, outermost first, and the element type. Looks through references.
pub(crate) fn arrays(ty: &Type) -> (Vec<usize>, &Type) {
    match ty {
        Type::Reference(reference) => arrays(&reference.elem),
        Type::Paren(inner) => arrays(&inner.elem),
        Type::Group(inner) => arrays(&inner.elem),
        Type::Array(array) => match length(&array.len) {
            Ok(length) => {
                let (mut lengths, element) = arrays(&array.elem);
                lengths.insert(0, length);
                (lengths, element)
            }
            Err(_) => (Vec::new(), ty),
        },
        _ => (Vec::new(), ty),
    }
}

/// Returns the type of the elements of a field whose length is known when the program runs: `Vec<T>` or `[T]`.
pub(crate) fn element_type(ty: &Type) -> Option<&Type> {
    match ty {
        Type::Reference(reference) => element_type(&reference.elem),
        Type::Paren(inner) => element_type(&inner.elem),
        Type::Group(inner) => element_type(&inner.elem),
        Type::Slice(slice) => Some(&slice.elem),
        Type::Path(path) => {
            let segment = path.path.segments.last()?;
            let [GenericArgument::Type(inner), ..] = arguments(segment)[..] else { return None };
            match segment.ident.to_string().as_str() {
                "Vec" => Some(inner),
                "Box" | "Rc" | "Arc" => element_type(inner),
                _ => None,
            }
        }
        _ => None,
    }
}

const OPEN_LENGTH: &str = "the length of a `Vec` is known when the program runs: say what it is called, `#[parameter(name: [n])]`, and take coordinates of this length, `#[coordinates(x: [n])]`";

pub(crate) fn shape(ty: &Type) -> Result<FieldShape, String> {
    if element_type(ty).is_some() {
        return Err(OPEN_LENGTH.to_owned());
    }
    match ty {
        Type::Reference(reference) => Ok(FieldShape { is_reference: true, ..shape(&reference.elem)? }),
        Type::Paren(inner) => shape(&inner.elem),
        Type::Group(inner) => shape(&inner.elem),
        Type::Array(array) => {
            let (mut shape, length) = (shape(&array.elem)?, length(&array.len)?);
            shape.layout.lengths.insert(0, length);
            Ok(shape)
        }
        Type::Path(path) => match path.path.segments.last() {
            Some(segment) => named(ty, segment),
            None => Err(unusable(ty)),
        },
        _ => Err(unusable(ty)),
    }
}

pub(crate) fn short_enough(shape: FieldShape) -> Result<FieldShape, String> {
    match shape.layout.numbers() {
        1..=LENGTH_LIMIT => Ok(shape),
        0 => Err("a field without any number cannot stand in an expression".to_owned()),
        _ => Err(format!("a field of more than {LENGTH_LIMIT} numbers cannot stand in an expression")),
    }
}

fn unusable(ty: &Type) -> String {
    let ty = ty.to_token_stream().to_string().replace(' ', "");
    if ["Isometry", "Similarity"].iter().any(|name| ty.rsplit("::").any(|part| part.starts_with(name))) {
        return format!(
            "a field of type `{ty}` cannot stand in an expression, as an `Isometry3` can: make it two, a rotation and a vector"
        );
    }
    format!(
        "a field of type `{ty}` cannot stand in an expression: write `f64`, an array or a nalgebra vector, matrix, rotation or quaternion of it, or say its shape with `#[parameter(name: [3])]`, or the members of structs with `#[parameter(name: [3] {{m}})]`"
    )
}

fn named(ty: &Type, segment: &PathSegment) -> Result<FieldShape, String> {
    let name = segment.ident.to_string();
    let arguments = arguments(segment);
    let layout = match (name.as_str(), &arguments[..]) {
        ("SVector", [_, n]) => Layout::array([argument_length(n)?]),
        ("SMatrix", [_, rows, columns]) => Layout::matrix(argument_length(rows)?, argument_length(columns)?),
        ("Rotation", [_, n]) => Layout::rotation(argument_length(n)?),
        (_, [_]) => named_layout(&name).ok_or_else(|| unusable(ty))?,
        (_, []) => Layout::array([]),
        _ => return Err(unusable(ty)),
    };
    let scalar = match arguments.first() {
        None => ty.clone(),
        Some(GenericArgument::Type(scalar)) => scalar.clone(),
        Some(_) => return Err(unusable(ty)),
    };
    Ok(FieldShape { layout, scalar: Some(scalar), is_reference: false })
}

pub(crate) fn arguments(segment: &PathSegment) -> Vec<&GenericArgument> {
    match &segment.arguments {
        PathArguments::AngleBracketed(arguments) => arguments.args.iter().collect(),
        _ => Vec::new(),
    }
}

/// Layout of `Vector3`, `Matrix2`, `Matrix2x3`, `Rotation3`, `UnitQuaternion`, ….
fn named_layout(name: &str) -> Option<Layout> {
    let size = |text: &str| text.parse().ok().filter(|size| (1..=6).contains(size));
    if let Some(length) = name.strip_prefix("Vector") {
        return size(length).map(|length| Layout::array([length]));
    }
    match name {
        "Rotation2" => return Some(Layout::rotation(2)),
        "Rotation3" => return Some(Layout::rotation(3)),
        "Quaternion" => return Some(Layout::quaternion(Inside::Quaternion)),
        "UnitQuaternion" => return Some(Layout::quaternion(Inside::UnitQuaternion)),
        _ => {}
    }
    let sizes = name.strip_prefix("Matrix")?;
    let (rows, columns) = sizes.split_once('x').unwrap_or((sizes, sizes));
    Some(Layout::matrix(size(rows)?, size(columns)?))
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

pub(super) const NOT_A_LITERAL: &str = "the length must be an integer literal: the equations are derived before constants and const generics have values. `const _: () = assert!(N == 3);` beside the struct keeps a constant equal to it";
