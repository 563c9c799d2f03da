//! The numbers of a point of the phase space.

use core::ops::{Index, IndexMut};

use nalgebra::Const;

use super::array::FromFn;
use super::kind::HalvesOf;
use super::{Array, Element, Kind, Length, StaticLength, Vector, VectorOf, ViewOf};

/// Coordinates and velocities, or coordinates and momenta: the unknowns of a one-step method. `y[0]` and `y[1]` are
/// slices of the entries of its halves.
///
/// ```
/// use lagrange_core::generic::PhaseVector;
///
/// let y = PhaseVector::from([[1.0, 2.0], [3.0, 4.0]]);
/// assert_eq!((y[1][0], y.half(0)[1], y.flat()), (3.0, 2.0, &[1.0, 2.0, 3.0, 4.0][..]));
/// ```
#[derive(Debug, PartialEq)]
pub struct PhaseVector<T: Element, N: Length>(HalvesOf<T, N>);

impl<T: Element, N: Length> Clone for PhaseVector<T, N> {
    #[inline(always)]
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }

    #[inline(always)]
    fn clone_from(&mut self, source: &Self) {
        self.0.clone_from(&source.0);
    }
}

impl<T: Element, N: Length> Copy for PhaseVector<T, N> where HalvesOf<T, N>: Copy {}

impl<T: Element, N: Length> PhaseVector<T, N> {
    /// Returns the vector of a length with `x` in every entry.
    #[inline]
    pub fn of_length(length: N, x: T) -> Self {
        Self(N::Kind::halves(length.count(), x))
    }

    /// Returns a half, 0 or 1.
    #[inline(always)]
    pub fn view(&self, half: usize) -> &ViewOf<T, N> {
        &self.0[half]
    }

    /// Returns a half, 0 or 1, for writing.
    #[inline(always)]
    pub fn view_mut(&mut self, half: usize) -> &mut ViewOf<T, N> {
        &mut self.0[half]
    }

    /// Returns all entries, those of the first half before those of the second.
    #[inline(always)]
    pub fn flat(&self) -> &[T] {
        N::Kind::flat(&self.0)
    }

    /// Returns all entries for writing, those of the first half before those of the second.
    #[inline(always)]
    pub fn flat_mut(&mut self) -> &mut [T] {
        N::Kind::flat_mut(&mut self.0)
    }
}

impl<T: Element, N: Length> PhaseVector<T, N> {
    /// Returns a vector that is not used. Its entries are `x`; for a run-time length it has none.
    #[inline(always)]
    pub(crate) fn placeholder(x: T) -> Self {
        Self(N::Kind::halves(0, x))
    }

    /// Joins coordinates to velocities or momenta.
    #[inline]
    pub(crate) fn joined(first: &VectorOf<T, N>, second: &VectorOf<T, N>) -> Self {
        SpareVectors::default().join(first, second)
    }

    /// Copies another vector of the same length.
    #[inline(always)]
    pub(crate) fn copy_from(&mut self, other: &Self) {
        N::Kind::copy(&mut self.0, &other.0);
    }

    /// Combines two vectors entry by entry.
    #[inline]
    pub(crate) fn each_with(&self, other: &Self, what_becomes: impl Fn(T, T) -> T) -> Self {
        let mut result = self.clone();
        for (x, y) in result.flat_mut().iter_mut().zip(other.flat()) {
            *x = what_becomes(*x, *y);
        }
        result
    }

    /// Returns a half, 0 or 1. For a run-time length it returns a vector without entries.
    #[inline(always)]
    pub(crate) fn half_if_constant(&self, half: usize) -> VectorOf<T, N> {
        N::Kind::half_if_constant(&self.0, half)
    }
}

/// Unused phase vectors, whose memory a step borrows. For constant lengths there are none.
pub(crate) struct SpareVectors<T: Element, N: Length>(<N::Kind as Kind>::Spare<T>);

impl<T: Element, N: Length> SpareVectors<T, N> {
    /// Returns a vector to write to, as long as this one.
    #[inline(always)]
    pub(crate) fn lend(&mut self, like: &PhaseVector<T, N>) -> PhaseVector<T, N> {
        PhaseVector(N::Kind::lend(&mut self.0, &like.0))
    }

    /// Joins coordinates to velocities or momenta.
    #[inline(always)]
    pub(crate) fn join(&mut self, first: &VectorOf<T, N>, second: &VectorOf<T, N>) -> PhaseVector<T, N> {
        PhaseVector(N::Kind::join(&mut self.0, first, second))
    }

    /// Takes back a vector.
    #[inline(always)]
    pub(crate) fn give_back(&mut self, lent: PhaseVector<T, N>) {
        N::Kind::give_back(&mut self.0, lent.0);
    }
}

impl<T: Element, N: Length> Clone for SpareVectors<T, N> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<T: Element, N: Length> core::fmt::Debug for SpareVectors<T, N> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("SpareVectors")
    }
}

impl<T: Element, N: Length> Default for SpareVectors<T, N> {
    fn default() -> Self {
        Self(Default::default())
    }
}

impl<T: Element, N: StaticLength> PhaseVector<T, N> {
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
impl<X: Element, N: StaticLength> FromFn for PhaseVector<X, N> {
    type Item = Array<X, N>;

    #[inline]
    fn from_fn(mut of: impl FnMut(usize) -> Array<X, N>) -> Self {
        Self::new([of(0), of(1)])
    }
}
