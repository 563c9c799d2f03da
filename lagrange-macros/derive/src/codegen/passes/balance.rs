//! Rewrites long sums as balanced trees. In a sequential sum, each addend waits for the sum before it.
//!
//! Pays off for short functions whose latency matters, such as one order of Taylor's method.

use super::rewrite::{carried_over, rebuilt};
use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;

pub(super) fn balanced(old: &Schedule, results: &[Register]) -> (Schedule, Vec<Register>) {
    let inner = inner(old, &old.uses(results));
    rebuilt(old, results, |new, index, places| {
        let addends = if inner[index] { Vec::new() } else { gathered(old, &inner, Register::at(index)) };
        // Separate added from subtracted terms: each tree then has one sign.
        let side =
            |sign| addends.iter().filter(move |addend| addend.1 == sign).map(|addend| places.at(addend.0));
        let (added, taken): (Vec<_>, Vec<_>) = (side(true).collect(), side(false).collect());
        match (addends.len(), added.is_empty()) {
            (4.., false) => {
                let added = tree(new, added);
                if taken.is_empty() {
                    return added;
                }
                let taken = tree(new, taken);
                new.push(Operation::Subtract(added, taken))
            }
            _ => carried_over(new, old, old.operations[index], |_, operand| places.at(operand)),
        }
    })
}

/// True for a sum that only one other sum uses.
fn inner(old: &Schedule, uses: &[usize]) -> Vec<bool> {
    let is_sum = |operation: &Operation| matches!(operation, Operation::Add(..) | Operation::Subtract(..));
    let mut inner = vec![false; uses.len()];
    for sum in old.operations.iter().filter(|operation| is_sum(operation)) {
        for part in sum.operands() {
            inner[part.index()] = uses[part.index()] == 1 && is_sum(&old.operations[part.index()]);
        }
    }
    inner
}

/// Returns the addends of a sum, including those of inner sums; `false` marks a subtracted term.
fn gathered(old: &Schedule, inner: &[bool], sum: Register) -> Vec<(Register, bool)> {
    let (mut addends, mut waiting) = (Vec::new(), vec![(sum, true)]);
    while let Some((part, sign)) = waiting.pop() {
        let is_open = part == sum || inner[part.index()];
        match old.operations[part.index()] {
            Operation::Add(x, y) if is_open => waiting.extend([(y, sign), (x, sign)]),
            Operation::Subtract(x, y) if is_open => waiting.extend([(y, !sign), (x, sign)]),
            _ => addends.push((part, sign)),
        }
    }
    addends
}

fn tree(new: &mut Schedule, mut addends: Vec<Register>) -> Register {
    while addends.len() > 1 {
        addends = addends
            .chunks(2)
            .map(|pair| match *pair {
                [x, y] => new.push(Operation::Add(x, y)),
                _ => pair[0],
            })
            .collect();
    }
    addends[0]
}
