//! A function's body before it is said in a language: what is computed in which part, in which local or nested in what,
//! and where results go. The [writer](super::writer) says it in Rust.

mod chunks;
mod order_of_evaluation;
mod plan;
mod repeats;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;

use super::operation::{Call, Operation};
use crate::symbolic::{Id, Symbol};

#[derive(Clone, Debug)]
pub(super) struct FunctionBody {
    /// One after the other; more than one where the function is long.
    pub(super) parts: Vec<Chunk>,
    /// How many results wait at once for a later part.
    pub(super) waiting: usize,
    /// The results, in locals of the only part; where there are none the parts store them, all but zeros.
    pub(super) results: Option<Vec<Operand>>,
    /// How many results wait for their last use at once, at most, in the order of the derivation and in this one.
    pub(super) peaks: [usize; 2],
}

/// Statements that see no locals but their own.
#[derive(Clone, Default, Debug)]
pub(super) struct Chunk {
    pub(super) inputs: BTreeSet<Symbol>,
    /// What the statements give values to, each once.
    pub(super) locals: Vec<Local>,
    pub(super) statements: Vec<Statement>,
    pub(super) rounds: Option<Rounds>,
}

impl Chunk {
    /// All inputs that are read, once or round by round.
    pub(super) fn reads(&self) -> impl Iterator<Item = Symbol> {
        let given = self.rounds.iter().flat_map(|rounds| &rounds.given).filter_map(|given| match given {
            Given::Inputs(symbols) => Some(symbols),
            Given::SpillSlots(_) => None,
        });
        self.inputs.iter().chain(given.flatten()).copied()
    }
}

/// Marks statements that run as a loop.
#[derive(Clone, Debug)]
pub(super) struct Rounds {
    pub(super) count: usize,
    /// Inputs of each round of the loop.
    pub(super) given: Vec<Given>,
}

#[derive(Clone, Debug)]
pub(super) enum Given {
    /// One after the other, round by round.
    Inputs(Vec<Symbol>),
    SpillSlots(SlotSequence),
}

/// Places in an array, round by round: in all the same one, or others as far apart.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct SlotSequence {
    pub(super) first: usize,
    pub(super) step: isize,
}

impl SlotSequence {
    pub(super) fn constant(place: usize) -> Self {
        Self { first: place, step: 0 }
    }

    /// Through these places, if there is one.
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
    /// Angles less full turns where they are large, of which there is no need to ask again.
    Small(Vec<(Local, Operand)>),
    /// Sines and cosines, together: of several, small angles.
    Turns(Vec<SineAndCosine>),
    /// A call of a function that the user supplies, and those of its results that are used.
    Call(Call<Operand>, Vec<(u32, Local)>),
    Store(Slot, Operand),
}

/// The sine and the cosine of one angle, as far as they are used.
#[derive(Clone, Debug)]
pub(super) struct SineAndCosine {
    pub(super) angle: Operand,
    pub(super) sine: Option<Local>,
    pub(super) cosine: Option<Local>,
}

#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Operand {
    Local(Local),
    /// What an earlier part has stored.
    SpillSlots(usize),
    /// A constant, an input, or an operation on what is nested in it.
    Of(Box<Operation<Self>>),
}

/// What a local is called after.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Local {
    Definition(Id),
    /// The operation that computes it.
    Operation(usize),
    /// That operation or input, as a small angle.
    Angle(usize),
    /// One result of a call.
    Result {
        call: u32,
        output: u32,
    },
}

/// Where a value is stored.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Slot {
    Result(usize),
    SpillSlots(SlotSequence),
}
