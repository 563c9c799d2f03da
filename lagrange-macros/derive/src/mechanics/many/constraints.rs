//! Constraints of elements: residuals, their rates of change, and the rows F.

use super::patterns::{self, Pattern};
use super::{Scatter, gradient, slots};
use crate::diagnostics::Diagnostics;
use crate::resolve::Problem;
use crate::resolve::many::{OpenConstraint, Range};
use crate::symbolic::{Graph, Id};
use crate::variables::{Variable, drift, has_velocity};

/// Constraints of the elements of some loops, one for each component.
pub(crate) struct ManyConstraint {
    pub(crate) ranges: Vec<Range>,
    pub(crate) rows: Vec<ConstraintRow>,
}

/// F q̇ + b = 0 of one component.
pub(crate) struct ConstraintRow {
    /// Slot of the multiplier.
    pub(crate) multiplier: usize,
    /// Φ of a holonomic constraint.
    pub(crate) residual: Option<Id>,
    /// F q̇ + b
    pub(crate) rate: Id,
    /// Rate of change of F q̇ + b at q̈ = 0.
    pub(crate) bias: Id,
    /// Row of F: in loops within those of the constraint, slots and the coefficients of their velocities.
    pub(crate) slopes: Vec<Scatter>,
    /// True if F q̇ + b is linear in the velocities without a constant part, so that the constraint does no work.
    pub(crate) is_homogeneous: bool,
}

/// Derives the constraints. Reports those that are malformed, and then returns `None`.
pub(super) fn derive(
    graph: &mut Graph,
    problem: &mut Problem,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<ManyConstraint>> {
    let stated = std::mem::take(&mut problem.many.constraints);
    let all = stated.iter().map(|constraint| {
        let rows = constraint.rows.iter().map(|&(multiplier, residual)| {
            let row = row(graph, problem, &constraint.ranges, (multiplier, residual));
            let fault = malformed(graph, problem, residual, &row);
            fault.into_iter().for_each(|message| diagnostics.error(constraint.place, message));
            diagnostics.stop_at_fault(constraint.place, graph);
            row
        });
        ManyConstraint { rows: rows.collect(), ranges: constraint.ranges.clone() }
    });
    let all: Vec<ManyConstraint> = all.collect();
    problem.many.constraints = stated;
    diagnostics.is_empty().then_some(all)
}

fn row(
    graph: &mut Graph,
    problem: &mut Problem,
    ranges: &[Range],
    (multiplier, stated): (usize, Id),
) -> ConstraintRow {
    let all = problem.many.with_bodies(graph, &[stated]);
    let (residual, rate) = match has_velocity(graph, &all) {
        true => (None, stated),
        false => (Some(stated), rate_of(graph, problem, stated)),
    };
    let bias = rate_of(graph, problem, rate);
    let parts = patterns::within(graph, problem, ranges, rate);
    let is_homogeneous = parts.iter().all(|part| at_rest(graph, part.body) == Id::ZERO);
    let slopes =
        parts.iter().map(|part| slopes(graph, part)).filter(|part| !part.values.is_empty()).collect();
    ConstraintRow { multiplier, residual, rate, bias, slopes, is_homogeneous }
}

/// Rate of change of an expression at q̈ = 0.
pub(super) fn rate_of(graph: &mut Graph, problem: &mut Problem, root: Id) -> Id {
    let mut drift = drift(graph, problem.many.slots.len());
    problem.many.follow_totals(graph, &mut drift, &[root]);
    drift.of(graph, root)
}

/// The constraints that state recursions, to be printed.
pub(super) fn of_recursions(graph: &mut Graph, problem: &mut Problem) -> Vec<ManyConstraint> {
    let stated = std::mem::take(&mut problem.many.stated_recursions);
    let mut derived = |OpenConstraint { ranges, rows, .. }: &OpenConstraint| {
        let rows = rows.iter().map(|&stated| row(graph, problem, ranges, stated)).collect();
        ManyConstraint { ranges: ranges.clone(), rows }
    };
    let all = stated.iter().flatten().map(&mut derived).collect();
    problem.many.stated_recursions = stated;
    all
}

/// Coefficients of the velocities in a part of F q̇ + b.
fn slopes(graph: &mut Graph, Pattern { ranges, factor, body }: &Pattern) -> Scatter {
    let slots = slots(graph, *body);
    let slopes = gradient(graph, *body, &slots, Variable::Velocity);
    let values = slots.into_iter().zip(slopes).filter(|(_, slope)| *slope != Id::ZERO);
    let values = values.map(|(slot, slope)| (slot, graph.mul(*factor, slope))).collect();
    Scatter { ranges: ranges.clone(), values }
}

/// An expression with all velocities zero.
fn at_rest(graph: &mut Graph, root: Id) -> Id {
    let is_velocity = |symbol| matches!(Variable::of(symbol), Variable::Velocity(_));
    graph.substituted(root, |symbol| is_velocity(symbol).then_some(Id::ZERO))
}

fn malformed(graph: &mut Graph, problem: &Problem, stated: Id, row: &ConstraintRow) -> Option<String> {
    if row.slopes.is_empty() {
        let message = match stated {
            Id::ZERO => "both sides of this constraint are the same, whatever the motion: leave it out",
            _ => "this constraint depends on no coordinate and no velocity: nothing can be done to meet it",
        };
        return Some(message.to_owned());
    }
    let coefficients = row.slopes.iter().flat_map(|part| &part.values).map(|(_, slope)| *slope);
    let all = problem.many.with_bodies(graph, &coefficients.collect::<Vec<_>>());
    has_velocity(graph, &all).then(|| {
        "this constraint is not linear in the velocities: d'Alembert's principle covers F(q,t) q̇ + b(q,t) = 0 only"
            .to_owned()
    })
}

impl ManyConstraint {
    /// Forces λ F on the coordinates.
    pub(super) fn forces(&self, graph: &mut Graph) -> Vec<Scatter> {
        let mut forces = Vec::new();
        for row in &self.rows {
            let multiplier = graph.symbol(Variable::Multiplier(row.multiplier).symbol());
            for Scatter { ranges, values } in &row.slopes {
                let values = values.iter().map(|&(slot, slope)| (slot, graph.mul(multiplier, slope)));
                forces.push(Scatter { ranges: ranges.clone(), values: values.collect() });
            }
        }
        forces
    }
}
