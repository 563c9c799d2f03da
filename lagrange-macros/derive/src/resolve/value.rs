//! Values of expressions: scalars, and arrays of scalars.

use std::borrow::Borrow;
use std::fmt;
use std::rc::Rc;

use crate::symbolic::{Graph, Id, Rational};

/// A scalar, a vector, nested vectors such as the rows of a matrix, or a vector in space by its components in a frame.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum Value {
    Scalar(Id),
    Vector(Vec<Self>),
    Spatial(Axes, [Id; 3]),
}

/// Axes of a frame, identified by the index and the name of the frame.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Axes {
    pub(super) frame: usize,
    pub(super) name: Rc<str>,
}

/// Array lengths from the outermost to the innermost, none for a scalar, and the axes of a vector in space.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Shape {
    pub(super) lengths: Vec<usize>,
    axes: Option<Axes>,
}

impl Shape {
    pub(super) fn plain(lengths: Vec<usize>) -> Self {
        Self { lengths, axes: None }
    }

    /// Common shape of two operands. A vector without axes takes the axes of the other.
    pub(super) fn with(&self, other: &Self) -> Option<Self> {
        let is_one = self.lengths == other.lengths;
        let axes = match (&self.axes, &other.axes) {
            (Some(one), Some(other)) if one != other => return None,
            (one, other) => one.as_ref().or(other.as_ref()).cloned(),
        };
        is_one.then(|| Self { lengths: self.lengths.clone(), axes })
    }

    /// Returns whether two shapes differ in their axes only.
    pub(super) fn is_turned_to(&self, other: &Self) -> bool {
        self.lengths == other.lengths && self.with(other).is_none()
    }
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.lengths[..], &self.axes) {
            ([], _) => write!(f, "a scalar"),
            ([_], Some(Axes { name, .. })) => write!(f, "a vector in the axes of `{name}`"),
            ([n], None) => write!(f, "a vector of {n}"),
            ([rows, columns], _) => write!(f, "a {rows} by {columns} matrix"),
            _ => write!(f, "an array of matrices"),
        }
    }
}

impl Value {
    pub(super) fn shape(&self) -> Shape {
        match self {
            Self::Scalar(_) => Shape::plain(Vec::new()),
            Self::Vector(items) => {
                let inner = items.first().map(Self::shape).map_or(Vec::new(), |shape| shape.lengths);
                Shape::plain([vec![items.len()], inner].concat())
            }
            Self::Spatial(axes, _) => Shape { lengths: vec![3], axes: Some(axes.clone()) },
        }
    }

    /// Array lengths from the outermost to the innermost; an array with a single entry counts as a scalar.
    pub(super) fn lengths(&self) -> Vec<usize> {
        if self.count() == 1 { Vec::new() } else { self.shape().lengths }
    }

    pub(super) fn as_scalar(&self) -> Option<Id> {
        match self {
            Self::Scalar(id) => Some(*id),
            Self::Vector(_) | Self::Spatial(..) => None,
        }
    }

    /// Entries, if this is a vector of scalars.
    pub(super) fn as_vector(&self) -> Option<Vec<Id>> {
        match self {
            Self::Scalar(_) => None,
            Self::Vector(items) => items.iter().map(Self::as_scalar).collect(),
            Self::Spatial(_, entries) => Some(entries.to_vec()),
        }
    }

    /// Rows, if this is a matrix.
    pub(super) fn as_matrix(&self) -> Option<Vec<Vec<Id>>> {
        match self {
            Self::Vector(rows) if !rows.is_empty() => rows.iter().map(Self::as_vector).collect(),
            _ => None,
        }
    }

    /// Rows, if this is a 3 × 3 matrix, which maps vectors in space.
    pub(super) fn as_map_of_space(&self) -> Option<[[Id; 3]; 3]> {
        let rows: Option<Vec<[Id; 3]>> =
            self.as_matrix()?.into_iter().map(|row| row.try_into().ok()).collect();
        rows?.try_into().ok()
    }

    /// Axes, if this is a vector in space.
    pub(super) fn axes(&self) -> Option<&Axes> {
        match self {
            Self::Spatial(axes, _) => Some(axes),
            Self::Scalar(_) | Self::Vector(_) => None,
        }
    }

    /// Attaches axes, if given, to a vector of three entries.
    pub(super) fn along(self, axes: Option<&Axes>) -> Self {
        let entries = self.as_vector().and_then(|entries| <[Id; 3]>::try_from(entries).ok());
        match (axes, entries) {
            (Some(axes), Some(entries)) => Self::Spatial(axes.clone(), entries),
            _ => self,
        }
    }

    /// Builds nested arrays of these lengths from entries in row-major order.
    pub(super) fn array(lengths: &[usize], entries: &[Id]) -> Self {
        match lengths {
            [] => Self::Scalar(entries[0]),
            [length, inner @ ..] => {
                let parts = entries.chunks(entries.len() / length);
                Self::Vector(parts.map(|part| Self::array(inner, part)).collect())
            }
        }
    }

    pub(super) fn vector(entries: impl IntoIterator<Item = Id>) -> Self {
        Self::Vector(entries.into_iter().map(Self::Scalar).collect())
    }

    pub(super) fn matrix(rows: impl IntoIterator<Item: IntoIterator<Item = Id>>) -> Self {
        Self::Vector(rows.into_iter().map(Self::vector).collect())
    }

    /// All scalars in row-major order.
    pub(crate) fn flat(&self) -> Vec<Id> {
        match self {
            Self::Scalar(id) => vec![*id],
            Self::Vector(items) => items.iter().flat_map(Self::flat).collect(),
            Self::Spatial(_, entries) => entries.to_vec(),
        }
    }

    /// Number of scalars.
    pub(super) fn count(&self) -> usize {
        match self {
            Self::Scalar(_) => 1,
            Self::Vector(items) => items.iter().map(Self::count).sum(),
            Self::Spatial(..) => 3,
        }
    }

    /// Σ coefficient · value of values of one shape. The sum is built at once: term by term, the cost would be
    /// quadratic in the number of terms.
    pub(super) fn combination<V: Borrow<Self>>(terms: &[(V, Rational)], graph: &mut Graph) -> Self {
        let Some(length) = terms.first().and_then(|(value, _)| value.borrow().length()) else {
            let scalars = terms.iter().filter_map(|(value, c)| Some((value.borrow().as_scalar()?, *c)));
            return Self::Scalar(graph.sum(scalars));
        };
        let column = |i: usize| -> Vec<(Self, Rational)> {
            terms.iter().filter_map(|(value, c)| Some((value.borrow().item(i)?, *c))).collect()
        };
        let axes = terms.iter().find_map(|(value, _)| value.borrow().axes());
        Self::Vector((0..length).map(|i| Self::combination(&column(i), graph)).collect()).along(axes)
    }

    /// Shapes of two items of an array with different lengths, if there are any.
    pub(super) fn uneven(&self) -> Option<[Shape; 2]> {
        let Self::Vector(items) = self else { return None };
        let shapes: Vec<Shape> = items.iter().map(Self::shape).collect();
        let odd = shapes.iter().find(|shape| shape.lengths != shapes[0].lengths);
        odd.map(|odd| [shapes[0].clone(), odd.clone()])
    }

    /// Number of items; `None` for a scalar.
    pub(super) fn length(&self) -> Option<usize> {
        match self {
            Self::Scalar(_) => None,
            Self::Vector(items) => Some(items.len()),
            Self::Spatial(..) => Some(3),
        }
    }

    pub(super) fn item(&self, i: usize) -> Option<Self> {
        match self {
            Self::Scalar(_) => None,
            Self::Vector(items) => items.get(i).cloned(),
            Self::Spatial(_, entries) => entries.get(i).map(|&entry| Self::Scalar(entry)),
        }
    }

    /// Applies `f` to every scalar and keeps the shape.
    pub(super) fn map(&self, f: &mut impl FnMut(Id) -> Id) -> Self {
        match self {
            Self::Scalar(id) => Self::Scalar(f(*id)),
            Self::Vector(items) => Self::Vector(items.iter().map(|item| item.map(f)).collect()),
            Self::Spatial(axes, entries) => Self::Spatial(axes.clone(), entries.map(f)),
        }
    }
}

/// Cross product x × y.
pub(crate) fn cross(x: [Id; 3], y: [Id; 3], graph: &mut Graph) -> [Id; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
        let (forth, back) = (graph.mul(x[i], y[j]), graph.mul(x[j], y[i]));
        graph.sub(forth, back)
    })
}
