//! Emits repeats as loops: inputs and outputs of their iterations.
//!
//! Each iteration stores its outputs in one row of the spill array, after the row of the previous iteration. So an
//! output of an earlier iteration lies at a constant distance. Rows before the first iteration hold the values that
//! replace outputs of iterations before the loop.

use std::ops::Range;

use indexmap::IndexSet;
use rustc_hash::FxHashMap;

use super::angles::plain_angles;
use super::planner::{LiveValue, Planner, RoundLayout};
use crate::codegen::body::repeats::{Computed, Repeat, Source};
use crate::codegen::body::{Chunk, Given, Operand, Rounds, Slot, SlotSequence};
use crate::codegen::operation::{Operation, Register};
use crate::codegen::passes::Program;
use crate::symbolic::Symbol;
use crate::variables::Variable;

/// Rows of spill slots: `ahead` rows before the loop, then one per iteration. Each row has `length` slots, the first
/// at `first`.
struct RoundRows {
    first: usize,
    length: usize,
    ahead: usize,
}

impl RoundRows {
    /// Slots at position `place` of the rows that the iterations stored `back` iterations ago; for `back` = 0, of
    /// their own rows.
    fn series(&self, place: usize, back: usize) -> SlotSequence {
        let first = self.first + (self.ahead - back) * self.length + place;
        SlotSequence { first, step: self.length as isize }
    }
}

impl Planner<'_> {
    /// Reserves slots for the inputs and outputs of a loop. Copies inputs that iterations cannot read where
    /// they are into these slots.
    pub(super) fn lay_out(&mut self, repeat: &Repeat, sequence: &[usize]) -> RoundLayout {
        // Keep results of the function alive past the loop: the chunk after it stores them.
        for &index in sequence.iter().filter(|&&index| self.places.contains_key(&Register::at(index))) {
            self.reach[index] = self.reach[index].max(self.index + 2);
        }
        let left = self.left(repeat, sequence);
        let (length, ahead) = (left.len(), left.iter().map(|left| left.before.len()).max().unwrap_or(0));
        let mut reserved = Vec::new();
        let first = self.reserve(length * (ahead + repeat.rounds), &mut reserved);
        let rows = RoundRows { first, length, ahead };
        for (place, Computed { before, .. }) in left.iter().enumerate() {
            self.bring(before, rows.series(place, before.len()));
        }
        let given = repeat.given.iter().map(|source| match source {
            Source::Round(computed) => {
                let place = left.get_index_of(computed).unwrap_or(0);
                Given::SpillSlots(rows.series(place, computed.before.len()))
            }
            Source::Outside(registers) => self.as_they_are(registers).unwrap_or_else(|| {
                let series = SlotSequence { first: self.reserve(repeat.rounds, &mut reserved), step: 1 };
                self.bring(registers, series);
                Given::SpillSlots(series)
            }),
        });
        let given = given.collect();
        let left =
            left.iter().enumerate().map(|(place, left)| (left.offset, rows.series(place, 0))).collect();
        RoundLayout { left, given, reserved }
    }

    fn reserve(&mut self, count: usize, reserved: &mut Vec<Range<usize>>) -> usize {
        let first = self.waiting.reserve(count);
        reserved.push(first..first + count);
        first
    }

    /// Outputs of an iteration: results that later iterations or later chunks use.
    fn left(&self, repeat: &Repeat, sequence: &[usize]) -> IndexSet<Computed> {
        let taken = repeat.given.iter().filter_map(|source| match source {
            Source::Round(computed) => Some(computed.clone()),
            Source::Outside(_) => None,
        });
        let mut left: IndexSet<Computed> = taken.collect();
        let mut is_left = vec![false; repeat.length()];
        left.iter().for_each(|left| is_left[left.offset] = true);
        for (offset, is_left) in is_left.into_iter().enumerate() {
            let mut all = sequence.iter().skip(offset).step_by(repeat.length());
            if !is_left && all.any(|&index| self.reach[index] > self.index + 1) {
                left.insert(Computed { offset, before: Vec::new() });
            }
        }
        left
    }

    /// Returns the inputs, or the slots at a constant stride, that already hold these registers, so that
    /// iterations can read them without a copy. `None` if there are none.
    fn as_they_are(&self, registers: &[Register]) -> Option<Given> {
        let symbol = |register: &Register| match self.schedule.operations[register.index()] {
            Operation::Input(symbol) => Some(symbol),
            _ => None,
        };
        let inputs: Option<Vec<Symbol>> = registers.iter().map(symbol).collect();
        let places: Option<Vec<usize>> =
            registers.iter().map(|&register| self.waiting.place(register)).collect();
        inputs.map(Given::Inputs).or_else(|| SlotSequence::through(&places?).map(Given::SpillSlots))
    }

    fn bring(&mut self, registers: &[Register], to: SlotSequence) {
        for (round, &register) in registers.iter().enumerate() {
            self.store(Slot::SpillSlots(SlotSequence::constant(to.at(round))), register);
        }
    }

    /// Emits the loop that was laid out, as a chunk.
    pub(super) fn rounds(&mut self, repeat: &Repeat, sequence: &[usize]) -> Chunk {
        let RoundLayout { left, given, reserved } = std::mem::take(&mut self.layout);
        let mut part = one_round(repeat, &left);
        part.rounds = Some(Rounds { count: repeat.rounds, given });
        for (offset, series) in left {
            let all = sequence.iter().skip(offset).step_by(repeat.length());
            all.enumerate().for_each(|(round, &index)| self.leave(Register::at(index), series.at(round)));
        }
        self.release_places();
        self.waiting.release(reserved.into_iter().flatten());
        self.forget_locals();
        self.index += 1;
        self.early = self.plain.pop().unwrap_or_default();
        for &index in sequence {
            let register = Register::at(index);
            self.places.remove(&register).into_iter().flatten().for_each(|place| self.store(place, register));
        }
        part
    }

    /// Records the slot to which an iteration stores this register, if a later chunk uses it.
    fn leave(&mut self, register: Register, place: usize) {
        if self.reach[register.index()] > self.index && self.waiting.place(register).is_none() {
            self.waiting.put(register, place);
            let expression = Operand::Local(self.local(register));
            self.values[register.index()] = Some(LiveValue { expression, depth: 0 });
        }
    }
}

fn one_round(repeat: &Repeat, left: &[(usize, SlotSequence)]) -> Chunk {
    let results: Vec<Register> = left.iter().map(|&(offset, _)| repeat.registers[offset]).collect();
    let program =
        Program { schedule: repeat.schedule.clone(), results, blocks: Vec::new(), counts: Vec::new() };
    let is_computed =
        |operation: &Operation| !matches!(operation, Operation::Constant(_) | Operation::Input(_));
    let operations = program.schedule.operations.iter().enumerate();
    let sequence: Vec<usize> =
        operations.filter(|(_, operation)| is_computed(operation)).map(|(k, _)| k).collect();
    let (names, all) = (FxHashMap::default(), 0..sequence.len());
    let plain = plain_angles(&program.schedule, &sequence, std::slice::from_ref(&all));
    let mut planner = Planner::new(&program, &sequence, std::slice::from_ref(&all), &names, plain);
    sequence.iter().for_each(|&index| planner.compute(index));
    for (&result, (_, series)) in program.results.iter().zip(left) {
        planner.store(Slot::SpillSlots(*series), result);
    }
    let mut part = planner.end_part(None);
    part.inputs.retain(|&symbol| !matches!(Variable::of(symbol), Variable::Given(_)));
    part
}
