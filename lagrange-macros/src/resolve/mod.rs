//! From a [`Declaration`] to a [`Problem`]: every name bound, every expression a scalar in the graph.

mod access;
mod algebra;
mod call;
mod define;
mod draw;
mod family;
mod forces;
mod frames;
mod function;
mod in_turn;
mod index;
mod lower;
mod matrix;
mod members;
pub(crate) mod nested;
mod outline;
mod parameters;
mod property;
mod quaternion;
mod scope;
mod statements;
mod turns;
mod unknown;
mod value;

use rustc_hash::FxHashMap;

use crate::diagnostics::{Diagnostics, Place};
use crate::symbolic::{Graph, Id};
use crate::syntax::{Declaration, Layout};
pub(crate) use frames::{Body, Frame, Step, Triple, columns, named, sum, symmetric};
pub(crate) use frames::{is_of_frames, is_step};
pub(crate) use function::Supplied;
use lower::Lowering;
pub(crate) use outline::{Observable, Outline, outline};
pub(crate) use parameters::{Entry, Parameters};
use scope::Scope;
pub(crate) use scope::is_built_in;
pub(crate) use value::cross;

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

/// A name for users to read, and where it was given.
#[derive(Clone, Debug)]
pub(crate) struct Label {
    pub(crate) text: String,
    pub(crate) place: Place,
}

/// Gives every expression its meaning; `None` where something was wrong, which is then reported.
pub(crate) fn problem(declaration: &Declaration, diagnostics: &mut Diagnostics) -> Option<(Graph, Problem)> {
    let scope = Scope::new(declaration, diagnostics);
    let functions = function::supplied(declaration, &scope, diagnostics);
    let parameters = Parameters::new(declaration, diagnostics);
    let mut lowering = Lowering::new(scope, parameters, declaration, diagnostics);
    lowering.define_all();
    let lagrangian = declaration.lagrangian.as_ref().and_then(|lagrangian| lowering.scalar(lagrangian));
    if let (Some(value), Some(written)) = (lagrangian, &declaration.lagrangian) {
        lowering.reject_kink("the Lagrangian", value, written.place);
    }
    let terms = lowering.terms(declaration);
    let forces = lowering.forces(declaration);
    let powers = lowering.powers(declaration);
    let dissipation =
        declaration.dissipation.as_ref().map(|function| (lowering.scalar(function), function.place));
    if let Some((Some(value), place)) = dissipation {
        lowering.reject_kink("a dissipation function", value, place);
    }
    let constraints = lowering.constraints(&declaration.constraints);
    let observables = lowering.observables(declaration);
    let conserved = lowering.conserved(declaration, &observables);
    let names = lowering.names(declaration);
    let frames_are_cheaper = lowering.frames_are_cheaper();
    let coordinates = labels(declaration);
    let Lowering { mut graph, parameters, diagnostics, frames, mut rates, .. } = lowering;
    rates.sort_unstable();
    rates.dedup();
    // Where shapes are wrong, it may be that a type is taken for a number.
    let scalar = parameters.scalar(declaration, diagnostics);
    let (place, lagrangian) = (declaration.lagrangian.as_ref()?.place, lagrangian?);
    let dissipation = match dissipation {
        Some((value, place)) => Some((value?, place)),
        None => None,
    };
    diagnostics.is_empty().then_some(())?;
    let mut problem = Problem {
        scalar,
        coordinates,
        lagrangian,
        terms,
        place,
        forces,
        powers,
        dissipation,
        constraints,
        observables,
        conserved,
        parameters,
        functions,
        frames: frames.all,
        bodies: frames.bodies,
        rates,
        frames_are_cheaper,
        names,
    };
    problem.nest_sums(&mut graph);
    diagnostics.is_empty().then_some((graph, problem))
}

/// Flat names of the coordinates: `x`, `r[0]`, `r[1]`.
pub(crate) fn labels(declaration: &Declaration) -> Vec<Label> {
    let elements = declaration.coordinates.iter().flat_map(|coordinate| {
        let place = coordinate.name.place;
        let texts = entry_names(&coordinate.name.text, &coordinate.lengths);
        texts.into_iter().map(move |text| Label { text, place })
    });
    elements.collect()
}

/// `x`, `x[0]` or `x[0][1]`
fn element_name(name: &str, indices: &[usize]) -> String {
    indices.iter().fold(name.to_owned(), |name, i| format!("{name}[{i}]"))
}

/// `x` of a number, `x[0]`, `x[1]` of a vector, `x[0][1]` of arrays in arrays of these lengths.
pub(crate) fn entry_names(name: &str, lengths: &[usize]) -> Vec<String> {
    let layout = Layout::array(lengths);
    (0..layout.numbers()).map(|number| element_name(name, &layout.indices(number))).collect()
}
