//! Splits a long function into chunks, and assigns spill slots to results that one chunk computes and a later one
//! uses.

use std::collections::BTreeSet;
use std::ops::Range;

use rustc_hash::FxHashMap;

use super::order_of_evaluation::Order;
use super::repeats::Repeat;
use crate::codegen::operation::Register;

/// Maximum number of operations of a function with a single chunk, since the time that LLVM takes grows
/// faster than linearly. Longer functions are also searched for loops.
const LONGEST: usize = 4_000;
/// Minimum number of operations of a chunk. The maximum is twice the number.
const SHORTEST: usize = 1_000;

/// Range of the sequence that becomes a chunk; with `repeat`, a loop.
pub(super) struct OperationRange {
    pub(super) range: Range<usize>,
    pub(super) repeat: Option<Repeat>,
}

pub(super) fn is_long(order: &Order) -> bool {
    order.sequence.len() > LONGEST
}

/// Splits the sequence into chunks. The chunks before and after a loop may be empty; they can copy numbers to and
/// from spill slots.
pub(super) fn segments(order: &Order, repeats: Vec<Repeat>) -> Vec<OperationRange> {
    let (mut segments, mut start) = (Vec::new(), 0);
    let straight = |range| cuts(order, range).into_iter().map(|range| OperationRange { range, repeat: None });
    for repeat in repeats {
        segments.extend(straight(start..repeat.range.start));
        start = repeat.range.end;
        segments.push(OperationRange { range: repeat.range.clone(), repeat: Some(repeat) });
    }
    segments.extend(straight(start..order.sequence.len()));
    segments
}

/// Splits a range of the sequence, at positions with the fewest live results.
fn cuts(order: &Order, range: Range<usize>) -> Vec<Range<usize>> {
    let Range { mut start, end: last } = range;
    let (mut parts, is_long) = (Vec::new(), range.len() > LONGEST);
    while is_long && last - start > 2 * SHORTEST {
        let latest = (start + 2 * SHORTEST).min(last - SHORTEST);
        let end = (start + SHORTEST..=latest).min_by_key(|&end| order.waiting[end - 1]).unwrap_or(latest);
        parts.push(start..end);
        start = end;
    }
    parts.push(start..last);
    parts
}

/// Allocation of an array of spill slots, which hold results between chunks.
#[derive(Default)]
pub(super) struct SpillSlots {
    places: FxHashMap<Register, usize>,
    free: BTreeSet<usize>,
    /// Length of the array.
    pub(super) length: usize,
}

impl SpillSlots {
    pub(super) fn place(&self, register: Register) -> Option<usize> {
        self.places.get(&register).copied()
    }

    pub(super) fn add(&mut self, register: Register) -> usize {
        let place = self.reserve(1);
        self.places.insert(register, place);
        place
    }

    /// Assigns a reserved slot to a register.
    pub(super) fn put(&mut self, register: Register, place: usize) {
        self.places.insert(register, place);
    }

    /// Reserves `count` consecutive free slots and returns the first.
    pub(super) fn reserve(&mut self, count: usize) -> usize {
        let is_free = |first: &usize| (*first..first + count).all(|place| self.free.contains(&place));
        let first = self.free.iter().copied().find(is_free).unwrap_or(self.length);
        (first..first + count).for_each(|place| _ = self.free.remove(&place));
        self.length = self.length.max(first + count);
        first
    }

    /// Frees the given slots, except those that hold a register.
    pub(super) fn release(&mut self, places: impl Iterator<Item = usize>) {
        let occupied: BTreeSet<usize> = self.places.values().copied().collect();
        self.free.extend(places.filter(|place| !occupied.contains(place)));
    }

    /// Frees the slots of registers that no later chunk uses.
    pub(super) fn keep(&mut self, is_awaited: impl Fn(Register) -> bool) {
        let free = &mut self.free;
        self.places.retain(|&register, place| {
            let is_awaited = is_awaited(register);
            free.extend((!is_awaited).then_some(*place));
            is_awaited
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn order(waiting: Vec<usize>) -> Order {
        Order { sequence: (0..waiting.len()).collect(), waiting, peak_before: 0 }
    }

    #[test]
    fn parts_follow_on_one_another_and_none_is_short_or_long() {
        for length in [LONGEST + 1, 5_000, 9_999, 30_000] {
            let parts = cuts(&order((0..length).map(|k| k * 7 % 13).collect()), 0..length);
            assert_eq!((parts[0].start, parts.last().map(|part| part.end)), (0, Some(length)));
            assert!(parts.windows(2).all(|pair| pair[0].end == pair[1].start));
            assert!(parts.iter().all(|part| (SHORTEST..=2 * SHORTEST).contains(&part.len())), "{parts:?}");
        }
        for length in [0, 1, LONGEST] {
            let parts = cuts(&order(vec![0; length]), 0..length);
            assert!(parts.len() == 1 && parts[0] == (0..length), "{parts:?}");
        }
    }

    #[test]
    fn a_cut_is_where_fewest_results_wait() {
        let mut waiting = vec![5; LONGEST + 1];
        waiting[1_233] = 1;
        assert_eq!(cuts(&order(waiting), 0..LONGEST + 1)[0], 0..1_234);
    }

    #[test]
    fn a_place_that_is_left_is_taken_again() {
        let mut waiting = SpillSlots::default();
        let [first, second, third] = [0, 1, 2].map(Register::at);
        assert_eq!([waiting.add(first), waiting.add(second)], [0, 1]);
        waiting.keep(|register| register != first);
        assert_eq!((waiting.place(first), waiting.add(third)), (None, 0));
        assert_eq!((waiting.place(second), waiting.length), (Some(1), 2));
    }
}
