//! Functions that may be too small for a series at the start of a step and large within: exp of what is far below zero, tanh where it is all
//! but ±1, high powers of what is all but zero. The runtime looks at how far their arguments go.

use super::coefficients::{Recurrences, SeriesQuantity};
use crate::codegen::operation::{Operation, Register};

/// A power is high from here on: it doubles where its base changes by a twentieth.
const HIGH: u32 = 16;

impl Recurrences {
    /// Notes the argument of exp, tanh, sinh or cosh.
    pub(super) fn note_steep(&mut self, x: SeriesQuantity) {
        self.steep.entry((x, None)).or_default();
    }

    /// Notes the base of a power whose exponent is not whole or is known at run time, unless that is small.
    pub(super) fn note_real_power(&mut self, x: SeriesQuantity, exponent: Register) {
        let is_low = matches!(self.schedule.operations[exponent.index()], Operation::Constant(e) if f64::from_bits(e).abs() < f64::from(HIGH));
        if !is_low {
            self.steep.insert((x, Some(exponent)), 1);
        }
    }

    /// Notes that a product is a power, where both factors are powers of the same base.
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

    /// For each argument that was noted its place among the sums and the exponent, 0 for a function that is no power, and its value. Of a
    /// power xᵉ whose exponent is known at run time only, the value is x/e and the exponent 1: the rate of its logarithm, e x′/x, is the same.
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
