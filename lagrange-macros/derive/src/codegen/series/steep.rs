//! Detects steep functions. Their values may be negligible at the start of a step and large within it: exp of a large
//! negative number, tanh near ±1, a high power of a number near 0. The runtime bounds the change of their arguments.

use super::coefficients::{Recurrences, SeriesQuantity};
use crate::codegen::operation::{Operation, Register};

/// Least exponent of a high power. A 16th power doubles if its base changes by about 1/20.
const HIGH: u32 = 16;

impl Recurrences {
    /// Records the argument of exp, tanh, sinh or cosh.
    pub(super) fn note_steep(&mut self, x: SeriesQuantity) {
        self.steep.entry((x, None)).or_default();
    }

    /// Records the base of a power with a non-integer exponent of magnitude [`HIGH`] or more, or with an exponent
    /// known only at run time.
    pub(super) fn note_real_power(&mut self, x: SeriesQuantity, exponent: Register) {
        let is_low = matches!(self.schedule.operations[exponent.index()], Operation::Constant(e) if f64::from_bits(e).abs() < f64::from(HIGH));
        if !is_low {
            self.steep.insert((x, Some(exponent)), 1);
        }
    }

    /// Records that a product is an integer power, if both factors are powers of the same base.
    pub(super) fn note_power(&mut self, [x, y]: [SeriesQuantity; 2], product: SeriesQuantity) {
        let power = |x: SeriesQuantity| self.powers.get(&x).copied().unwrap_or((x, 1));
        let [(base, e), (other, f)] = [power(x), power(y)];
        if base == other {
            self.powers.insert(product, (base, e + f));
            if e + f >= HIGH {
                let noted = self.steep.entry((base, None)).or_default();
                *noted = (*noted).max(e + f);
            }
        }
    }

    /// Returns for each recorded argument: the index of its entry of `sums`; its exponent, or 0 for other functions;
    /// and its value. A power xᵉ with e in a register, possibly known only at run time, has the value x/e and the
    /// exponent 1: the rate of its logarithm, e x′/x, is the same.
    pub(super) fn steep(&mut self) -> Vec<([usize; 2], Register)> {
        let noted = core::mem::take(&mut self.steep);
        let of = |((x, at_run_time), exponent): ((SeriesQuantity, Option<Register>), u32)| {
            let value = match at_run_time {
                None => self.first(x),
                Some(e) => self.schedule.push(Operation::Divide(self.first(x), e)),
            };
            ([self.argument_place(x), exponent as usize], value)
        };
        noted.into_iter().map(of).collect()
    }
}
