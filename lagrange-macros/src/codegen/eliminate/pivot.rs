//! What tells at run time whether the elimination can be trusted.

use super::Solved;
use super::arithmetic::{Entry, Solver};
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

    /// The results; `pushes` are what constraints do to the accelerations.
    pub(super) fn finish(
        mut self,
        accelerations: Vec<Entry>,
        multipliers: Vec<Entry>,
        pushes: &[Entry],
    ) -> Solved {
        let mut registers =
            |entries: Vec<Entry>| entries.into_iter().map(|entry| self.known(entry)).collect();
        let accelerations: Vec<Register> = registers(accelerations);
        let multipliers: Vec<Register> = registers(multipliers);
        let pivot = self.smallest_pivot();
        let free = accelerations.iter().zip(pushes).filter(|(_, push)| push.is_none());
        let results: Vec<Register> = free.map(|(&free, _)| free).chain(multipliers.iter().copied()).collect();
        let poison = self.poison(&results, !multipliers.is_empty());
        let pivot = self.schedule.push(Operation::Add(pivot, poison));
        Solved { accelerations, multipliers, pivot }
    }

    /// Zero, but not a number where a result is none, or infinite, or rests on a pivot that is.
    ///
    /// What a constraint pushes has a part in its multiplier, so these results are the multipliers and what no
    /// constraint pushes, and of these those that are not seen in another one.
    fn poison(&mut self, results: &[Register], is_constrained: bool) -> Register {
        let mut seen = ends(self.schedule, results);
        seen.extend(&self.growth);
        // One that is infinite leaves finite results, and one that is zero may cancel out of them.
        for [pivot, reciprocal] in self.plain.clone() {
            seen.extend((!self.is_input(pivot)).then_some(pivot));
            seen.extend((!is_constrained).then_some(reciprocal));
        }
        if is_constrained {
            seen.extend(self.square_of_reciprocals());
        }
        let zero = self.schedule.constant(0.0);
        self.sum(seen).map_or(zero, |sum| self.schedule.push(Operation::Multiply(zero, sum)))
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

    /// The least of pivot/diagonal and diagonal/pivot.
    fn smallest_pivot(&mut self) -> Register {
        let one = self.schedule.constant(1.0);
        let Some((&first, rest)) = self.growth.split_first() else { return one };
        let (mut least, mut most) = (first, first);
        for &growth in rest {
            least = self.schedule.push(Operation::Minimum(least, growth));
            most = self.schedule.push(Operation::Maximum(most, growth));
        }
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
