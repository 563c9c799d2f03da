//! Sines and cosines: which of them are computed together, and when.

use std::collections::BTreeSet;
use std::ops::Range;

use super::planner::Planner;
use crate::codegen::body::{Local, Operand, SineAndCosine, Statement};
use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;
use crate::symbolic::Function;

/// Sines and cosines of so many angles are computed side by side, on the lanes of a vector, where there are not fewer than that
/// in all: of few a processor computes one after another as fast, as long as it foresees their branches.
const ABREAST: usize = 4;
const FEWEST: usize = 4;

impl Planner<'_> {
    /// The sine and the cosine of one argument are computed together, and with them those of the angles whose turn comes
    /// next, if they are at hand: a processor takes several side by side. Not those of all: while pivots wait for one another
    /// it has time for others, of which it is to know by then. So each group comes with the first of the group before.
    pub(super) fn turn(&mut self, x: Register) {
        if !self.is_taken(x) {
            let angles = self.angles_with(x);
            self.turn_all(&angles);
        }
        if self.leader == Some(x) {
            let angles = self.next_angles();
            self.turn_all(&angles);
        }
    }

    /// The angles whose turn comes with this one's.
    fn angles_with(&mut self, x: Register) -> Vec<Register> {
        match self.early.iter().position(|&angle| angle == x) {
            Some(place) => {
                self.early.drain(..place);
                self.next_angles()
            }
            None => vec![x],
        }
    }

    fn next_angles(&mut self) -> Vec<Register> {
        // An earlier part may have taken the cosine with a sine.
        let mut early = std::mem::take(&mut self.early);
        early.retain(|&angle| !self.is_taken(angle));
        if self.small.is_empty() {
            self.make_small(&early);
        }
        self.early = early.split_off(early.len().min(ABREAST));
        self.leader = early.first().copied();
        self.in_memory_order(&mut early);
        early
    }

    /// Coordinates come into a vector as they lie in the state.
    fn in_memory_order(&self, angles: &mut [Register]) {
        angles.sort_by_key(|angle| match self.schedule.operations[angle.index()] {
            Operation::Input(symbol) => Some(symbol),
            _ => None,
        });
    }

    /// All at once, before the first: each branch would keep the compiler from mixing what comes before with what comes after.
    fn make_small(&mut self, angles: &[Register]) {
        angles.iter().for_each(|&angle| self.compute_early(angle));
        let mut angles = angles.to_vec();
        self.in_memory_order(&mut angles);
        let small = |angle: &Register| (Local::Angle(angle.index()), self.value(*angle));
        let small: Vec<_> = angles.iter().map(small).collect();
        self.part.locals.extend(small.iter().map(|(local, _)| *local));
        self.part.statements.push(Statement::Small(small));
        self.small = angles.iter().copied().collect();
    }

    /// The sines and cosines of these angles.
    fn turn_all(&mut self, angles: &[Register]) {
        angles.iter().for_each(|&angle| self.compute_early(angle));
        let turns: Vec<SineAndCosine> = angles.iter().map(|&angle| self.turn_of(angle)).collect();
        match &turns[..] {
            [] => {}
            [
                SineAndCosine { angle, sine: Some(only), cosine: None }
                | SineAndCosine { angle, sine: None, cosine: Some(only) },
            ] => {
                let function = if turns[0].sine.is_some() { Function::Sin } else { Function::Cos };
                let expression = Operand::Of(Box::new(Operation::Function(function, angle.clone())));
                self.assign(*only, expression);
            }
            _ => {
                let locals = turns.iter().flat_map(|turn| [turn.sine, turn.cosine]).flatten();
                self.part.locals.extend(locals);
                self.part.statements.push(Statement::Turns(turns));
            }
        }
        for &angle in angles {
            let both = [Function::Sin, Function::Cos].map(|function| self.missing(function, angle));
            for register in both.into_iter().flatten() {
                self.keep(register, self.local(register));
            }
        }
    }

    /// Whether both its sine and its cosine are at hand, as far as they are used. Where a loop has left one alone, the other is
    /// still to come.
    fn is_taken(&self, angle: Register) -> bool {
        let both = [Function::Sin, Function::Cos].into_iter().filter_map(|f| self.used(f, angle));
        both.into_iter().all(|register| self.values[register.index()].is_some())
    }

    fn turn_of(&mut self, x: Register) -> SineAndCosine {
        let [sine, cosine] =
            [Function::Sin, Function::Cos].map(|f| self.missing(f, x).map(|register| self.local(register)));
        let is_small = self.small.contains(&x);
        let angle = if is_small { Operand::Local(Local::Angle(x.index())) } else { self.value(x) };
        SineAndCosine { angle, sine, cosine }
    }

    /// Computes an angle, and what it depends on, ahead of the schedule.
    fn compute_early(&mut self, angle: Register) {
        let mut needed = BTreeSet::from([angle]);
        let mut pending = vec![angle];
        while let Some(register) = pending.pop() {
            for operand in self.schedule.operations[register.index()].operands() {
                if needed.insert(operand) {
                    pending.push(operand);
                }
            }
        }
        for register in needed {
            let is_at_hand = self.values[register.index()].is_some()
                || matches!(
                    self.schedule.operations[register.index()],
                    Operation::Constant(_) | Operation::Input(_)
                );
            if !is_at_hand {
                self.compute(register.index());
            }
        }
    }

    /// Sine or cosine of a register, if it is used and not computed yet.
    fn missing(&self, function: Function, x: Register) -> Option<Register> {
        self.used(function, x).filter(|register| self.values[register.index()].is_none())
    }

    /// The sine or the cosine of this, if it is used.
    fn used(&self, function: Function, x: Register) -> Option<Register> {
        self.schedule
            .find(Operation::Function(function, x))
            .filter(|register| self.uses[register.index()] > 0)
    }
}

/// For each part, the last first, the angles of its sines and cosines that are made of inputs by arithmetic alone, in their
/// order; none where there are few.
pub(super) fn plain_angles(
    schedule: &Schedule,
    sequence: &[usize],
    cuts: &[Range<usize>],
) -> Vec<Vec<Register>> {
    let mut is_plain = vec![false; schedule.operations.len()];
    for (index, operation) in schedule.operations.iter().enumerate() {
        let is_arithmetic = !matches!(
            operation,
            Operation::Function(..) | Operation::Power(..) | Operation::Atan2(..) | Operation::Result { .. }
        );
        is_plain[index] = is_arithmetic && operation.operands().all(|operand| is_plain[operand.index()]);
    }
    let angle = |&index: &usize| match schedule.operations[index] {
        Operation::Function(Function::Sin | Function::Cos, x) if is_plain[x.index()] => Some(x),
        _ => None,
    };
    let of_part = |cut: &Range<usize>| {
        let mut known = BTreeSet::new();
        let angles = sequence[cut.clone()].iter().filter_map(angle).filter(|&angle| known.insert(angle));
        let angles: Vec<Register> = angles.collect();
        if angles.len() < FEWEST { Vec::new() } else { angles }
    };
    cuts.iter().rev().map(of_part).collect()
}
