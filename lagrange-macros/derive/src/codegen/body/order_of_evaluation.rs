//! Instruction scheduling: an order of the operations with few live results. Live results occupy registers, then the
//! stack, and an array between the chunks of a long function.
//!
//! The order is depth first from the first result, with the operand of longest latency first. (Sethi and Ullman,
//! *Journal of the ACM* 17, 1970, put the operand that needs more registers first.) An elimination then evaluates the
//! sines of the next link while it waits for pivots. If fewer results are live in the order of the derivation, that
//! order is kept.

use crate::codegen::operation::{Operation, Register};
use crate::codegen::passes::Program;
use crate::codegen::schedule::Schedule;
use crate::symbolic::Function;

/// Order of evaluation, operands first. It omits constants and inputs, which need no computation.
pub(super) struct Order {
    pub(super) sequence: Vec<usize>,
    /// Number of live results after each operation.
    pub(super) waiting: Vec<usize>,
    /// Maximum number of live results in the order of the derivation.
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

    /// Moves the sines and cosines of these angles to the front, with the operations they depend on. Loops then do
    /// not contain them, and they can be evaluated together.
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

    /// Maximum number of live results.
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

/// Operands that are operations, without duplicates.
fn operands(schedule: &Schedule, index: usize) -> Vec<usize> {
    let operands = schedule.operands(schedule.operations[index]).map(Register::index);
    let mut operands: Vec<usize> = operands.filter(|&operand| is_computed(schedule, operand)).collect();
    operands.sort_unstable();
    operands.dedup();
    operands
}

/// Depth-first order from the first to the last result. Iterative, because a chain of operations may be arbitrarily
/// long.
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
        // The last operand pushed is the first computed.
        operands.sort_by_key(|&operand| ready[operand]);
        stack.push((index, true));
        stack.extend(operands.into_iter().map(|operand| (operand, false)));
    }
    sequence
}

/// Number of live results after each operation.
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

    /// Σ sin x_i, with all sines before the sum.
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
        let order = Order::new(&Program {
            schedule: schedule.clone(),
            results: roots.to_vec(),
            blocks: Vec::new(),
            counts: Vec::new(),
        });
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
