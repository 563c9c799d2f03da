//! Where a long function is cut into parts, and where results wait that one part computes and a later one uses.

use std::ops::Range;

use rustc_hash::FxHashMap;

use super::order_of_evaluation::Order;
use crate::codegen::operation::Register;

/// Longer functions are cut: the time that LLVM takes grows faster than the length.
const LONGEST: usize = 4_000;
/// A part has at least as many operations, and at most twice as many.
const SHORTEST: usize = 1_000;

/// The parts of a function as ranges of the sequence, cut where fewest results wait.
pub(super) fn cuts(order: &Order) -> Vec<Range<usize>> {
    let length = order.sequence.len();
    let (mut parts, mut start) = (Vec::new(), 0);
    while length > LONGEST && length - start > 2 * SHORTEST {
        let latest = (start + 2 * SHORTEST).min(length - SHORTEST);
        let end = (start + SHORTEST..=latest).min_by_key(|&end| order.waiting[end - 1]).unwrap_or(latest);
        parts.push(start..end);
        start = end;
    }
    parts.push(start..length);
    parts
}

/// The places of an array in which results wait between parts.
#[derive(Default)]
pub(super) struct Waiting {
    places: FxHashMap<Register, usize>,
    free: Vec<usize>,
    /// The length of the array.
    pub(super) length: usize,
}

impl Waiting {
    pub(super) fn place(&self, register: Register) -> Option<usize> {
        self.places.get(&register).copied()
    }

    pub(super) fn add(&mut self, register: Register) -> usize {
        let place = self.free.pop().unwrap_or_else(|| {
            self.length += 1;
            self.length - 1
        });
        self.places.insert(register, place);
        place
    }

    /// Its place can be another's.
    pub(super) fn remove(&mut self, register: Register) {
        self.free.extend(self.places.remove(&register));
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
            let parts = cuts(&order((0..length).map(|k| k * 7 % 13).collect()));
            assert_eq!((parts[0].start, parts.last().map(|part| part.end)), (0, Some(length)));
            assert!(parts.windows(2).all(|pair| pair[0].end == pair[1].start));
            assert!(parts.iter().all(|part| (SHORTEST..=2 * SHORTEST).contains(&part.len())), "{parts:?}");
        }
        for length in [0, 1, LONGEST] {
            let parts = cuts(&order(vec![0; length]));
            assert!(parts.len() == 1 && parts[0] == (0..length), "{parts:?}");
        }
    }

    #[test]
    fn a_cut_is_where_fewest_results_wait() {
        let mut waiting = vec![5; LONGEST + 1];
        waiting[1_233] = 1;
        assert_eq!(cuts(&order(waiting))[0], 0..1_234);
    }

    #[test]
    fn a_place_that_is_left_is_taken_again() {
        let mut waiting = Waiting::default();
        let [first, second, third] = [0, 1, 2].map(Register::at);
        assert_eq!([waiting.add(first), waiting.add(second)], [0, 1]);
        waiting.remove(first);
        assert_eq!((waiting.place(first), waiting.add(third)), (None, 0));
        assert_eq!((waiting.place(second), waiting.length), (Some(1), 2));
    }
}
