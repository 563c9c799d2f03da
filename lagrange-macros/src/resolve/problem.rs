//! What a mechanical system is made of.

use rustc_hash::FxHashMap;

use super::frames::{Body, Frame};
use super::function::Supplied;
use super::label::{Label, entry_names};
use super::parameters::Parameters;
use crate::diagnostics::Place;
use crate::symbolic::Id;

/// A mechanical system: what it is made of are nodes of a graph beside it.
pub(crate) struct Problem {
    /// The number type.
    pub(crate) scalar: syn::Type,
    pub(crate) coordinates: Vec<Label>,
    pub(crate) lagrangian: Id,
    /// The terms of the sum that the Lagrangian is, as written.
    pub(crate) terms: Vec<Id>,
    /// Where the Lagrangian stands.
    pub(crate) place: Place,
    /// Q of each coordinate without the dissipation.
    pub(crate) forces: Vec<Id>,
    /// Forces by the velocities that they act along: each does their product of virtual work.
    pub(crate) powers: Vec<(Id, Id)>,
    pub(crate) dissipation: Option<(Id, Place)>,
    /// Φ or F q̇ + b as written: left − right.
    pub(crate) constraints: Vec<(Label, Id)>,
    pub(crate) observables: Vec<Observed>,
    /// The observables that are said to be conserved, and where.
    pub(crate) conserved: Vec<(usize, Place)>,
    pub(crate) parameters: Parameters,
    pub(crate) functions: Vec<Supplied>,
    /// Each after the one that it comes from; the first is at rest.
    pub(crate) frames: Vec<Frame>,
    pub(crate) bodies: Vec<Body>,
    /// Total time derivatives as written, and velocities in frames, by components.
    pub(crate) rates: Vec<Vec<Id>>,
    /// Whether it could be stated in frames, and would cost less.
    pub(crate) frames_are_cheaper: bool,
    /// Names of nodes that are definitions.
    pub(crate) names: FxHashMap<Id, String>,
}

/// What is observed: a number, a vector or a matrix.
pub(crate) struct Observed {
    pub(crate) label: Label,
    pub(crate) lengths: Vec<usize>,
    /// Row by row.
    pub(crate) values: Vec<Id>,
}

impl Observed {
    /// Of every number, as it is asked for.
    pub(crate) fn names(&self) -> Vec<String> {
        entry_names(&self.label.text, &self.lengths)
    }
}
