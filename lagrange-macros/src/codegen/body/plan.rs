//! From a schedule to a [`FunctionBody`], chunk by chunk.

mod angles;
mod rounds;

use std::collections::BTreeSet;
use std::ops::Range;

use rustc_hash::FxHashMap;

use super::chunks::{self, OperationRange, SpillSlots};
use super::order_of_evaluation::Order;
use super::repeats::{Repeat, repeats};
use super::{Chunk, FunctionBody, Local, Operand, Slot, SlotSequence, Statement};
use crate::codegen::operation::{Call, Operation, Register};
use crate::codegen::passes::Program;
use crate::codegen::schedule::Schedule;
use crate::symbolic::{Function, Id};
use rounds::RoundLayout;

/// Single-use results are nested into what uses them to this depth.
const NESTING: usize = 6;
/// So many results, most of them zero, are not written out.
const MANY: usize = 256;

impl FunctionBody {
    /// Computes the results of a program; definitions with names have locals called after them.
    pub(in crate::codegen) fn new(program: &Program, names: &FxHashMap<Id, String>) -> Self {
        let Program { schedule, results, .. } = program;
        let order = Order::new(program);
        let peaks = [order.peak_before, order.peak()];
        let (order, segments) = segments(schedule, order);
        let ranges: Vec<Range<usize>> = segments.iter().map(|segment| segment.range.clone()).collect();
        let mut planner = Planner::new(program, &order.sequence, &ranges, names);
        let zero = schedule.find(Operation::Constant(0.0_f64.to_bits()));
        let stored = results.iter().copied().enumerate().filter(|(_, result)| Some(*result) != zero);
        let stored: Vec<(usize, Register)> = stored.collect();
        let is_sparse = results.len() >= MANY && stored.len() < results.len().div_ceil(2);
        let in_locals = segments.len() == 1 && !is_sparse;
        if !in_locals {
            planner.will_store(&stored);
        }
        let mut last = None;
        let mut parts = Vec::new();
        for (k, segment) in segments.iter().enumerate() {
            let sequence = &order.sequence[segment.range.clone()];
            if let Some(repeat) = &segment.repeat {
                parts.push(planner.rounds(repeat, sequence));
                continue;
            }
            sequence.iter().for_each(|&index| planner.compute(index));
            last = in_locals.then(|| results.iter().map(|&result| planner.value(result)).collect());
            let next = segments.get(k + 1).and_then(|next| next.repeat.as_ref());
            parts.push(planner.end_part(next.map(|repeat| (repeat, &order.sequence[repeat.range.clone()]))));
        }
        parts.retain(|part| in_locals || !part.statements.is_empty());
        Self { parts, waiting: planner.waiting.length, results: last, peaks }
    }
}

/// What becomes a part each. Of a long function only what is not computed in loops is long.
fn segments(schedule: &Schedule, order: Order) -> (Order, Vec<OperationRange>) {
    if !chunks::is_long(&order) {
        let segments = chunks::segments(&order, Vec::new());
        return (order, segments);
    }
    let all = 0..order.sequence.len();
    let angles = angles::plain_angles(schedule, &order.sequence, &[all]).concat();
    let angles: BTreeSet<Register> = angles.into_iter().collect();
    let order = order.with_sines_first(schedule, |register| angles.contains(&register));
    let repeats = repeats(schedule, &order);
    let segments = chunks::segments(&order, repeats);
    (order, segments)
}

/// A body under construction.
struct Planner<'p> {
    schedule: &'p Schedule,
    uses: Vec<usize>,
    /// For each register the last part that uses it.
    reach: Vec<usize>,
    /// What stands for each register that is computed.
    values: Vec<Option<LiveValue>>,
    definitions: FxHashMap<Register, Id>,
    /// For each call the results of it that are used.
    outputs: FxHashMap<u32, Vec<u32>>,
    /// For each register where it is stored as soon as it is computed.
    places: FxHashMap<Register, Vec<Slot>>,
    waiting: SpillSlots,
    index: usize,
    part: Chunk,
    /// What earlier parts computed and this one has in a local.
    fetched: BTreeSet<Register>,
    /// What is in a local and which a later part uses.
    kept: Vec<Register>,
    /// Where the repeat that comes next finds and leaves what it computes with.
    layout: RoundLayout,
    /// For each part, the last first, the angles in it that depend on no sine and on no other function.
    plain: Vec<Vec<Register>>,
    /// Those of this part whose turn has not come.
    early: Vec<Register>,
    /// The first of those that were taken last.
    leader: Option<Register>,
    /// Those that are at hand as small ones.
    small: BTreeSet<Register>,
}

struct LiveValue {
    expression: Operand,
    /// How deep it nests.
    depth: usize,
}

impl<'p> Planner<'p> {
    fn new(
        program: &'p Program,
        sequence: &[usize],
        cuts: &[Range<usize>],
        names: &FxHashMap<Id, String>,
    ) -> Self {
        let schedule = &program.schedule;
        let mut definitions = FxHashMap::default();
        for &(register, id) in schedule.definitions.iter().filter(|(_, id)| names.contains_key(id)) {
            definitions.entry(register).or_insert(id);
        }
        let mut reach = vec![0; schedule.operations.len()];
        for (part, cut) in cuts.iter().enumerate() {
            for &index in &sequence[cut.clone()] {
                reach[index] = part;
                schedule.operands(schedule.operations[index]).for_each(|x| reach[x.index()] = part);
            }
        }
        let uses = schedule.uses(&program.results);
        let mut outputs = FxHashMap::<u32, Vec<u32>>::default();
        for (operation, _) in schedule.operations.iter().zip(&uses).filter(|(_, uses)| **uses > 0) {
            if let &Operation::Result { call, output } = operation {
                outputs.entry(call).or_default().push(output);
            }
        }
        outputs.values_mut().for_each(|outputs| outputs.sort_unstable());
        let values = schedule.operations.iter().map(|_| None).collect();
        let (places, waiting, index, part, fetched, kept, layout) = Default::default();
        let mut plain = angles::plain_angles(schedule, sequence, cuts);
        let early = plain.pop().unwrap_or_default();
        Self {
            schedule,
            uses,
            reach,
            values,
            definitions,
            outputs,
            places,
            waiting,
            index,
            part,
            fetched,
            kept,
            layout,
            plain,
            early,
            leader: None,
            small: BTreeSet::new(),
        }
    }

    /// What stands for a result, here: what is neither in a local of this part nor waits is computed.
    fn value(&mut self, register: Register) -> Operand {
        let operation = self.schedule.operations[register.index()];
        if let Operation::Input(symbol) = operation {
            self.part.inputs.insert(symbol);
        }
        if matches!(operation, Operation::Constant(_) | Operation::Input(_)) {
            return Operand::Of(Box::new(operation.with_operands(|operand| self.value(operand))));
        }
        if self.values[register.index()].is_none() {
            self.compute(register.index());
        }
        self.fetch(register);
        self.values[register.index()].as_ref().expect("what was computed has a value").expression.clone()
    }

    /// Brings what an earlier part computed into a local.
    fn fetch(&mut self, register: Register) {
        if let Some(place) = self.waiting.place(register)
            && self.fetched.insert(register)
        {
            self.assign(self.local(register), Operand::SpillSlots(place));
        }
    }

    /// Computes one operation, if it has not come with another, and stores it where it is a result.
    fn compute(&mut self, index: usize) {
        let register = Register::at(index);
        match self.schedule.operations[index] {
            Operation::Function(Function::Sin | Function::Cos, x) => self.turn(x),
            _ if self.values[index].is_some() => {}
            Operation::Result { call, .. } => self.call(call),
            operation => {
                let operands = self.schedule.operands(operation);
                let depth = 1 + operands.map(|operand| self.depth(operand)).max().unwrap_or(0);
                let expression =
                    Operand::Of(Box::new(operation.with_operands(|operand| self.value(operand))));
                let is_used_here = self.uses[index] == 1 && self.reach[index] == self.index;
                if is_used_here && depth < NESTING {
                    self.values[index] = Some(LiveValue { expression, depth });
                } else {
                    let local = self.local(register);
                    self.assign(local, expression);
                    self.keep(register, local);
                }
            }
        }
        for place in self.places.remove(&register).unwrap_or_default() {
            self.store(place, register);
        }
    }

    fn depth(&self, register: Register) -> usize {
        self.values[register.index()].as_ref().map_or(0, |value| value.depth)
    }

    /// All results of a call are computed together, when the first of them is met.
    fn call(&mut self, call: u32) {
        let Call { function, derivatives, arguments } = self.schedule.calls[call as usize].clone();
        let mut results = Vec::new();
        for output in self.outputs.get(&call).cloned().unwrap_or_default() {
            let register = self.schedule.find(Operation::Result { call, output });
            let Some(register) = register.filter(|register| self.values[register.index()].is_none()) else {
                continue;
            };
            results.push((output, self.local(register)));
            self.keep(register, self.local(register));
        }
        let arguments = arguments.iter().map(|&argument| self.value(argument)).collect();
        self.part.locals.extend(results.iter().map(|(_, local)| local));
        self.part.statements.push(Statement::Call(Call { function, derivatives, arguments }, results));
    }

    /// In every part the same one.
    fn local(&self, register: Register) -> Local {
        match (self.definitions.get(&register), self.schedule.operations[register.index()]) {
            (Some(&id), _) => Local::Definition(id),
            (None, Operation::Result { call, output }) => Local::Result { call, output },
            (None, _) => Local::Operation(register.index()),
        }
    }

    fn assign(&mut self, local: Local, expression: Operand) {
        self.part.locals.push(local);
        self.part.statements.push(Statement::Let(local, expression));
    }

    /// Notes in which local a result is.
    fn keep(&mut self, register: Register, local: Local) {
        if self.reach[register.index()] > self.index {
            self.kept.push(register);
        }
        let expression = Operand::Local(local);
        self.values[register.index()] = Some(LiveValue { expression, depth: 0 });
    }

    /// Says which results are stored where: what is at hand at once, the others when they are computed.
    fn will_store(&mut self, results: &[(usize, Register)]) {
        for &(k, register) in results {
            match self.schedule.operations[register.index()] {
                Operation::Constant(_) | Operation::Input(_) => self.store(Slot::Result(k), register),
                _ => self.places.entry(register).or_default().push(Slot::Result(k)),
            }
        }
    }

    fn store(&mut self, place: Slot, register: Register) {
        let value = self.value(register);
        self.part.statements.push(Statement::Store(place, value));
    }

    /// Those of what no later part uses.
    fn release_places(&mut self) {
        let (reach, index) = (&self.reach, self.index);
        self.waiting.keep(|register| reach[register.index()] > index);
    }

    /// Forgets what does not wait: no later part sees the locals of this one.
    fn forget_locals(&mut self) {
        for (index, value) in self.values.iter_mut().enumerate().filter(|(_, value)| value.is_some()) {
            if self.waiting.place(Register::at(index)).is_none() {
                *value = None;
            }
        }
    }

    /// The part as it stands; the next one begins, which may be a repeat of this sequence.
    fn end_part(&mut self, next: Option<(&Repeat, &[usize])>) -> Chunk {
        self.release_places();
        for register in std::mem::take(&mut self.kept) {
            let value = self.value(register);
            let place = Slot::SpillSlots(SlotSequence::constant(self.waiting.add(register)));
            self.part.statements.push(Statement::Store(place, value));
            // It is at hand.
            self.fetched.insert(register);
        }
        if let Some((repeat, sequence)) = next {
            self.layout = self.lay_out(repeat, sequence);
        }
        self.fetched.clear();
        self.forget_locals();
        self.index += 1;
        self.early = self.plain.pop().unwrap_or_default();
        (self.leader, self.small) = Default::default();
        std::mem::take(&mut self.part)
    }
}
