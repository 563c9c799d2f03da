//! Gauss's principle of least constraint: the accelerations minimize ½ aᵀMa − hᵀa, subject to F a + γ = 0.
//!
//! If definitions name velocities, as in `vx[i] = vx[i-1] + …`, the rates of these velocities become variables of the
//! form, too. That form is sparse: M of a chain is dense, but its kinetic energy is a sum of squares of link
//! velocities. Eliminating each acceleration as soon as it occurs in no remaining definition then yields the
//! articulated-body algorithm (Featherstone, *Rigid Body Dynamics Algorithms*, chapter 7).

use super::completion;
use super::constraints::Constraints;
use super::form::{Form, LIMIT};
use super::formulation::Formulation;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id};

impl Form {
    /// Returns the form over the accelerations alone. If definitions name velocities and exact arithmetic can write
    /// it, adds the form over their rates as well.
    pub(super) fn all(
        graph: &mut Graph,
        problem: &Problem,
        formulation: &dyn Formulation,
        (mass, forcing): (&[Vec<Id>], &[Id]),
        constraints: &Constraints,
    ) -> Vec<Self> {
        let plain = Self::new(mass.to_vec(), forcing.to_vec(), Vec::new());
        let others = formulation.forms(graph).into_iter().filter(|form| form.matrix.len() <= LIMIT);
        let others: Vec<Self> = others.filter(|_| graph.take_fault().is_none()).collect();
        let mut forms: Vec<Self> = [plain].into_iter().chain(others).collect();
        let completing = completion::completing(graph, problem, mass, constraints);
        for form in &mut forms {
            form.complete(graph, constraints, &completing);
            form.divide_what_is_alone(graph);
        }
        forms
    }

    /// Replaces H by H + FᵀσF and b by b − Fᵀσγ, for the given constraints and their σ. Leaves the form unchanged if
    /// exact arithmetic cannot write the result.
    fn complete(&mut self, graph: &mut Graph, constraints: &Constraints, completing: &[(usize, Id)]) {
        let (mut matrix, mut linear) = (self.matrix.clone(), self.linear.clone());
        for &(a, weight) in completing {
            let row = constraints.jacobian[a].iter().enumerate().filter(|&(_, &entry)| entry != Id::ZERO);
            let row: Vec<(usize, Id)> = row.map(|(i, &entry)| (i, entry)).collect();
            for &(i, entry) in &row {
                let weighted = graph.mul(weight, entry);
                for &(j, other) in &row {
                    let part = graph.mul(weighted, other);
                    let sum = graph.add(matrix[i][j], part);
                    matrix[i][j] = shorter(graph, sum);
                }
                let part = graph.mul(weighted, constraints.bias[a]);
                linear[i] = graph.sub(linear[i], part);
            }
        }
        if graph.take_fault().is_none() {
            (self.matrix, self.linear, self.completing) = (matrix, linear, completing.to_vec());
        }
    }

    /// Divides the entries of `linear` whose variables are coupled to no other one.
    pub(super) fn divide_what_is_alone(&mut self, graph: &mut Graph) {
        let free = self.matrix.len() - self.definitions.len();
        for i in (0..free).filter(|&i| self.is_alone(i)).collect::<Vec<_>>() {
            let quotient = graph.div(self.linear[i], self.matrix[i][i]);
            self.alone[i] = graph.take_fault().is_none().then_some(quotient);
        }
    }

    fn is_alone(&self, i: usize) -> bool {
        let is_defined_by = self.definitions.iter().flatten().any(|&(j, _)| j == i);
        let mut row = self.matrix[i].iter().enumerate();
        !is_defined_by && row.all(|(j, &entry)| (j == i) == (entry != Id::ZERO))
    }
}

/// Inlines definitions if that makes the expression shorter because terms cancel; returns it unchanged otherwise.
pub(super) fn shorter(graph: &mut Graph, entry: Id) -> Id {
    const LONG: usize = 100;
    let length = |graph: &Graph, root| graph.reachable(&[root]).len();
    let before = length(graph, entry);
    if before > LONG {
        return entry;
    }
    let through = graph.looked_through(entry);
    if length(graph, through) < before { through } else { entry }
}
