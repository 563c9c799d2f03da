//! Classification of constraints: holonomic, integrable, or truly nonholonomic.
//!
//! A velocity constraint F q̇ + b = 0 is a one-form ω = F dq + b dt in the space of (q, t). The allowed motions are
//! curves along which ω = 0 and t increases. So vector fields X with ω(X) = 0 span the allowed directions; one of them
//! goes along t and is never left out. A function that is constant along every motion is constant along every X, hence
//! along every bracket [X, Y], [X, [X, Y]] … too. So the number of integrable constraints is the number of directions
//! that the brackets leave unreached (Frobenius; Chow; the derived flag of Bryant et al., *Exterior Differential
//! Systems*, II.1 and II.4). Holonomic constraints enter by dΦ, and all expressions are evaluated on Φ = 0.

mod distribution;
mod integral;
mod kinds;
mod space;

use super::ConstraintKind;
use super::Evidence;
use super::constraints::Constraints;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id};
use distribution::{Closure, Distribution};
pub(crate) use kinds::Kinds;
pub use kinds::{Classification, Integrability, Integrals};
use space::{OneForm, Space};

/// Classifies every constraint, and the velocity constraints as a set.
pub(super) fn classify(graph: &mut Graph, problem: &Problem, constraints: &Constraints) -> Kinds {
    let classes = constraints.kinds.iter().map(|kind| match kind {
        ConstraintKind::Holonomic => verdict(Integrability::Holonomic, Evidence::Proved),
        ConstraintKind::Velocity => verdict(Integrability::Undecided, Evidence::Held(0)),
    });
    let count = constraints.kinds.len();
    let mut kinds = Kinds { classes: classes.collect(), integrals: None, functions: vec![None; count] };
    if !constraints.kinds.contains(&ConstraintKind::Velocity) {
        kinds.integrals = Some(Integrals { count: 0, of: 0, evidence: Evidence::Proved });
    } else if let Some(mut space) = Space::new(graph, problem, constraints) {
        fill(graph, problem, constraints, &mut space, &mut kinds);
    }
    kinds
}

fn verdict(integrability: Integrability, evidence: Evidence) -> Classification {
    Classification { integrability, evidence }
}

/// Classifies the velocity constraints. Those that always hold are a set; each other one is classified without the others.
fn fill(
    graph: &mut Graph,
    problem: &Problem,
    constraints: &Constraints,
    space: &mut Space,
    kinds: &mut Kinds,
) {
    let rows = space.velocity.clone();
    // First the cheap tests: the brackets of a large set may exceed the size limit of the graph.
    let alone: Vec<_> = rows.iter().map(|(_, form)| classify_alone(space, form)).collect();
    let held = rows.iter().filter(|(row, _)| constraints.always_holds(*row));
    let forms: Vec<OneForm> = held.map(|(_, form)| form.clone()).collect();
    let set = Distribution::new(space, &forms);
    let set = set.and_then(|set| set.closure(space).map(|closure| (set, closure)));
    kinds.integrals = set.as_ref().map(|(set, closure)| {
        let of = set.independent();
        Integrals { count: of - closure.reached.len(), of, evidence: closure.evidence }
    });
    for ((row, form), alone) in rows.into_iter().zip(alone) {
        let class = match alone {
            Some(class) if constraints.always_holds(row) && !class.integrability.is_integrable() => {
                set.as_ref().and_then(|(set, closure)| classify_in(space, set, closure, &form))
            }
            class => class,
        };
        let Some(class) = class else { continue };
        kinds.classes[row] = class;
        kinds.functions[row] = integral::of(graph, problem, space, &form, class.integrability);
    }
}

/// Classifies a constraint without the other velocity constraints.
fn classify_alone(space: &mut Space, form: &OneForm) -> Option<Classification> {
    let manifold = Distribution::new(space, &[])?;
    let curl = manifold.curl(space, form);
    space.settled()?;
    let (closed, evidence) = space.vanish(&curl)?;
    if closed {
        return Some(verdict(Integrability::Exact, evidence));
    }
    let alone = Distribution::new(space, std::slice::from_ref(form))?.closure(space)?;
    Some(match alone.reached.is_empty() {
        true => verdict(Integrability::IntegratingFactor, alone.evidence.and(evidence)),
        false => verdict(Integrability::Nonholonomic, space.seen()),
    })
}

/// Classifies a constraint that is not integrable alone: it is integrable with the set if it holds along all
/// directions that the brackets reach.
fn classify_in(
    space: &mut Space,
    set: &Distribution,
    closure: &Closure,
    form: &OneForm,
) -> Option<Classification> {
    let along: Vec<Id> = closure.reached.iter().map(|parts| set.along_pivots(space, form, parts)).collect();
    let (obeyed, evidence) = space.vanish(&along)?;
    Some(match obeyed {
        true => verdict(Integrability::Together, evidence.and(closure.evidence).and(space.seen())),
        false => verdict(Integrability::Nonholonomic, evidence),
    })
}
