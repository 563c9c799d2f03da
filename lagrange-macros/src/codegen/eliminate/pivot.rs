//! What tells at run time whether the elimination can be trusted.

use super::arithmetic::{Entry, Solver};
use super::{Found, Solved, Trust};
use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;

impl Solver<'_> {
    /// For a pivot that differs from what it was before anything was subtracted, that over the pivot.
    pub(super) fn note_pivot(&mut self, scale: Entry, pivot: Register, reciprocal: Register) {
        self.reciprocals.push(reciprocal);
        match scale.filter(|&scale| scale != pivot) {
            Some(scale) => self.growth.push(self.schedule.push(Operation::Multiply(scale, reciprocal))),
            None => self.plain.push([pivot, reciprocal]),
        }
    }

    /// The results, and the pivot, which is no number where a result is none, or infinite.
    ///
    /// What a constraint pushes has a part in its multiplier, so results to look at are the multipliers and what no
    /// constraint pushes, and of these those that are not seen in another one.
    pub(super) fn finish(mut self, found: Found, count: usize, Trust { pivot, doubt }: Trust) -> Solved {
        let Found { mut accelerations, multipliers, pushes } = found;
        accelerations.truncate(count);
        let mut registers =
            |entries: Vec<Entry>| entries.into_iter().map(|entry| self.known(entry)).collect();
        let accelerations: Vec<Register> = registers(accelerations);
        let multipliers: Vec<Register> = registers(multipliers);
        let free = accelerations.iter().zip(&pushes).filter(|(_, push)| push.is_none());
        let results: Vec<Register> = free.map(|(&free, _)| free).chain(multipliers.iter().copied()).collect();
        let seen = ends(self.schedule, &results);
        let pivot = self.poisoned(pivot, seen);
        let mut doubted = |results: Vec<Register>| match doubt {
            Some(doubt) => {
                results.into_iter().map(|x| self.schedule.push(Operation::Add(x, doubt))).collect()
            }
            None => results,
        };
        Solved { accelerations: doubted(accelerations), multipliers: doubted(multipliers), pivot }
    }

    /// How far the factorization can be trusted.
    pub(super) fn trust(&mut self, is_constrained: bool) -> Trust {
        let mut doubts = self.growth.clone();
        // One that is infinite leaves finite results, and one that is zero may cancel out of them.
        for [pivot, reciprocal] in self.plain.clone() {
            doubts.extend((!self.is_input(pivot)).then_some(pivot));
            doubts.extend((!is_constrained).then_some(reciprocal));
        }
        if is_constrained {
            doubts.extend(self.square_of_reciprocals());
        }
        let zero = self.schedule.constant(0.0);
        let poison = self.sum(doubts).map(|sum| self.schedule.push(Operation::Multiply(zero, sum)));
        let range = self.range();
        let doubt = range.map(|[least, most]| self.schedule.push(Operation::Doubt(least, most)));
        let pivot = self.smallest_pivot(range);
        Trust {
            pivot: self.schedule.push(Operation::Add(pivot, poison.unwrap_or(zero))),
            doubt: if is_constrained { self.add(doubt, poison) } else { doubt },
        }
    }

    /// The pivot, but not a number where one of these is none or infinite.
    fn poisoned(&mut self, pivot: Register, seen: Vec<Register>) -> Register {
        let zero = self.schedule.constant(0.0);
        let poison = self.sum(seen).map(|sum| self.schedule.push(Operation::Multiply(zero, sum)));
        self.schedule.push(Operation::Add(pivot, poison.unwrap_or(zero)))
    }

    /// Infinite where a reciprocal is beyond the root of the largest number. So it is where entries of F are so small that
    /// their squares have lost digits: be it the pivot of the Schur complement that is too small then, or a mass.
    fn square_of_reciprocals(&mut self) -> Option<Register> {
        let sum = self.sum(self.reciprocals.clone())?;
        Some(self.schedule.push(Operation::Multiply(sum, sum)))
    }

    fn is_input(&self, register: Register) -> bool {
        matches!(self.schedule.operations[register.index()], Operation::Input(_))
    }

    /// The sum of those that differ, without constants.
    fn sum(&mut self, mut terms: Vec<Register>) -> Option<Register> {
        terms.retain(|&register| !is_ordinary_constant(self.schedule, register));
        terms.sort_unstable();
        terms.dedup();
        terms.into_iter().reduce(|sum, x| self.schedule.push(Operation::Add(sum, x)))
    }

    /// The least and the greatest of what the pivots were over what they are.
    fn range(&mut self) -> Option<[Register; 2]> {
        let (&first, rest) = self.growth.split_first()?;
        let (mut least, mut most) = (first, first);
        for &growth in rest {
            least = self.schedule.push(Operation::Minimum(least, growth));
            most = self.schedule.push(Operation::Maximum(most, growth));
        }
        Some([least, most])
    }

    /// The least of pivot/diagonal and diagonal/pivot.
    fn smallest_pivot(&mut self, range: Option<[Register; 2]>) -> Register {
        let one = self.schedule.constant(1.0);
        let Some([least, most]) = range else { return one };
        let inverse = self.schedule.push(Operation::Divide(one, most));
        self.schedule.push(Operation::Minimum(least, inverse))
    }
}

/// Whether it is a constant whose square is a number in any precision.
fn is_ordinary_constant(schedule: &Schedule, register: Register) -> bool {
    let ordinary = 1e-15..1e15;
    matches!(schedule.operations[register.index()], Operation::Constant(bits) if ordinary.contains(&f64::from_bits(bits).abs()))
}

/// Those of `results` that are seen in no other: sums and products of what is no number, or infinite, are too, but a
/// quotient by it may be zero.
fn ends(schedule: &Schedule, results: &[Register]) -> Vec<Register> {
    let mut is_result = vec![false; schedule.operations.len()];
    results.iter().for_each(|result| is_result[result.index()] = true);
    let mut is_seen = vec![false; schedule.operations.len()];
    for (index, &operation) in schedule.operations.iter().enumerate().rev() {
        if !is_result[index] && !is_seen[index] {
            continue;
        }
        let operands = match operation {
            Operation::Negate(x) | Operation::Divide(x, _) => [Some(x), None],
            Operation::Add(x, y) | Operation::Subtract(x, y) | Operation::Multiply(x, y) => {
                [Some(x), Some(y)]
            }
            _ => [None, None],
        };
        operands.into_iter().flatten().for_each(|operand| is_seen[operand.index()] = true);
    }
    results.iter().copied().filter(|result| !is_seen[result.index()]).collect()
}
