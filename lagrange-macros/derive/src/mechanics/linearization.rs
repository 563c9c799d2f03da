//! Directional derivatives of the equations of motion in time, state and parameters.
//!
//! The residual is written as dp/dt − ∂L/∂q − Q − Fᵀλ and d/dt(F q̇ + b), without the entries of M. It then costs as
//! much as the Lagrangian, and its derivative along one direction a small multiple of that (forward mode; Griewank and
//! Walther, *Evaluating Derivatives*, 3.1). The whole Jacobian as formulas would have N² entries, each with second
//! derivatives of M.

use super::equations::Equations;
use super::twists::{BodyTree, Twists};
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
    /// The derivatives by the state in two parts, for systems with many joints.
    pub(crate) split: Option<SplitResidual>,
    /// Derivatives of h along a direction in time and state, for systems with contacts; else empty.
    pub(crate) forces: Vec<Id>,
}

/// The residual in two parts: inertial forces and weights of a tree of bodies, and all other terms.
pub(crate) struct SplitResidual {
    pub(crate) tree: BodyTree,
    /// Derivatives of the other terms along a direction in time and state.
    pub(crate) by_state: Changes,
    /// The other terms.
    pub(crate) residual: Vec<Id>,
}

/// Least number of columns of the joints with which a tree of bodies is differentiated apart. The quadruped of `benches/peers`
/// has 19, and its `state_jacobian` gains a tenth; arms along the axes of their frames lose a third with 6 and are even with 12.
const LEAST_COLUMNS: usize = 19;

/// Largest number N of coordinates for which a tree is differentiated apart. That takes 2N² numbers, and several times as many on the
/// stack: without optimization 1 MB for 60 coordinates, half of what a thread has, and 3 MB for 102.
const MOST_COORDINATES: usize = 64;

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
    let all = changes(problem);
    let n = problem.coordinates.len();
    let (state, parameters) = all.split_at(1 + 2 * n);
    let is_small = n <= MOST_COORDINATES;
    let split = is_small.then(|| SplitResidual::of(graph, problem, equations, LEAST_COLUMNS)).flatten();
    let linearization = Linearization {
        by_state: Changes::along(graph, &equations.balance, equations, state),
        by_parameters: Changes::along(graph, &equations.balance, equations, parameters),
        residual: residual(&equations.balance, equations),
        split,
        forces: forces(graph, problem, equations, state),
    };
    graph.take_fault().is_none().then_some(linearization)
}

fn forces(
    graph: &mut Graph,
    problem: &Problem,
    equations: &Equations,
    pairs: &[(Symbol, Symbol)],
) -> Vec<Id> {
    if problem.contacts.is_empty() && problem.frictions.is_empty() {
        return Vec::new();
    }
    let mut along = along(graph, pairs);
    equations.forcing.iter().map(|&force| along.of(graph, force)).collect()
}

/// Derivatives along the direction whose components are the second of these pairs of symbols.
fn along(graph: &mut Graph, pairs: &[(Symbol, Symbol)]) -> Forward {
    Forward::along(pairs.iter().map(|&(argument, change)| (argument, graph.symbol(change)))).keeping_sums()
}

fn residual(balance: &[Id], equations: &Equations) -> Vec<Id> {
    let Equations { constraint_acceleration, rate, residual, .. } = equations;
    [balance, constraint_acceleration, rate, residual].concat()
}

impl Changes {
    /// Derivatives along a [direction](along). `balance` is the residual of the equations of motion.
    fn along(graph: &mut Graph, balance: &[Id], equations: &Equations, pairs: &[(Symbol, Symbol)]) -> Self {
        let mut along = along(graph, pairs);
        let mut of = |roots: &[Id]| roots.iter().map(|&root| along.of(graph, root)).collect::<Vec<Id>>();
        Self {
            motion: of(balance),
            acceleration: of(&equations.constraint_acceleration),
            rate: of(&equations.rate),
            position: of(&equations.residual),
        }
    }
}

impl SplitResidual {
    /// `None` if the tree has fewer columns than `least`.
    pub(crate) fn of(
        graph: &mut Graph,
        problem: &Problem,
        equations: &Equations,
        least: usize,
    ) -> Option<Self> {
        let twists = Twists::of(graph, problem)?;
        let tree = BodyTree::of(graph, &twists, least)?;
        let mut rest = tree.rest.clone();
        // Without constraints there is no list of constraint forces.
        let forces = rest.iter_mut().zip(&equations.constraint_force);
        forces.for_each(|(rest, &force)| *rest = graph.sub(*rest, force));
        let all = changes(problem);
        let by_state = Changes::along(graph, &rest, equations, &all[..=2 * problem.coordinates.len()]);
        Some(Self { by_state, residual: residual(&rest, equations), tree })
    }
}
