//! Prevents a derivative that does not exist from spoiling the others.
//!
//! A directional derivative is a sum over all variables that change. A slope may be infinite, as that of √x at 0, or
//! NaN, as that of xⁿ with respect to n there. Its product with a zero rate of change would then be NaN, and so would
//! the whole sum. The guard sets such a product to zero if all rates in it are zero.
//!
//! A number that is infinite only where the residual itself is not finite needs no guard: there, no derivative exists.
//! Such are the divisors of the residual, as |q|² of a quaternion, and their products.

use super::rewrite::{carried_over, carry_definitions};
use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;
use crate::symbolic::Function;
use crate::variables::Variable;

/// Returns the schedule with guarded products, and the registers of the results in it. Guards matter where the numbers
/// `residual` are finite.
pub(super) fn guarded(
    source: &Schedule,
    results: &[Register],
    residual: &[Register],
) -> (Schedule, Vec<Register>) {
    let finite = Finite::where_finite(source, residual);
    let mut guard = Guard { schedule: Schedule::default(), numbers: Vec::new(), finite };
    for index in 0..source.operations.len() {
        guard.copy(index, source);
    }
    let Guard { mut schedule, numbers, .. } = guard;
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

/// What is known of the operations where the residual is finite.
struct Finite {
    /// Those without which the residual is not finite.
    is_finite: Vec<bool>,
    /// Those that are not zero, and not so by rounding alone.
    is_divisor: Vec<bool>,
}

impl Finite {
    fn where_finite(source: &Schedule, residual: &[Register]) -> Self {
        let count = source.operations.len();
        let mut of = Self { is_finite: vec![false; count], is_divisor: vec![false; count] };
        residual.iter().for_each(|number| of.is_finite[number.index()] = true);
        for (index, &operation) in source.operations.iter().enumerate().rev() {
            if of.is_finite[index] {
                of.operands_of_finite(operation);
            }
        }
        for (index, &operation) in source.operations.iter().enumerate() {
            if let Operation::Multiply(x, y) = operation {
                of.is_divisor[index] |= of.is_divisor[x.index()] && of.is_divisor[y.index()];
            }
        }
        of
    }

    /// No infinity and no NaN of an operand vanishes in a sum, a product or a dividend.
    fn operands_of_finite(&mut self, operation: Operation) {
        let mut set = |x: Register| self.is_finite[x.index()] = true;
        match operation {
            Operation::Add(x, y) | Operation::Subtract(x, y) | Operation::Multiply(x, y) => {
                set(x);
                set(y);
            }
            Operation::Negate(x) => set(x),
            Operation::Divide(x, y) => {
                set(x);
                self.is_divisor[y.index()] = true;
            }
            _ => {}
        }
    }

    /// True if the operation may have a pole where the residual is finite.
    fn has_pole(&self, operation: Operation) -> bool {
        match operation {
            Operation::Divide(_, y) => !self.is_divisor[y.index()],
            _ => has_pole(operation),
        }
    }
}

struct Guard {
    schedule: Schedule,
    /// Classification of each operation of the source.
    numbers: Vec<Number>,
    finite: Finite,
}

impl Guard {
    fn copy(&mut self, index: usize, source: &Schedule) {
        let operation = source.operations[index];
        let operands: Vec<GuardKind> =
            source.operands(operation).map(|operand| self.numbers[operand.index()].kind).collect();
        let numbers = &self.numbers;
        let mut register = carried_over(&mut self.schedule, source, operation, |_, operand| {
            numbers[operand.index()].register
        });
        let is_finite = self.finite.is_finite[index];
        let kind = self.kind(operation, is_finite, register, &operands);
        if let GuardKind::Rate { activity } = kind
            && self.is_doubtful(operation, &operands)
        {
            register = self.schedule.push(Operation::Where(activity, register));
        }
        self.numbers.push(Number { register, kind });
    }

    fn kind(
        &mut self,
        operation: Operation,
        is_finite: bool,
        register: Register,
        operands: &[GuardKind],
    ) -> GuardKind {
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
            None if is_finite => GuardKind::Finite,
            None if self.finite.has_pole(operation) || operands.contains(&GuardKind::Unbounded) => {
                GuardKind::Unbounded
            }
            None => GuardKind::Finite,
        }
    }

    /// True for the quotient of a rate by a number that may be zero, and for its product or quotient with a number
    /// that may be infinite.
    fn is_doubtful(&self, operation: Operation, operands: &[GuardKind]) -> bool {
        match operation {
            Operation::Multiply(..) | Operation::Divide(..) => {
                operands.contains(&GuardKind::Unbounded) || self.finite.has_pole(operation)
            }
            _ => false,
        }
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
