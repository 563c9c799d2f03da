//! The constraints and their derivatives: F, γ and the kind of each.

use super::evidence::vanishes;
use crate::diagnostics::Diagnostics;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id, Rational};
use crate::variables::{Variable, drift, symbols};

/// How a constraint acts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum ConstraintKind {
    /// Φ(q, t) = 0
    Holonomic,
    /// F(q, t) q̇ + b(q, t) = 0
    Velocity,
}

pub(super) struct Constraints {
    pub(super) kinds: Vec<ConstraintKind>,
    pub(super) residual: Vec<Id>,
    pub(super) rate: Vec<Id>,
    pub(super) jacobian: Vec<Vec<Id>>,
    pub(super) bias: Vec<Id>,
}

impl Constraints {
    /// Σ_α λ_α F_αa for each coordinate a.
    pub(super) fn force(&self, graph: &mut Graph) -> Vec<Id> {
        let lambda: Vec<Id> =
            (0..self.kinds.len()).map(|a| graph.symbol(Variable::Multiplier(a).symbol())).collect();
        let coordinates = self.jacobian.first().map_or(0, Vec::len);
        let one = Rational::from_integer(1);
        let force = |i: usize| {
            let terms: Vec<_> = self
                .jacobian
                .iter()
                .zip(&lambda)
                .map(|(row, &lambda)| (graph.mul(lambda, row[i]), one))
                .collect();
            graph.sum(terms)
        };
        (0..coordinates).map(force).collect()
    }
}

/// Differentiates the constraints; `None` where one of them is none, which is then reported.
pub(super) fn derive(
    graph: &mut Graph,
    problem: &Problem,
    diagnostics: &mut Diagnostics,
) -> Option<Constraints> {
    let mut constraints = Constraints {
        kinds: Vec::new(),
        residual: Vec::new(),
        rate: Vec::new(),
        jacobian: Vec::new(),
        bias: Vec::new(),
    };
    for index in 0..problem.constraints.len() {
        push_row(graph, problem, index, &mut constraints, diagnostics);
        diagnostics.stop_at_fault(problem.constraints[index].0.place, graph);
    }
    diagnostics.is_empty().then_some(constraints)
}

fn push_row(
    graph: &mut Graph,
    problem: &Problem,
    index: usize,
    constraints: &mut Constraints,
    diagnostics: &mut Diagnostics,
) {
    let n = problem.coordinates.len();
    let expression = problem.constraints[index].1;
    let kind = kind(graph, expression);
    let mut drift = drift(graph, n);
    let (residual, rate, variable): (_, _, fn(usize) -> Variable) = match kind {
        ConstraintKind::Holonomic => (expression, drift.of(graph, expression), Variable::Coordinate),
        ConstraintKind::Velocity => (Id::ZERO, expression, Variable::Velocity),
    };
    let jacobian = graph.gradient(expression, &symbols(n, variable));
    reject_malformed(graph, problem, index, kind, &jacobian, diagnostics);
    constraints.kinds.push(kind);
    constraints.residual.push(residual);
    constraints.rate.push(rate);
    constraints.bias.push(drift.of(graph, rate));
    constraints.jacobian.push(jacobian);
}

fn kind(graph: &Graph, expression: Id) -> ConstraintKind {
    let has_velocity =
        graph.symbols(&[expression]).any(|symbol| matches!(Variable::of(symbol), Variable::Velocity(_)));
    if has_velocity { ConstraintKind::Velocity } else { ConstraintKind::Holonomic }
}

fn reject_malformed(
    graph: &mut Graph,
    problem: &Problem,
    index: usize,
    kind: ConstraintKind,
    jacobian: &[Id],
    diagnostics: &mut Diagnostics,
) {
    let place = problem.constraints[index].0.place;
    if jacobian.iter().all(|&entry| vanishes(graph, problem, entry).is_some()) {
        let message = match problem.constraints[index].1 {
            Id::ZERO => "both sides of this constraint are the same",
            _ => "this constraint depends on no coordinate and no velocity: nothing can be done to meet it",
        };
        return diagnostics.error(place, message);
    }
    if kind == ConstraintKind::Velocity {
        reject_nonlinear(graph, problem, index, jacobian, diagnostics);
    }
}

/// A velocity constraint is F q̇ + b: its Jacobian holds no velocity.
fn reject_nonlinear(
    graph: &mut Graph,
    problem: &Problem,
    index: usize,
    jacobian: &[Id],
    diagnostics: &mut Diagnostics,
) {
    let n = problem.coordinates.len();
    for &entry in jacobian {
        let slopes = graph.gradient(entry, &symbols(n, Variable::Velocity));
        let nonlinear = slopes.into_iter().position(|slope| vanishes(graph, problem, slope).is_none());
        if let Some(velocity) = nonlinear {
            let name = &problem.coordinates[velocity].text;
            let message = format!(
                "this constraint is not linear in the velocity of `{name}`: d'Alembert's principle covers F(q,t) q̇ + b(q,t) = 0 only"
            );
            return diagnostics.error(problem.constraints[index].0.place, message);
        }
    }
}
