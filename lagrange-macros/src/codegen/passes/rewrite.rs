//! A schedule built anew from another one, operation by operation.

use crate::codegen::operation::{Call, Operation, Register};
use crate::codegen::schedule::Schedule;

/// Computes in `new` what `operation` of `old` computes, where `at` tells where its operands are.
pub(super) fn carried_over(
    new: &mut Schedule,
    old: &Schedule,
    operation: Operation,
    mut at: impl FnMut(&mut Schedule, Register) -> Register,
) -> Register {
    let operation = match operation {
        Operation::Result { call, output } => {
            let Call { function, derivatives, arguments } = old.calls[call as usize].clone();
            let arguments = arguments.iter().map(|&argument| at(new, argument)).collect();
            let (call, _) = new.calls.insert_full(Call { function, derivatives, arguments });
            Operation::Result { call: call as u32, output }
        }
        operation => operation.with_operands(|operand| at(new, operand)),
    };
    new.push(operation)
}

/// Which registers hold the named definitions, in a schedule built anew.
pub(super) fn carry_definitions(
    new: &mut Schedule,
    old: &Schedule,
    at: impl Fn(Register) -> Option<Register>,
) {
    new.definitions =
        old.definitions.iter().filter_map(|&(register, id)| Some((at(register)?, id))).collect();
}
