//! All that is known while expressions are lowered.

use std::rc::Rc;

use rustc_hash::{FxHashMap, FxHashSet};

use super::family::Family;
use super::frames::Frames;
use super::parameters::Parameters;
use super::scope::Scope;
use super::turns::Turns;
use super::value::Value;
use crate::diagnostics::{Diagnostics, Place};
use crate::symbolic::{Forward, Graph, Id};
use crate::syntax::{Coordinate, Declaration, Define, FrameDeclaration, FunctionDeclaration};
use crate::variables::total_time_derivative;

/// What the expression at hand may contain beside coordinates, velocities and time.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Setting {
    /// The Lagrangian, constraints, forces and what defines them.
    Equations,
    /// Observables: accelerations and multipliers too.
    Observable,
}

/// A definition as far as it has been read.
#[derive(Debug)]
pub(super) enum Definition {
    /// Its turn has not come.
    Pending,
    Value(Value),
    Family(Family),
    Function,
    /// Something was wrong with it, and reported.
    Wrong,
}

/// The multipliers of one `constraint` attribute or family.
#[derive(Debug)]
pub(super) struct MultiplierGroup {
    pub(super) name: String,
    pub(super) elements: Family,
}

/// An element of a definition: the definition's index, and the element's.
type Element = (usize, Vec<usize>);

/// How far the definitions are.
#[derive(Default)]
pub(super) struct Progress {
    /// The elements that are being defined, each because the one before it needs it.
    pub(super) current: Vec<Element>,
    /// Those that were needed before their turn.
    pub(super) early: FxHashSet<Element>,
    /// The indices that a definition stands for, in order.
    pub(super) elements: FxHashMap<usize, Rc<[Vec<usize>]>>,
}

/// Everything needed to give an expression its meaning.
pub(super) struct Lowering<'a> {
    pub(super) graph: Graph,
    pub(super) scope: Scope,
    pub(super) parameters: Parameters,
    pub(super) diagnostics: &'a mut Diagnostics,
    pub(super) coordinates: &'a [Coordinate],
    /// The first flat index of each coordinate, and how many there are.
    pub(super) offsets: Vec<usize>,
    pub(super) count: usize,
    pub(super) functions: &'a [FunctionDeclaration],
    pub(super) defines: &'a [Define],
    pub(super) declared_frames: &'a [FrameDeclaration],
    pub(super) frames: Frames,
    pub(super) turns: Turns,
    /// Vectors and matrices of which rates were asked.
    pub(super) differentiated: Vec<Id>,
    /// What `der` gave, and the velocities in frames, by components.
    pub(super) rates: Vec<Vec<Id>>,
    /// Where `min`, `max` or `clamp` was written last, by the argument of the function that it is made of.
    pub(super) kinks: FxHashMap<Id, Place>,
    /// By the index of the first `define` of the name.
    pub(super) definitions: Vec<Definition>,
    pub(super) progress: Progress,
    pub(super) multipliers: Vec<MultiplierGroup>,
    pub(super) observables: Vec<(String, Value)>,
    pub(super) setting: Setting,
    /// Whether something stands in for what is wrong.
    pub(super) is_guessing: bool,
    /// For how many values something does.
    pub(super) guesses: usize,
    /// Formals and indices, the innermost last.
    pub(super) locals: Vec<(String, Value)>,
    /// The calls of definitions around the expression at hand, the outermost first.
    pub(super) calls: Vec<Place>,
    pub(super) rate: Forward,
    pub(super) depth: usize,
    pub(super) steps: usize,
    pub(super) numbers: usize,
}

impl<'a> Lowering<'a> {
    pub(super) fn new(
        scope: Scope,
        parameters: Parameters,
        declaration: &'a Declaration,
        diagnostics: &'a mut Diagnostics,
    ) -> Self {
        let Declaration { coordinates, functions, defines, frames, .. } = declaration;
        let mut graph = Graph::default();
        let mut count = 0;
        let offsets = coordinates
            .iter()
            .map(|coordinate| {
                count += coordinate.count();
                count - coordinate.count()
            })
            .collect();
        Self {
            rate: total_time_derivative(&mut graph, count),
            graph,
            scope,
            parameters,
            diagnostics,
            coordinates,
            offsets,
            count,
            functions,
            defines,
            declared_frames: frames,
            frames: Frames::default(),
            turns: Turns::default(),
            differentiated: Vec::new(),
            rates: Vec::new(),
            kinks: FxHashMap::default(),
            definitions: defines.iter().map(|_| Definition::Pending).collect(),
            progress: Progress::default(),
            multipliers: Vec::new(),
            observables: Vec::new(),
            setting: Setting::Equations,
            is_guessing: false,
            guesses: 0,
            locals: Vec::new(),
            calls: Vec::new(),
            depth: 0,
            steps: 0,
            numbers: 0,
        }
    }

    pub(super) fn report<T>(&mut self, place: Place, message: impl std::fmt::Display) -> Option<T> {
        self.diagnostics.error(place, message);
        None
    }
}
