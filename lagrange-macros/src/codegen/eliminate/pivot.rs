//! What tells at run time whether the elimination can be trusted.

use super::Solved;
use super::arithmetic::{Entry, Solver};
use crate::codegen::schedule::{Operation, Register};

impl Solver<'_> {
    pub(super) fn finish(mut self, accelerations: Vec<Entry>, multipliers: Vec<Entry>) -> Solved {
        let mut registers =
            |entries: Vec<Entry>| entries.into_iter().map(|entry| self.known(entry)).collect();
        let accelerations: Vec<Register> = registers(accelerations);
        let multipliers: Vec<Register> = registers(multipliers);
        let pivot = self.smallest_pivot();
        let poison = self.poison(&accelerations, &multipliers);
        let pivot = self.schedule.push(Operation::Add(pivot, poison));
        Solved { accelerations, multipliers, pivot }
    }

    /// Zero, but not a number where any result is none, or infinite. Such a result makes all that it is used by the
    /// like, and what a multiplier acts on has a part in it: few results have to be looked at.
    fn poison(&mut self, accelerations: &[Register], multipliers: &[Register]) -> Register {
        let pushed = self.schedule.depending_on(multipliers);
        let others = accelerations.iter().filter(|acceleration| !pushed[acceleration.index()]);
        let results: Vec<Register> = others.chain(multipliers).copied().collect();
        let ends = self.schedule.not_used_by_one_another(&results);
        let zero = self.schedule.constant(0.0);
        let sum = ends.into_iter().reduce(|sum, x| self.schedule.push(Operation::Add(sum, x)));
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
