//! Resolves a [`Declaration`] into a [`Problem`]: binds every name and lowers every expression to scalars of the graph.

mod access;
mod algebra;
mod call;
mod define;
mod draw;
mod elements;
mod expression;
mod family;
mod forces;
mod frames;
mod friction;
mod function;
mod in_turn;
mod index;
mod label;
mod lowering;
pub(crate) mod many;
mod matrix;
mod members;
pub(crate) mod nested;
mod outline;
mod parameters;
mod problem;
mod property;
mod quaternion;
mod scope;
mod statements;
mod turns;
mod unknown;
mod value;

use crate::diagnostics::Diagnostics;
use crate::symbolic::Graph;
use crate::syntax::Declaration;
pub(crate) use frames::{Body, Frame, Step, Triple, columns, named, sum, symmetric};
pub(crate) use frames::{is_of_frames, is_step};
pub(crate) use function::Supplied;
pub(crate) use label::{Label, entry_names, labels, vector, vectors};
use lowering::Lowering;
use many::Many;
pub(crate) use many::loops_instead;
pub(crate) use outline::{Observable, Outline, outline};
pub(crate) use parameters::{Entry, Parameters, Switch, SwitchReading};
pub(crate) use problem::{FrictionRows, Limit, Observed, Problem};
use scope::Scope;
pub(crate) use scope::is_built_in;
pub(crate) use value::cross;

/// Resolves a declaration into a graph and a problem; returns `None` after reporting any error.
pub(crate) fn problem(declaration: &Declaration, diagnostics: &mut Diagnostics) -> Option<(Graph, Problem)> {
    let parameters = Parameters::new(declaration, diagnostics);
    let many = Many::of(declaration, &parameters, diagnostics);
    resolved(declaration, (parameters, many), diagnostics)
}

/// Resolves a declaration with arrays of several elements so that the equations of all elements are one; `None` if it has none, or
/// states something that is not said of all elements.
pub(crate) fn families(declaration: &Declaration) -> Option<(Graph, Problem)> {
    let many = Many::attempt(declaration);
    (many.is_open() && declaration.constraints.is_empty()).then_some(())?;
    let diagnostics = &mut Diagnostics::default();
    let parameters = Parameters::new(declaration, diagnostics);
    resolved(declaration, (parameters, many), diagnostics)
}

fn resolved(
    declaration: &Declaration,
    (parameters, many): (Parameters, Many),
    diagnostics: &mut Diagnostics,
) -> Option<(Graph, Problem)> {
    let scope = Scope::new(declaration, diagnostics);
    let functions = function::supplied(declaration, &scope, diagnostics);
    let mut lowering = Lowering::new(scope, (parameters, many), declaration, diagnostics);
    if lowering.many.is_open() {
        lowering.refuse_with_open_lengths(declaration);
        lowering.diagnostics.is_empty().then_some(())?;
    }
    lowering.define_all();
    lowering.many.stated_recursions = lowering.constraints_of_recursions();
    let lagrangian = declaration.lagrangian.as_ref().and_then(|lagrangian| lowering.scalar(lagrangian));
    if let (Some(value), Some(written)) = (lagrangian, &declaration.lagrangian) {
        lowering.reject_kink("the Lagrangian", value, written.place);
    }
    let terms = lowering.terms(declaration);
    let forces = lowering.forces(declaration);
    let mut powers = lowering.powers(declaration);
    let dissipation =
        declaration.dissipation.as_ref().map(|function| (lowering.scalar(function), function.place));
    if let Some((Some(value), place)) = dissipation {
        lowering.reject_kink("a dissipation function", value, place);
    }
    let constraints = match lowering.many.is_open() {
        true => {
            lowering.open_constraints(declaration);
            Vec::new()
        }
        false => lowering.constraints(&declaration.constraints, &mut powers),
    };
    lowering.parameters.check_states(lowering.diagnostics);
    let observables = lowering.observables(declaration);
    let conserved = lowering.conserved(declaration, &observables);
    let (names, vectors) = (lowering.names(declaration), lowering.vectors(declaration));
    let frames_are_cheaper = lowering.frames_are_cheaper();
    let coordinates = match lowering.many.is_open() {
        true => lowering.many.labels(&lowering.parameters),
        false => labels(declaration),
    };
    let quaternions = lowering.quaternions(coordinates.len());
    let Lowering {
        mut graph,
        parameters,
        many,
        diagnostics,
        frames,
        mut rates,
        limits,
        switches,
        contacts,
        frictions,
        ..
    } = lowering;
    rates.sort_unstable();
    rates.dedup();
    // Scalar types are checked after the shapes: a shape error may come from a type mistaken for a number.
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
        switches,
        contacts,
        frictions,
        observables,
        conserved,
        parameters,
        many,
        functions,
        frame_names: frames.names(),
        frames: frames.all,
        bodies: frames.bodies,
        quaternions,
        rates,
        frames_are_cheaper,
        limits,
        names,
        vectors,
    };
    problem.nest_sums(&mut graph);
    diagnostics.is_empty().then_some((graph, problem))
}
