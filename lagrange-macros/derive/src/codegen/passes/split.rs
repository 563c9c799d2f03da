//! Splits a linear function of rates of change into two programs: one computes the coefficients, the other applies
//! them to rates. The coefficients are computed once and serve any rates, also several at once.

use indexmap::{IndexMap, IndexSet};
use rustc_hash::FxHashMap;

use super::rewrite::{carried_over, carry_definitions};
use crate::codegen::operation::{Call, CallArgument, CallKind, Operation, Register};
use crate::codegen::schedule::Schedule;
use crate::codegen::slopes::SlopeBlock;
use crate::variables::Variable;

/// Linear function of rates of change, as two schedules.
pub(super) struct TwoParts {
    /// Schedule that does not depend on rates, and the registers that the other part reads as [`Variable::Slope`] 0,
    /// 1, …
    pub(super) slopes: (Schedule, Vec<Register>),
    /// Schedule that depends on rates, and the registers of the results.
    pub(super) changes: (Schedule, Vec<Register>),
    /// Gradients of long functions, which the other part reads after the slopes.
    pub(super) blocks: Vec<SlopeBlock>,
}

/// Splits the computation of `results`.
pub(super) fn split(source: &Schedule, results: &[Register]) -> TwoParts {
    let mut split = Split {
        numbers: Schedule::default(),
        changes: Schedule::default(),
        slopes: Vec::new(),
        known: FxHashMap::default(),
        blocks: IndexMap::new(),
    };
    let mut values: Vec<ResultLocation> = Vec::new();
    for &operation in &source.operations {
        let depends =
            source.operands(operation).any(|x| matches!(values[x.index()], ResultLocation::Rate { .. }));
        let value = match operation {
            Operation::Input(symbol) if is_rate(symbol) => {
                ResultLocation::from(split.changes.push(operation))
            }
            Operation::Result { call, output } if source.calls[call as usize].kind == CallKind::Along => {
                split.along(&source.calls[call as usize], output, &values)
            }
            _ if depends => split.rate(operation, &values),
            _ => ResultLocation::Number(carried_over(&mut split.numbers, source, operation, |_, x| {
                values[x.index()].number()
            })),
        };
        values.push(value);
    }
    let results = results.iter().map(|result| split.changed(values[result.index()])).collect();
    let blocks = split.blocks();
    let Split { mut numbers, changes, slopes, .. } = split;
    carry_definitions(&mut numbers, source, |register| match values[register.index()] {
        ResultLocation::Number(register) => Some(register),
        ResultLocation::Rate { .. } => None,
    });
    TwoParts { slopes: (numbers, slopes), changes: (changes, results), blocks }
}

fn is_rate(symbol: crate::symbolic::Symbol) -> bool {
    Variable::of(symbol).is_change()
}

/// Location of the result of an operation.
#[derive(Clone, Copy)]
enum ResultLocation {
    /// In the schedule without rates.
    Number(Register),
    /// In the schedule of rates, times a factor without rates. Products of such factors are formed before they
    /// multiply a rate.
    Rate { rate: Register, factor: Option<Register> },
}

impl From<Register> for ResultLocation {
    fn from(rate: Register) -> Self {
        Self::Rate { rate, factor: None }
    }
}

impl ResultLocation {
    /// Returns the register of a result that depends on no rate.
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
    /// Index among `slopes` of each number of the first schedule that the second reads.
    known: FxHashMap<Register, usize>,
    /// For each order, function and place, the partial derivatives whose gradients are slopes.
    blocks: IndexMap<(usize, Call), IndexSet<Box<[u32]>>>,
}

impl Split {
    /// Replaces a derivative along a direction by the product of a gradient, which is a slope, and the direction.
    fn along(&mut self, call: &Call, output: u32, values: &[ResultLocation]) -> ResultLocation {
        let (at, direction) = call.arguments.split_at(call.arguments.len() / 2);
        let at = at.iter().map(|x| values[x.index()].number()).collect();
        let of = Call { arguments: at, kind: CallKind::Partial, derivatives: Box::default(), ..*call };
        let next = self.blocks.entry((call.derivatives.len(), of));
        let kind = CallKind::Slopes(next.index());
        next.or_default().insert(call.derivatives.clone());
        let arguments = direction.iter().map(|x| self.changed(values[x.index()])).collect();
        let call = Call { arguments, kind, derivatives: call.derivatives.clone(), ..*call };
        let (call, _) = self.changes.calls.insert_full(call);
        self.changes.push(Operation::Result { call: call as u32, output }).into()
    }

    /// Returns the blocks, with their arguments as slopes.
    fn blocks(&mut self) -> Vec<SlopeBlock> {
        let blocks = std::mem::take(&mut self.blocks).into_iter();
        let argument = |split: &mut Self, number: Register| match split.numbers.operations[number.index()] {
            Operation::Constant(bits) => CallArgument::Constant(bits),
            _ => CallArgument::Kept(split.place(number)),
        };
        blocks.map(|((_, call), by)| SlopeBlock { call: call.on(|&x| argument(self, x)), by }).collect()
    }

    /// Copies an operation with at least one rate among its operands.
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

    /// Returns a value as a register of the schedule of rates.
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

    /// Returns a number as an input of the schedule of rates. A constant is copied.
    fn slope(&mut self, number: Register) -> Register {
        if let constant @ Operation::Constant(_) = self.numbers.operations[number.index()] {
            return self.changes.push(constant);
        }
        let place = self.place(number);
        self.changes.push(Operation::Input(Variable::Slope(place).symbol()))
    }

    /// Index of a number among the slopes.
    fn place(&mut self, number: Register) -> usize {
        let next = self.slopes.len();
        let place = *self.known.entry(number).or_insert(next);
        if place == next {
            self.slopes.push(number);
        }
        place
    }
}
