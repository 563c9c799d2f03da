//! Groups sines and cosines that are evaluated together, and decides when.

use std::collections::BTreeSet;
use std::ops::Range;

use super::planner::Planner;
use crate::codegen::body::{Local, Operand, SineAndCosine, Statement};
use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;
use crate::symbolic::Function;

/// Number of angles whose sines and cosines are evaluated together on the lanes of a vector ([`ABREAST`]),
/// and minimum number of angles in a chunk for this ([`FEWEST`]). A processor evaluates fewer angles one by
/// one as fast, as long as it predicts their branches.
const ABREAST: usize = 4;
const FEWEST: usize = 4;

impl Planner<'_> {
    /// Emits the sine and cosine of `x` together with those of the next angles that are ready, on the lanes of a
    /// vector. Angles come in groups. Each group is emitted with the first angle of the previous group, so that the
    /// processor evaluates its sines while it waits for pivots.
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

    /// Returns the angles to evaluate together with `x`: `x` and the angles after it in `early`, at most
    /// [`ABREAST`]. An angle that is not in `early` is evaluated alone.
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
        // Skip angles that are done: an earlier chunk may have computed the cosine with the sine.
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

    /// Sorts coordinates as they lie in the state, so that they load as a vector.
    fn in_memory_order(&self, angles: &mut [Register]) {
        angles.sort_by_key(|angle| match self.schedule.operations[angle.index()] {
            Operation::Input(symbol) => Some(symbol),
            _ => None,
        });
    }

    /// Reduces all angles to small ones, before the first sine. A branch at each group would prevent the compiler
    /// from interleaving the code before and after it.
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

    /// Emits the sines and cosines of these angles.
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

    /// True if the sine and the cosine are computed, as far as they are used. A loop may have computed only one of
    /// them.
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

    /// Computes an angle and its dependencies ahead of the schedule.
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

    /// Returns the sine or cosine of a register, if it is used and not yet computed.
    fn missing(&self, function: Function, x: Register) -> Option<Register> {
        self.used(function, x).filter(|register| self.values[register.index()].is_none())
    }

    /// Returns the sine or cosine of a register, if it is used.
    fn used(&self, function: Function, x: Register) -> Option<Register> {
        self.schedule
            .find(Operation::Function(function, x))
            .filter(|register| self.uses[register.index()] > 0)
    }
}

/// Returns the plain angles of each chunk, in reverse order of the chunks. Plain angles follow from inputs by
/// arithmetic alone. Empty for a chunk with fewer than [`FEWEST`].
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
