//! Removes products with zero. Zero times x only shows whether x is finite.
//!
//! Used for functions of a state that other functions have already found finite.

use super::rewrite::{carried_over, rebuilt};
use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;

pub(super) fn left_out(old: &Schedule, results: &[Register]) -> (Schedule, Vec<Register>) {
    rebuilt(old, results, |new, index, places| {
        let carried = carried_over(new, old, old.operations[index], |_, operand| places.at(operand));
        let is_zero = |x: Register| matches!(new.operations[x.index()], Operation::Constant(bits) if f64::from_bits(bits) == 0.0);
        match new.operations[carried.index()] {
            Operation::Multiply(x, y) if is_zero(x) || is_zero(y) => new.constant(0.0),
            Operation::Add(x, y) | Operation::Subtract(x, y) if is_zero(y) => x,
            Operation::Add(x, y) if is_zero(x) => y,
            Operation::Subtract(x, y) if is_zero(x) => new.push(Operation::Negate(y)),
            _ => carried,
        }
    })
}
