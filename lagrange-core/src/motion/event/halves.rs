//! A piece of a step, divided by halving until nothing in a part is left open.

use crate::number::Real;

/// An interval among those that a piece of a step is divided into, by halving.
pub(super) struct Halves<T> {
    ends: [T; 2],
    /// How often it has been halved, and the place among those that are as short.
    pub(super) level: u32,
    index: u64,
}

impl<T: Real> Halves<T> {
    pub(super) fn of(ends: [T; 2]) -> Self {
        Self { ends, level: 0, index: 0 }
    }

    /// Where the interval ends.
    pub(super) fn end(&self) -> T {
        let (next, count) = (self.index + 1, 1_u64 << self.level);
        let [from, to] = self.ends;
        if next == count { to } else { from + (to - from) * T::constant(next as f64 / count as f64) }
    }

    /// Goes to the first half of the interval.
    pub(super) fn halve(&mut self) {
        (self.level, self.index) = (self.level + 1, 2 * self.index);
    }

    /// Goes to the interval that follows, if there is one in the piece: the longest, of which no part has been looked at.
    pub(super) fn advance(&mut self) -> bool {
        self.index += 1;
        while self.index.is_multiple_of(2) && self.level > 0 {
            (self.level, self.index) = (self.level - 1, self.index / 2);
        }
        self.level > 0
    }
}

/// A piece is halved this often at most.
pub(super) const LEVELS: u32 = 52;
