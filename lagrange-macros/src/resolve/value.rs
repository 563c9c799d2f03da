//! What an expression stands for: a number, or an array of such.

use std::borrow::Borrow;
use std::fmt;

use crate::symbolic::{Graph, Id, Rational};

/// A scalar, a vector, or rows of vectors.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum Value {
    Scalar(Id),
    Vector(Vec<Self>),
}

/// Lengths from the outside in: none for a scalar.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Shape(Vec<usize>);

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0[..] {
            [] => write!(f, "a scalar"),
            [n] => write!(f, "a vector of {n}"),
            [rows, columns] => write!(f, "a {rows} by {columns} matrix"),
            _ => write!(f, "an array of matrices"),
        }
    }
}

impl Value {
    pub(super) fn shape(&self) -> Shape {
        match self {
            Self::Scalar(_) => Shape(Vec::new()),
            Self::Vector(items) => {
                let inner = items.first().map(Self::shape).map_or(Vec::new(), |shape| shape.0);
                Shape([vec![items.len()], inner].concat())
            }
        }
    }

    pub(super) fn as_scalar(&self) -> Option<Id> {
        match self {
            Self::Scalar(id) => Some(*id),
            Self::Vector(_) => None,
        }
    }

    /// The entries of a vector of numbers.
    pub(super) fn as_vector(&self) -> Option<Vec<Id>> {
        match self {
            Self::Scalar(_) => None,
            Self::Vector(items) => items.iter().map(Self::as_scalar).collect(),
        }
    }

    pub(super) fn vector(entries: impl IntoIterator<Item = Id>) -> Self {
        Self::Vector(entries.into_iter().map(Self::Scalar).collect())
    }

    /// All numbers in order.
    pub(crate) fn flat(&self) -> Vec<Id> {
        match self {
            Self::Scalar(id) => vec![*id],
            Self::Vector(items) => items.iter().flat_map(Self::flat).collect(),
        }
    }

    /// How many numbers there are.
    pub(super) fn count(&self) -> usize {
        match self {
            Self::Scalar(_) => 1,
            Self::Vector(items) => items.iter().map(Self::count).sum(),
        }
    }

    /// Σ coefficient · value, where all have one shape. In one go: term by term, long sums would take the
    /// square of their length.
    pub(super) fn combination<V: Borrow<Self>>(terms: &[(V, Rational)], graph: &mut Graph) -> Self {
        let Some(Self::Vector(first)) = terms.first().map(|(value, _)| value.borrow()) else {
            let scalars = terms.iter().filter_map(|(value, c)| Some((value.borrow().as_scalar()?, *c)));
            return Self::Scalar(graph.sum(scalars));
        };
        let column = |i: usize| -> Vec<(&Self, Rational)> {
            terms.iter().filter_map(|(value, c)| Some((value.borrow().items().get(i)?, *c))).collect()
        };
        Self::Vector((0..first.len()).map(|i| Self::combination(&column(i), graph)).collect())
    }

    fn items(&self) -> &[Self] {
        match self {
            Self::Scalar(_) => &[],
            Self::Vector(items) => items,
        }
    }

    /// The same shape with `f` of every number.
    pub(super) fn map(&self, f: &mut impl FnMut(Id) -> Id) -> Self {
        match self {
            Self::Scalar(id) => Self::Scalar(f(*id)),
            Self::Vector(items) => Self::Vector(items.iter().map(|item| item.map(f)).collect()),
        }
    }
}

/// x × y
pub(super) fn cross(x: [Id; 3], y: [Id; 3], graph: &mut Graph) -> [Id; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
        let (forth, back) = (graph.mul(x[i], y[j]), graph.mul(x[j], y[i]));
        graph.sub(forth, back)
    })
}
