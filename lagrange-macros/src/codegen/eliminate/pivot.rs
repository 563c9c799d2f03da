//! What tells at run time whether the elimination can be trusted.

use super::Solved;
use super::arithmetic::{Entry, Solver};
use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;

impl Solver<'_> {
    /// For a pivot that differs from what it was before anything was subtracted, that over the pivot; else the pivot's
    /// reciprocal, which may cancel out of all results.
    pub(super) fn note_pivot(&mut self, scale: Entry, pivot: Register, reciprocal: Register) {
        match scale.filter(|&scale| scale != pivot) {
            Some(scale) => self.growth.push(self.schedule.push(Operation::Multiply(scale, reciprocal))),
            None => self.reciprocals.push(reciprocal),
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
        let poison = self.poison(&results);
        let pivot = self.schedule.push(Operation::Add(pivot, poison));
        Solved { accelerations, multipliers, pivot }
    }

    /// Zero, but not a number where a result is none, or infinite, or rests on a pivot that is.
    ///
    /// What a constraint pushes has a part in its multiplier, so these results are the multipliers and what no
    /// constraint pushes, and of these those that are not seen in another one.
    fn poison(&mut self, results: &[Register]) -> Register {
        let ends = ends(self.schedule, results);
        let seen = ends.iter().chain(&self.reciprocals).chain(&self.growth).copied();
        let mut seen: Vec<Register> =
            seen.filter(|&register| !is_constant(self.schedule, register)).collect();
        seen.sort_unstable();
        seen.dedup();
        let zero = self.schedule.constant(0.0);
        let sum = seen.into_iter().reduce(|sum, x| self.schedule.push(Operation::Add(sum, x)));
        sum.map_or(zero, |sum| self.schedule.push(Operation::Multiply(zero, sum)))
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

fn is_constant(schedule: &Schedule, register: Register) -> bool {
    matches!(schedule.operations[register.index()], Operation::Constant(_))
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
