//! d/dt(∂L/∂q̇) = ∂L/∂q + Q: momenta, forces and energy.

use super::degree;
use crate::resolve::Problem;
use crate::symbolic::{Forward, Graph, Id};
use crate::variables::{Variable, has_velocity, nodes, symbols};

/// Momenta p and their rates.
pub(super) struct Momenta {
    pub(super) momentum: Vec<Id>,
    /// ∂L/∂q + Q
    pub(super) rate: Vec<Id>,
}

impl Momenta {
    pub(super) fn of(graph: &mut Graph, problem: &Problem) -> Self {
        let n = problem.coordinates.len();
        let both = [symbols(n, Variable::Coordinate), symbols(n, Variable::Velocity)].concat();
        let mut gradient = graph.gradient(problem.lagrangian, &both);
        let momentum = gradient.split_off(n);
        let forces = generalized_forces(graph, problem);
        let rate = (0..n).map(|i| graph.add(gradient[i], forces[i])).collect();
        Self { momentum, rate }
    }
}

/// E = p·q̇ − L, Milton (8.17). By Euler's theorem a part of L of degree d in the velocities contributes (d − 1) times
/// itself. Summed this way, the energy reads as T + U if it is T + U.
pub(super) fn energy(graph: &mut Graph, problem: &Problem, momentum: &[Id]) -> Id {
    let parts = degree::parts(graph, problem.lagrangian).unwrap_or_default();
    let terms = parts.iter().map(|part| Some((part.term, part.energy()?))).collect::<Option<Vec<_>>>();
    if let Some(terms) = terms.filter(|terms| !terms.is_empty()) {
        return graph.sum(terms);
    }
    let velocities = nodes(graph, momentum.len(), Variable::Velocity);
    let vis_viva = graph.dot(momentum, &velocities);
    graph.sub(vis_viva, problem.lagrangian)
}

/// Generalized forces Q: the given forces, force · ∂velocity/∂q̇ of forces along a velocity, and −∂D/∂q̇ of Rayleigh's
/// dissipation function.
pub(super) fn generalized_forces(graph: &mut Graph, problem: &Problem) -> Vec<Id> {
    let velocities = nodes(graph, problem.coordinates.len(), Variable::Velocity);
    forces_along(graph, problem, &velocities)
}

/// Generalized forces along `velocities`, which begin with the generalized velocities.
pub(super) fn forces_along(graph: &mut Graph, problem: &Problem, velocities: &[Id]) -> Vec<Id> {
    let mut forces = graph.pulled_back(&problem.powers, velocities);
    for (sum, &given) in forces.iter_mut().zip(&problem.forces) {
        *sum = graph.add(given, *sum);
    }
    if let Some((dissipation, _)) = problem.dissipation {
        let friction = graph.gradient_to(dissipation, velocities);
        forces.iter_mut().zip(friction).for_each(|(sum, friction)| *sum = graph.sub(*sum, friction));
    }
    forces
}

/// M_ij = ∂p_i/∂v_j. Only the lower triangle is differentiated.
pub(super) fn hessian(graph: &mut Graph, momenta: &[Id], velocities: &[Id]) -> Vec<Vec<Id>> {
    let n = momenta.len();
    let mut mass = vec![vec![Id::ZERO; n]; n];
    if !has_velocity(graph, momenta) {
        return mass;
    }
    for (j, &momentum) in momenta.iter().enumerate() {
        let rates = velocities.iter().enumerate();
        let rates = rates.map(|(i, &node)| (node, if i == j { Id::ONE } else { Id::ZERO }));
        let mut along = Forward::along([]).through(graph, rates);
        mass[j][j] = along.of(graph, momentum);
        for i in j + 1..n {
            mass[i][j] = along.of(graph, momenta[i]);
            mass[j][i] = mass[i][j];
        }
    }
    mass
}
