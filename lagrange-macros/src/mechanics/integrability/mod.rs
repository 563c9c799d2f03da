//! What kind of constraint it is: holonomic, integrable, or truly nonholonomic.
//!
//! A velocity constraint F q̇ + b = 0 is a form ω = F dq + b dt in the space of (q, t), and the motions that it
//! allows are curves along which ω = 0 and t increases. So the allowed directions are spanned by vector fields
//! X with ω(X) = 0, one of which goes along t and is never left out. Functions that are constant along every
//! motion are those that no X changes, hence no bracket [X, Y], [X, [X, Y]] … either: of r constraints, as many
//! are integrable as the brackets leave directions unreached (Frobenius; Chow; the derived flag of Bryant et
//! al., *Exterior Differential Systems*, II.1 and II.4). Holonomic constraints enter by dΦ, and everything is
//! evaluated on Φ = 0.

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
pub(crate) use kinds::{Classification, Integrability, Integrals, Kinds};
use space::{OneForm, Space};

/// Classifies every constraint and the set of them.
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
        fill(graph, problem, &mut space, &mut kinds);
    }
    kinds
}

fn verdict(integrability: Integrability, evidence: Evidence) -> Classification {
    Classification { integrability, evidence }
}

fn fill(graph: &mut Graph, problem: &Problem, space: &mut Space, kinds: &mut Kinds) {
    let rows = space.velocity.clone();
    // First what is cheap: the brackets of a large set may grow out of hand.
    let alone: Vec<_> = rows.iter().map(|(_, form)| classify_alone(space, form)).collect();
    let forms: Vec<OneForm> = rows.iter().map(|(_, form)| form.clone()).collect();
    let set = Distribution::new(space, &forms);
    let set = set.and_then(|set| set.closure(space).map(|closure| (set, closure)));
    kinds.integrals = set.as_ref().map(|(set, closure)| {
        let of = set.independent();
        Integrals { count: of - closure.reached.len(), of, evidence: closure.evidence }
    });
    for ((row, form), alone) in rows.into_iter().zip(alone) {
        let class = match alone {
            Some(class) if !class.integrability.is_integrable() => {
                set.as_ref().and_then(|(set, closure)| classify_in(space, set, closure, &form))
            }
            class => class,
        };
        let Some(class) = class else { continue };
        kinds.classes[row] = class;
        kinds.functions[row] = integral::of(graph, problem, space, &form, class.integrability);
    }
}

/// The verdict on a constraint without the other velocity constraints.
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

/// The verdict on a constraint that is not integrable alone: whether the directions that the set reaches obey it.
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
