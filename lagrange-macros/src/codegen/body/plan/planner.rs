//! A body under construction: results become values, locals and spill slots, part by part.

use std::collections::BTreeSet;
use std::ops::Range;

use rustc_hash::FxHashMap;

use crate::codegen::body::chunks::SpillSlots;
use crate::codegen::body::repeats::Repeat;
use crate::codegen::body::{Chunk, Given, Local, Operand, Slot, SlotSequence, Statement};
use crate::codegen::operation::{Call, Operation, Register};
use crate::codegen::passes::Program;
use crate::codegen::schedule::Schedule;
use crate::symbolic::{Function, Id};

/// Single-use results are nested into what uses them to this depth.
const NESTING: usize = 6;

/// A body under construction.
pub(super) struct Planner<'p> {
    pub(super) schedule: &'p Schedule,
    pub(super) uses: Vec<usize>,
    /// For each register the last part that uses it.
    pub(super) reach: Vec<usize>,
    /// What stands for each register that is computed.
    pub(super) values: Vec<Option<LiveValue>>,
    definitions: FxHashMap<Register, Id>,
    /// For each call the results of it that are used.
    outputs: FxHashMap<u32, Vec<u32>>,
    /// For each register where it is stored as soon as it is computed.
    pub(super) places: FxHashMap<Register, Vec<Slot>>,
    pub(super) waiting: SpillSlots,
    pub(super) index: usize,
    pub(super) part: Chunk,
    /// What earlier parts computed and this one has in a local.
    fetched: BTreeSet<Register>,
    /// What is in a local and which a later part uses.
    kept: Vec<Register>,
    /// Where the repeat that comes next finds and leaves what it computes with.
    pub(super) layout: RoundLayout,
    /// For each part, the last first, the angles in it that depend on no sine and on no other function.
    pub(super) plain: Vec<Vec<Register>>,
    /// Those of this part whose turn has not come.
    pub(super) early: Vec<Register>,
    /// The first of those that were taken last.
    pub(super) leader: Option<Register>,
    /// Those that are at hand as small ones.
    pub(super) small: BTreeSet<Register>,
}

pub(super) struct LiveValue {
    pub(super) expression: Operand,
    /// How deep it nests.
    pub(super) depth: usize,
}

#[derive(Default)]
pub(super) struct RoundLayout {
    /// The operations of a round that leave something, and where.
    pub(super) left: Vec<(usize, SlotSequence)>,
    pub(super) given: Vec<Given>,
    /// What is free after the last round, unless something waits there.
    pub(super) reserved: Vec<Range<usize>>,
}

impl<'p> Planner<'p> {
    pub(super) fn new(
        program: &'p Program,
        sequence: &[usize],
        cuts: &[Range<usize>],
        names: &FxHashMap<Id, String>,
        mut plain: Vec<Vec<Register>>,
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
    pub(super) fn value(&mut self, register: Register) -> Operand {
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
    pub(super) fn compute(&mut self, index: usize) {
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
    pub(super) fn local(&self, register: Register) -> Local {
        match (self.definitions.get(&register), self.schedule.operations[register.index()]) {
            (Some(&id), _) => Local::Definition(id),
            (None, Operation::Result { call, output }) => Local::Result { call, output },
            (None, _) => Local::Operation(register.index()),
        }
    }

    pub(super) fn assign(&mut self, local: Local, expression: Operand) {
        self.part.locals.push(local);
        self.part.statements.push(Statement::Let(local, expression));
    }

    /// Notes in which local a result is.
    pub(super) fn keep(&mut self, register: Register, local: Local) {
        if self.reach[register.index()] > self.index {
            self.kept.push(register);
        }
        let expression = Operand::Local(local);
        self.values[register.index()] = Some(LiveValue { expression, depth: 0 });
    }

    /// Says which results are stored where: what is at hand at once, the others when they are computed.
    pub(super) fn will_store(&mut self, results: &[(usize, Register)]) {
        for &(k, register) in results {
            match self.schedule.operations[register.index()] {
                Operation::Constant(_) | Operation::Input(_) => self.store(Slot::Result(k), register),
                _ => self.places.entry(register).or_default().push(Slot::Result(k)),
            }
        }
    }

    pub(super) fn store(&mut self, place: Slot, register: Register) {
        let value = self.value(register);
        self.part.statements.push(Statement::Store(place, value));
    }

    /// Those of what no later part uses.
    pub(super) fn release_places(&mut self) {
        let (reach, index) = (&self.reach, self.index);
        self.waiting.keep(|register| reach[register.index()] > index);
    }

    /// Forgets what does not wait: no later part sees the locals of this one.
    pub(super) fn forget_locals(&mut self) {
        for (index, value) in self.values.iter_mut().enumerate().filter(|(_, value)| value.is_some()) {
            if self.waiting.place(Register::at(index)).is_none() {
                *value = None;
            }
        }
    }

    /// The part as it stands; the next one begins, which may be a repeat of this sequence.
    pub(super) fn end_part(&mut self, next: Option<(&Repeat, &[usize])>) -> Chunk {
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
