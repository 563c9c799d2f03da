//! The numbers of a point of the phase space.

use core::ops::{Index, IndexMut};

use nalgebra::Const;

use super::array::FromFn;
use super::{Array, Element, Length, Vector};

/// Coordinates and velocities, or coordinates and momenta: the unknowns of a one-step method. `y[0]` and `y[1]` are
/// slices of the entries of its halves.
///
/// ```
/// use lagrange_core::generic::PhaseVector;
///
/// let y = PhaseVector::from([[1.0, 2.0], [3.0, 4.0]]);
/// assert_eq!((y[1][0], y.half(0)[1], y.flat()), (3.0, 2.0, &[1.0, 2.0, 3.0, 4.0][..]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseVector<T: Element, N: Length>(N::Halves<T>);

impl<T: Element, N: Length> PhaseVector<T, N> {
    /// Joins two halves.
    #[inline]
    pub fn new(halves: [Array<T, N>; 2]) -> Self {
        Self(N::join(halves))
    }

    /// Returns the vector with `x` in every entry.
    #[inline]
    pub fn filled(x: T) -> Self {
        Self::new([Array::filled(x); 2])
    }

    /// Joins coordinates to velocities or momenta.
    #[inline]
    pub fn of(first: Vector<T, N>, second: Vector<T, N>) -> Self {
        Self::new([first.into(), second.into()])
    }

    /// Returns a half, 0 or 1.
    #[inline]
    pub fn half(&self, half: usize) -> Array<T, N> {
        Array(self.0[half])
    }

    /// Returns both halves.
    #[inline]
    pub fn arrays(&self) -> [Array<T, N>; 2] {
        [self.half(0), self.half(1)]
    }

    /// Sets a half, 0 or 1.
    #[inline]
    pub fn set(&mut self, half: usize, to: Array<T, N>) {
        self.0[half] = to.0;
    }

    /// Returns all entries, those of the first half before those of the second.
    #[inline(always)]
    pub fn flat(&self) -> &[T] {
        N::flat(&self.0)
    }

    /// Returns all entries for writing, those of the first half before those of the second.
    #[inline(always)]
    pub fn flat_mut(&mut self) -> &mut [T] {
        N::flat_mut(&mut self.0)
    }
}

impl<T: Element, const K: usize> From<[[T; K]; 2]> for PhaseVector<T, Const<K>> {
    fn from(halves: [[T; K]; 2]) -> Self {
        Self(halves)
    }
}

impl<T: Element, N: Length> Index<usize> for PhaseVector<T, N> {
    type Output = [T];

    #[inline(always)]
    fn index(&self, half: usize) -> &[T] {
        self.0[half].as_ref()
    }
}

impl<T: Element, N: Length> IndexMut<usize> for PhaseVector<T, N> {
    #[inline(always)]
    fn index_mut(&mut self, half: usize) -> &mut [T] {
        self.0[half].as_mut()
    }
}

/// The index counts the halves.
impl<X: Element, N: Length> FromFn for PhaseVector<X, N> {
    type Item = Array<X, N>;

    #[inline]
    fn from_fn(mut of: impl FnMut(usize) -> Array<X, N>) -> Self {
        Self::new([of(0), of(1)])
    }
}
