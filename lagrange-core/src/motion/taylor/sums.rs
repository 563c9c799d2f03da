//! Sums of Taylor's recurrences: convolutions of Taylor coefficients.
//!
//! Reading the factors from memory takes most of the time. So two orders are summed in one pass, the later one as far
//! as its factors are known. Each of its terms has the same left factor as in the earlier order, and the right factor
//! of the term before.

mod alone;
mod group;

use alloc::vec;
use alloc::vec::Vec;
use core::marker::PhantomData;

use crate::number::Scalar;
use crate::vector::FixedArray;

use super::limits::WIDTH;
pub(super) use alone::Ends;
use group::{Group, plus, products};

/// Factors of all convolutions, order by order, up to the order last computed.
#[derive(Clone, Debug)]
pub(super) struct SeriesFactors<T, S> {
    /// Number of orders that fit; the first is 1.
    orders: usize,
    left: Vec<Group<T>>,
    /// Right factors from the highest order down, so that a sum reads both arrays in the same direction.
    right: Vec<Group<T>>,
    /// Sums of the next order, without the terms that contain factors of the current order, which are not
    /// known yet.
    ahead: Vec<Group<T>>,
    sums: PhantomData<S>,
}

impl<T: Scalar, S: FixedArray<T>> SeriesFactors<T, S> {
    /// Allocates memory for this number of orders.
    pub(super) fn new(orders: usize) -> Self {
        let sums = S::filled(T::constant(0.0)).as_ref().len();
        let groups = sums / WIDTH;
        let room = |groups| vec![Group([T::constant(0.0); WIDTH]); groups];
        let (left, right, ahead) = (room(groups * orders), room(groups * orders), room(groups));
        Self { orders, left, right, ahead, sums: PhantomData }
    }

    /// Stores the factors of an order.
    #[inline(always)]
    pub(super) fn put(&mut self, order: usize, newest: &[S; 2], ends: &mut Ends<S>) {
        if const { alone::is::<T, S>() } {
            ends.put(order, newest);
        }
        let [left, right] = newest;
        let places = [(&mut self.left, left, order - 1), (&mut self.right, right, self.orders - order)];
        for (all, newest, place) in places {
            // Strided, not in chunks: counting chunks would take a division.
            for (group, newest) in newest.as_ref().as_chunks().0.iter().enumerate() {
                all[group * self.orders + place] = Group(*newest);
            }
        }
    }

    /// Taylor coefficients of orders 1 to `count` of the right factor in the convolution with index `place`.
    pub(super) fn right_factor(&self, place: usize, count: usize) -> impl Iterator<Item = T> + Clone {
        (1..=count)
            .map(move |order| self.right[place / WIDTH * self.orders + self.orders - order].0[place % WIDTH])
    }

    /// Taylor coefficients of orders 1 to `count` of the left factor in the convolution with index `place`.
    pub(super) fn left_factor(&self, place: usize, count: usize) -> impl Iterator<Item = T> + Clone {
        (1..=count).map(move |order| self.left[place / WIDTH * self.orders + order - 1].0[place % WIDTH])
    }

    /// Computes the sums of an order from the factors of all orders before it. Factors of later orders are not read:
    /// they may be NaN. Orders must follow each other.
    #[inline(always)]
    pub(super) fn add_up(&mut self, order: usize, ends: &Ends<S>, sums: &mut S) {
        if const { alone::is::<T, S>() } {
            return ends.add_to(alone::between(order, &self.left, &self.right), sums);
        }
        let terms = order - 1;
        let sums = sums.as_mut().as_chunks_mut().0.iter_mut();
        for (group, (sums, ahead)) in sums.zip(&mut self.ahead).enumerate() {
            let (left, right) = (group * self.orders, (group + 1) * self.orders - terms);
            let (left, right) = (&self.left[left..left + terms], &self.right[right..right + terms]);
            if order.is_multiple_of(2) {
                // A group of plain numbers fills one SIMD vector, and the registers hold two sets of partial
                // sums. A group of lanes fills four, and the registers hold one set.
                let [now, next] = match const { size_of::<T>() > size_of::<f64>() } {
                    true => products::<T, 1>(left, right),
                    false => products::<T, 2>(left, right),
                };
                (*sums, ahead.0) = (now, next);
            } else if let ([first, .., last], [newest, .., oldest]) = (left, right) {
                *sums = plus(&plus(&ahead.0, first, newest), last, oldest);
            }
        }
    }
}
