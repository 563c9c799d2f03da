//! Directional derivatives of the equations of motion in time, state and parameters.
//!
//! The residual is written as dp/dt − ∂L/∂q − Q − Fᵀλ and d/dt(F q̇ + b), without the entries of M. It then costs as
//! much as the Lagrangian, and its derivative along one direction a small multiple of that (forward mode; Griewank and
//! Walther, *Evaluating Derivatives*, 3.1). The whole Jacobian as formulas would have N² entries, each with second
//! derivatives of M.

use super::equations::Equations;
use crate::resolve::Problem;
use crate::symbolic::{Forward, Graph, Id, Symbol};
use crate::variables::{Variable, symbols};

/// Derivatives of the residual at fixed accelerations and multipliers.
pub(crate) struct Linearization {
    /// Derivatives along a direction in time and state.
    pub(crate) by_state: Changes,
    /// Derivatives along a direction in the parameters.
    pub(crate) by_parameters: Changes,
    /// What is differentiated: the residual.
    pub(crate) residual: Vec<Id>,
}

/// Directional derivatives of the residuals.
pub(crate) struct Changes {
    /// Derivatives of M q̈ − h − Fᵀλ.
    pub(crate) motion: Vec<Id>,
    /// Derivatives of F q̈ + γ.
    pub(crate) acceleration: Vec<Id>,
    /// Derivatives of F q̇ + b.
    pub(crate) rate: Vec<Id>,
    /// Derivatives of Φ of holonomic constraints, zero for velocity constraints.
    pub(crate) position: Vec<Id>,
}

impl Linearization {
    /// All derivatives, as roots in the graph.
    pub(crate) fn roots(&self) -> Vec<Id> {
        [self.by_state.roots(), self.by_parameters.roots()].concat()
    }
}

impl Changes {
    /// All expressions, as roots in the graph.
    pub(crate) fn roots(&self) -> Vec<Id> {
        [&self.motion, &self.acceleration, &self.rate, &self.position].map(Vec::as_slice).concat()
    }
}

/// Arguments of the equations, each with the symbol of its change: the time, coordinates, velocities, parameters.
pub(crate) fn changes(problem: &Problem) -> Vec<(Symbol, Symbol)> {
    let state = state_arguments(problem).into_iter().enumerate();
    let parameters = problem.parameters.by_field().into_iter().enumerate();
    let of_state = state.map(|(i, argument)| (argument, Variable::Change(i).symbol()));
    let of_parameters =
        parameters.map(|(i, k)| (Variable::Parameter(k).symbol(), Variable::ParameterChange(i).symbol()));
    of_state.chain(of_parameters).collect()
}

fn state_arguments(problem: &Problem) -> Vec<Symbol> {
    let n = problem.coordinates.len();
    let mut arguments = vec![Variable::Time.symbol()];
    arguments.extend(symbols(n, Variable::Coordinate));
    arguments.extend(symbols(n, Variable::Velocity));
    arguments
}

/// Differentiates the residual; `None` where exact arithmetic cannot write the result.
pub(super) fn linearize(
    graph: &mut Graph,
    problem: &Problem,
    equations: &Equations,
) -> Option<Linearization> {
    let mut along = |pairs: &[(Symbol, Symbol)]| {
        let seeds: Vec<_> =
            pairs.iter().map(|&(argument, change)| (argument, graph.symbol(change))).collect();
        let mut along = Forward::along(seeds);
        let mut of = |roots: &[Id]| roots.iter().map(|&root| along.of(graph, root)).collect::<Vec<Id>>();
        Changes {
            motion: of(&equations.balance),
            acceleration: of(&equations.constraint_acceleration),
            rate: of(&equations.rate),
            position: of(&equations.residual),
        }
    };
    let all = changes(problem);
    let (state, parameters) = all.split_at(1 + 2 * problem.coordinates.len());
    let residual =
        [&equations.balance, &equations.constraint_acceleration, &equations.rate, &equations.residual];
    let linearization = Linearization {
        by_state: along(state),
        by_parameters: along(parameters),
        residual: residual.into_iter().flatten().copied().collect(),
    };
    graph.take_fault().is_none().then_some(linearization)
}
