//! Body of a function, independent of the language: the operations of each chunk, which are locals and which are
//! nested, and where results go. The [writer](super::writer) turns it into Rust.

mod chunks;
mod order_of_evaluation;
mod plan;
mod repeats;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;

use super::operation::{Call, CallKind, Operation};
use crate::symbolic::{Id, Symbol};

#[derive(Clone, Debug)]
pub(super) struct FunctionBody {
    /// Chunks in the order of execution; more than one for a long function.
    pub(super) parts: Vec<Chunk>,
    /// Number of spill slots.
    pub(super) waiting: usize,
    /// Results, as operands in the only chunk. `None` if the chunks store the results, except zeros, in the result
    /// arrays.
    pub(super) results: Option<Vec<Operand>>,
    /// Maximum number of live results, in the order of the derivation and in the chosen order.
    pub(super) peaks: [usize; 2],
}

/// Chunk of a function, with its own locals. Other chunks do not see them.
#[derive(Clone, Default, Debug)]
pub(super) struct Chunk {
    pub(super) inputs: BTreeSet<Symbol>,
    /// Locals that the statements assign, each once.
    pub(super) locals: Vec<Local>,
    pub(super) statements: Vec<Statement>,
    pub(super) rounds: Option<Rounds>,
}

impl Chunk {
    /// Returns all inputs that the chunk reads, before a loop or in an iteration.
    pub(super) fn reads(&self) -> impl Iterator<Item = Symbol> {
        let given = self.rounds.iter().flat_map(|rounds| &rounds.given).filter_map(|given| match given {
            Given::Inputs(symbols) => Some(symbols),
            Given::SpillSlots(_) => None,
        });
        self.inputs.iter().chain(given.flatten()).copied()
    }

    /// True if the chunk multiplies gradients among the slopes.
    pub(super) fn reads_gradients(&self) -> bool {
        let reads = |statement: &Statement| match statement {
            Statement::Call(call, _) => matches!(call.kind, CallKind::Slopes(_)),
            _ => false,
        };
        self.statements.iter().any(reads)
    }
}

/// Marks a chunk as a loop.
#[derive(Clone, Debug)]
pub(super) struct Rounds {
    pub(super) count: usize,
    /// Inputs of each iteration.
    pub(super) given: Vec<Given>,
}

#[derive(Clone, Debug)]
pub(super) enum Given {
    /// One input per iteration.
    Inputs(Vec<Symbol>),
    SpillSlots(SlotSequence),
}

/// Slot for each iteration: `first` plus a constant stride, which may be zero.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct SlotSequence {
    pub(super) first: usize,
    pub(super) step: isize,
}

impl SlotSequence {
    pub(super) fn constant(place: usize) -> Self {
        Self { first: place, step: 0 }
    }

    /// Finds a first slot and a stride that give these slots. `None` if there is no constant stride.
    pub(super) fn through(places: &[usize]) -> Option<Self> {
        let [first, second, ..] = *places else { return None };
        let series = Self { first, step: second as isize - first as isize };
        let is_on_it = places.iter().enumerate().all(|(round, place)| series.at(round) == *place);
        is_on_it.then_some(series)
    }

    pub(super) fn at(self, round: usize) -> usize {
        self.first.wrapping_add_signed(self.step * round as isize)
    }
}

#[derive(Clone, Debug)]
pub(super) enum Statement {
    Let(Local, Operand),
    /// Reduces angles by full turns if they are large. Their sines and cosines then need no range check.
    Small(Vec<(Local, Operand)>),
    /// Sines and cosines, evaluated together. More than one angle requires that all were reduced by
    /// [`Small`](Self::Small).
    Turns(Vec<SineAndCosine>),
    /// Calls of a user-supplied function, or of its derivatives of one order, on the same arguments.
    Call(Call<Operand>, Vec<CalledDerivative>),
    Store(Slot, Operand),
}

/// Positions of the arguments of differentiation of a call, with the indices and locals of the results in use.
pub(super) type CalledDerivative = (Box<[u32]>, Vec<(u32, Local)>);

/// Sine and cosine of one angle. `None` if unused.
#[derive(Clone, Debug)]
pub(super) struct SineAndCosine {
    pub(super) angle: Operand,
    pub(super) sine: Option<Local>,
    pub(super) cosine: Option<Local>,
}

#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Operand {
    Local(Local),
    /// Spill slot that an earlier chunk has filled.
    SpillSlots(usize),
    /// Constant, input, or operation on nested operands.
    Of(Box<Operation<Self>>),
}

/// Identity of a local, from which its name follows.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Local {
    Definition(Id),
    /// Index of the operation that computes the value.
    Operation(usize),
    /// Small angle, by the index of the operation or input that is the angle.
    Angle(usize),
    /// One result of a call.
    Result {
        call: u32,
        output: u32,
    },
}

/// Destination of a stored value.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Slot {
    Result(usize),
    SpillSlots(SlotSequence),
}
