//! The constraints and their derivatives: the Jacobian F, the bias γ and the kind of each constraint.

use std::collections::BTreeSet;

use ConstraintKind::{Holonomic, Velocity};

use super::contacts;
use super::evidence::vanishes;
use super::formulation::Formulation;
use crate::diagnostics::Diagnostics;
use crate::resolve::{Label, Problem};
use crate::symbolic::{Function, Graph, Id};
use crate::variables::{Variable, has_velocity, nodes, symbols};

/// Form of a constraint as written.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ConstraintKind {
    /// Holonomic: Φ(q, t) = 0.
    Holonomic,
    /// Velocity constraint: F(q, t) q̇ + b(q, t) = 0.
    Velocity,
}

#[derive(Default)]
pub(super) struct Constraints {
    pub(super) kinds: Vec<ConstraintKind>,
    pub(super) residual: Vec<Id>,
    pub(super) rate: Vec<Id>,
    pub(super) jacobian: Vec<Vec<Id>>,
    pub(super) bias: Vec<Id>,
    /// Diagonal of c in F q̈ + γ + c λ = 0: zero, but 1 while a switched constraint does not hold, so that its λ is zero, or
    /// that of sliding friction.
    pub(super) compliance: Vec<Id>,
    /// Entries of c beside its diagonal, each with its row and column: friction that slides is a multiple of λ of its contact.
    pub(super) coupling: Vec<(usize, usize, Id)>,
    /// −λ of friction that slides, with multipliers as symbols; zero for other constraints.
    pub(super) sliding: Vec<Id>,
}

impl Constraints {
    /// True if the constraint holds whatever the fields are.
    pub(super) fn always_holds(&self, a: usize) -> bool {
        self.compliance[a] == Id::ZERO
    }

    /// Adds a constraint with its derivatives. Returns the error message if the constraint is malformed.
    fn push(
        &mut self,
        graph: &mut Graph,
        problem: &Problem,
        formulation: &dyn Formulation,
        expression: Id,
    ) -> Option<String> {
        let mut drift = formulation.drift(graph);
        let (kind, residual, rate) = match has_velocity(graph, &[expression]) {
            false => (Holonomic, expression, drift.of(graph, expression)),
            true => (Velocity, Id::ZERO, expression),
        };
        let jacobian = formulation.jacobian_row(graph, expression);
        let switch = problem.switches.get(self.kinds.len()).copied().flatten();
        self.compliance.push(switch.map_or(Id::ZERO, |switch| graph.sub(Id::ONE, switch)));
        let wrong = malformed(graph, problem, self.kinds.len(), kind, &jacobian);
        self.kinds.push(kind);
        self.residual.push(residual);
        self.rate.push(rate);
        self.bias.push(drift.of(graph, rate));
        self.jacobian.push(jacobian);
        wrong
    }

    /// Adds the law of friction that slides.
    fn slide(&mut self, graph: &mut Graph, problem: &Problem) {
        self.sliding = vec![Id::ZERO; self.kinds.len()];
        for friction in &problem.frictions {
            for (row, &force) in (friction.row..).zip(&friction.sliding) {
                self.sliding[row] = graph.neg(force);
                let Multiples { rest, of } = Multiples::of(graph, self.sliding[row]);
                self.bias[row] = graph.add(self.bias[row], rest);
                self.coupling.extend(of.into_iter().map(|(column, entry)| (row, column, entry)));
            }
        }
    }

    /// Σ_α λ_α F_αa for each coordinate a.
    pub(super) fn force(&self, graph: &mut Graph) -> Vec<Id> {
        let multipliers = nodes(graph, self.kinds.len(), Variable::Multiplier);
        let coordinates = self.jacobian.first().map_or(0, Vec::len);
        let column = |i: usize| self.jacobian.iter().map(|row| row[i]).collect::<Vec<Id>>();
        (0..coordinates).map(|i| graph.dot(&multipliers, &column(i))).collect()
    }

    /// Σ_i |F_αi x_i| for each constraint α of the kinds that `counts` accepts, zero for the other kinds. With x the
    /// coordinates or the velocities, it is the scale of the terms that cancel in Φ or F q̇ + b.
    pub(super) fn magnitude(
        &self,
        graph: &mut Graph,
        x: fn(usize) -> Variable,
        counts: impl Fn(ConstraintKind) -> bool,
    ) -> Vec<Id> {
        let rows = self.jacobian.iter().zip(&self.kinds);
        let size = rows.map(|(row, &kind)| {
            let entries = row.iter().enumerate().filter(|&(_, &entry)| counts(kind) && entry != Id::ZERO);
            let terms = entries.map(|(i, &entry)| {
                let x = graph.symbol(x(i).symbol());
                // The magnitude of each factor, not of the product: terms that share a factor share its magnitude.
                let [entry, x] = [entry, x].map(|factor| graph.function(Function::Abs, factor));
                graph.mul(entry, x)
            });
            let terms: Vec<Id> = terms.collect();
            graph.total(terms)
        });
        size.collect()
    }
}

/// An expression that is linear in the multipliers: the multiple of each in it, and the rest.
pub(super) struct Multiples {
    pub(super) rest: Id,
    pub(super) of: Vec<(usize, Id)>,
}

impl Multiples {
    pub(super) fn of(graph: &mut Graph, expression: Id) -> Self {
        let multiplier = |symbol| match Variable::of(symbol) {
            Variable::Multiplier(a) => Some(a),
            _ => None,
        };
        let all: BTreeSet<usize> = graph.symbols(&[expression]).filter_map(multiplier).collect();
        let slopes = all.iter().map(|&a| Variable::Multiplier(a).symbol()).collect::<Vec<_>>();
        let of = all.into_iter().zip(graph.gradient(expression, &slopes)).collect();
        let zeros: Vec<Id> = slopes.iter().map(|&multiplier| graph.symbol(multiplier)).collect();
        let rest = graph.without(expression, &zeros);
        Self { rest, of }
    }
}

/// Differentiates the constraints. Reports malformed ones, and then returns `None`.
pub(super) fn derive(
    graph: &mut Graph,
    problem: &Problem,
    formulation: &dyn Formulation,
    diagnostics: &mut Diagnostics,
) -> Option<Constraints> {
    let mut constraints = Constraints::default();
    for (label, expression) in &problem.constraints {
        if let Some(message) = constraints.push(graph, problem, formulation, *expression) {
            diagnostics.error(label.place, named(label, message));
        }
        diagnostics.stop_at_fault(label.place, graph);
    }
    contacts::check(graph, problem, &constraints, diagnostics);
    constraints.slide(graph, problem);
    diagnostics.is_empty().then_some(constraints)
}

/// Prefixes a message with the name of the constraint if it is one of an indexed family.
fn named(label: &Label, message: String) -> String {
    if label.text.contains('[') { format!("`{}`: {message}", label.text) } else { message }
}

/// Advice how to remove one constraint and keep the others of its indexed family.
fn without(label: &Label) -> String {
    match label.text.split_once('[') {
        Some((name, _)) => format!("write the others alone, as in `{name}[k in 0..2]: a[k] = b[k]`"),
        None => "leave it out".to_owned(),
    }
}

fn malformed(
    graph: &mut Graph,
    problem: &Problem,
    row: usize,
    kind: ConstraintKind,
    jacobian: &[Id],
) -> Option<String> {
    let (label, expression) = &problem.constraints[row];
    if jacobian.iter().all(|&entry| vanishes(graph, problem, entry).is_some()) {
        let is_component =
            problem.frictions.iter().any(|of| of.sliding.len() == 2 && of.rows().contains(&row));
        let message = match *expression {
            Id::ZERO if is_component => {
                "a component of this velocity is zero, whatever the motion: leave it out, as in `v[0]` for `v[0..2]`"
                    .to_owned()
            }
            Id::ZERO => {
                format!("both sides of this constraint are the same, whatever the motion: {}", without(label))
            }
            _ => "this constraint depends on no coordinate and no velocity: nothing can be done to meet it"
                .to_owned(),
        };
        return Some(message);
    }
    // The Jacobian of a velocity constraint F(q, t) q̇ + b(q, t) must be free of velocities.
    let entries = if kind == Velocity { jacobian } else { &[] };
    let velocity = entries.iter().find_map(|&entry| {
        let slopes = graph.gradient(entry, &symbols(problem.coordinates.len(), Variable::Velocity));
        slopes.into_iter().position(|slope| vanishes(graph, problem, slope).is_none())
    })?;
    let name = &problem.coordinates[velocity].text;
    let is_friction = problem.frictions.iter().any(|of| of.rows().contains(&row));
    Some(match is_friction {
        true => format!(
            "this is not linear in the velocity of `{name}`: friction acts along a velocity F(q,t) q̇ + b(q,t), as that of one body past another"
        ),
        false => format!(
            "this constraint is not linear in the velocity of `{name}`: d'Alembert's principle covers F(q,t) q̇ + b(q,t) = 0 only"
        ),
    })
}
