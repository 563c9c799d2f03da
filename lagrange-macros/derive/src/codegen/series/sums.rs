//! Convolution sums over lower orders, which the runtime computes, and the coefficients of each order that
//! enter them.

use indexmap::IndexSet;

use super::coefficients::{Recurrences, SeriesQuantity, Stage, Sum};
use crate::codegen::operation::{Operation, Register};
use crate::variables::Variable;

impl Recurrences {
    /// Convolution Σ x_j y_{k−j}. While [`of_means`](Self::of_means) is set, k + 1 times the convolution of
    /// the mean values of x and y.
    pub(super) fn product_sum(&mut self, x: SeriesQuantity, y: SeriesQuantity) -> Register {
        let (x, y) = (x.min(y), x.max(y));
        if !self.of_means {
            return self.place(Sum::Product(x, y));
        }
        let [next, sum] = [self.order_plus(1.0), self.place(Sum::Mean(x, y))];
        self.schedule.push(Operation::Multiply(next, sum))
    }

    /// Σ j x_j y_{k−j}/k
    pub(super) fn weighted_sum(&mut self, x: SeriesQuantity, y: SeriesQuantity) -> Register {
        let sum = self.place(Sum::Weighted(x, y));
        let reciprocal = self.schedule.push(Operation::Input(Variable::OrderReciprocal.symbol()));
        self.schedule.push(Operation::Multiply(sum, reciprocal))
    }

    /// Returns the register of a sum, which is an input: the runtime computes it.
    pub(super) fn place(&mut self, sum: Sum) -> Register {
        let (place, _) = self.sums.insert_full(sum);
        self.schedule.push(Operation::Input(Variable::Sum(place).symbol()))
    }

    fn times_input(&mut self, input: Variable, x: Option<Register>) -> Option<Register> {
        let input = self.schedule.push(Operation::Input(input.symbol()));
        self.times(input, x)
    }

    /// Registers a root for a check of its sign. Past a zero of x, the series of √x may become negative, but
    /// the root cannot: the series of √x² is ±x.
    pub(super) fn watch(&mut self, sum: Sum, first: Register) {
        let (place, _) = self.sums.insert_full(sum);
        self.roots.push((place, first));
    }

    /// Returns the coefficients of order k of all factors, left ones first, each list padded with zeros to
    /// `count`. Also returns the parts of them that are known before the accelerations and multipliers of
    /// order k.
    pub(super) fn factors(&mut self, count: usize) -> (IndexSet<Register>, Vec<Register>) {
        let (mut known, zero) = (IndexSet::new(), self.schedule.constant(0.0));
        let mut terms = vec![zero; 2 * count];
        for (place, sum) in self.sums.clone().into_iter().enumerate() {
            let factors = match sum {
                Sum::Product(x, y) | Sum::Weighted(x, y) | Sum::Mean(x, y) => [Some(x), Some(y)],
                Sum::Argument(x) => [Some(x), None],
                Sum::Value(..) => [None; 2],
            };
            let [left, right] = factors.map(|factor| factor.and_then(|factor| self.term(factor, &mut known)));
            let [left, right] = match sum {
                Sum::Weighted(..) => [self.times_input(Variable::Order, left), right],
                // Both factors get a weight c/(k + 1), which is exact: c is a multiple of all orders. The product with
                // 1/c² has a relative error of only 10⁻²⁰. Weights 1/(k + 1) would be rounded in the same direction
                // in every step; with them, constraints were violated and the energy drifted.
                Sum::Mean(..) => {
                    let [left, right] = [left, right].map(|x| self.times_input(Variable::NextWeight, x));
                    [left, self.times_input(Variable::WeightsReciprocal, right)]
                }
                _ => [left, right],
            };
            (terms[place], terms[count + place]) = (left.unwrap_or(zero), right.unwrap_or(zero));
        }
        (known, terms)
    }

    /// Returns the coefficient of order k, from its known part. Inputs are read directly, other known parts
    /// are stored in `known`.
    fn term(&mut self, of: SeriesQuantity, known: &mut IndexSet<Register>) -> Option<Register> {
        let first = self.part(of, Stage::Known).map(|part| match self.schedule.operations[part.index()] {
            Operation::Input(symbol) if !matches!(Variable::of(symbol), Variable::Sum(_)) => part,
            _ => {
                let (place, _) = known.insert_full(part);
                self.schedule.push(Operation::Input(Variable::Term(place).symbol()))
            }
        });
        let added = self.part(of, Stage::Added);
        self.sum(first, added)
    }
}
