//! A linear function of rates of change in two: the numbers that rates are multiplied by, and what becomes of the rates
//! by them. The numbers are computed once for any rates, and for several at once.

use rustc_hash::FxHashMap;

use super::rewrite::{carried_over, carry_definitions};
use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;
use crate::variables::Variable;

/// A function in two parts.
pub(super) struct Parts {
    /// What does not depend on rates, and which of it the other part reads as [`Variable::Slope`] 0, 1, …
    pub(super) slopes: (Schedule, Vec<Register>),
    /// What does, with the results.
    pub(super) changes: (Schedule, Vec<Register>),
}

/// The parts of what computes `results`.
pub(super) fn split(source: &Schedule, results: &[Register]) -> Parts {
    let mut split = Split {
        numbers: Schedule::default(),
        changes: Schedule::default(),
        slopes: Vec::new(),
        known: FxHashMap::default(),
    };
    let mut values: Vec<Value> = Vec::new();
    for &operation in &source.operations {
        let depends = source.operands(operation).any(|x| matches!(values[x.index()], Value::Rate { .. }));
        let value = match operation {
            Operation::Input(symbol) if is_rate(symbol) => Value::from(split.changes.push(operation)),
            _ if depends => split.rate(operation, &values),
            _ => Value::Number(carried_over(&mut split.numbers, source, operation, |_, x| {
                values[x.index()].number()
            })),
        };
        values.push(value);
    }
    let results = results.iter().map(|result| split.changed(values[result.index()])).collect();
    let Split { mut numbers, changes, slopes, .. } = split;
    carry_definitions(&mut numbers, source, |register| match values[register.index()] {
        Value::Number(register) => Some(register),
        Value::Rate { .. } => None,
    });
    Parts { slopes: (numbers, slopes), changes: (changes, results) }
}

fn is_rate(symbol: crate::symbolic::Symbol) -> bool {
    Variable::of(symbol).is_change()
}

/// Where the result of an operation is.
#[derive(Clone, Copy)]
enum Value {
    /// Among the numbers.
    Number(Register),
    /// Among the changes, times a number: products of numbers are put together before they meet a rate.
    Rate { rate: Register, factor: Option<Register> },
}

impl From<Register> for Value {
    fn from(rate: Register) -> Self {
        Self::Rate { rate, factor: None }
    }
}

impl Value {
    /// Of what depends on no rate.
    fn number(self) -> Register {
        match self {
            Self::Number(register) | Self::Rate { rate: register, .. } => register,
        }
    }
}

struct Split {
    numbers: Schedule,
    changes: Schedule,
    slopes: Vec<Register>,
    /// Which slope a number is.
    known: FxHashMap<Register, usize>,
}

impl Split {
    /// An operation on at least one rate.
    fn rate(&mut self, operation: Operation, values: &[Value]) -> Value {
        let of = |register: Register| values[register.index()];
        match operation {
            Operation::Multiply(x, y) => match (of(x), of(y)) {
                (Value::Rate { rate, factor }, Value::Number(number))
                | (Value::Number(number), Value::Rate { rate, factor }) => {
                    let product = |factor| self.numbers.push(Operation::Multiply(factor, number));
                    Value::Rate { rate, factor: Some(factor.map_or(number, product)) }
                }
                _ => self.apply(operation, values),
            },
            Operation::Negate(x) => match of(x) {
                Value::Rate { rate, factor: Some(factor) } => {
                    Value::Rate { rate, factor: Some(self.numbers.push(Operation::Negate(factor))) }
                }
                _ => self.apply(operation, values),
            },
            _ => self.apply(operation, values),
        }
    }

    fn apply(&mut self, operation: Operation, values: &[Value]) -> Value {
        let operation = operation.with_operands(|operand| self.changed(values[operand.index()]));
        self.changes.push(operation).into()
    }

    /// The value among the changes.
    fn changed(&mut self, value: Value) -> Register {
        match value {
            Value::Number(number) => self.slope(number),
            Value::Rate { rate, factor: None } => rate,
            Value::Rate { rate, factor: Some(factor) } => {
                let slope = self.slope(factor);
                self.changes.push(Operation::Multiply(rate, slope))
            }
        }
    }

    /// A number, as the changes read it.
    fn slope(&mut self, number: Register) -> Register {
        if let constant @ Operation::Constant(_) = self.numbers.operations[number.index()] {
            return self.changes.push(constant);
        }
        let next = self.slopes.len();
        let place = *self.known.entry(number).or_insert(next);
        if place == next {
            self.slopes.push(number);
        }
        self.changes.push(Operation::Input(Variable::Slope(place).symbol()))
    }
}
