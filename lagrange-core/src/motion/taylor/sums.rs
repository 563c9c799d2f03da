//! The sums of Taylor's recurrences: of products of coefficients, the orders of which add up to one order.

use alloc::vec;
use alloc::vec::Vec;
use core::array::from_fn;

use crate::number::{Filled, Scalar};

/// So many sums are computed side by side, of a multiple of which the derive tells, and so many orders in one go.
const WIDTH: usize = 4;
const BLOCK: usize = 4;

/// Aligned as the instructions that read it would have it: every other one would otherwise touch two lines of the cache.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
struct Group<T>([T; WIDTH]);

/// The factors of all sums so far, order by order.
#[derive(Clone, Debug)]
pub(super) struct Factors<T> {
    /// How many orders there is room for; the first is 1.
    orders: usize,
    left: Vec<Group<T>>,
    /// From the highest order down, so that a sum runs through both in the same direction. A block of zeros follows: a sum may
    /// run on into it.
    right: Vec<Group<T>>,
}

impl<T: Scalar> Factors<T> {
    /// Room for so many sums.
    pub(super) fn new(sums: usize, orders: usize) -> Self {
        let room = vec![Group([T::constant(0.0); WIDTH]); sums / WIDTH * (orders + BLOCK)];
        Self { orders, left: room.clone(), right: room }
    }

    /// Forgets all: a sum runs on over terms of a motion before, by zeros, which leave what is not a number as it is.
    #[cold]
    pub(super) fn clear(&mut self) {
        for factor in [&mut self.left, &mut self.right] {
            factor.fill(Group([T::constant(0.0); WIDTH]));
        }
    }

    /// The terms of an order.
    #[inline(always)]
    pub(super) fn put<S: Filled<T>>(&mut self, order: usize, [left, right]: &[S; 2]) {
        let places = [(&mut self.left, left, order - 1), (&mut self.right, right, self.orders - order)];
        for (all, newest, place) in places {
            let groups = all.chunks_exact_mut(self.orders + BLOCK);
            for (group, newest) in groups.zip(newest.as_ref().as_chunks().0) {
                group[place] = Group(*newest);
            }
        }
    }

    /// The coefficients of the right factor of a sum, from order 1, of which there are so many.
    pub(super) fn right_factor(&self, place: usize, count: usize) -> impl Iterator<Item = T> + Clone {
        let group = &self.right[place / WIDTH * (self.orders + BLOCK)..];
        (1..=count).map(move |order| group[self.orders - order].0[place % WIDTH])
    }

    /// The sums of an order, of the factors of all orders before it.
    #[inline(always)]
    pub(super) fn add_up<S: Filled<T>>(&self, order: usize, sums: &mut S) {
        let (length, blocks) = (self.orders + BLOCK, (order - 1).div_ceil(BLOCK));
        let groups = self.left.chunks_exact(length).zip(self.right.chunks_exact(length));
        for (sums, (left, right)) in sums.as_mut().as_chunks_mut().0.iter_mut().zip(groups) {
            // There, order k − 1 comes first.
            let right = &right[self.orders + 1 - order..];
            *sums = products(&left.as_chunks().0[..blocks], &right.as_chunks().0[..blocks]);
        }
    }
}

/// Σ x_j y_j of blocks, in as many parts side by side as a block has.
#[inline(always)]
fn products<T: Scalar>(x: &[[Group<T>; BLOCK]], y: &[[Group<T>; BLOCK]]) -> [T; WIDTH] {
    let mut parts = [[T::constant(0.0); WIDTH]; BLOCK];
    for (x, y) in x.iter().zip(y) {
        for ((part, x), y) in parts.iter_mut().zip(x).zip(y) {
            *part = from_fn(|lane| x.0[lane].multiply_add(y.0[lane], part[lane]));
        }
    }
    let [a, b, c, d] = parts;
    from_fn(|lane| (a[lane] + b[lane]) + (c[lane] + d[lane]))
}
