//! Rebuilds a schedule from another one, operation by operation.

use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;

/// Copies an operation of `old` to `new`. `at` maps its operands to registers of `new`.
pub(super) fn carried_over(
    new: &mut Schedule,
    old: &Schedule,
    operation: Operation,
    mut at: impl FnMut(&mut Schedule, Register) -> Register,
) -> Register {
    let operation = match operation {
        Operation::Result { call, output } => {
            let call = old.calls[call as usize].on(|&argument| at(new, argument));
            let (call, _) = new.calls.insert_full(call);
            Operation::Result { call: call as u32, output }
        }
        operation => operation.with_operands(|operand| at(new, operand)),
    };
    new.push(operation)
}

/// Registers in the rebuilt schedule of operations of the old one, as far as it is built.
pub(super) struct Places(Vec<Option<Register>>);

impl Places {
    /// Returns the new register of an operand. Operands precede their uses, so it exists.
    pub(super) fn at(&self, register: Register) -> Register {
        self.0[register.index()].unwrap_or(register)
    }
}

/// Rebuilds the part of the schedule that `results` depend on; `step` translates each operation.
pub(super) fn rebuilt(
    old: &Schedule,
    results: &[Register],
    mut step: impl FnMut(&mut Schedule, usize, &Places) -> Register,
) -> (Schedule, Vec<Register>) {
    let uses = old.uses(results);
    let (mut new, mut places) = (Schedule::default(), Places(vec![None; old.operations.len()]));
    for index in (0..old.operations.len()).filter(|&index| uses[index] > 0) {
        places.0[index] = Some(step(&mut new, index, &places));
    }
    carry_definitions(&mut new, old, |register| places.0[register.index()]);
    let results = results.iter().map(|&result| places.at(result)).collect();
    (new, results)
}

/// Copies the named definitions to a rebuilt schedule.
pub(super) fn carry_definitions(
    new: &mut Schedule,
    old: &Schedule,
    at: impl Fn(Register) -> Option<Register>,
) {
    new.definitions =
        old.definitions.iter().filter_map(|&(register, id)| Some((at(register)?, id))).collect();
}
