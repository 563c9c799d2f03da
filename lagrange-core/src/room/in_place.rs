//! Storage without an allocator: in place.

use core::ops::{Deref, DerefMut};

/// A list of one: each value replaces the one before.
#[derive(Debug)]
pub struct Within<I>(Option<I>);

impl<I> Default for Within<I> {
    fn default() -> Self {
        Self(None)
    }
}

impl<I> Within<I> {
    pub(crate) fn clear(&mut self) {
        self.0 = None;
    }

    pub(crate) fn push(&mut self, x: I) {
        self.0 = Some(x);
    }

    pub(crate) fn first(&self) -> Option<&I> {
        self.0.as_ref()
    }

    pub(crate) fn last_mut(&mut self) -> Option<&mut I> {
        self.0.as_mut()
    }
}

/// A value where it is declared.
#[derive(Clone, Debug)]
pub(crate) struct Room<X>(X);

impl<X> Room<X> {
    #[inline]
    pub(crate) fn of(x: X) -> Self {
        Self(x)
    }
}

impl<X: Clone, const K: usize> Room<[X; K]> {
    pub(crate) fn filled(x: X) -> Self {
        Self(core::array::from_fn(|_| x.clone()))
    }
}

impl<X> Deref for Room<X> {
    type Target = X;

    #[inline(always)]
    fn deref(&self) -> &X {
        &self.0
    }
}

impl<X> DerefMut for Room<X> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut X {
        &mut self.0
    }
}
