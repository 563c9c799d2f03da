//! The sums of Taylor's recurrences: of products of coefficients, the orders of which add up to one order.

mod few;

use alloc::vec;
use alloc::vec::Vec;
use core::array::from_fn;

use crate::number::{Filled, Scalar};
pub(super) use few::Ends;
use few::Few;

/// So many sums are computed side by side, of a multiple of which the derive tells.
const WIDTH: usize = 4;

/// Aligned as the instructions that read it would have it: every other one would otherwise touch two lines of the cache.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
struct Group<T>([T; WIDTH]);

/// The factors of all sums so far, order by order.
#[derive(Clone, Debug)]
pub(super) struct Factors<T, S> {
    /// How many orders there is room for; the first is 1.
    orders: usize,
    /// Where there are few of them, else by groups.
    few: Few<S>,
    left: Vec<Group<T>>,
    /// From the highest order down, so that a sum runs through both in the same direction.
    right: Vec<Group<T>>,
}

impl<T: Scalar, S: Filled<T>> Factors<T, S> {
    /// Room for so many orders.
    pub(super) fn new(orders: usize) -> Self {
        let sums = S::filled(T::constant(0.0)).as_ref().len();
        let [rows, groups] = if few::are::<T, S>() { [orders, 0] } else { [0, sums / WIDTH * orders] };
        let room = vec![Group([T::constant(0.0); WIDTH]); groups];
        Self { orders, few: Few::new::<T>(rows), left: room.clone(), right: room }
    }

    /// The terms of an order.
    #[inline(always)]
    pub(super) fn put(&mut self, order: usize, newest: &[S; 2], ends: &mut Ends<S>) {
        if const { few::are::<T, S>() } {
            return self.few.put(order, newest, ends);
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
        (1..=count).map(move |order| match const { few::are::<T, S>() } {
            true => self.few.right_factor(place, order),
            false => self.right[place / WIDTH * self.orders + self.orders - order].0[place % WIDTH],
        })
    }

    /// The sums of an order, of the factors of all orders before it, and of no other: there may be no numbers.
    #[inline(always)]
    pub(super) fn add_up(&self, order: usize, ends: &Ends<S>, sums: &mut S) {
        if const { few::are::<T, S>() } {
            *sums = self.few.add_up(order, ends);
            return;
        }
        let terms = order - 1;
        for (group, sums) in sums.as_mut().as_chunks_mut().0.iter_mut().enumerate() {
            let (left, right) = (group * self.orders, (group + 1) * self.orders - terms);
            let (left, right) = (&self.left[left..left + terms], &self.right[right..right + terms]);
            // Four numbers alone are one vector, four lanes are four: of these there are registers for two parts.
            *sums = match const { size_of::<T>() > size_of::<f64>() } {
                true => products::<T, 2>(left, right),
                false => products::<T, 4>(left, right),
            };
        }
    }
}

/// Σ x_j y_j in so many parts side by side: of one, each product waits for the one before. The newest come last, at both
/// ends: meanwhile the others can be computed.
#[inline(always)]
fn products<T: Scalar, const PARTS: usize>(x: &[Group<T>], y: &[Group<T>]) -> [T; WIDTH] {
    let mut parts = [[T::constant(0.0); WIDTH]; PARTS];
    let add = |part: &mut [T; WIDTH], x: &Group<T>, y: &Group<T>| {
        *part = from_fn(|lane| x.0[lane].multiply_add(y.0[lane], part[lane]));
    };
    match (x, y) {
        ([first, x @ .., last], [newest, y @ .., oldest]) => {
            let ((x, rest), (y, rest_y)) = (x.as_chunks::<PARTS>(), y.as_chunks::<PARTS>());
            for (x, y) in x.iter().zip(y) {
                (0..PARTS).for_each(|k| add(&mut parts[k], &x[k], &y[k]));
            }
            parts.iter_mut().zip(rest.iter().zip(rest_y)).for_each(|(part, (x, y))| add(part, x, y));
            add(&mut parts[PARTS - 2], first, newest);
            add(&mut parts[PARTS - 1], last, oldest);
        }
        ([x], [y]) => add(&mut parts[0], x, y),
        _ => {}
    }
    // Neighbours first.
    let mut count = PARTS;
    while count > 1 {
        count /= 2;
        for k in 0..count {
            parts[k] = from_fn(|lane| parts[2 * k][lane] + parts[2 * k + 1][lane]);
        }
    }
    parts[0]
}
