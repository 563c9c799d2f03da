//! Prevents a derivative that does not exist from spoiling the others.
//!
//! A directional derivative is a sum over all variables that change. A slope may be infinite, as that of √x at 0, or
//! NaN, as that of xⁿ with respect to n there. Its product with a zero rate of change would then be NaN, and so would
//! the whole sum. The guard sets such a product to zero if all rates in it are zero.

use super::rewrite::{carried_over, carry_definitions};
use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;
use crate::symbolic::Function;
use crate::variables::Variable;

/// Returns the schedule with guarded products, and the registers of the results in it.
pub(super) fn guarded(source: &Schedule, results: &[Register]) -> (Schedule, Vec<Register>) {
    let mut guard = Guard { schedule: Schedule::default(), numbers: Vec::new() };
    for &operation in &source.operations {
        guard.copy(operation, source);
    }
    let Guard { mut schedule, numbers } = guard;
    let place = |register: Register| numbers[register.index()].register;
    carry_definitions(&mut schedule, source, |register| Some(place(register)));
    (schedule, results.iter().map(|&result| place(result)).collect())
}

/// Classification of a result.
#[derive(Clone, Copy)]
struct Number {
    /// Register in the new schedule.
    register: Register,
    kind: GuardKind,
}

#[derive(Clone, Copy, PartialEq)]
enum GuardKind {
    /// Finite for finite arguments.
    Finite,
    /// Possibly infinite: contains a division, a function with a pole, or a user-supplied function.
    Unbounded,
    /// Linear combination of rates of change. `activity` is zero if all its rates are zero.
    Rate { activity: Register },
}

struct Guard {
    schedule: Schedule,
    /// Classification of each operation of the source.
    numbers: Vec<Number>,
}

impl Guard {
    fn copy(&mut self, operation: Operation, source: &Schedule) {
        let operands: Vec<GuardKind> =
            source.operands(operation).map(|operand| self.numbers[operand.index()].kind).collect();
        let numbers = &self.numbers;
        let mut register = carried_over(&mut self.schedule, source, operation, |_, operand| {
            numbers[operand.index()].register
        });
        let kind = self.kind(operation, register, &operands);
        if let GuardKind::Rate { activity } = kind
            && is_doubtful(operation, &operands)
        {
            register = self.schedule.push(Operation::Where(activity, register));
        }
        self.numbers.push(Number { register, kind });
    }

    fn kind(&mut self, operation: Operation, register: Register, operands: &[GuardKind]) -> GuardKind {
        let activities = operands.iter().filter_map(|kind| match kind {
            GuardKind::Rate { activity } => Some(*activity),
            _ => None,
        });
        if let Operation::Input(symbol) = operation
            && Variable::of(symbol).is_change()
        {
            return GuardKind::Rate {
                activity: self.schedule.push(Operation::Function(Function::Abs, register)),
            };
        }
        let sum = activities.reduce(|x, y| if x == y { x } else { self.schedule.push(Operation::Add(x, y)) });
        match sum {
            Some(activity) => GuardKind::Rate { activity },
            None if has_pole(operation) || operands.contains(&GuardKind::Unbounded) => GuardKind::Unbounded,
            None => GuardKind::Finite,
        }
    }
}

/// True for the quotient of a rate by a number, and for its product with a number that may be infinite.
fn is_doubtful(operation: Operation, operands: &[GuardKind]) -> bool {
    match operation {
        Operation::Multiply(..) => operands.contains(&GuardKind::Unbounded),
        Operation::Divide(..) => true,
        _ => false,
    }
}

/// True if the result may be infinite for finite operands.
fn has_pole(operation: Operation) -> bool {
    match operation {
        Operation::Divide(..) | Operation::Power(..) | Operation::Result { .. } => true,
        Operation::Function(function, _) => matches!(function, Function::Ln | Function::Tan),
        _ => false,
    }
}
