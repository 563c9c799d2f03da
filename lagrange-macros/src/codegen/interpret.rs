//! Schedules computed without a compiler, for tests.

use super::operation::{Operation, Register};
use super::passes::Program;
use super::schedule::Schedule;
use crate::symbolic::{Symbol, apply};

impl Program {
    /// The results, of these inputs.
    pub(super) fn values(&self, input: impl Fn(Symbol) -> f64) -> Vec<f64> {
        self.schedule.values(&self.results, input)
    }
}

impl Schedule {
    pub(super) fn values(&self, results: &[Register], input: impl Fn(Symbol) -> f64) -> Vec<f64> {
        let mut values: Vec<f64> = Vec::new();
        for &operation in &self.operations {
            let of = |register: Register| values[register.index()];
            values.push(match operation {
                Operation::Constant(bits) => f64::from_bits(bits),
                Operation::Input(symbol) => input(symbol),
                Operation::Negate(x) => -of(x),
                Operation::Add(x, y) => of(x) + of(y),
                Operation::Subtract(x, y) => of(x) - of(y),
                Operation::Multiply(x, y) => of(x) * of(y),
                Operation::Divide(x, y) => of(x) / of(y),
                Operation::MultiplyAdd(x, y, z) => of(x) * of(y) + of(z),
                Operation::SubtractProduct(x, y, z) => of(z) - of(x) * of(y),
                Operation::Minimum(x, y) => of(x).min(of(y)),
                Operation::Maximum(x, y) => of(x).max(of(y)),
                Operation::Where(x, _) if of(x) == 0.0 => 0.0,
                Operation::Where(_, y) => of(y),
                Operation::SquareRoot(x) => of(x).sqrt(),
                Operation::Function(function, x) => apply(function, &of(x)),
                Operation::Atan2(y, x) => of(y).atan2(of(x)),
                Operation::Power(x, y) => of(x).powf(of(y)),
                Operation::Result { .. } => f64::NAN,
            });
        }
        results.iter().map(|result| values[result.index()]).collect()
    }
}
