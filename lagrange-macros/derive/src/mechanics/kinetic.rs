//! Kinetic energies of rigid bodies as terms of L.

use crate::resolve::{Body, Problem};
use crate::symbolic::{Graph, Id};

/// Splits L into the bodies whose kinetic energies are terms of L, and the remaining terms.
pub(super) fn apart(graph: &mut Graph, problem: &Problem) -> (Vec<Body>, Id) {
    let mut bodies: Vec<Body> = Vec::new();
    for body in &problem.bodies {
        if bodies.iter().all(|known| known.energy != body.energy) {
            bodies.push(body.clone());
        }
    }
    let energies = |bodies: &[Body]| bodies.iter().map(|body| body.energy).collect::<Vec<Id>>();
    let weights = graph.gradient_to(problem.lagrangian, &energies(&bodies));
    let weighed = bodies.into_iter().zip(weights).filter(|(_, weight)| *weight == Id::ONE);
    let bodies: Vec<Body> = weighed.map(|(body, _)| body).collect();
    let others = graph.without(problem.lagrangian, &energies(&bodies));
    (bodies, others)
}

/// Returns the kinetic energies of bodies that are terms of L, and L without them; `None` if there are none.
pub(super) fn kinetic_energies(graph: &mut Graph, problem: &Problem) -> Option<(Vec<Id>, Id)> {
    if problem.bodies.is_empty() {
        return None;
    }
    let (bodies, others) = apart(graph, problem);
    (!bodies.is_empty()).then(|| (bodies.iter().map(|body| body.energy).collect(), others))
}
