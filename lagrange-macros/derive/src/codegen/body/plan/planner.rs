//! Builder of a body: assigns results to expressions, locals and spill slots, chunk by chunk.

use std::collections::BTreeSet;
use std::ops::Range;

use rustc_hash::FxHashMap;

use crate::codegen::body::chunks::SpillSlots;
use crate::codegen::body::repeats::Repeat;
use crate::codegen::body::{Chunk, Given, Local, Operand, Slot, SlotSequence, Statement};
use crate::codegen::operation::{Family, Operation, Register};
use crate::codegen::passes::Program;
use crate::codegen::schedule::Schedule;
use crate::symbolic::{Function, Id};

/// Maximum depth to which single-use results are nested in expressions.
const NESTING: usize = 6;

/// Body under construction.
pub(super) struct Planner<'p> {
    pub(super) schedule: &'p Schedule,
    pub(super) uses: Vec<usize>,
    /// Index of the last chunk that uses each register.
    pub(super) reach: Vec<usize>,
    /// Current value of each computed register, in the current chunk or in a spill slot.
    pub(super) values: Vec<Option<LiveValue>>,
    definitions: FxHashMap<Register, Id>,
    /// Indices of the results in use, for each call.
    outputs: FxHashMap<u32, Vec<u32>>,
    /// Calls in use that are emitted together.
    families: FxHashMap<Family<'p>, Vec<u32>>,
    /// Destinations to which each register is stored as soon as it is computed.
    pub(super) places: FxHashMap<Register, Vec<Slot>>,
    pub(super) waiting: SpillSlots,
    pub(super) index: usize,
    pub(super) part: Chunk,
    /// Registers of earlier chunks that the current chunk has loaded into locals.
    fetched: BTreeSet<Register>,
    /// Registers that the current chunk holds in locals and a later chunk uses.
    kept: Vec<Register>,
    /// Inputs and outputs of the next loop, in spill slots.
    pub(super) layout: RoundLayout,
    /// Angles that follow from inputs by arithmetic alone: lists per chunk, the last chunk first.
    pub(super) plain: Vec<Vec<Register>>,
    /// Plain angles of the current chunk that are not yet evaluated.
    pub(super) early: Vec<Register>,
    /// First angle of the last group emitted. The next group is emitted where this angle is used.
    pub(super) leader: Option<Register>,
    /// Angles of the current chunk that are available as small angles.
    pub(super) small: BTreeSet<Register>,
}

pub(super) struct LiveValue {
    pub(super) expression: Operand,
    /// Nesting depth of the expression.
    pub(super) depth: usize,
}

#[derive(Default)]
pub(super) struct RoundLayout {
    /// Operations of an iteration whose results are stored, with their slots.
    pub(super) left: Vec<(usize, SlotSequence)>,
    pub(super) given: Vec<Given>,
    /// Slots to free after the loop, unless they hold a live register.
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
        let mut families = FxHashMap::<Family, Vec<u32>>::default();
        for (call, of) in schedule.calls.iter().enumerate().map(|(call, of)| (call as u32, of)) {
            if outputs.contains_key(&call) {
                families.entry(of.family()).or_default().push(call);
            }
        }
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
            families,
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

    /// Returns a register as an operand. Computes it if it is neither in a local of the current chunk nor in a spill
    /// slot.
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

    /// Loads a result of an earlier chunk into a local.
    fn fetch(&mut self, register: Register) {
        if let Some(place) = self.waiting.place(register)
            && self.fetched.insert(register)
        {
            self.assign(self.local(register), Operand::SpillSlots(place));
        }
    }

    /// Computes the operation at this index, unless an earlier operation was computed together with it. Stores the
    /// value if it is a result of the function.
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

    /// Emits the calls of a family and computes all their results, when the first of them is needed.
    fn call(&mut self, call: u32) {
        let schedule = self.schedule;
        let on = schedule.calls[call as usize].on(|&argument| self.value(argument));
        let mut calls = Vec::new();
        for call in self.families[&schedule.calls[call as usize].family()].clone() {
            let results = self.results_of(call);
            self.part.locals.extend(results.iter().map(|(_, local)| local));
            calls.push((schedule.calls[call as usize].derivatives.clone(), results));
        }
        self.part.statements.push(Statement::Call(on, calls));
    }

    /// Puts the results of a call that are in use into locals.
    fn results_of(&mut self, call: u32) -> Vec<(u32, Local)> {
        let mut results = Vec::new();
        for output in self.outputs.get(&call).cloned().unwrap_or_default() {
            let register = self.schedule.find(Operation::Result { call, output });
            let Some(register) = register.filter(|register| self.values[register.index()].is_none()) else {
                continue;
            };
            results.push((output, self.local(register)));
            self.keep(register, self.local(register));
        }
        results
    }

    /// Local of a register, the same in every chunk.
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

    /// Records that a register is in a local.
    pub(super) fn keep(&mut self, register: Register, local: Local) {
        if self.reach[register.index()] > self.index {
            self.kept.push(register);
        }
        let expression = Operand::Local(local);
        self.values[register.index()] = Some(LiveValue { expression, depth: 0 });
    }

    /// Sets the destinations of results. Constants and inputs are stored at once, the others when they are computed.
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

    /// Frees the slots of registers that no later chunk uses.
    pub(super) fn release_places(&mut self) {
        let (reach, index) = (&self.reach, self.index);
        self.waiting.keep(|register| reach[register.index()] > index);
    }

    /// Forgets registers outside of spill slots: later chunks do not see the locals of the current one.
    pub(super) fn forget_locals(&mut self) {
        for (index, value) in self.values.iter_mut().enumerate().filter(|(_, value)| value.is_some()) {
            if self.waiting.place(Register::at(index)).is_none() {
                *value = None;
            }
        }
    }

    /// Ends the current chunk and returns it. Spills live registers, and lays out the loop that follows, if any.
    pub(super) fn end_part(&mut self, next: Option<(&Repeat, &[usize])>) -> Chunk {
        self.release_places();
        for register in std::mem::take(&mut self.kept) {
            let value = self.value(register);
            let place = Slot::SpillSlots(SlotSequence::constant(self.waiting.add(register)));
            self.part.statements.push(Statement::Store(place, value));
            // The register is still in a local of this chunk, so it needs no load.
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
