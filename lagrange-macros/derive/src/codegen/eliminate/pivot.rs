//! Run-time checks of the accuracy of the elimination.

use super::arithmetic::{Solver, SparseEntry};
use super::{Found, PivotCheck, Solved};
use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;

impl Solver<'_> {
    /// Records a pivot. If it differs from the diagonal entry `scale`, records the ratio scale/pivot.
    pub(super) fn note_pivot(&mut self, scale: SparseEntry, pivot: Register, reciprocal: Register) {
        self.reciprocals.push(reciprocal);
        match scale.filter(|&scale| scale != pivot) {
            Some(scale) => self.growth.push(self.schedule.push(Operation::Multiply(scale, reciprocal))),
            None => self.plain.push([pivot, reciprocal]),
        }
    }

    /// Returns the results, with `count` accelerations.
    pub(super) fn finish(mut self, found: Found, count: usize, pivot: Register) -> Solved {
        let Found { mut accelerations, multipliers } = found;
        accelerations.truncate(count);
        let mut registers =
            |entries: Vec<SparseEntry>| entries.into_iter().map(|entry| self.known(entry)).collect();
        Solved { accelerations: registers(accelerations), multipliers: registers(multipliers), pivot }
    }

    /// Appends the check of the factorization.
    pub(super) fn pivot_check(&mut self, is_constrained: bool) -> PivotCheck {
        let mut doubts = Vec::new();
        // Check pivots and reciprocals: an infinite pivot gives finite results, and a zero pivot may cancel
        // from the results.
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

    /// Infinite if a reciprocal exceeds the square root of the largest number. This covers entries of F so small that
    /// their squares lose digits: a pivot of the Schur complement, or a mass, is then too small.
    fn square_of_reciprocals(&mut self) -> Option<Register> {
        let sum = self.sum(self.reciprocals.clone())?;
        Some(self.schedule.push(Operation::Multiply(sum, sum)))
    }

    fn is_input(&self, register: Register) -> bool {
        matches!(self.schedule.operations[register.index()], Operation::Input(_))
    }

    /// Sum of the distinct registers, without constants.
    fn sum(&mut self, mut terms: Vec<Register>) -> Option<Register> {
        terms.retain(|&register| !is_ordinary_constant(self.schedule, register));
        terms.sort_unstable();
        terms.dedup();
        self.in_pairs(terms, Operation::Add)
    }

    /// Reduces a list pairwise, as a balanced tree, which shortens the dependency chain.
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

    /// Smallest and largest ratio of diagonal entry to pivot. A sequential reduction follows the pivots as they
    /// become available; with a tree, the compiler would combine pairs into vectors that wait for each other.
    fn range(&mut self) -> Option<[Register; 2]> {
        let mut last = |pair: fn(Register, Register) -> Operation| {
            let all = self.growth.iter().copied();
            all.reduce(|so_far, next| self.schedule.push(pair(so_far, next)))
        };
        Some([last(Operation::Minimum)?, last(Operation::Maximum)?])
    }

    /// Smallest of all pivot/diagonal and diagonal/pivot.
    fn smallest_pivot(&mut self, range: Option<[Register; 2]>) -> Register {
        let one = self.schedule.constant(1.0);
        let Some([least, most]) = range else { return one };
        let inverse = self.schedule.push(Operation::Divide(one, most));
        self.schedule.push(Operation::Minimum(least, inverse))
    }
}

/// True for a constant whose square is a finite nonzero number in any precision.
fn is_ordinary_constant(schedule: &Schedule, register: Register) -> bool {
    let ordinary = 1e-15..1e15;
    matches!(schedule.operations[register.index()], Operation::Constant(bits) if ordinary.contains(&f64::from_bits(bits).abs()))
}
