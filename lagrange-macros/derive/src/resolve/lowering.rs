//! State of the lowering of expressions to the graph.

use std::rc::Rc;

use rustc_hash::{FxHashMap, FxHashSet};

use super::family::Family;
use super::frames::Frames;
use super::many::Many;
use super::parameters::Parameters;
use super::problem::{ContactRow, FrictionRows, Limit};
use super::scope::Scope;
use super::turns::Turns;
use super::value::Value;
use crate::diagnostics::{Diagnostics, Place};
use crate::symbolic::{Forward, Graph, Id};
use crate::syntax::{Coordinate, Declaration, Define, FrameDeclaration, FunctionDeclaration};
use crate::variables::total_time_derivative;

/// Symbols that the current expression may contain besides coordinates, velocities and time.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Setting {
    /// No others: the Lagrangian, constraints, forces and their definitions.
    Equations,
    /// Accelerations and multipliers too: observables.
    Observable,
}

/// State of a definition during lowering.
#[derive(Debug)]
pub(super) enum Definition {
    /// Not lowered yet.
    Pending,
    Value(Value),
    Family(Family),
    /// A family whose range is known when the program runs.
    Open,
    /// A family defined by recursion along such a range: index of its array.
    Recursion(usize),
    Function,
    /// An error in the definition has been reported.
    Wrong,
}

/// Multiplier symbols of one `constraint` attribute or family.
#[derive(Debug)]
pub(super) struct MultiplierGroup {
    pub(super) name: String,
    pub(super) elements: Family,
}

/// Index of a definition, and the indices of one of its elements.
type Element = (usize, Vec<usize>);

/// Progress of lowering the definitions.
#[derive(Default)]
pub(super) struct Progress {
    /// Stack of elements being defined; each is needed by the one before it.
    pub(super) current: Vec<Element>,
    /// Elements defined before their turn, because an earlier definition needs them.
    pub(super) early: FxHashSet<Element>,
    /// Element indices of each definition, in order, keyed by the index of the definition.
    pub(super) elements: FxHashMap<usize, Rc<[Vec<usize>]>>,
}

/// Symbol tables, graph and progress needed to lower expressions.
pub(super) struct Lowering<'a> {
    pub(super) graph: Graph,
    pub(super) scope: Scope,
    pub(super) parameters: Parameters,
    /// Arrays whose lengths are known when the program runs.
    pub(super) many: Many,
    pub(super) diagnostics: &'a mut Diagnostics,
    pub(super) coordinates: &'a [Coordinate],
    /// First flat index of each coordinate; `count` is the number of scalar coordinates.
    pub(super) offsets: Vec<usize>,
    pub(super) count: usize,
    pub(super) functions: &'a [FunctionDeclaration],
    pub(super) defines: &'a [Define],
    pub(super) declared_frames: &'a [FrameDeclaration],
    pub(super) frames: Frames,
    pub(super) turns: Turns,
    /// Entries of vectors and matrices in space whose time derivative was asked for.
    pub(super) differentiated: Vec<Id>,
    /// Components of each result of `der`, and of each velocity of a point in a frame.
    pub(super) rates: Vec<Vec<Id>>,
    /// Source position of the last `min`, `max` or `clamp`, keyed by the argument of the ramp function that represents
    /// it.
    pub(super) kinks: FxHashMap<Id, Place>,
    pub(super) limits: Vec<Limit>,
    /// State of each definition, at the index of the first `define` of its name.
    pub(super) definitions: Vec<Definition>,
    pub(super) progress: Progress,
    pub(super) multipliers: Vec<MultiplierGroup>,
    /// Names of constraints with errors, which have been reported.
    pub(super) failed_constraints: Vec<String>,
    /// Switch of each constraint that has one.
    pub(super) switches: Vec<Option<Id>>,
    pub(super) contacts: Vec<ContactRow>,
    pub(super) frictions: Vec<FrictionRows>,
    pub(super) observables: Vec<(String, Value)>,
    pub(super) setting: Setting,
    /// True while the outline is read: an erroneous expression gets a stand-in value.
    pub(super) is_guessing: bool,
    /// Number of stand-in values so far.
    pub(super) guesses: usize,
    /// Formal arguments and running indices in scope, innermost last.
    pub(super) locals: Vec<(String, Value)>,
    /// Calls of user definitions that enclose the current expression, outermost first.
    pub(super) calls: Vec<Place>,
    pub(super) rate: Forward,
    pub(super) depth: usize,
    pub(super) steps: usize,
    pub(super) numbers: usize,
}

impl<'a> Lowering<'a> {
    pub(super) fn new(
        scope: Scope,
        (parameters, many): (Parameters, Many),
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
            many,
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
            limits: Vec::new(),
            definitions: defines.iter().map(|_| Definition::Pending).collect(),
            progress: Progress::default(),
            multipliers: Vec::new(),
            failed_constraints: Vec::new(),
            switches: Vec::new(),
            contacts: Vec::new(),
            frictions: Vec::new(),
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
