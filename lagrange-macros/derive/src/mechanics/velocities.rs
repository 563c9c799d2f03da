//! Velocities named by definitions, as variables besides the generalized velocities.

use super::euler_lagrange::generalized_forces;
use super::form::{Form, LIMIT};
use crate::resolve::Problem;
use crate::symbolic::{Forward, Graph, Id, Node, Rational};
use crate::variables::{Variable, drift, nodes};

/// Generalized velocities q̇ and velocities w named by definitions. Their rates are the variables of a [`Form`].
pub(super) struct Velocities {
    /// q̇, then the named velocities.
    pub(super) nodes: Vec<Id>,
    /// For each named velocity, its partial derivatives by the earlier entries of `nodes`.
    pub(super) rows: Vec<Vec<Id>>,
}

impl Velocities {
    /// Collects the definitions in L that are linear in the velocities. Collects none if more than [`LIMIT`] variables
    /// would result.
    pub(super) fn named(graph: &mut Graph, problem: &Problem) -> Self {
        let n = problem.coordinates.len();
        let mut named = Self { nodes: nodes(graph, n, Variable::Velocity), rows: Vec::new() };
        let mut moving = Moving::default();
        moving.extend(graph);
        let mut candidates: Vec<(Id, Id)> = Vec::new();
        for id in graph.reachable(&[problem.lagrangian]) {
            match *graph.node(id) {
                Node::Defined(inner) if moving.contains(id) => candidates.push((id, inner)),
                _ => {}
            }
        }
        if n + candidates.len() > LIMIT {
            return named;
        }
        for (id, inner) in candidates {
            let row = graph.gradient_to(inner, &named.nodes);
            moving.extend(graph);
            if row.iter().all(|&entry| !moving.contains(entry)) {
                named.nodes.push(id);
                named.rows.push(row);
            }
        }
        named
    }

    /// Form over the rates of q̇ and of the named velocities w. Let L = ℓ(q, q̇, w) with w = f(q, q̇, w),
    /// each in terms of earlier ones. The adjoints of w are μ = ∂ℓ/∂w + Σ μ ∂f/∂w. Then p = ∂ℓ/∂q̇ + Σ μ
    /// ∂f/∂q̇. Each term of d/dt p = ∂L/∂q + Q is assigned to the variable x whose coefficient it is.
    pub(super) fn form(&self, graph: &mut Graph, problem: &Problem) -> Form {
        let local = graph.gradient_to(problem.lagrangian, &self.nodes);
        let linear = self.linear(graph, problem, &local);
        self.form_of(graph, &local, linear)
    }

    /// Returns the quadratic form ½ xᵀHx − bᵀx with b = `linear`. H is the derivative by (q̇, w), with w the
    /// named velocities, of the momenta `local` conjugate to these.
    pub(super) fn form_of(&self, graph: &mut Graph, local: &[Id], linear: Vec<Id>) -> Form {
        let matrix = self.hessian(graph, local);
        Form::over(matrix, linear, &self.rows)
    }

    /// ∂²ℓ/∂(q̇, w)²
    fn hessian(&self, graph: &mut Graph, local: &[Id]) -> Vec<Vec<Id>> {
        let row = |j: usize| {
            let rates = self.nodes.iter().enumerate();
            let rates = rates.map(|(i, &node)| (node, if i == j { Id::ONE } else { Id::ZERO }));
            let mut along = Forward::along([]).through(graph, rates);
            local.iter().map(|&part| along.of(graph, part)).collect()
        };
        (0..local.len()).map(row).collect()
    }

    fn linear(&self, graph: &mut Graph, problem: &Problem, local: &[Id]) -> Vec<Id> {
        let n = problem.coordinates.len();
        let one = Rational::from_integer(1);
        let adjoints = self.adjoints(graph, local);
        let mut along = drift(graph, n);
        let mut linear = Vec::with_capacity(local.len());
        for (j, &part) in local.iter().enumerate() {
            let mut terms = vec![(along.of(graph, part), -one)];
            for (row, &adjoint) in self.rows.iter().zip(&adjoints) {
                let Some(&entry) = row.get(j).filter(|&&entry| entry != Id::ZERO) else { continue };
                let turn = along.of(graph, entry);
                terms.push((graph.mul(adjoint, turn), -one));
            }
            linear.push(terms);
        }
        for (terms, force) in linear.iter_mut().zip(self.forces(graph, problem, &adjoints)) {
            terms.extend(force.into_iter().map(|force| (force, one)));
        }
        linear.into_iter().map(|terms| graph.sum(terms)).collect()
    }

    /// Adjoints μ of the named velocities, from the last to the first: each adds its share to the velocities
    /// in its definition.
    fn adjoints(&self, graph: &mut Graph, local: &[Id]) -> Vec<Id> {
        let n = local.len() - self.rows.len();
        let one = Rational::from_integer(1);
        let mut adjoints: Vec<Id> = vec![Id::ZERO; self.rows.len()];
        for k in (0..self.rows.len()).rev() {
            let mut terms = vec![(local[n + k], one)];
            let users = self.rows.iter().zip(&adjoints).skip(k + 1);
            for (row, &later) in users.filter(|(row, _)| row[n + k] != Id::ZERO) {
                terms.push((graph.mul(later, row[n + k]), one));
            }
            let adjoint = graph.sum(terms);
            adjoints[k] = graph.defined(adjoint);
        }
        adjoints
    }

    /// Terms of ∂L/∂q + Q for each coordinate: ∂L/∂q at fixed named velocities, the changes of named
    /// velocities times their adjoints, and Q.
    fn forces(&self, graph: &mut Graph, problem: &Problem, adjoints: &[Id]) -> Vec<Vec<Id>> {
        let n = problem.coordinates.len();
        let q = nodes(graph, n, Variable::Coordinate);
        let held: Vec<Id> = q.iter().chain(&self.nodes).copied().collect();
        let slopes = graph.gradient_to(problem.lagrangian, &held);
        let mut forces: Vec<Vec<Id>> = slopes[..n].iter().map(|&slope| vec![slope]).collect();
        for (k, &adjoint) in adjoints.iter().enumerate() {
            let Node::Defined(inner) = *graph.node(self.nodes[n + k]) else { continue };
            let held: Vec<Id> = q.iter().chain(&self.nodes[..n + k]).copied().collect();
            let slopes = graph.gradient_to(inner, &held);
            for (force, slope) in forces.iter_mut().zip(slopes).filter(|(_, slope)| *slope != Id::ZERO) {
                force.push(graph.mul(adjoint, slope));
            }
        }
        for (force, given) in forces.iter_mut().zip(generalized_forces(graph, problem)) {
            force.push(given);
        }
        forces
    }
}

/// For each node of the graph, by index: true if it contains a velocity.
#[derive(Default)]
struct Moving(Vec<bool>);

impl Moving {
    fn contains(&self, id: Id) -> bool {
        self.0[id.index()]
    }

    fn extend(&mut self, graph: &Graph) {
        for id in graph.ids().skip(self.0.len()) {
            let mut any = match graph.node(id) {
                Node::Symbol(symbol) => matches!(Variable::of(*symbol), Variable::Velocity(_)),
                _ => false,
            };
            graph.operands(id, |operand| any |= self.contains(operand));
            self.0.push(any);
        }
    }
}
