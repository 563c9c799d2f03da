//! The sums of Taylor's recurrences: of products of coefficients, the orders of which add up to one order.
//!
//! They take as long as their factors are read from memory. So two orders are summed at once, the later one as far as it is
//! known: its left factors are those of the earlier one, its right factors those of the term before.

mod alone;
mod group;

use alloc::vec;
use alloc::vec::Vec;
use core::marker::PhantomData;

use crate::number::{FixedArray, Scalar};
pub(super) use alone::Ends;
use group::{Group, WIDTH, plus, products};

/// The factors of all sums so far, order by order.
#[derive(Clone, Debug)]
pub(super) struct SeriesFactors<T, S> {
    /// How many orders there is room for; the first is 1.
    orders: usize,
    left: Vec<Group<T>>,
    /// From the highest order down, so that a sum runs through both in the same direction.
    right: Vec<Group<T>>,
    /// The sums of the next order, without the terms in which the newest are that are still to come.
    ahead: Vec<Group<T>>,
    sums: PhantomData<S>,
}

impl<T: Scalar, S: FixedArray<T>> SeriesFactors<T, S> {
    /// Room for so many orders.
    pub(super) fn new(orders: usize) -> Self {
        let sums = S::filled(T::constant(0.0)).as_ref().len();
        let groups = sums / WIDTH;
        let room = |groups| vec![Group([T::constant(0.0); WIDTH]); groups];
        let (left, right, ahead) = (room(groups * orders), room(groups * orders), room(groups));
        Self { orders, left, right, ahead, sums: PhantomData }
    }

    /// The terms of an order.
    #[inline(always)]
    pub(super) fn put(&mut self, order: usize, newest: &[S; 2], ends: &mut Ends<S>) {
        if const { alone::is::<T, S>() } {
            ends.put(order, newest);
        }
        let [left, right] = newest;
        let places = [(&mut self.left, left, order - 1), (&mut self.right, right, self.orders - order)];
        for (all, newest, place) in places {
            // In steps, not in chunks: how many of these there are takes a division.
            for (group, newest) in newest.as_ref().as_chunks().0.iter().enumerate() {
                all[group * self.orders + place] = Group(*newest);
            }
        }
    }

    /// The coefficients of the right factor of a sum, from order 1, of which there are so many.
    pub(super) fn right_factor(&self, place: usize, count: usize) -> impl Iterator<Item = T> + Clone {
        (1..=count)
            .map(move |order| self.right[place / WIDTH * self.orders + self.orders - order].0[place % WIDTH])
    }

    /// The coefficients of the left factor of a sum, from order 1, of which there are so many.
    pub(super) fn left_factor(&self, place: usize, count: usize) -> impl Iterator<Item = T> + Clone {
        (1..=count).map(move |order| self.left[place / WIDTH * self.orders + order - 1].0[place % WIDTH])
    }

    /// The sums of an order, of the factors of all orders before it. Those of later orders are not read: they may hold NaN.
    /// Orders come one after the other.
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
                // A group of numbers is one vector, one of lanes four of them: registers suffice for one set of partial sums.
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
