//! A linear function of rates of change in two: the numbers that rates are multiplied by, and what becomes of the rates
//! by them. The numbers are computed once for any rates, and for several at once.

use rustc_hash::FxHashMap;

use super::rewrite::{carried_over, carry_definitions};
use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;
use crate::variables::Variable;

/// A function in two parts.
pub(super) struct TwoParts {
    /// What does not depend on rates, and which of it the other part reads as [`Variable::Slope`] 0, 1, …
    pub(super) slopes: (Schedule, Vec<Register>),
    /// What does, with the results.
    pub(super) changes: (Schedule, Vec<Register>),
}

/// The parts of what computes `results`.
pub(super) fn split(source: &Schedule, results: &[Register]) -> TwoParts {
    let mut split = Split {
        numbers: Schedule::default(),
        changes: Schedule::default(),
        slopes: Vec::new(),
        known: FxHashMap::default(),
    };
    let mut values: Vec<ResultLocation> = Vec::new();
    for &operation in &source.operations {
        let depends =
            source.operands(operation).any(|x| matches!(values[x.index()], ResultLocation::Rate { .. }));
        let value = match operation {
            Operation::Input(symbol) if is_rate(symbol) => {
                ResultLocation::from(split.changes.push(operation))
            }
            _ if depends => split.rate(operation, &values),
            _ => ResultLocation::Number(carried_over(&mut split.numbers, source, operation, |_, x| {
                values[x.index()].number()
            })),
        };
        values.push(value);
    }
    let results = results.iter().map(|result| split.changed(values[result.index()])).collect();
    let Split { mut numbers, changes, slopes, .. } = split;
    carry_definitions(&mut numbers, source, |register| match values[register.index()] {
        ResultLocation::Number(register) => Some(register),
        ResultLocation::Rate { .. } => None,
    });
    TwoParts { slopes: (numbers, slopes), changes: (changes, results) }
}

fn is_rate(symbol: crate::symbolic::Symbol) -> bool {
    Variable::of(symbol).is_change()
}

/// Where the result of an operation is.
#[derive(Clone, Copy)]
enum ResultLocation {
    /// Among the numbers.
    Number(Register),
    /// Among the changes, times a number: products of numbers are put together before they meet a rate.
    Rate { rate: Register, factor: Option<Register> },
}

impl From<Register> for ResultLocation {
    fn from(rate: Register) -> Self {
        Self::Rate { rate, factor: None }
    }
}

impl ResultLocation {
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
    fn rate(&mut self, operation: Operation, values: &[ResultLocation]) -> ResultLocation {
        let of = |register: Register| values[register.index()];
        match operation {
            Operation::Multiply(x, y) => match (of(x), of(y)) {
                (ResultLocation::Rate { rate, factor }, ResultLocation::Number(number))
                | (ResultLocation::Number(number), ResultLocation::Rate { rate, factor }) => {
                    let product = |factor| self.numbers.push(Operation::Multiply(factor, number));
                    ResultLocation::Rate { rate, factor: Some(factor.map_or(number, product)) }
                }
                _ => self.apply(operation, values),
            },
            Operation::Negate(x) => match of(x) {
                ResultLocation::Rate { rate, factor: Some(factor) } => {
                    ResultLocation::Rate { rate, factor: Some(self.numbers.push(Operation::Negate(factor))) }
                }
                _ => self.apply(operation, values),
            },
            _ => self.apply(operation, values),
        }
    }

    fn apply(&mut self, operation: Operation, values: &[ResultLocation]) -> ResultLocation {
        let operation = operation.with_operands(|operand| self.changed(values[operand.index()]));
        self.changes.push(operation).into()
    }

    /// The value among the changes.
    fn changed(&mut self, value: ResultLocation) -> Register {
        match value {
            ResultLocation::Number(number) => self.slope(number),
            ResultLocation::Rate { rate, factor: None } => rate,
            ResultLocation::Rate { rate, factor: Some(factor) } => {
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
