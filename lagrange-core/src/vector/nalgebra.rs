//! Vectors and matrices of nalgebra whose lengths are types.

use nalgebra::U1;

use super::{Array, Element, StaticLength};
use crate::number::Scalar;

/// Column vector of a length: `SVector<T, K>` for [`Const<K>`](nalgebra::Const).
pub type Vector<T, N> = nalgebra::Matrix<T, N, U1, <N as StaticLength>::Storage<T, U1>>;

/// Matrix with `R` rows and `C` columns: `SMatrix<T, R, C>` for lengths [`Const`](nalgebra::Const).
pub type Matrix<T, R, C> = nalgebra::Matrix<T, R, C, <R as StaticLength>::Storage<T, C>>;

impl<T: Element, N: StaticLength> From<Vector<T, N>> for Array<T, N> {
    #[inline]
    fn from(vector: Vector<T, N>) -> Self {
        Self(N::entries(vector))
    }
}

impl<T: Element, R: StaticLength, C: StaticLength> From<Matrix<T, R, C>> for Array<Array<T, R>, C> {
    #[inline]
    fn from(matrix: Matrix<T, R, C>) -> Self {
        Self::from_fn(|j| Array::from_fn(|i| matrix[(i, j)]))
    }
}

impl<T: Element, N: StaticLength> From<Array<T, N>> for Vector<T, N> {
    #[inline]
    fn from(array: Array<T, N>) -> Self {
        vector(array)
    }
}

/// Converts an array to a column vector, without a copy.
#[inline]
pub(crate) fn vector<T: Element, N: StaticLength>(entries: Array<T, N>) -> Vector<T, N> {
    N::vector(entries.0)
}

/// Returns a column vector of zeros.
#[inline]
pub(crate) fn zeros<T: Scalar, N: StaticLength>() -> Vector<T, N> {
    vector(Array::filled(T::constant(0.0)))
}

/// Converts a column vector to an array, without a copy.
#[inline]
pub(crate) fn array<T: Element, N: StaticLength>(vector: Vector<T, N>) -> Array<T, N> {
    Array(N::entries(vector))
}

/// Converts an array of columns to a matrix, without a copy.
#[inline]
pub(crate) fn matrix<T: Element, R: StaticLength, C: StaticLength>(
    columns: Array<Array<T, R>, C>,
) -> Matrix<T, R, C> {
    R::matrix(columns)
}

/// Returns the rows of a matrix.
#[inline]
pub(crate) fn rows<T: Element, R: StaticLength, C: StaticLength>(
    matrix: &Matrix<T, R, C>,
) -> Array<Array<T, C>, R> {
    Array::from_fn(|i| Array::from_fn(|j| matrix[(i, j)]))
}

/// Operations on the entries of a vector, for any length.
pub(crate) trait Entrywise<T: Element, N: StaticLength> {
    /// Returns the values of a function of each entry.
    fn each<U: Element>(&self, of: impl FnMut(T) -> U) -> Vector<U, N>;

    /// Returns the values of a function of each entry and that of another vector.
    fn each_with<S: Element, U: Element>(
        &self,
        other: &Vector<S, N>,
        of: impl FnMut(T, S) -> U,
    ) -> Vector<U, N>;

    /// Returns the sum of two vectors.
    #[inline]
    fn plus(&self, other: &Vector<T, N>) -> Vector<T, N>
    where
        T: Scalar,
    {
        self.each_with(other, |x, y| x + y)
    }

    /// Returns the difference of two vectors.
    #[inline]
    fn minus(&self, other: &Vector<T, N>) -> Vector<T, N>
    where
        T: Scalar,
    {
        self.each_with(other, |x, y| x - y)
    }

    /// Returns the negative of the vector.
    #[inline]
    fn negated(&self) -> Vector<T, N>
    where
        T: Scalar,
    {
        self.each(|x| -x)
    }
}

impl<T: Element, N: StaticLength> Entrywise<T, N> for Vector<T, N> {
    #[inline]
    fn each<U: Element>(&self, mut of: impl FnMut(T) -> U) -> Vector<U, N> {
        vector(Array::from_fn(|i| of(self[i])))
    }

    #[inline]
    fn each_with<S: Element, U: Element>(
        &self,
        other: &Vector<S, N>,
        mut of: impl FnMut(T, S) -> U,
    ) -> Vector<U, N> {
        vector(Array::from_fn(|i| of(self[i], other[i])))
    }
}
