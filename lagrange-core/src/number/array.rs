//! Arrays as vectors and matrices.

use nalgebra::{ArrayStorage, SMatrix, SVector};

/// A column vector of an array, without a copy.
#[inline]
pub fn vector<T, const K: usize>(entries: [T; K]) -> SVector<T, K> {
    SVector::from_array_storage(ArrayStorage([entries]))
}

/// A matrix of an array of its columns, without a copy.
#[inline]
pub fn matrix<T, const R: usize, const C: usize>(columns: [[T; R]; C]) -> SMatrix<T, R, C> {
    SMatrix::from_array_storage(ArrayStorage(columns))
}
