//! Lagrange's equations of a Lagrangian stated in frames, without differentiating the transformations of frames.
//!
//! Velocities propagate from frame to frame, and forces propagate back: the recursive Newton–Euler algorithm
//! (Featherstone, *Rigid Body Dynamics Algorithms*, chapter 5). The forces of rigid bodies are known in closed form;
//! those of all other terms in L follow from Poincaré's equations.

mod accelerations;
mod bodies;
mod chain_rule;
mod components;
mod composite;
mod parts;
mod places;
mod poincare;
mod resultants;
mod tree;
mod turning;

use super::euler_lagrange::forces_along;
use super::form::Form;
use super::formulation::Formulation;
use crate::symbolic::{Forward, Graph, Id};
use crate::variables::{drift, has_velocity, total_time_derivative};
use accelerations::InTime;
pub(crate) use chain_rule::{ChainArgument, ChainRule};
pub(super) use components::Twists;
use parts::TwistParts;
pub(crate) use resultants::{Dependence, Link, Resultants, RigidBody};
#[cfg(test)]
pub(crate) use tree::TreeColumn;
pub(crate) use tree::{BodyTree, TreeBody, TreeJoint};
pub(crate) use turning::{Euler, Turning, Turnings};

impl Formulation for Twists<'_> {
    fn mass_and_forcing(&self, graph: &mut Graph) -> (Vec<Vec<Id>>, Vec<Id>) {
        let n = self.problem.coordinates.len();
        let mut mass = self.mass(graph);
        for k in (n..self.outer).rev() {
            self.put_in(graph, &mut mass, &self.velocities.rows[k - n]);
        }
        (mass, self.handed_back(graph, drift, n))
    }

    fn balance(&self, graph: &mut Graph) -> Vec<Id> {
        let left_over = self.handed_back(graph, total_time_derivative, self.problem.coordinates.len());
        left_over.into_iter().map(|left| graph.neg(left)).collect()
    }

    fn drift(&self, graph: &mut Graph) -> Forward {
        self.rates(graph, drift)
    }

    fn jacobian_row(&self, graph: &mut Graph, constraint: Id) -> Vec<Id> {
        self.row(graph, constraint, self.problem.coordinates.len())
    }

    /// Returns the form over the rates of all velocities. If some [outer velocities](Twists::outer) are not
    /// generalized velocities, a form over the rates of the outer velocities precedes it.
    fn forms(&self, graph: &mut Graph) -> Vec<Form> {
        let n = self.problem.coordinates.len();
        let mut forms = Vec::new();
        if self.outer > n {
            let (mass, forcing) = (self.mass(graph), self.handed_back(graph, drift, self.outer));
            let form = Form::over(mass, forcing, &self.velocities.rows[..self.outer - n]);
            forms.push(form.with(self.rows(graph, self.outer)));
        }
        let momenta = graph.gradient_to(self.problem.lagrangian, &self.velocities.nodes);
        let parts = self.parts(graph, drift);
        let linear = parts.sums(graph);
        let form = self.velocities.form_of(graph, &momenta, linear);
        forms.push(form.with(self.rows(graph, self.velocities.nodes.len())));
        forms
    }
}

impl Twists<'_> {
    /// Eliminates the last variable of a form, which is the sum g over the variables before it: the matrix becomes
    /// H_ij + g_i H_kj + H_ik g_j + g_i H_kk g_j.
    fn put_in(&self, graph: &mut Graph, matrix: &mut Vec<Vec<Id>>, row: &[Id]) {
        let last = matrix.pop().unwrap_or_default();
        let Some((&own, beside)) = last.split_last() else { return };
        for i in 0..matrix.len() {
            matrix[i].pop();
            for j in 0..=i {
                let both = graph.mul(row[j], own);
                let both = graph.add(both, beside[j]);
                let (forth, back) = (graph.mul(row[i], both), graph.mul(beside[i], row[j]));
                let sum = graph.total([matrix[i][j], forth, back]);
                (matrix[i][j], matrix[j][i]) = (sum, sum);
            }
        }
    }

    fn rows(&self, graph: &mut Graph, first: usize) -> Vec<Vec<Id>> {
        self.problem.constraints.iter().map(|&(_, constraint)| self.row(graph, constraint, first)).collect()
    }

    /// Generalized forces, inertial ones included, conjugate to each velocity.
    fn parts(&self, graph: &mut Graph, in_time: InTime) -> TwistParts {
        let mut parts = self.nothing();
        let places = self.places(graph);
        let gravity = self.others_of(graph, in_time, &places, &mut parts, None);
        self.of_bodies(graph, in_time, gravity, &mut parts);
        self.given_forces(graph, &mut parts);
        parts
    }

    /// Adds the generalized forces that do not follow from L.
    fn given_forces(&self, graph: &mut Graph, parts: &mut TwistParts) {
        for (i, force) in forces_along(graph, self.problem, &self.velocities.nodes).into_iter().enumerate() {
            parts.add(i, force, 1);
        }
    }

    /// Generalized forces conjugate to the first `first` velocities. The other velocities depend on these, so
    /// the forces conjugate to them contribute.
    fn handed_back(&self, graph: &mut Graph, in_time: InTime, first: usize) -> Vec<Id> {
        let parts = self.parts(graph, in_time);
        self.hand_back(graph, parts, first)
    }

    /// Propagates the generalized forces conjugate to all velocities back to the first `first` velocities,
    /// and sums them.
    fn hand_back(&self, graph: &mut Graph, mut parts: TwistParts, first: usize) -> Vec<Id> {
        let n = self.problem.coordinates.len();
        for k in (first - n..self.velocities.rows.len()).rev() {
            let sum = graph.sum(std::mem::take(&mut parts.0[n + k]));
            let sum = graph.defined(sum);
            for (i, &entry) in self.velocities.rows[k].iter().enumerate() {
                let part = graph.mul(entry, sum);
                parts.add(i, part, 1);
            }
        }
        parts.0.truncate(first);
        parts.sums(graph)
    }

    /// Row of F of a constraint, with one column for each of the first `first` velocities.
    fn row(&self, graph: &mut Graph, constraint: Id, first: usize) -> Vec<Id> {
        let mut parts = self.nothing();
        if has_velocity(graph, &[constraint]) {
            let slopes = graph.gradient_to(constraint, &self.velocities.nodes);
            slopes.into_iter().enumerate().for_each(|(number, slope)| parts.add(number, slope, 1));
        } else {
            let places = self.places(graph);
            let (_, slopes) = self.slopes(graph, constraint, &places);
            self.at_rest(graph, &places, &slopes, &mut parts);
        }
        self.hand_back(graph, parts, first)
    }
}
