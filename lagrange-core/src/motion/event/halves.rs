//! Division of a part of a step by repeated halving.

use crate::number::Real;

/// Current interval of a part of a step that is divided by halving.
pub(super) struct Halves<T> {
    ends: [T; 2],
    /// Number of halvings that lead to the interval, and its index among the intervals of the same length.
    pub(super) level: u32,
    index: u64,
}

impl<T: Real> Halves<T> {
    pub(super) fn of(ends: [T; 2]) -> Self {
        Self { ends, level: 0, index: 0 }
    }

    /// End of the interval.
    pub(super) fn end(&self) -> T {
        let (next, count) = (self.index + 1, 1_u64 << self.level);
        let [from, to] = self.ends;
        if next == count { to } else { from + (to - from) * T::constant(next as f64 / count as f64) }
    }

    /// Moves to the first half of the interval.
    pub(super) fn halve(&mut self) {
        (self.level, self.index) = (self.level + 1, 2 * self.index);
    }

    /// Moves to the interval that follows: the longest of which no part has been searched. Returns false at the end of
    /// the part.
    pub(super) fn advance(&mut self) -> bool {
        self.index += 1;
        while self.index.is_multiple_of(2) && self.level > 0 {
            (self.level, self.index) = (self.level - 1, self.index / 2);
        }
        self.level > 0
    }
}

/// Largest number of halvings: one for each bit of a number.
pub(super) const LEVELS: u32 = f64::MANTISSA_DIGITS - 1;
