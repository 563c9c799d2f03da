//! How the equations of motion change along a direction in time, state and parameters.
//!
//! The residual is written as the textbook does, dp/dt − ∂L/∂q − Q − Fᵀλ and d/dt(F q̇ + b), and not with the entries
//! of M: so it costs as much as the Lagrangian, and its derivative along one direction a small multiple of that
//! (forward mode; Griewank and Walther, *Evaluating Derivatives*, 3.1). The whole Jacobian as formulas would
//! be N² entries, each with second derivatives of M.

use super::equations::Equations;
use crate::resolve::Problem;
use crate::symbolic::{Forward, Graph, Id, Symbol};
use crate::variables::{Variable, symbols, total_time_derivative};

/// Derivatives along a direction, at given accelerations and multipliers, of …
pub(crate) struct Linearization {
    /// … M q̈ − h − Fᵀλ,
    pub(crate) motion: Vec<Id>,
    /// F q̈ + γ,
    pub(crate) acceleration: Vec<Id>,
    /// F q̇ + b,
    pub(crate) rate: Vec<Id>,
    /// Φ of holonomic constraints, zero for the others.
    pub(crate) position: Vec<Id>,
}

impl Linearization {
    /// Every entry.
    pub(crate) fn roots(&self) -> Vec<Id> {
        [&self.motion, &self.acceleration, &self.rate, &self.position]
            .into_iter()
            .flatten()
            .copied()
            .collect()
    }
}

/// What the equations depend on, in the order of [`Variable::Change`]: the time, coordinates, velocities, parameters.
pub(crate) fn arguments(problem: &Problem) -> Vec<Symbol> {
    let n = problem.coordinates.len();
    let mut arguments = vec![Variable::Time.symbol()];
    arguments.extend(symbols(n, Variable::Coordinate));
    arguments.extend(symbols(n, Variable::Velocity));
    arguments.extend(problem.parameters.by_field().into_iter().map(|k| Variable::Parameter(k).symbol()));
    arguments
}

/// Differentiates the residual; `None` where exact arithmetic cannot write the result.
pub(super) fn linearize(
    graph: &mut Graph,
    problem: &Problem,
    equations: &Equations,
) -> Option<Linearization> {
    let mut along_motion = total_time_derivative(graph, problem.coordinates.len());
    let motion = motion(graph, problem, equations, &mut along_motion);
    let acceleration: Vec<Id> =
        equations.rate.iter().map(|&velocity| along_motion.of(graph, velocity)).collect();
    let arguments = arguments(problem);
    let seeds: Vec<_> = arguments
        .into_iter()
        .enumerate()
        .map(|(i, argument)| (argument, graph.symbol(Variable::Change(i).symbol())))
        .collect();
    let mut along = Forward::along(seeds);
    let mut changes = |roots: &[Id]| roots.iter().map(|&root| along.of(graph, root)).collect::<Vec<Id>>();
    let linearization = Linearization {
        motion: changes(&motion),
        acceleration: changes(&acceleration),
        rate: changes(&equations.rate),
        position: changes(&equations.residual),
    };
    graph.take_fault().is_none().then_some(linearization)
}

/// dp/dt − ∂L/∂q − Q − Fᵀλ, with accelerations and multipliers as symbols.
fn motion(
    graph: &mut Graph,
    problem: &Problem,
    equations: &Equations,
    along_motion: &mut Forward,
) -> Vec<Id> {
    let n = problem.coordinates.len();
    let row = |i: usize| {
        let inertia = along_motion.of(graph, equations.momentum[i]);
        let free = graph.sub(inertia, equations.momentum_rate[i]);
        match equations.constraint_force.get(i) {
            Some(&force) => graph.sub(free, force),
            None => free,
        }
    };
    (0..n).map(row).collect()
}
