//! Functions that may be too small for a series at the start of a step and large within: exp of what is far below zero, tanh where it is all
//! but ±1, high powers of what is all but zero. The runtime looks at how far their arguments go.

use super::recurrences::{Recurrences, SeriesQuantity};
use crate::codegen::operation::Register;

/// A power is high from here on: it doubles where its base changes by a twentieth.
const HIGH: u32 = 16;

impl Recurrences {
    /// Notes the argument of exp, tanh, sinh or cosh, or the base of a power, with its exponent.
    pub(super) fn note_steep(&mut self, x: SeriesQuantity, exponent: u32) {
        let noted = self.steep.entry(x).or_default();
        *noted = (*noted).max(exponent);
    }

    /// Notes that a product is a power, where both factors are powers of the same base.
    pub(super) fn note_power(&mut self, [x, y]: [SeriesQuantity; 2], product: SeriesQuantity) {
        let power = |x: SeriesQuantity| self.powers.get(&x).copied().unwrap_or((x, 1));
        let [(base, e), (other, f)] = [power(x), power(y)];
        if base == other {
            self.powers.insert(product, (base, e + f));
            if e + f >= HIGH {
                self.note_steep(base, e + f);
            }
        }
    }

    /// What was noted: its place among the sums, its value, and its exponent or zero.
    pub(super) fn steep(&mut self) -> Vec<([usize; 2], Register)> {
        let noted = core::mem::take(&mut self.steep);
        let of = |(x, exponent): (SeriesQuantity, u32)| {
            ([self.argument_place(x), exponent as usize], self.first(x))
        };
        noted.into_iter().map(of).collect()
    }
}
