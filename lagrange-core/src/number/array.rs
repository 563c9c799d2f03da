//! Views of arrays as vectors and matrices.

use nalgebra::{ArrayStorage, SMatrix, SVector};

use super::Scalar;

/// Converts an array to a column vector, without a copy.
#[inline]
pub fn vector<T, const K: usize>(entries: [T; K]) -> SVector<T, K> {
    SVector::from_array_storage(ArrayStorage([entries]))
}

/// Converts an array of columns to a matrix, without a copy.
#[inline]
pub fn matrix<T, const R: usize, const C: usize>(columns: [[T; R]; C]) -> SMatrix<T, R, C> {
    SMatrix::from_array_storage(ArrayStorage(columns))
}

/// Like [`core::array::from_fn`], but cheaper to compile: rustc has many times as much work with `from_fn`, as
/// with iterators.
#[inline]
pub(crate) fn entries<T: Scalar, const K: usize>(mut of: impl FnMut(usize) -> T) -> [T; K] {
    let mut entries = [T::constant(0.0); K];
    let mut k = 0;
    while k < K {
        entries[k] = of(k);
        k += 1;
    }
    entries
}

/// An array of fixed length that can be filled with copies of a value.
pub trait FixedArray<T>: Copy + AsRef<[T]> + AsMut<[T]> {
    /// Returns an array with `x` in every entry.
    fn filled(x: T) -> Self;
}

impl<T: Copy, const K: usize> FixedArray<T> for [T; K] {
    #[inline(always)]
    fn filled(x: T) -> Self {
        [x; K]
    }
}
