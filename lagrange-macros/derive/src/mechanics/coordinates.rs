//! Lagrange's equations in plain coordinates: L is differentiated as written.

use super::euler_lagrange::{Momenta, hessian};
use super::form::Form;
use super::formulation::Formulation;
use super::velocities::Velocities;
use crate::resolve::Problem;
use crate::symbolic::{Forward, Graph, Id};
use crate::variables::{Variable, drift, has_velocity, nodes, symbols, total_time_derivative};

pub(super) struct Coordinates<'p> {
    pub(super) problem: &'p Problem,
    pub(super) momenta: &'p Momenta,
}

impl Formulation for Coordinates<'_> {
    fn mass_and_forcing(&self, graph: &mut Graph) -> (Vec<Vec<Id>>, Vec<Id>) {
        let momentum = &self.momenta.momentum;
        let velocities = nodes(graph, momentum.len(), Variable::Velocity);
        let mass = hessian(graph, momentum, &velocities);
        let mut drift = self.drift(graph);
        let row = |(&momentum, &force): (&Id, &Id)| {
            let rate = drift.of(graph, momentum);
            let forcing = graph.sub(force, rate);
            graph.combined(forcing)
        };
        (mass, momentum.iter().zip(&self.momenta.rate).map(row).collect())
    }

    fn balance(&self, graph: &mut Graph) -> Vec<Id> {
        let Momenta { momentum, rate } = self.momenta;
        let mut along_motion = total_time_derivative(graph, momentum.len());
        let row = |(&momentum, &force): (&Id, &Id)| {
            let inertia = along_motion.of(graph, momentum);
            let balance = graph.sub(inertia, force);
            graph.combined(balance)
        };
        momentum.iter().zip(rate).map(row).collect()
    }

    fn drift(&self, graph: &mut Graph) -> Forward {
        drift(graph, self.problem.coordinates.len())
    }

    fn jacobian_row(&self, graph: &mut Graph, constraint: Id) -> Vec<Id> {
        let variable =
            if has_velocity(graph, &[constraint]) { Variable::Velocity } else { Variable::Coordinate };
        graph.gradient(constraint, &symbols(self.problem.coordinates.len(), variable))
    }

    fn forms(&self, graph: &mut Graph) -> Vec<Form> {
        let velocities = Velocities::named(graph, self.problem);
        Vec::from_iter((!velocities.rows.is_empty()).then(|| velocities.form(graph, self.problem)))
    }
}
