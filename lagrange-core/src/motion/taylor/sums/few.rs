//! Few sums of plain numbers, as a small system has them.
//!
//! There an order takes as long as its results wait for one another. So code is made for each number of terms, without
//! loops, and the terms at both ends are added last, from where they were computed: what reads four numbers at once from
//! where they were written one by one waits until they are in the cache. The others were written an order before.

use alloc::vec;
use alloc::vec::Vec;

use super::WIDTH;
use crate::number::{FixedArray, Four, ROOM, Scalar};

/// So many sums are few.
const FEW: usize = 32;

/// Whether sums of this type are few numbers: what else is longer keeps its processor busy without that.
pub(super) const fn are<T, S>() -> bool {
    size_of::<T>() <= size_of::<f64>() && size_of::<S>() <= FEW * size_of::<T>()
}

/// The terms of all sums of an order, aligned as the instructions that read them would have it.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
struct AlignedTerms<S>(S);

/// The factors of all sums so far, order by order.
#[derive(Clone, Debug)]
pub(super) struct Few<S> {
    left: Vec<AlignedTerms<S>>,
    /// From the highest order down.
    right: Vec<AlignedTerms<S>>,
}

/// The terms at both ends of few sums.
pub(in crate::motion::taylor) struct Ends<S> {
    newest: [S; 2],
    /// Those of order 1; that of the left factor where it is not the newest as well, which is from order 3 on.
    first: [S; 2],
}

impl<S> Ends<S> {
    pub(in crate::motion::taylor) fn new<T: Scalar>() -> Self
    where
        S: FixedArray<T>,
    {
        let none = [S::filled(T::constant(0.0)); 2];
        Self { newest: none, first: none }
    }
}

impl<S: Copy> Few<S> {
    pub(super) fn new<T: Scalar>(orders: usize) -> Self
    where
        S: FixedArray<T>,
    {
        let room = vec![AlignedTerms(S::filled(T::constant(0.0))); orders];
        Self { left: room.clone(), right: room }
    }

    #[inline(always)]
    pub(super) fn put(&mut self, order: usize, newest: &[S; 2], ends: &mut Ends<S>) {
        let place = self.right.len() - order;
        (self.left[order - 1], self.right[place]) = (AlignedTerms(newest[0]), AlignedTerms(newest[1]));
        match order {
            1 => ends.first[1] = newest[1],
            2 => ends.first[0] = self.left[0].0,
            _ => {}
        }
        ends.newest = *newest;
    }

    pub(super) fn left_factor<T: Copy>(&self, place: usize, order: usize) -> T
    where
        S: FixedArray<T>,
    {
        self.left[order - 1].0.as_ref()[place]
    }

    pub(super) fn right_factor<T: Copy>(&self, place: usize, order: usize) -> T
    where
        S: FixedArray<T>,
    {
        self.right[self.right.len() - order].0.as_ref()[place]
    }

    #[inline(always)]
    pub(super) fn add_up<T: Scalar>(&self, order: usize, ends: &Ends<S>) -> S
    where
        S: FixedArray<T>,
    {
        let (between, Ends { newest, first }) = (self.between(order), ends);
        let mut sums = S::filled(T::constant(0.0));
        for (sums, between) in sums.as_mut().as_chunks_mut().0.iter_mut().zip(between.as_ref()) {
            *sums = between.to_array();
        }
        for (i, sum) in sums.as_mut().iter_mut().enumerate() {
            let [[left, right], [first_left, first_right]] =
                [newest, first].map(|ends| ends.each_ref().map(|end| end.as_ref()[i]));
            *sum = left.multiply_add(first_right, right.multiply_add(first_left, *sum));
        }
        sums
    }

    /// The sums without their ends, by fours; the rest of the places is empty.
    #[inline(always)]
    fn between<T: Scalar>(&self, order: usize) -> S::Of<Four<T>>
    where
        S: FixedArray<T>,
    {
        let (none, orders) = (S::Of::filled(Four::zero()), self.right.len());
        let Some(terms @ 1..) = order.checked_sub(3) else { return none };
        let (left, right) = (&self.left[1..], &self.right[orders - terms - 1..]);
        macro_rules! by_terms {
            ($($terms:literal)*) => {
                match terms {
                    $($terms => match (left.first_chunk(), right.first_chunk()) {
                        (Some(left), Some(right)) => products::<T, S, $terms>(left, right),
                        _ => none,
                    },)*
                    _ => none,
                }
            };
        }
        const { assert!(ROOM == 31, "the highest order, 29, has sums of order 28") }
        by_terms!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25)
    }
}

/// Σ x_j y_j for each sum, in two parts side by side: of one, each product waits for the one before.
#[inline(always)]
fn products<T: Scalar, S: FixedArray<T>, const TERMS: usize>(
    left: &[AlignedTerms<S>; TERMS],
    right: &[AlignedTerms<S>; TERMS],
) -> S::Of<Four<T>> {
    let mut sums = S::Of::filled(Four::zero());
    let groups = left[0].0.as_ref().len() / WIDTH;
    for (group, sum) in sums.as_mut().iter_mut().enumerate().take(groups) {
        let (mut even, mut odd) = (Four::zero(), Four::zero());
        for (x, y) in left.iter().zip(right) {
            let [x, y] = [x, y].map(|row| Four::from(row.0.as_ref().as_chunks::<WIDTH>().0[group]));
            (even, odd) = (odd, x.multiply_add(y, even));
        }
        *sum = even + odd;
    }
    sums
}
