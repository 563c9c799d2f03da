//! d/dt(∂L/∂q̇) = ∂L/∂q + Q, solved for what multiplies the accelerations.

use super::degree;
use super::twists::Twists;
use crate::resolve::Problem;
use crate::symbolic::{Forward, Graph, Id};
use crate::variables::{Variable, drift, has_velocity, nodes, symbols, total_time_derivative};

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
    pub(super) fn balance(
        &self,
        graph: &mut Graph,
        twists: Option<&Twists>,
        constraint_force: &[Id],
    ) -> Vec<Id> {
        let mut balance = match twists {
            Some(twists) => twists.left_over(graph).into_iter().map(|left| graph.neg(left)).collect(),
            None => self.without_constraints(graph),
        };
        for (sum, &force) in balance.iter_mut().zip(constraint_force) {
            *sum = graph.sub(*sum, force);
        }
        balance
    }

    /// dp/dt − ∂L/∂q − Q
    fn without_constraints(&self, graph: &mut Graph) -> Vec<Id> {
        let mut along_motion = total_time_derivative(graph, self.momentum.len());
        let row = |(&momentum, &rate): (&Id, &Id)| {
            let inertia = along_motion.of(graph, momentum);
            let balance = graph.sub(inertia, rate);
            graph.combined(balance)
        };
        self.momentum.iter().zip(&self.momentum_rate).map(row).collect()
    }
}

pub(super) fn derive(graph: &mut Graph, problem: &Problem, twists: Option<&Twists>) -> Motion {
    let n = problem.coordinates.len();
    let both = [symbols(n, Variable::Coordinate), symbols(n, Variable::Velocity)].concat();
    let mut gradient = graph.gradient(problem.lagrangian, &both);
    let momentum = gradient.split_off(n);
    let forces = generalized_forces(graph, problem);
    let momentum_rate: Vec<Id> = (0..n).map(|i| graph.add(gradient[i], forces[i])).collect();
    let (mass, forcing) = match twists {
        Some(twists) => twists.mass_and_forcing(graph),
        None => {
            let velocities = nodes(graph, n, Variable::Velocity);
            (hessian(graph, &momentum, &velocities), forcing(graph, &momentum, &momentum_rate))
        }
    };
    let energy = energy(graph, problem, &momentum);
    Motion { momentum, mass, momentum_rate, forcing, energy }
}

/// h = ∂L/∂q + Q − (dp/dt where q̈ = 0)
fn forcing(graph: &mut Graph, momentum: &[Id], momentum_rate: &[Id]) -> Vec<Id> {
    let mut drift = drift(graph, momentum.len());
    let row = |(&momentum, &momentum_rate): (&Id, &Id)| {
        let rate = drift.of(graph, momentum);
        let forcing = graph.sub(momentum_rate, rate);
        graph.combined(forcing)
    };
    momentum.iter().zip(momentum_rate).map(row).collect()
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

/// Q: the forces given, force · ∂velocity/∂q̇ of those that act along a velocity, and −∂D/∂q̇ of Rayleigh's dissipation
/// function.
pub(super) fn generalized_forces(graph: &mut Graph, problem: &Problem) -> Vec<Id> {
    let velocities = nodes(graph, problem.coordinates.len(), Variable::Velocity);
    forces_along(graph, problem, &velocities)
}

/// The same for these velocities, of which the generalized ones are the first.
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

/// M_ij = ∂p_i/∂v_j, of which the lower triangle is differentiated.
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
