//! Arrays as vectors and matrices.

use nalgebra::{ArrayStorage, SMatrix, SVector};

use super::Scalar;

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

/// The numbers that belong to 0, 1, …: [`core::array::from_fn`], of which rustc has many times as much to
/// compile, as of iterators.
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

/// An array that can be filled, as long as it is.
pub trait FixedArray<T>: Copy + AsRef<[T]> + AsMut<[T]> {
    /// With `x` in every place.
    fn filled(x: T) -> Self;
}

impl<T: Copy, const K: usize> FixedArray<T> for [T; K] {
    #[inline(always)]
    fn filled(x: T) -> Self {
        [x; K]
    }
}
