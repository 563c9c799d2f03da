//! What tells at run time whether the elimination can be trusted.

use super::arithmetic::{Solver, SparseEntry};
use super::{Found, PivotCheck, Solved};
use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;

impl Solver<'_> {
    /// For a pivot that differs from what it was before anything was subtracted, that over the pivot.
    pub(super) fn note_pivot(&mut self, scale: SparseEntry, pivot: Register, reciprocal: Register) {
        self.reciprocals.push(reciprocal);
        match scale.filter(|&scale| scale != pivot) {
            Some(scale) => self.growth.push(self.schedule.push(Operation::Multiply(scale, reciprocal))),
            None => self.plain.push([pivot, reciprocal]),
        }
    }

    /// The results, as many accelerations as there are coordinates.
    pub(super) fn finish(mut self, found: Found, count: usize, pivot: Register) -> Solved {
        let Found { mut accelerations, multipliers } = found;
        accelerations.truncate(count);
        let mut registers =
            |entries: Vec<SparseEntry>| entries.into_iter().map(|entry| self.known(entry)).collect();
        Solved { accelerations: registers(accelerations), multipliers: registers(multipliers), pivot }
    }

    /// How far the factorization can be trusted.
    pub(super) fn pivot_check(&mut self, is_constrained: bool) -> PivotCheck {
        let mut doubts = Vec::new();
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
        let doubt =
            range.map(|[least, most]| self.schedule.push(Operation::NanIfIllConditioned(least, most)));
        let pivot = self.smallest_pivot(range);
        PivotCheck {
            pivot: self.schedule.push(Operation::Add(pivot, poison.unwrap_or(zero))),
            doubt: if is_constrained { self.add(doubt, poison) } else { doubt },
        }
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
        self.in_pairs(terms, Operation::Add)
    }

    /// All in one, pairs of pairs of them: one after the other each would wait for the one before.
    fn in_pairs(
        &mut self,
        mut all: Vec<Register>,
        pair: fn(Register, Register) -> Operation,
    ) -> Option<Register> {
        while all.len() > 1 {
            let pairs = all.chunks(2).map(|two| match *two {
                [x, y] => self.schedule.push(pair(x, y)),
                _ => two[0],
            });
            all = pairs.collect();
        }
        all.pop()
    }

    /// The least and the greatest of what the pivots were over what they are. One after the other, as the pivots come: pairs
    /// of them would wait for each other, put side by side by the compiler.
    fn range(&mut self) -> Option<[Register; 2]> {
        let mut last = |pair: fn(Register, Register) -> Operation| {
            let all = self.growth.iter().copied();
            all.reduce(|so_far, next| self.schedule.push(pair(so_far, next)))
        };
        Some([last(Operation::Minimum)?, last(Operation::Maximum)?])
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
