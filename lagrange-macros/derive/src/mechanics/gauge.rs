//! Total time derivatives d/dt f(q, t) in the Lagrangian, which do not affect the motion.
//!
//! An expression is a total time derivative exactly if its Euler–Lagrange equations are identically zero.

use super::degree::by_degree;
use super::equations::Equations;
use super::evidence::{Evidence, vanishes};
use crate::resolve::Problem;
use crate::symbolic::{Forward, Graph, Id, Rational};
use crate::variables::{Variable, directions, has_velocity, symbols, total_time_derivative};

/// One term, or several terms together, of the Lagrangian as written that form a total time derivative.
#[derive(Debug)]
pub(crate) struct TotalDerivative {
    /// Indices of the terms in the Lagrangian.
    pub(crate) terms: Vec<usize>,
    pub(crate) evidence: Evidence,
}

/// Effect of A(q,t)·q̇, the part of L that is linear in the velocities.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum LinearPart {
    /// L has no linear part.
    Absent,
    /// ∂A_i/∂q_j = ∂A_j/∂q_i: the linear part adds no velocity-dependent force.
    Closed(Evidence),
    /// The linear part adds gyroscopic forces, or L has parts of degrees other than 0, 1 and 2.
    Open,
}

/// Largest number of terms, with a `sum` as one, of a Lagrangian that is searched: pairs grow with its square. Longer
/// Lagrangians are written by programs.
const TERMS: usize = 100;

/// Returns the terms that are total time derivatives individually, then pairs of remaining terms that are one
/// together. Last come all remaining terms linear in the velocities, if their sum is one.
pub(super) fn total_derivatives(graph: &mut Graph, problem: &Problem) -> Vec<TotalDerivative> {
    let terms = &problem.terms;
    if terms.len() > TERMS {
        return Vec::new();
    }
    let variations = terms.iter().map(|&term| variation(graph, problem, term)).collect();
    let mut search = Search { graph, problem, variations };
    let mut found = Vec::new();
    let mut rest = Vec::new();
    for term in 0..terms.len() {
        match search.cancelled(&[term]) {
            Some(total) => found.push(total),
            None => rest.push(term),
        }
    }
    rest.retain(|&term| search.is_linear(terms[term]));
    let (mut rest, mut potentials): (Vec<_>, Vec<_>) =
        rest.into_iter().partition(|&term| has_velocity(search.graph, &[terms[term]]));
    while let Some(pair) = search.pair(&rest, &potentials) {
        rest.retain(|term| !pair.terms.contains(term));
        potentials.retain(|term| !pair.terms.contains(term));
        found.push(pair);
    }
    if rest.len() > 2 {
        found.extend(search.cancelled(&rest));
    }
    found.sort_by_key(|total| total.terms[0]);
    found
}

struct Search<'a> {
    graph: &'a mut Graph,
    problem: &'a Problem,
    /// The Euler–Lagrange expressions of each term, one per coordinate.
    variations: Vec<Vec<Id>>,
}

impl Search<'_> {
    /// Finds a total time derivative of two terms, of which one at least is linear in the velocities.
    fn pair(&mut self, linear: &[usize], potentials: &[usize]) -> Option<TotalDerivative> {
        let mut pairs = linear.iter().enumerate().flat_map(|(i, &first)| {
            let others = linear[i + 1..].iter().chain(potentials);
            others.map(move |&second| [first.min(second), first.max(second)])
        });
        pairs.find_map(|pair| self.cancelled(&pair))
    }

    /// Returns the terms as a total derivative if their Euler–Lagrange expressions sum to zero.
    fn cancelled(&mut self, terms: &[usize]) -> Option<TotalDerivative> {
        let mut coordinates = 0..self.problem.coordinates.len();
        let evidence = coordinates.try_fold(Evidence::Proved, |evidence, i| {
            let sum = self.graph.total(terms.iter().map(|&term| self.variations[term][i]));
            Some(evidence.and(vanishes(self.graph, self.problem, sum)?))
        })?;
        Some(TotalDerivative { terms: terms.to_vec(), evidence })
    }

    /// True if a term has parts of degree 0 and 1 in the velocities only: then D(D − 1) = 0 on it, with D = Σ q̇
    /// ∂/∂q̇.
    fn is_linear(&mut self, term: Id) -> bool {
        let first = by_degree(self.graph, self.problem, term);
        let second = by_degree(self.graph, self.problem, first);
        let difference = self.graph.sub(second, first);
        vanishes(self.graph, self.problem, difference).is_some()
    }
}

/// d/dt ∂T/∂q̇ − ∂T/∂q of a term T, for each coordinate.
fn variation(graph: &mut Graph, problem: &Problem, term: Id) -> Vec<Id> {
    let n = problem.coordinates.len();
    let total = total_time_derivative(graph, n);
    variation_along(graph, problem, term, total)
}

fn variation_along(graph: &mut Graph, problem: &Problem, term: Id, mut rate: Forward) -> Vec<Id> {
    let n = problem.coordinates.len();
    let state = [symbols(n, Variable::Coordinate), symbols(n, Variable::Velocity)].concat();
    let gradient = graph.gradient(term, &state);
    let (force, momentum) = gradient.split_at(n);
    let row = |(&p, &force): (&Id, &Id)| {
        let rate = rate.of(graph, p);
        graph.sub(rate, force)
    };
    momentum.iter().zip(force).map(row).collect()
}

/// Examines the linear part L₁ = A_i q̇_i of a Lagrangian of degree 2 in the velocities. With D = q̇_i ∂/∂q̇_i, D L =
/// L₁ + 2 L₂, hence L₁ = 2 D L − D² L. At fixed time its Euler–Lagrange equations are (∂A_i/∂q_j − ∂A_j/∂q_i) q̇_j =
/// 0.
pub(super) fn linear_part(graph: &mut Graph, problem: &Problem, equations: &Equations) -> LinearPart {
    let (one, two) = (Rational::from_integer(1), Rational::from_integer(2));
    let vis_viva = graph.add(equations.energy, problem.lagrangian);
    let rate = by_degree(graph, problem, vis_viva);
    let linear = graph.sum([(vis_viva, two), (rate, -one)]);
    let degree = by_degree(graph, problem, linear);
    let difference = graph.sub(degree, linear);
    if vanishes(graph, problem, difference).is_none() {
        return LinearPart::Open;
    }
    let n = problem.coordinates.len();
    let seeds = directions(graph, n, &[(Variable::Coordinate, Variable::Velocity)]);
    let rows = variation_along(graph, problem, linear, Forward::along(seeds));
    let evidence = rows.into_iter().map(|row| vanishes(graph, problem, row)).collect::<Option<Vec<_>>>();
    match evidence {
        Some(rows) => LinearPart::Closed(rows.into_iter().fold(Evidence::Proved, Evidence::and)),
        None => LinearPart::Open,
    }
}
