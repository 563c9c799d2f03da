//! Storage for values too large for the stack.

use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;
use core::ops::{Deref, DerefMut};

/// Dense output of the stored steps; without the feature `alloc`, of one step.
pub(crate) type Within<I> = Vec<I>;

/// A value on the heap, or in place without the feature `alloc`. It is allocated once per run. The size of `X`
/// grows with the number of coordinates, and unoptimized code copies it in every function that passes it by
/// value.
#[derive(Clone, Debug)]
pub(crate) struct Room<X>(Box<X>);

impl<X> Room<X> {
    #[inline]
    pub(crate) fn of(x: X) -> Self {
        Self(Box::new(x))
    }
}

impl<X: Clone, const K: usize> Room<[X; K]> {
    /// Returns an array filled with `x`, built in its final place.
    pub(crate) fn filled(x: X) -> Self {
        Self(
            vec![x.clone(); K]
                .into_boxed_slice()
                .try_into()
                .unwrap_or_else(|_| Box::new(core::array::from_fn(|_| x.clone()))),
        )
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
