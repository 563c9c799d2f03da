//! The sums over the orders before, which the runtime adds up, and the terms that an order puts into them.

use indexmap::IndexSet;

use super::coefficients::{Recurrences, SeriesQuantity, Stage, Sum};
use crate::codegen::operation::{Operation, Register};
use crate::variables::Variable;

impl Recurrences {
    /// Σ x_j y_{k−j}; of [means](Self::of_means) k + 1 times that.
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

    /// A sum, as the runtime gives it.
    pub(super) fn place(&mut self, sum: Sum) -> Register {
        let (place, _) = self.sums.insert_full(sum);
        self.schedule.push(Operation::Input(Variable::Sum(place).symbol()))
    }

    fn times_input(&mut self, input: Variable, x: Option<Register>) -> Option<Register> {
        let input = self.schedule.push(Operation::Input(input.symbol()));
        self.times(input, x)
    }

    /// Notes a root, whose series goes on below zero as it does not: that of √x² is ±x.
    pub(super) fn watch(&mut self, sum: Sum, first: Register) {
        let (place, _) = self.sums.insert_full(sum);
        self.roots.push((place, first));
    }

    /// What has to be computed of the factors of the sums before the accelerations and multipliers of an order, and by this and
    /// them the newest terms, those of left factors first, filled up with zeros to so many of either.
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
                // Weights are exact, and what takes them out of the sum is so nearly: 1/(k + 1) is rounded to the same side in
                // every step, by which constraints were missed and energy drifted.
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

    /// The newest coefficient, by what is known of it; what is given with its order is not computed.
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
