//! d/dt(∂L/∂q̇) = ∂L/∂q + Q, solved for what multiplies the accelerations.

use super::degree;
use crate::resolve::Problem;
use crate::symbolic::{Forward, Graph, Id};
use crate::variables::{Variable, drift, nodes, symbols, total_time_derivative};

/// M q̈ = h without constraints.
pub(super) struct Motion {
    pub(super) momentum: Vec<Id>,
    pub(super) mass: Vec<Vec<Id>>,
    pub(super) momentum_rate: Vec<Id>,
    pub(super) forcing: Vec<Id>,
    pub(super) energy: Id,
}

impl Motion {
    /// dp/dt − ∂L/∂q − Q − Fᵀλ, with accelerations and multipliers as symbols: not by the entries of M, so that it costs
    /// as much as the Lagrangian.
    pub(super) fn balance(&self, graph: &mut Graph, constraint_force: &[Id]) -> Vec<Id> {
        let mut along_motion = total_time_derivative(graph, self.momentum.len());
        let row = |(i, &momentum): (usize, &Id)| {
            let inertia = along_motion.of(graph, momentum);
            let free = graph.sub(inertia, self.momentum_rate[i]);
            constraint_force.get(i).map_or(free, |&force| graph.sub(free, force))
        };
        self.momentum.iter().enumerate().map(row).collect()
    }
}

pub(super) fn derive(graph: &mut Graph, problem: &Problem) -> Motion {
    let n = problem.coordinates.len();
    let both = [symbols(n, Variable::Coordinate), symbols(n, Variable::Velocity)].concat();
    let mut gradient = graph.gradient(problem.lagrangian, &both);
    let momentum = gradient.split_off(n);
    let forces = generalized_forces(graph, problem);
    let mass = mass_matrix(graph, &momentum);
    let mut drift = drift(graph, n);
    let momentum_rate: Vec<Id> = (0..n).map(|i| graph.add(gradient[i], forces[i])).collect();
    let forcing = (0..n).map(|i| {
        let rate = drift.of(graph, momentum[i]);
        graph.sub(momentum_rate[i], rate)
    });
    let forcing = forcing.collect();
    let energy = energy(graph, problem, &momentum);
    Motion { momentum, mass, momentum_rate, forcing, energy }
}

/// E = p·q̇ − L, Milton (8.17). A part of L of degree d in the velocities adds (d − 1) times itself (Euler's
/// theorem): so the energy reads as T + U where it is that.
fn energy(graph: &mut Graph, problem: &Problem, momentum: &[Id]) -> Id {
    let parts = degree::parts(graph, problem.lagrangian).unwrap_or_default();
    let terms = parts.iter().map(|part| Some((part.term, part.energy()?))).collect::<Option<Vec<_>>>();
    if let Some(terms) = terms.filter(|terms| !terms.is_empty()) {
        return graph.sum(terms);
    }
    let velocities = nodes(graph, momentum.len(), Variable::Velocity);
    let vis_viva = graph.dot(momentum, &velocities);
    graph.sub(vis_viva, problem.lagrangian)
}

/// Q: the forces given, and −∂D/∂q̇ of Rayleigh's dissipation function.
pub(super) fn generalized_forces(graph: &mut Graph, problem: &Problem) -> Vec<Id> {
    let n = problem.coordinates.len();
    let Some((dissipation, _)) = problem.dissipation else { return problem.forces.clone() };
    let friction = graph.gradient(dissipation, &symbols(n, Variable::Velocity));
    (0..n).map(|i| graph.sub(problem.forces[i], friction[i])).collect()
}

/// M_ij = ∂p_i/∂q̇_j, of which the lower triangle is differentiated.
fn mass_matrix(graph: &mut Graph, momentum: &[Id]) -> Vec<Vec<Id>> {
    let n = momentum.len();
    let mut mass = vec![vec![Id::ZERO; n]; n];
    for (j, p) in momentum.iter().enumerate() {
        let mut along = Forward::along([(Variable::Velocity(j).symbol(), Id::ONE)]);
        mass[j][j] = along.of(graph, *p);
        for i in j + 1..n {
            mass[i][j] = along.of(graph, momentum[i]);
            mass[j][i] = mass[i][j];
        }
    }
    mass
}
