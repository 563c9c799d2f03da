//! What can be said of a system before it moves.

use num_traits::Zero;

use super::conservation;
use super::conservation::{Conserved, Quantity, found};
use super::degree::{self, Part, by_degree};
use super::equations::Equations;
use super::evidence::{Evidence, vanishes};
use super::gauge::{self, LinearPart, TotalDerivative};
use super::moment::Moments;
use crate::diagnostics::Diagnostics;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id, Rational};

/// Statements about the system as a whole. What is not among them is false or could not be decided.
#[derive(Debug)]
pub(crate) struct Facts {
    /// Coordinates that occur in neither L nor forces nor constraint forces, but by their velocities.
    pub(crate) cyclic: Vec<usize>,
    pub(crate) conserved: Vec<Conserved>,
    pub(crate) energy_is_t_plus_u: Option<Evidence>,
    pub(crate) total_derivatives: Vec<TotalDerivative>,
    pub(crate) linear_part: LinearPart,
}

impl Facts {
    /// Finds what there is to find, and reports what is said to be conserved and is not.
    pub(super) fn find(
        graph: &mut Graph,
        problem: &Problem,
        equations: &Equations,
        diagnostics: &mut Diagnostics,
    ) -> Self {
        let mut moments = Moments::new(problem, equations);
        let (cyclic, mut conserved) = momenta(graph, &mut moments);
        conserved.extend(conservation::of_energy(graph, &mut moments));
        let said = conservation::of_observables(graph, &mut moments, diagnostics);
        conserved.retain(|found| said.iter().all(|said| said.name != found.name));
        conserved.extend(said);
        let energy_is_t_plus_u = energy_is_t_plus_u(graph, problem, equations);
        let linear_part = match energy_is_t_plus_u {
            Some(_) => LinearPart::Absent,
            None => gauge::linear_part(graph, problem, equations),
        };
        let total_derivatives = gauge::total_derivatives(graph, problem);
        Self { cyclic, conserved, energy_is_t_plus_u, total_derivatives, linear_part }
    }
}

/// The cyclic coordinates, and the momenta that are conserved because L and the forces do not depend on their
/// coordinates and no constraint acts along them.
fn momenta(graph: &mut Graph, moments: &mut Moments) -> (Vec<usize>, Vec<Conserved>) {
    let &mut Moments { problem, equations, .. } = moments;
    let (mut cyclic, mut conserved) = (Vec::new(), Vec::new());
    for a in 0..problem.coordinates.len() {
        let Some(free) = vanishes(graph, problem, equations.momentum_rate[a]) else { continue };
        let force = equations.constraint_force.get(a).copied().unwrap_or(Id::ZERO);
        let evidence = match vanishes(graph, problem, force) {
            Some(constrained) => {
                cyclic.push(a);
                Some(free.and(constrained))
            }
            // A constraint that could act along the coordinate may do so in no motion.
            None => found(graph, moments, equations.momentum[a]),
        };
        let (name, quantity) = (format!("p_{}", problem.coordinates[a].text), Quantity::Momentum(a));
        conserved.extend(evidence.map(|evidence| Conserved { name, quantity, evidence }));
    }
    (cyclic, conserved)
}

/// With L = L₀ + L₁ + L₂ by degree in the velocities: E = L₂ − L₀, which is T + U if L₁ = 0. With
/// D = Σ q̇ ∂/∂q̇ that is D(E) = D(L).
fn energy_is_t_plus_u(graph: &mut Graph, problem: &Problem, equations: &Equations) -> Option<Evidence> {
    let two = Rational::from_integer(2);
    let is_even = |part: &Part| part.degree.is_zero() || part.degree == two;
    if degree::parts(graph, problem.lagrangian).is_some_and(|parts| parts.iter().all(is_even)) {
        return Some(Evidence::Proved);
    }
    let rate = by_degree(graph, problem, equations.energy);
    let vis_viva = graph.add(equations.energy, problem.lagrangian);
    let difference = graph.sub(rate, vis_viva);
    vanishes(graph, problem, difference)
}
