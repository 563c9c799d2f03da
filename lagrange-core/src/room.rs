//! Storage for values too large for the stack.

use core::ops::{Deref, DerefMut};

#[cfg(feature = "alloc")]
use alloc::boxed::Box;

/// A value on the heap, or in place without the feature `alloc`. It is allocated once per run. The size of `X`
/// grows with the number of coordinates, and unoptimized code copies it in every function that passes it by
/// value.
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

impl<X: Clone, const K: usize> Room<[X; K]> {
    /// Returns an array filled with `x`, built in its final place.
    pub(crate) fn filled(x: X) -> Self {
        #[cfg(feature = "alloc")]
        return Self(
            alloc::vec![x.clone(); K]
                .into_boxed_slice()
                .try_into()
                .unwrap_or_else(|_| Box::new(core::array::from_fn(|_| x.clone()))),
        );
        #[cfg(not(feature = "alloc"))]
        return Self(core::array::from_fn(|_| x.clone()));
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
