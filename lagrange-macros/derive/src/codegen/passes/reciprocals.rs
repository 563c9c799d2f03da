//! Replaces several divisions by the same number with one reciprocal: a division takes as long as several
//! multiplications.

use rustc_hash::FxHashMap;

use super::rewrite::{carried_over, rebuilt};
use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;

pub(super) fn shared(old: &Schedule, results: &[Register]) -> (Schedule, Vec<Register>) {
    let uses = old.uses(results);
    let mut divisions: FxHashMap<Register, usize> = FxHashMap::default();
    for (&operation, _) in old.operations.iter().zip(&uses).filter(|(_, uses)| **uses > 0) {
        if let Operation::Divide(_, divisor) = operation {
            *divisions.entry(divisor).or_default() += 1;
        }
    }
    rebuilt(old, results, |new, index, places| match old.operations[index] {
        Operation::Divide(x, y) if divisions[&y] > 1 => over(new, places.at(x), places.at(y)),
        operation => carried_over(new, old, operation, |_, operand| places.at(operand)),
    })
}

fn over(new: &mut Schedule, x: Register, y: Register) -> Register {
    let one = new.constant(1.0);
    let reciprocal = new.push(Operation::Divide(one, y));
    if x == one { reciprocal } else { new.push(Operation::Multiply(x, reciprocal)) }
}
