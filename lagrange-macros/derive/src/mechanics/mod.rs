//! Derives the equations of motion of a [`Problem`] and statements about them.

mod completion;
mod conservation;
mod consistency;
mod constraints;
mod contacts;
mod coordinates;
mod degree;
mod determinacy;
mod dissipation;
mod energy_form;
mod equations;
mod euler_lagrange;
mod evidence;
mod facts;
mod form;
mod formulation;
mod gauge;
mod gauss;
mod hamilton;
mod integrability;
mod kinetic;
mod legendre;
mod linearization;
pub(crate) mod many;
mod marker;
mod moment;
mod multipliers;
mod switched;
mod symmetries;
mod twists;
mod vanishing;
mod velocities;

use rustc_hash::FxHashMap;

use crate::diagnostics::Diagnostics;
use crate::resolve::{Limit, Problem};
use crate::symbolic::{Graph, Id};
use crate::variables::{Variable, nodes};
pub(crate) use completion::Completed;
pub(crate) use conservation::{Conserved, ConservedKind, EnergyChange, Symmetry};
pub use constraints::ConstraintKind;
pub use energy_form::EnergyForm;
pub(crate) use equations::{Equations, LinearEquations};
pub use evidence::Evidence;
pub(crate) use facts::Facts;
pub(crate) use form::Form;
pub use gauge::LinearPart;
use gauss::shorter;
pub(crate) use hamilton::{Hamilton, NoHamiltonian};
#[cfg(test)]
pub(crate) use integrability::Kinds;
pub use integrability::{Classification, Integrability, Integrals};
#[cfg(test)]
pub(crate) use linearization::SplitResidual;
use linearization::linearize;
pub(crate) use linearization::{Changes, Linearization, changes};
pub use marker::Marker;
#[cfg(test)]
pub(crate) use moment::{Moment, Moments};
pub(crate) use switched::{Row, RowGroup, SwitchedEquations};
#[cfg(test)]
pub(crate) use twists::TreeColumn;
pub(crate) use twists::{
    BodyTree, ChainArgument, ChainRule, Dependence, Euler, Link, Resultants, RigidBody, TreeBody, TreeJoint,
    Turning, Turnings,
};

/// Results derived from a problem. Their expressions are nodes of the graph of the problem.
pub(crate) struct Derived {
    pub(crate) equations: Equations,
    pub(crate) facts: Facts,
    /// The parts L₂ and −L₀ of E, if L is quadratic or even; `None` if L cannot be written at q̇ = 0
    pub(crate) energies: Option<[Id; 2]>,
    /// M q̈, for display
    pub(crate) inertia: Vec<Id>,
    /// Multipliers as functions of the state, for display, where the constraints hold
    pub(crate) multipliers: Option<Vec<Id>>,
    /// Rotations by quaternions, with their equations of motion, for display
    pub(crate) turnings: Turnings,
    /// Rigid bodies by the forces and torques on them, for display
    pub(crate) resultants: Option<Resultants>,
    /// Shorter expression to display in place of each key, found by inlining definitions that frames introduce.
    pub(crate) read: FxHashMap<Id, Id>,
    /// Hamilton's equations in symbols, or the reason why they are missing
    pub(crate) hamilton: Result<Hamilton, NoHamiltonian>,
    /// `None` if exact arithmetic cannot write it
    pub(crate) linearization: Option<Linearization>,
    /// Marker traits that the system implements
    pub(crate) markers: Vec<Marker>,
}

impl Derived {
    /// Nothing but expressions: the context in which those of systems of any number of bodies are read.
    /// `symmetries` are those of the system, and its Lagrangian is even in the velocities or not.
    pub(crate) fn of_expressions(symmetries: impl Iterator<Item = Symmetry>, is_even: bool) -> Self {
        Self {
            equations: Equations::none(),
            facts: Facts::of_symmetries(symmetries, is_even),
            energies: None,
            inertia: Vec::new(),
            turnings: Turnings::default(),
            resultants: None,
            read: FxHashMap::default(),
            hamilton: Err(NoHamiltonian::Long),
            linearization: None,
            multipliers: None,
            markers: Vec::new(),
        }
    }

    /// Calls of `min`, `max` and `clamp`, by velocities and by momenta.
    pub(crate) fn limits<'a>(&'a self, problem: &'a Problem) -> impl Iterator<Item = &'a Limit> {
        problem.limits.iter().chain(self.hamilton.iter().flat_map(|hamilton| &hamilton.limits))
    }
}

/// Derives the equations of motion and the statements about them. Reports missing equations and wrong declarations,
/// and then returns `None`.
pub(crate) fn derive(graph: &mut Graph, problem: &Problem, diagnostics: &mut Diagnostics) -> Option<Derived> {
    let equations = Equations::derive(graph, problem, diagnostics)?;
    let facts = Facts::find(graph, problem, &equations, diagnostics);
    let accelerations = nodes(graph, equations.mass.len(), Variable::Acceleration);
    let inertia: Vec<Id> = equations.mass.iter().map(|row| graph.dot(row, &accelerations)).collect();
    let mut read =
        if problem.frames.len() > 1 { read(graph, &equations, &inertia) } else { FxHashMap::default() };
    diagnostics.stop_at_fault(problem.place, graph)?;
    diagnostics.is_empty().then_some(())?;
    let turnings = Turnings::of(graph, problem, facts.energy_rate);
    graph.take_fault();
    let linearization = linearize(graph, problem, &equations);
    let energies = energy_form::parts(graph, problem, &equations, facts.energy_form);
    let of_frames = energies.filter(|_| problem.frames.len() > 1);
    read.extend(of_frames.into_iter().flatten().map(|id| (id, shorter(graph, id))));
    let hamilton = Hamilton::derive(graph, problem, &equations);
    let multipliers = multipliers::multipliers(graph, problem, &equations);
    graph.take_fault();
    let markers = Marker::proved(graph, &equations);
    let is_of_power = |(change, _): &&(EnergyChange, Id)| *change != EnergyChange::Time;
    let power = facts.energy_changes.iter().filter(is_of_power).map(|(_, part)| *part).collect::<Vec<_>>();
    let power = graph.total(power);
    let resultants = Resultants::of(graph, problem, &turnings, power);
    let beside = resultants.iter().flat_map(|resultants| resultants.beside.nodes());
    read.extend(beside.map(|id| (id, shorter(graph, id))));
    graph.take_fault();
    Some(Derived {
        equations,
        facts,
        energies,
        inertia,
        multipliers,
        turnings,
        resultants,
        read,
        hamilton,
        linearization,
        markers,
    })
}

/// Replaces the intermediate names of frames by their values, which shortens the printed equations.
fn read(graph: &mut Graph, equations: &Equations, inertia: &[Id]) -> FxHashMap<Id, Id> {
    let Equations { printed_forcing, momentum, energy, printed_force, .. } = equations;
    let all = [inertia, printed_forcing, momentum, &[*energy], printed_force].concat();
    all.into_iter().map(|id| (id, shorter(graph, id))).collect()
}
