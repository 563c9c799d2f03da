//! A resolved mechanical system.

use rustc_hash::FxHashMap;

use super::frames::{Body, Frame};
use super::function::Supplied;
use super::label::{Label, entry_names};
use super::many::Many;
use super::parameters::{Entry, Parameters};
use crate::diagnostics::Place;
use crate::symbolic::Id;
use crate::syntax::ImpactLaw;

/// A mechanical system, resolved. Its expressions are nodes of a graph that is held separately.
pub(crate) struct Problem {
    /// Scalar type of the system.
    pub(crate) scalar: syn::Type,
    pub(crate) coordinates: Vec<Label>,
    pub(crate) lagrangian: Id,
    /// Terms of the Lagrangian, as written.
    pub(crate) terms: Vec<Id>,
    /// Source position of the Lagrangian.
    pub(crate) place: Place,
    /// Generalized force Q on each coordinate, without dissipation.
    pub(crate) forces: Vec<Id>,
    /// Force components, and the velocities that they act along. The virtual work of each pair is force · ∂velocity/∂q̇
    /// · δq.
    pub(crate) powers: Vec<(Id, Id)>,
    pub(crate) dissipation: Option<(Id, Place)>,
    /// Residual of each constraint as written, left − right: Φ or F q̇ + b.
    pub(crate) constraints: Vec<(Label, Id)>,
    /// Switch of each constraint that has one: its factor in the residual, 1 while the constraint holds, else 0.
    pub(crate) switches: Vec<Option<Id>>,
    pub(crate) contacts: Vec<ContactRow>,
    pub(crate) frictions: Vec<FrictionRows>,
    pub(crate) observables: Vec<Observed>,
    /// Indices of the observables declared as conserved, with the source position of each.
    pub(crate) conserved: Vec<(usize, Place)>,
    pub(crate) parameters: Parameters,
    /// Arrays whose lengths are known when the program runs. If there are any, `coordinates` are the elements in use.
    pub(crate) many: Many,
    pub(crate) functions: Vec<Supplied>,
    /// Frames, each after the one that it lies in; the first is the fixed frame.
    pub(crate) frames: Vec<Frame>,
    /// Names of frames, each with the index of its frame.
    pub(crate) frame_names: Vec<(usize, String)>,
    pub(crate) bodies: Vec<Body>,
    /// First of the four coordinates of each quaternion that turns a frame.
    pub(crate) quaternions: Vec<usize>,
    /// Components of each total time derivative as written, and of each velocity in a frame.
    pub(crate) rates: Vec<Vec<Id>>,
    /// True if the system could be stated in frames at lower cost.
    pub(crate) frames_are_cheaper: bool,
    /// Calls of `min`, `max` and `clamp`.
    pub(crate) limits: Vec<Limit>,
    /// Names of nodes that are definitions.
    pub(crate) names: FxHashMap<Id, String>,
    /// Names of the definitions that are vectors, with the numbers of their components.
    pub(crate) vectors: Vec<(String, usize)>,
}

impl Problem {
    /// Name of a multiplier.
    pub(crate) fn multiplier(&self, multiplier: usize) -> &Label {
        match self.many.is_open() {
            true => &self.coordinates[multiplier],
            false => &self.constraints[multiplier].0,
        }
    }
}

/// Value of `min`, `max` or `clamp`, with the arguments as they are written.
#[derive(Debug)]
pub(crate) struct Limit {
    pub(crate) value: Id,
    pub(crate) name: String,
    pub(crate) arguments: Vec<Id>,
}

impl Limit {
    /// The same with each node replaced.
    pub(crate) fn map(&self, mut node: impl FnMut(Id) -> Id) -> Self {
        let arguments = self.arguments.iter().map(|&argument| node(argument)).collect();
        Self { value: node(self.value), name: self.name.clone(), arguments }
    }
}

/// A contact: a constraint that holds while its gap is closed.
pub(crate) struct ContactRow {
    /// Index of the constraint.
    pub(crate) row: usize,
    /// Entry of the field that says whether it is closed.
    pub(crate) entry: Entry,
    /// Coefficient of restitution.
    pub(crate) restitution: Id,
    pub(crate) impact: ImpactLaw,
}

/// Friction: constraints that hold while bodies stick to one another, and else a force against the velocity.
pub(crate) struct FrictionRows {
    /// Index of the first constraint; one follows for a second velocity.
    pub(crate) row: usize,
    /// Multipliers while it slides, one for each velocity.
    pub(crate) sliding: Vec<Id>,
    /// Entry of the field that says whether it sticks.
    pub(crate) entry: Entry,
    /// Index of the contact that presses the bodies together; none for dry friction.
    pub(crate) contact: Option<usize>,
    /// Largest force while the bodies stick, and the sliding force, as multiples of the multiplier of the contact if there
    /// is one.
    pub(crate) bounds: [Id; 2],
}

impl FrictionRows {
    /// Indices of its constraints.
    pub(crate) fn rows(&self) -> core::ops::Range<usize> {
        self.row..self.row + self.sliding.len()
    }
}

/// An observable: a scalar, a vector or a matrix.
pub(crate) struct Observed {
    pub(crate) label: Label,
    pub(crate) lengths: Vec<usize>,
    /// Entries in row-major order.
    pub(crate) values: Vec<Id>,
}

impl Observed {
    /// Name of each entry, as a caller asks for it.
    pub(crate) fn names(&self) -> Vec<String> {
        entry_names(&self.label.text, &self.lengths)
    }
}
