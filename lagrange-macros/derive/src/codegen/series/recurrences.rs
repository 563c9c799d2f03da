//! Taylor coefficients of the results of a schedule along a motion, order by order.
//!
//! The coefficient of order k of a product, (xy)_k = x₀ y_k + y₀ x_k + Σ x_j y_{k−j} with j from 1 to k − 1,
//! is linear in the coefficients of order k of its factors. The same holds for every other operation, by a
//! recurrence with sums of the same form (Griewank and Walther, *Evaluating Derivatives*, table 13.2; Jorba
//! and Zou, *Experimental Mathematics* 14 (2005), proposition 2.1). The runtime computes these sums, all by
//! the same code. All other terms are linear in the coefficients of order k, with numbers of order 0 as
//! factors.

use rustc_hash::FxHashMap;

use super::coefficients::{Recurrences, SeriesQuantity, Sum};
use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;
use crate::symbolic::Symbol;
use crate::variables::Variable;

impl Recurrences {
    /// Adds the operations that `results` depend on. `None` if an operation has no Taylor series, or no known
    /// recurrence.
    pub(super) fn add_up(&mut self, source: &Schedule, results: &[Register]) -> Option<Vec<SeriesQuantity>> {
        let (uses, mut quantities) = (source.uses(results), FxHashMap::default());
        for (index, &operation) in source.operations.iter().enumerate().filter(|(index, _)| uses[*index] > 0)
        {
            let quantity = match operation {
                Operation::Result { call, output } => {
                    let call = source.calls[call as usize].on(|argument| quantities[argument]);
                    self.result(call, output)?
                }
                _ => self.operation(operation.with_operands(|x| quantities[&x]))?,
            };
            quantities.insert(Register::at(index), quantity);
        }
        Some(results.iter().map(|result| quantities[result]).collect())
    }

    fn operation(&mut self, operation: Operation<SeriesQuantity>) -> Option<SeriesQuantity> {
        Some(match operation {
            Operation::Constant(bits) => self.at_rest(Operation::Constant(bits)),
            Operation::Input(symbol) => self.input(symbol),
            Operation::Negate(x) => self.negated(x),
            Operation::Add(x, y) => self.linear(Operation::Add(x, y), |of, [x, y]| of.sum(x, y)),
            Operation::Subtract(x, y) => {
                self.linear(Operation::Subtract(x, y), |of, [x, y]| of.difference(x, y))
            }
            Operation::Multiply(x, y) => self.product(x, y),
            Operation::Divide(x, y) => self.quotient(x, y),
            Operation::SquareRoot(x) => self.root(x),
            Operation::Function(function, x) => self.function(function, x)?,
            Operation::Atan2(y, x) => self.angle_of(y, x),
            Operation::Power(x, exponent) => self.power(x, exponent),
            _ => return None,
        })
    }

    fn input(&mut self, symbol: Symbol) -> SeriesQuantity {
        let (newest, is_solved) = match Variable::of(symbol) {
            Variable::Time => (Variable::Change(0), false),
            Variable::Coordinate(i) => (Variable::Change(1 + i), false),
            Variable::Velocity(i) => (Variable::Change(1 + self.coordinates + i), false),
            Variable::Acceleration(i) => (Variable::AccelerationChange(i), true),
            Variable::Multiplier(a) => (Variable::MultiplierChange(a), true),
            _ => return self.at_rest(Operation::Input(symbol)),
        };
        let first = self.schedule.push(Operation::Input(symbol));
        let newest = Some(self.schedule.push(Operation::Input(newest.symbol())));
        self.add(first, Some(if is_solved { [None, newest] } else { [newest, None] }))
    }

    pub(super) fn linear<const K: usize>(
        &mut self,
        operation: Operation<SeriesQuantity>,
        newest: impl FnMut(&mut Self, [Option<Register>; K]) -> Option<Register>,
    ) -> SeriesQuantity {
        let operands: Vec<SeriesQuantity> = operation.operands().collect();
        let first = operation.with_operands(|x| self.first(x));
        let first = self.schedule.push(first);
        match <[SeriesQuantity; K]>::try_from(operands) {
            Ok(operands) if operands.iter().any(|&x| !self.is_at_rest(x)) => {
                self.moving(first, operands, newest)
            }
            _ => self.add(first, None),
        }
    }

    fn negated(&mut self, x: SeriesQuantity) -> SeriesQuantity {
        self.linear(Operation::Negate(x), |of, [x]| of.negative(x))
    }

    /// (xy)_k = x₀ y_k + y₀ x_k + Σ x_j y_{k−j}
    pub(super) fn product(&mut self, x: SeriesQuantity, y: SeriesQuantity) -> SeriesQuantity {
        let [x0, y0] = [x, y].map(|x| self.first(x));
        let first = self.schedule.push(Operation::Multiply(x0, y0));
        match [x, y].map(|x| self.is_at_rest(x)) {
            [true, true] => self.add(first, None),
            [true, false] => self.moving(first, [y], |of, [y]| of.times(x0, y)),
            [false, true] => self.moving(first, [x], |of, [x]| of.times(y0, x)),
            [false, false] => {
                let sum = self.product_sum(x, y);
                let product = self.moving(first, [x, y], |of, [x, y]| {
                    let (left, right) = (of.times(x0, y), of.times(y0, x));
                    let ends = of.sum(left, right);
                    of.sum(ends, of.known(sum))
                });
                self.note_power([x, y], product);
                product
            }
        }
    }

    /// From x = z y: z_k = (x_k − z₀ y_k − Σ z_j y_{k−j})/y₀
    fn quotient(&mut self, x: SeriesQuantity, y: SeriesQuantity) -> SeriesQuantity {
        let [x0, y0] = [x, y].map(|x| self.first(x));
        let z0 = self.schedule.push(Operation::Divide(x0, y0));
        if self.is_at_rest(x) && self.is_at_rest(y) {
            return self.add(z0, None);
        }
        let over = self.reciprocal(y0);
        if self.is_at_rest(y) {
            return self.moving(z0, [x], |of, [x]| of.times(over, x));
        }
        self.defined(z0, |of, z| {
            let sum = of.product_sum(z, y);
            of.moving(z0, [x, y], |of, [x, y]| {
                let known = of.times(z0, y);
                let known = of.sum(known, of.known(sum));
                let rest = of.difference(x, known);
                of.times(over, rest)
            })
        })
    }

    /// From z² = x: z_k = (x_k − Σ z_j z_{k−j})/(2 z₀)
    pub(super) fn root(&mut self, x: SeriesQuantity) -> SeriesQuantity {
        let x0 = self.first(x);
        let z0 = self.schedule.push(Operation::SquareRoot(x0));
        if self.is_at_rest(x) {
            return self.add(z0, None);
        }
        let twice = self.schedule.push(Operation::Add(z0, z0));
        let over = self.reciprocal(twice);
        self.defined(z0, |of, z| {
            let sum = of.product_sum(z, z);
            of.watch(Sum::Product(z, z), z0);
            of.moving(z0, [x], |of, [x]| {
                let rest = of.difference(x, of.known(sum));
                of.times(over, rest)
            })
        })
    }
}
