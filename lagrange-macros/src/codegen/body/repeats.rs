//! What a long function computes over and over of other numbers, as it does for the links of a chain: found in the sequence of
//! its operations, to be emitted once, as a loop.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::hash::{Hash, Hasher};
use std::mem::discriminant;
use std::ops::Range;

use indexmap::IndexSet;
use rustc_hash::{FxHashMap, FxHasher};

use super::order_of_evaluation::Order;
use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;
use crate::variables::Variable;

/// A round has at least so many operations, and the rounds after the first have so many in all.
const SHORTEST: usize = 24;
const LEAST: usize = 128;
/// What was computed so many operations ago, or later, is looked for there in other rounds too; what is older may be given.
const NEAR: usize = 60;
/// So many operations in a row tell where a round may begin again.
const PHRASE: usize = 8;
/// Number of candidate starts of the first round, in order of fewest live results.
const BEGINNINGS: usize = 8;

/// Rounds of like operations, one after the other in the sequence.
pub(super) struct Repeat {
    /// Where in the sequence the rounds are, all of them.
    pub(super) range: Range<usize>,
    pub(super) rounds: usize,
    /// What a round is given, number by number.
    pub(super) given: Vec<Source>,
    /// A round, of what it is given.
    pub(super) schedule: Schedule,
    /// What the operations of a round are there.
    pub(super) registers: Vec<Register>,
}

pub(super) enum Source {
    /// What was computed before the first round: one for each round.
    Outside(Vec<Register>),
    /// What an earlier round has computed, as far back in all rounds.
    Round(Computed),
}

/// What the operation of this place in a round computes, with what stands for it before the first round.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(super) struct Computed {
    pub(super) offset: usize,
    pub(super) before: Vec<Register>,
}

impl Repeat {
    /// How many operations a round has.
    pub(super) fn length(&self) -> usize {
        self.registers.len()
    }
}

/// The repeats of a sequence, in its order.
pub(super) fn repeats(schedule: &Schedule, order: &Order) -> Vec<Repeat> {
    let text = Text::new(schedule, order);
    let mut runs: Vec<Run> = text.periods().flat_map(|period| text.runs(period)).collect();
    runs.sort_by_key(|run| (Reverse(run.range.len() - run.period), run.period, run.range.start));
    let (mut is_free, mut repeats) = (vec![true; order.sequence.len()], Vec::new());
    for run in runs {
        let range = longest_stretch(&is_free, run.range);
        if let Some(repeat) = text.repeat(&Run { range, ..run }) {
            is_free[repeat.range.clone()].fill(false);
            repeats.push(repeat);
        }
    }
    repeats.sort_by_key(|repeat| repeat.range.start);
    repeats
}

fn longest_stretch(is_free: &[bool], range: Range<usize>) -> Range<usize> {
    let (mut best, mut start) = (range.start..range.start, range.start);
    for at in range {
        if !is_free[at] {
            start = at + 1;
        } else if at + 1 - start > best.len() {
            best = start..at + 1;
        }
    }
    best
}

/// Operations that look like those a period before them, and that first period.
struct Run {
    range: Range<usize>,
    period: usize,
}

/// A sequence of operations, to be searched.
struct Text<'s> {
    schedule: &'s Schedule,
    order: &'s Order,
    /// Where in the sequence each register is computed.
    places: Vec<Option<usize>>,
    /// What is alike has the same number, what has the same number is likely alike.
    looks: Vec<u64>,
}

impl<'s> Text<'s> {
    fn new(schedule: &'s Schedule, order: &'s Order) -> Self {
        let mut places = vec![None; schedule.operations.len()];
        order.sequence.iter().enumerate().for_each(|(at, &index)| places[index] = Some(at));
        let mut text = Self { schedule, order, places, looks: Vec::new() };
        text.looks = (0..order.sequence.len()).map(|at| text.look(at)).collect();
        text
    }

    fn operation(&self, at: usize) -> Operation {
        self.schedule.operations[self.order.sequence[at]]
    }

    fn look(&self, at: usize) -> u64 {
        let mut hasher = FxHasher::default();
        let operation = self.operation(at);
        discriminant(&operation).hash(&mut hasher);
        match operation {
            Operation::Function(function, _) => function.hash(&mut hasher),
            // Calls of what the user supplies are not repeated.
            Operation::Result { .. } => at.hash(&mut hasher),
            _ => {}
        }
        for operand in operation.operands() {
            match (self.schedule.operations[operand.index()], self.places[operand.index()]) {
                (Operation::Constant(bits), _) => bits.hash(&mut hasher),
                (_, Some(place)) if at - place <= NEAR => (at - place).hash(&mut hasher),
                _ => NEAR.hash(&mut hasher),
            }
        }
        hasher.finish()
    }

    /// After how many operations phrases come again.
    fn periods(&self) -> impl Iterator<Item = usize> {
        let (mut last, mut counts) = (FxHashMap::default(), BTreeMap::<usize, usize>::new());
        for (at, phrase) in self.looks.windows(PHRASE).enumerate() {
            if let Some(before) = last.insert(phrase, at) {
                *counts.entry(at - before).or_default() += 1;
            }
        }
        let is_frequent = |(period, count): &(usize, usize)| *period >= SHORTEST && 2 * count >= *period;
        counts.into_iter().filter(is_frequent).map(|(period, _)| period)
    }

    /// Runs of operations that equal those `period` operations earlier, up to their operands.
    fn runs(&self, period: usize) -> Vec<Run> {
        let (mut runs, mut start) = (Vec::new(), 0);
        for at in 0..=self.looks.len() - period {
            let is_alike = self.looks.get(at + period).is_some_and(|look| *look == self.looks[at]);
            if !is_alike {
                let range = start..at + period;
                runs.extend((at - start >= LEAST.max(period)).then_some(Run { range, period }));
                start = at + 1;
            }
        }
        runs
    }

    /// The rounds of a run that are given least.
    fn repeat(&self, run: &Run) -> Option<Repeat> {
        let (start, length, period) = (run.range.start, run.range.len(), run.period);
        if length < period + LEAST.max(period) {
            return None;
        }
        let waiting = |start: &usize| start.checked_sub(1).map_or(0, |before| self.order.waiting[before]);
        let mut starts: Vec<usize> = (start..start + period.min(length - 2 * period + 1)).collect();
        starts.sort_by_key(waiting);
        let rounds = |at: usize| self.rounds(at, period, (run.range.end - at) / period);
        starts.into_iter().take(BEGINNINGS).filter_map(rounds).min_by_key(|repeat| repeat.given.len())
    }

    /// As many rounds as are alike, and at most so many.
    fn rounds(&self, start: usize, period: usize, most: usize) -> Option<Repeat> {
        let first = start..start + period;
        let is_alike = |round: &usize| (0..period).all(|offset| self.are_alike(&first, *round, offset));
        let rounds = 1 + (1..most).take_while(is_alike).count();
        let range = start..start + rounds * period;
        ((rounds - 1) * period >= LEAST).then(|| Round::new(self, range, rounds).repeat())?
    }

    /// Whether an operation of the first round and that of another do the same with what was computed in their rounds.
    fn are_alike(&self, first: &Range<usize>, round: usize, offset: usize) -> bool {
        let shift = round * first.len();
        let other = first.start + shift..first.end + shift;
        let operations = [first, &other].map(|range| self.operation(range.start + offset));
        let [kind, other_kind] = operations.map(|operation| operation.with_operands(|_| ()));
        let mut operands = operations[0].operands().zip(operations[1].operands());
        kind == other_kind
            && operands.all(|(x, y)| match (self.offset(first, x), self.offset(&other, y)) {
                (None, None) => self.constant(x) == self.constant(y),
                (x, y) => x == y,
            })
    }

    /// Where in these operations a register is computed.
    fn offset(&self, range: &Range<usize>, register: Register) -> Option<usize> {
        self.places[register.index()]?.checked_sub(range.start).filter(|offset| *offset < range.len())
    }

    fn constant(&self, register: Register) -> Option<u64> {
        match self.schedule.operations[register.index()] {
            Operation::Constant(bits) => Some(bits),
            _ => None,
        }
    }
}

/// A round under construction.
struct Round<'t> {
    text: &'t Text<'t>,
    range: Range<usize>,
    rounds: usize,
    given: IndexSet<Vec<Register>>,
    schedule: Schedule,
    registers: Vec<Register>,
}

impl<'t> Round<'t> {
    fn new(text: &'t Text<'t>, range: Range<usize>, rounds: usize) -> Self {
        let (given, schedule, registers) = Default::default();
        Self { text, range, rounds, given, schedule, registers }
    }

    /// `None` where a round is given what an earlier one computes, and others are not.
    fn repeat(mut self) -> Option<Repeat> {
        for offset in 0..self.length() {
            self.compute(offset);
        }
        let given: Option<Vec<Source>> = self.given.iter().map(|given| self.source(given)).collect();
        let Self { range, rounds, schedule, registers, .. } = self;
        Some(Repeat { range, rounds, given: given?, schedule, registers })
    }

    fn length(&self) -> usize {
        self.range.len() / self.rounds
    }

    fn compute(&mut self, offset: usize) {
        let operations: Vec<Operation> = self
            .range
            .clone()
            .step_by(self.length())
            .map(|start| self.text.operation(start + offset))
            .collect();
        let mut operand = 0;
        let operation = operations[0].with_operands(|first| {
            let all = operations.iter().filter_map(|operation| operation.operands().nth(operand)).collect();
            operand += 1;
            self.operand(first, all)
        });
        let register = self.schedule.push(operation);
        self.registers.push(register);
    }

    fn operand(&mut self, first: Register, all: Vec<Register>) -> Register {
        let round = self.range.start..self.range.start + self.length();
        if let Some(offset) = self.text.offset(&round, first) {
            return self.registers[offset];
        }
        let operation = self.text.schedule.operations[first.index()];
        let is_at_hand = matches!(operation, Operation::Constant(_) | Operation::Input(_));
        if is_at_hand && all.iter().all(|other| *other == first) {
            return self.schedule.push(operation.with_operands(|operand| operand));
        }
        let (place, _) = self.given.insert_full(all);
        self.schedule.push(Operation::Input(Variable::Given(place).symbol()))
    }

    fn source(&self, given: &[Register]) -> Option<Source> {
        let computed = |register: &Register| self.text.offset(&self.range, *register);
        let (before, rest) =
            given.split_at(given.iter().take_while(|given| computed(given).is_none()).count());
        let Some(offset) = rest.first().and_then(computed) else {
            return Some(Source::Outside(given.to_vec()));
        };
        let mut places = (offset..).step_by(self.length());
        let is_regular = rest.iter().all(|register| computed(register) == places.next());
        (is_regular && offset < self.length())
            .then(|| Source::Round(Computed { offset, before: before.to_vec() }))
    }
}
