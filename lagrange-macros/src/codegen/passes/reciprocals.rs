//! One reciprocal where a division is shared: a division takes as long as several multiplications.

use rustc_hash::FxHashMap;

use super::rewrite::{carried_over, carry_definitions};
use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;

pub(super) fn shared(old: &Schedule, results: &[Register]) -> (Schedule, Vec<Register>) {
    let uses = old.uses(results);
    let mut divisions: FxHashMap<Register, usize> = FxHashMap::default();
    let operations = || old.operations.iter().enumerate().filter(|(index, _)| uses[*index] > 0);
    for (_, &operation) in operations() {
        if let Operation::Divide(_, divisor) = operation {
            *divisions.entry(divisor).or_default() += 1;
        }
    }
    let mut new = Schedule::default();
    let mut places: Vec<Option<Register>> = vec![None; old.operations.len()];
    for (index, &operation) in operations() {
        let place = |register: Register| places[register.index()].unwrap_or(register);
        places[index] = Some(match operation {
            Operation::Divide(x, y) if divisions[&y] > 1 => over(&mut new, place(x), place(y)),
            _ => carried_over(&mut new, old, operation, |_, operand| place(operand)),
        });
    }
    carry_definitions(&mut new, old, |register| places[register.index()]);
    let results = results.iter().map(|result| places[result.index()].unwrap_or(*result)).collect();
    (new, results)
}

fn over(new: &mut Schedule, x: Register, y: Register) -> Register {
    let one = new.constant(1.0);
    let reciprocal = new.push(Operation::Divide(one, y));
    if x == one { reciprocal } else { new.push(Operation::Multiply(x, reciprocal)) }
}
