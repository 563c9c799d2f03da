//! Sums of the smallest systems, which fit into one group of plain numbers.
//!
//! Latency determines their time: each result waits for the one before. So the code is unrolled for each
//! number of terms. The first and the last term, which contain the factors of the order before, are added
//! last, from the variables in which these were computed. Numbers just stored one by one cannot be loaded as
//! a vector before they reach the cache; the other factors were stored an order earlier. With more groups,
//! the processor works on other groups meanwhile, and none of this is needed.

use super::super::limits::WIDTH;
use super::group::{Group, plus};
use crate::number::{ROOM, Scalar};
use crate::vector::FixedArray;

/// True if sums of this type are one group of plain numbers.
pub(super) const fn is<T, S>() -> bool {
    size_of::<T>() <= size_of::<f64>() && size_of::<S>() == WIDTH * size_of::<T>()
}

/// Factors of the terms at both ends of the sums.
pub(crate) struct Ends<S> {
    newest: [S; 2],
    /// Left and right factors of order 1. The left one is zero until `newest` holds a higher order, from the
    /// sums of order 3 on.
    first: [S; 2],
}

impl<S: Copy> Ends<S> {
    pub(crate) fn new<T: Scalar>() -> Self
    where
        S: FixedArray<T>,
    {
        let none = [S::filled(T::constant(0.0)); 2];
        Self { newest: none, first: none }
    }

    /// Stores the left and right factors of one Taylor order, for the end terms of the next sums.
    #[inline(always)]
    pub(super) fn put(&mut self, order: usize, newest: &[S; 2]) {
        match order {
            1 => self.first[1] = newest[1],
            2 => self.first[0] = self.newest[0],
            _ => {}
        }
        self.newest = *newest;
    }

    /// Computes the sums of an order from their inner terms.
    #[inline(always)]
    pub(super) fn add_to<T: Scalar>(&self, between: [T; WIDTH], sums: &mut S)
    where
        S: FixedArray<T>,
    {
        for (i, (sum, between)) in sums.as_mut().iter_mut().zip(between).enumerate() {
            let [[left, right], [first_left, first_right]] =
                [&self.newest, &self.first].map(|ends| ends.each_ref().map(|end| end.as_ref()[i]));
            *sum = left.multiply_add(first_right, right.multiply_add(first_left, between));
        }
    }
}

/// Inner terms of the sums of an order; [`Ends::add_to`] adds the terms at both ends.
#[inline(always)]
pub(super) fn between<T: Scalar>(order: usize, left: &[Group<T>], right: &[Group<T>]) -> [T; WIDTH] {
    let none = [T::constant(0.0); WIDTH];
    let Some(terms @ 1..) = order.checked_sub(3) else { return none };
    let (left, right) = (&left[1..], &right[right.len() - terms - 1..]);
    macro_rules! by_terms {
        ($($terms:literal)*) => {
            match terms {
                $($terms => match (left.first_chunk(), right.first_chunk()) {
                    (Some(left), Some(right)) => products::<T, $terms>(left, right),
                    _ => none,
                },)*
                _ => none,
            }
        };
    }
    const { assert!(ROOM == 31, "the highest order, 29, has sums of order 28") }
    by_terms!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25)
}

/// Σ x_j y_j for each sum, in two partial sums: in a single one, each product waits for the one before.
#[inline(always)]
fn products<T: Scalar, const TERMS: usize>(
    left: &[Group<T>; TERMS],
    right: &[Group<T>; TERMS],
) -> [T; WIDTH] {
    let none = [T::constant(0.0); WIDTH];
    let (mut even, mut odd) = (none, none);
    for (x, y) in left.iter().zip(right) {
        (even, odd) = (odd, plus(&even, x, y));
    }
    core::array::from_fn(|lane| even[lane] + odd[lane])
}
