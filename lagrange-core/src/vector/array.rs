//! Arrays whose length is a type.

use core::fmt::{self, Debug, Formatter};
use core::ops::{Deref, DerefMut};

use nalgebra::Const;

use super::{Element, StaticLength};

/// Array of a length: `[T; K]` for [`Const<K>`](Const). It dereferences to a slice.
#[derive(Clone, Copy)]
pub struct Array<T: Element, N: StaticLength>(pub N::Entries<T>);

impl<T: Element, N: StaticLength> Array<T, N> {
    /// Returns an array with `x` in every entry.
    #[inline]
    pub fn filled(x: T) -> Self {
        Self(N::filled(x))
    }

    /// Returns the array `of(0)`, `of(1)`, ….
    #[inline]
    pub fn from_fn(of: impl FnMut(usize) -> T) -> Self {
        Self(N::from_fn(of))
    }

    /// Returns the values of a function of the entries.
    #[inline]
    pub fn map<U: Element>(self, mut of: impl FnMut(T) -> U) -> Array<U, N> {
        Array::from_fn(|i| of(self[i]))
    }
}

impl<T: Element, N: StaticLength> Deref for Array<T, N> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        self.0.as_ref()
    }
}

impl<T: Element, N: StaticLength> DerefMut for Array<T, N> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        self.0.as_mut()
    }
}

impl<T: Element, N: StaticLength> IntoIterator for Array<T, N> {
    type Item = T;
    type IntoIter = <N::Entries<T> as IntoIterator>::IntoIter;

    #[inline(always)]
    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl<'a, T: Element, N: StaticLength> IntoIterator for &'a Array<T, N> {
    type Item = &'a T;
    type IntoIter = core::slice::Iter<'a, T>;

    #[inline(always)]
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<'a, T: Element, N: StaticLength> IntoIterator for &'a mut Array<T, N> {
    type Item = &'a mut T;
    type IntoIter = core::slice::IterMut<'a, T>;

    #[inline(always)]
    fn into_iter(self) -> Self::IntoIter {
        self.iter_mut()
    }
}

impl<T: Element, N: StaticLength> Debug for Array<T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        Debug::fmt(&**self, f)
    }
}

impl<T: Element, N: StaticLength> PartialEq for Array<T, N> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<T: Element, N: StaticLength> AsRef<[T]> for Array<T, N> {
    #[inline(always)]
    fn as_ref(&self) -> &[T] {
        self
    }
}

impl<T: Element, N: StaticLength> AsMut<[T]> for Array<T, N> {
    #[inline(always)]
    fn as_mut(&mut self) -> &mut [T] {
        self
    }
}

impl<T: Element, const K: usize> From<[T; K]> for Array<T, Const<K>> {
    #[inline]
    fn from(entries: [T; K]) -> Self {
        Self(entries)
    }
}

impl<T: Element, const R: usize, const C: usize> From<[[T; R]; C]> for Array<Array<T, Const<R>>, Const<C>> {
    #[inline]
    fn from(columns: [[T; R]; C]) -> Self {
        Self(columns.map(Array))
    }
}

/// An array that a function of the index fills: `[X; K]` or [`Array`].
pub(crate) trait FromFn {
    type Item;
    fn from_fn(of: impl FnMut(usize) -> Self::Item) -> Self;
}

impl<X, const K: usize> FromFn for [X; K] {
    type Item = X;

    #[inline]
    fn from_fn(of: impl FnMut(usize) -> X) -> Self {
        core::array::from_fn(of)
    }
}

impl<X: Element, N: StaticLength> FromFn for Array<X, N> {
    type Item = X;

    #[inline]
    fn from_fn(of: impl FnMut(usize) -> X) -> Self {
        Self(N::from_fn(of))
    }
}

/// Returns the array `of(0)`, `of(1)`, ….
#[inline]
pub(crate) fn from_fn<A: FromFn>(of: impl FnMut(usize) -> A::Item) -> A {
    A::from_fn(of)
}

/// An array of fixed length that can be filled with copies of a value.
pub trait FixedArray<T>: Copy + AsRef<[T]> + AsMut<[T]> {
    /// Returns an array with `x` in every entry.
    fn filled(x: T) -> Self;
}

impl<T: Copy, const K: usize> FixedArray<T> for [T; K] {
    #[inline]
    fn filled(x: T) -> Self {
        [x; K]
    }
}
