//! Room for what is too large for the stack.

use core::ops::{Deref, DerefMut};

#[cfg(feature = "alloc")]
use alloc::boxed::Box;

/// A value on the heap where there is one, and in place without the feature `alloc`. It is made once in a run: its size grows with
/// the number of coordinates, and every function that hands it on by value, unless it is optimized, would have copies.
#[cfg(feature = "alloc")]
#[derive(Clone, Debug)]
pub(crate) struct Room<X>(Box<X>);

#[cfg(not(feature = "alloc"))]
#[derive(Clone, Debug)]
pub(crate) struct Room<X>(X);

impl<X> Room<X> {
    #[inline]
    pub(crate) fn of(x: X) -> Self {
        #[cfg(feature = "alloc")]
        return Self(Box::new(x));
        #[cfg(not(feature = "alloc"))]
        return Self(x);
    }
}

impl<X: Copy, const K: usize> Room<[X; K]> {
    /// An array of `x`, built where it stays.
    pub(crate) fn filled(x: X) -> Self {
        #[cfg(feature = "alloc")]
        return Self(alloc::vec![x; K].into_boxed_slice().try_into().unwrap_or_else(|_| Box::new([x; K])));
        #[cfg(not(feature = "alloc"))]
        return Self([x; K]);
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
