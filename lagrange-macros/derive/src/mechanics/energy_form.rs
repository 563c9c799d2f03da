//! Form of the energy function E = p·q̇ − L by degree in the velocities: with L = L₀ + L₁ + L₂ it is L₂ − L₀.
//!
//! A Lagrangian does not tell T from U: the term m ω² r²/2 is kinetic energy for a bead on a rotating wire, but −U for
//! a repelling spring. So E is called T + U only if T is known as the sum of `kinetic(…)`. E is said to differ from T
//! + U only if a velocity visibly has a component of degree zero. With T = T₀ + T₁ + T₂ the energy function is T₂ − T₀
//! + U (Goldstein, Poole and Safko, *Classical Mechanics*, 2.7).

use num_traits::{One, Zero};

use super::degree::{self, GradedTerm, by_degree};
use super::equations::Equations;
use super::evidence::{Evidence, vanishes};
use super::kinetic::kinetic_energies;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id, Rational, Verdict};
use crate::variables::{Variable, has_velocity, nodes};

/// Composition of the energy function E = p·q̇ − L, with L₂, L₁ and L₀ the parts of the Lagrangian by degree in the
/// velocities: whether it is T + U.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum EnergyForm {
    /// T + U: T, the sum of `kinetic(…)`, is of degree two and contains all velocities; U = T − L.
    Sum(Evidence),
    /// L₂ − L₀, with L₁ = 0: T + U if −L₀ is U.
    Even(Evidence),
    /// Not T + U: T has a part of degree one or zero, because positions depend explicitly on time.
    Moving,
    /// L₂ − L₀, with L₁ ≠ 0 or not known to vanish.
    Quadratic,
    /// p·q̇ − L, and L is not quadratic in the velocities.
    General,
}

/// Returns the form of E, and the evidence that L has parts of degree zero and two only.
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

/// Returns the parts L₂ and −L₀ of E, of an L that is quadratic in the velocities or even. They are T and U if E is T + U.
pub(super) fn parts(
    graph: &mut Graph,
    problem: &Problem,
    equations: &Equations,
    form: EnergyForm,
) -> Option<[Id; 2]> {
    (equations.momenta_are_linear || matches!(form, EnergyForm::Even(_))).then_some(())?;
    let velocities = nodes(graph, problem.coordinates.len(), Variable::Velocity);
    let at_rest = graph.without(problem.lagrangian, &velocities);
    let potential = graph.neg(at_rest);
    let kinetic = graph.sub(equations.energy, potential);
    graph.take_fault().is_none().then_some([kinetic, potential])
}

/// Tests that L has parts of degree zero and two only: D(E) = D(L) with D = Σ q̇ ∂/∂q̇.
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

/// Form of E if L contains kinetic energies of bodies: they are of degree two unless a frame moves with time.
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

/// True if L is nonlinear in a velocity (from `der` or of a frame) that does not vanish with q̇.
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
