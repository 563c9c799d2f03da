//! What the energy function E = p·q̇ − L is made of, by degree in the velocities: with L = L₀ + L₁ + L₂ it is L₂ − L₀.
//!
//! A Lagrangian does not tell T from U: m ω² r²/2 is kinetic energy of a bead on a wire that is turned, and −U of a spring
//! that pushes. So E is called T + U only where T is known, as the sum of `kinetic(…)`, and E is denied to be T + U only
//! where a velocity is seen to have a part that no coordinate's velocity gives it. With T = T₀ + T₁ + T₂ the
//! energy function is T₂ − T₀ + U (Goldstein, Poole and Safko, *Classical Mechanics*, 2.7).

use num_traits::{One, Zero};

use super::degree::{self, GradedTerm, by_degree};
use super::equations::Equations;
use super::evidence::{Evidence, vanishes};
use super::kinetic::kinetic_energies;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id, Rational, Verdict};
use crate::variables::{Variable, has_velocity, nodes};

/// What E is, as far as it is known.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum EnergyForm {
    /// T + U: T is the sum of `kinetic(…)`, of degree two, and holds all velocities; U = T − L.
    Sum(Evidence),
    /// L₂ − L₀, and L₁ = 0: T + U if −L₀ is U.
    Even(Evidence),
    /// Not T + U: T has a part of degree one or zero, as positions move with time.
    Moving,
    /// L₂ − L₀, while L₁ ≠ 0 or is not known to vanish.
    Quadratic,
    /// p·q̇ − L, and L is not quadratic in the velocities.
    General,
}

/// The form of E, and how sure it is that L has no parts but of degree zero and two.
pub(super) fn find(
    graph: &mut Graph,
    problem: &Problem,
    equations: &Equations,
) -> (EnergyForm, Option<Evidence>) {
    let even = is_even(graph, problem, equations);
    let form = of_bodies(graph, problem).or_else(|| is_carried(graph, problem).then_some(EnergyForm::Moving));
    let form = form.unwrap_or(match even {
        Some(evidence) => EnergyForm::Even(evidence),
        None if equations.momenta_are_linear => EnergyForm::Quadratic,
        None => EnergyForm::General,
    });
    (form, even)
}

/// −L at rest, the potential energy if E of this form is T + U.
pub(super) fn potential(graph: &mut Graph, problem: &Problem, form: EnergyForm) -> Option<Id> {
    let EnergyForm::Even(_) = form else { return None };
    let velocities = nodes(graph, problem.coordinates.len(), Variable::Velocity);
    let at_rest = graph.without(problem.lagrangian, &velocities);
    let potential = graph.neg(at_rest);
    graph.take_fault().is_none().then_some(potential)
}

/// D(E) = D(L) with D = Σ q̇ ∂/∂q̇.
fn is_even(graph: &mut Graph, problem: &Problem, equations: &Equations) -> Option<Evidence> {
    let is_even = |part: &GradedTerm| part.degree.is_zero() || part.degree == Rational::from_integer(2);
    if degree::parts(graph, problem.lagrangian).is_some_and(|parts| parts.iter().all(is_even)) {
        return Some(Evidence::Proved);
    }
    let rate = by_degree(graph, problem, equations.energy);
    let vis_viva = graph.add(equations.energy, problem.lagrangian);
    let difference = graph.sub(rate, vis_viva);
    vanishes(graph, problem, difference)
}

/// Where L has bodies: their kinetic energy is of degree two unless the time moves their frames.
fn of_bodies(graph: &mut Graph, problem: &Problem) -> Option<EnergyForm> {
    let (energies, others) = kinetic_energies(graph, problem)?;
    let kinetic = graph.total(energies);
    let is_quadratic = |part: &GradedTerm| part.degree == Rational::from_integer(2);
    let holds_all = !has_velocity(graph, &[others]);
    if degree::parts(graph, kinetic).is_some_and(|parts| parts.iter().all(is_quadratic)) {
        return holds_all.then_some(EnergyForm::Sum(Evidence::Proved));
    }
    let twice = graph.add(kinetic, kinetic);
    let rate = by_degree(graph, problem, kinetic);
    let difference = graph.sub(rate, twice);
    match graph.is_zero(difference, |symbol, draw| problem.drawn(symbol, draw)) {
        Verdict::Zero => holds_all.then_some(EnergyForm::Sum(Evidence::Proved)),
        Verdict::Held(points) => holds_all.then_some(EnergyForm::Sum(Evidence::Held(points))),
        Verdict::NonZero => Some(EnergyForm::Moving),
        Verdict::Undecided => None,
    }
}

/// Whether a velocity, by `der` or of a frame, has a component that is not zero where all q̇ are, and L is not linear in it.
fn is_carried(graph: &mut Graph, problem: &Problem) -> bool {
    let is_of_degree_one = |part: &GradedTerm| part.degree.is_one();
    let moving = problem.rates.iter().filter(|components| has_velocity(graph, components)).flatten();
    let carried: Vec<Id> = moving
        .copied()
        .filter(|&rate| !degree::parts(graph, rate).is_some_and(|parts| parts.iter().all(is_of_degree_one)))
        .collect();
    if carried.is_empty() {
        return false;
    }
    let velocities = nodes(graph, problem.coordinates.len(), Variable::Velocity);
    let slopes = graph.gradient_to(problem.lagrangian, &carried);
    carried.into_iter().zip(slopes).any(|(rate, slope)| {
        let is_squared = graph.gradient_to(slope, &[rate]) != [Id::ZERO];
        is_squared && {
            let at_rest = graph.without(rate, &velocities);
            graph.is_zero(at_rest, |symbol, draw| problem.drawn(symbol, draw)) == Verdict::NonZero
        }
    })
}
