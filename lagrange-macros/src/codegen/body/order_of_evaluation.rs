//! The order in which operations are computed, so that few results wait for their last use: what waits fills
//! registers, then the stack, and between the parts of a long function an array.
//!
//! Depth first from the first result, the operand that takes longest first (as Sethi and Ullman, *Journal of the ACM*
//! 17, 1970, take the one of more registers first): an elimination, which waits for its pivots, then computes the sines
//! of the next link meanwhile. Or the order of the derivation, where results wait less in that.

use crate::codegen::operation::{Operation, Register};
use crate::codegen::passes::Program;
use crate::codegen::schedule::Schedule;
use crate::symbolic::Function;

/// What is to be computed, operands first. Constants and inputs are at hand and have no place in it.
pub(super) struct Order {
    pub(super) sequence: Vec<usize>,
    /// How many results wait after each operation.
    pub(super) waiting: Vec<usize>,
    /// The most that would wait in the order of the derivation.
    pub(super) peak_before: usize,
}

impl Order {
    pub(super) fn new(program: &Program) -> Self {
        let Program { schedule, results: roots, .. } = program;
        let uses = schedule.uses(roots);
        let derived: Vec<usize> =
            (0..uses.len()).filter(|&index| uses[index] > 0 && is_computed(schedule, index)).collect();
        let operands: Vec<Vec<usize>> = (0..uses.len()).map(|index| operands(schedule, index)).collect();
        let nested = depth_first(schedule, &operands, roots);
        let [of_derived, of_nested] = [&derived, &nested].map(|sequence| waiting(&operands, sequence));
        let peak_before = peak(&of_derived);
        let is_better = of_nested.iter().sum::<usize>() < of_derived.iter().sum();
        let (sequence, waiting) = if is_better { (nested, of_nested) } else { (derived, of_derived) };
        Self { sequence, waiting, peak_before }
    }

    /// With the sines and cosines of these angles first, and what the angles are made of: what is computed in loops is then
    /// computed without them, and they can be taken side by side.
    pub(super) fn with_sines_first(self, schedule: &Schedule, is_angle: impl Fn(Register) -> bool) -> Self {
        let mut is_early = vec![false; schedule.operations.len()];
        for (index, operation) in schedule.operations.iter().enumerate().rev() {
            let is_turn =
                matches!(operation, Operation::Function(Function::Sin | Function::Cos, x) if is_angle(*x));
            is_early[index] |= is_turn;
            if is_early[index] {
                operation.operands().for_each(|operand| is_early[operand.index()] = true);
            }
        }
        let (mut sequence, rest): (Vec<_>, Vec<_>) =
            self.sequence.into_iter().partition(|&index| is_early[index]);
        sequence.extend(rest);
        let operands: Vec<Vec<usize>> = (0..is_early.len()).map(|index| operands(schedule, index)).collect();
        let waiting = waiting(&operands, &sequence);
        Self { sequence, waiting, ..self }
    }

    /// The most results that wait at once.
    pub(super) fn peak(&self) -> usize {
        peak(&self.waiting)
    }
}

fn peak(waiting: &[usize]) -> usize {
    waiting.iter().copied().max().unwrap_or(0)
}

fn is_computed(schedule: &Schedule, index: usize) -> bool {
    !matches!(schedule.operations[index], Operation::Constant(_) | Operation::Input(_))
}

/// The operands that are computed, each once.
fn operands(schedule: &Schedule, index: usize) -> Vec<usize> {
    let operands = schedule.operands(schedule.operations[index]).map(Register::index);
    let mut operands: Vec<usize> = operands.filter(|&operand| is_computed(schedule, operand)).collect();
    operands.sort_unstable();
    operands.dedup();
    operands
}

/// From the first result to the last. Without recursion: a chain of operations may be as long as there are any.
fn depth_first(schedule: &Schedule, operands: &[Vec<usize>], roots: &[Register]) -> Vec<usize> {
    let ready = schedule.ready();
    let (mut sequence, mut is_done) = (Vec::new(), vec![false; schedule.operations.len()]);
    let mut stack: Vec<(usize, bool)> = roots.iter().rev().map(|root| (root.index(), false)).collect();
    while let Some((index, are_operands_done)) = stack.pop() {
        if is_done[index] || !is_computed(schedule, index) {
            continue;
        }
        if are_operands_done {
            is_done[index] = true;
            sequence.push(index);
            continue;
        }
        let mut operands = operands[index].clone();
        // The operand pushed last is computed first.
        operands.sort_by_key(|&operand| ready[operand]);
        stack.push((index, true));
        stack.extend(operands.into_iter().map(|operand| (operand, false)));
    }
    sequence
}

/// How many results are still to be used after each operation.
fn waiting(operands: &[Vec<usize>], sequence: &[usize]) -> Vec<usize> {
    let mut last_use = vec![None; operands.len()];
    for (at, &index) in sequence.iter().enumerate() {
        operands[index].iter().for_each(|&operand| last_use[operand] = Some(at));
    }
    let (mut ending, mut now) = (vec![0; sequence.len()], 0);
    let counts = sequence.iter().enumerate().map(|(at, &index)| {
        now -= ending[at];
        if let Some(end) = last_use[index] {
            now += 1;
            ending[end] += 1;
        }
        now
    });
    counts.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::symbolic::Symbol;

    fn input(schedule: &mut Schedule, index: u32) -> Register {
        schedule.push(Operation::Input(Symbol { family: 0, index }))
    }

    /// Σ sin x_i, all sines before the sum.
    fn sines(count: u32) -> (Schedule, Register) {
        let mut schedule = Schedule::default();
        let sines: Vec<Register> = (0..count)
            .map(|index| {
                let x = input(&mut schedule, index);
                schedule.push(Operation::Function(Function::Sin, x))
            })
            .collect();
        let sum = sines[1..].iter().fold(sines[0], |sum, &sine| schedule.push(Operation::Add(sum, sine)));
        (schedule, sum)
    }

    fn order(schedule: &Schedule, roots: &[Register]) -> Order {
        let order =
            Order::new(&Program { schedule: schedule.clone(), results: roots.to_vec(), counts: Vec::new() });
        let mut is_done = vec![false; schedule.operations.len()];
        for &index in &order.sequence {
            assert!(operands(schedule, index).into_iter().all(|operand| is_done[operand]), "operands first");
            assert!(!std::mem::replace(&mut is_done[index], true), "each once");
        }
        assert!(roots.iter().all(|root| is_done[root.index()]));
        order
    }

    #[test]
    fn terms_are_added_as_they_come() {
        let (schedule, sum) = sines(50);
        let order = order(&schedule, &[sum]);
        assert_eq!((order.peak_before, order.peak()), (50, 2));
        assert_eq!(order.sequence.len(), 50 + 49);
    }

    #[test]
    fn what_no_result_needs_has_no_place() {
        let (mut schedule, sum) = sines(3);
        schedule.push(Operation::Negate(sum));
        assert_eq!(order(&schedule, &[sum]).sequence.len(), 3 + 2);
    }

    #[test]
    fn a_chain_of_operations_may_be_long() {
        let mut schedule = Schedule::default();
        let x = input(&mut schedule, 0);
        let last = (0..100_000).fold(x, |last, _| {
            let negative = schedule.push(Operation::Negate(last));
            schedule.push(Operation::Add(negative, x))
        });
        assert_eq!(order(&schedule, &[last]).peak(), 1);
    }
}
