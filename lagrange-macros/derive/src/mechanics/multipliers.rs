//! Multipliers as functions of the state, for display. The sign is that of M q̈ = h + Fᵀλ.

use super::equations::{Equations, LinearEquations};
use super::hamilton::{COORDINATES, inverse};
use super::moment::Moments;
use crate::resolve::Problem;
use crate::symbolic::{ExactPolynomial, Graph, Id, Polynomials, rank};

/// Largest number of nodes in the equations of motion. Longer ones give a multiplier that fills more than a printed line.
const NODES: usize = 200;

/// λ = −(F M⁻¹Fᵀ)⁻¹ (F M⁻¹h + γ), where the constraints hold. `None` if contacts open or friction slides, if M or F M⁻¹Fᵀ has
/// no inverse in symbols where the constraints hold, or if the equations are long.
pub(super) fn multipliers(graph: &mut Graph, problem: &Problem, equations: &Equations) -> Option<Vec<Id>> {
    let Equations { mass, forcing, linear: LinearEquations { jacobian, bias, .. }, residual, .. } = equations;
    let all = [mass.concat(), jacobian.concat(), forcing.clone(), bias.clone(), residual.clone()].concat();
    let is_short = mass.len() <= COORDINATES && graph.reachable(&all).len() <= NODES;
    (is_short && equations.switched.is_none() && !jacobian.is_empty()).then_some(())?;
    let mut fractions = Fractions::of(graph, residual)?;
    let inverse_mass = inverse(graph, problem, mass).ok()?;
    let responses: Vec<Vec<Id>> = jacobian.iter().map(|row| applied(graph, &inverse_mass, row)).collect();
    let compliance = responses.iter().map(|response| {
        let row = applied(graph, jacobian, response);
        fractions.written(graph, &row)
    });
    let compliance = compliance.collect::<Option<Vec<_>>>()?;
    // Constraints may depend on each other where they hold, and only there.
    let mut moments = Moments::new(problem, equations, false);
    let values = moments.get(0, graph)?.values(graph, &compliance.concat());
    (rank(values.chunks(compliance.len()).map(<[_]>::to_vec).collect()) == compliance.len()).then_some(())?;
    let pushed = applied(graph, &responses, forcing);
    let free: Vec<Id> = pushed.into_iter().zip(bias).map(|(pushed, &bias)| graph.add(pushed, bias)).collect();
    let stiffness = inverse(graph, problem, &compliance).ok()?;
    let opposite = applied(graph, &stiffness, &free);
    let multipliers: Vec<Id> = opposite.into_iter().map(|opposite| graph.neg(opposite)).collect();
    fractions.written(graph, &multipliers)
}

/// Product of a matrix and a vector.
fn applied(graph: &mut Graph, matrix: &[Vec<Id>], vector: &[Id]) -> Vec<Id> {
    matrix.iter().map(|row| graph.dot(row, vector)).collect()
}

/// Writes expressions as fractions, shortened by the holonomic constraints: l² replaces x² + y² + z².
struct Fractions {
    polynomials: Polynomials,
    /// Φ of each constraint; zero for velocity constraints.
    zeros: Vec<ExactPolynomial>,
}

impl Fractions {
    fn of(graph: &mut Graph, residual: &[Id]) -> Option<Self> {
        let mut polynomials = Polynomials::default();
        let zero = |&residual: &Id| {
            let residual = graph.looked_through(residual);
            polynomials.of(graph, residual)
        };
        let zeros = residual.iter().map(zero).collect::<Option<_>>()?;
        Some(Self { polynomials, zeros })
    }

    fn written(&mut self, graph: &mut Graph, all: &[Id]) -> Option<Vec<Id>> {
        let fraction = |&id: &Id| {
            let id = graph.looked_through(id);
            self.polynomials.fraction(graph, id, &self.zeros)
        };
        all.iter().map(fraction).collect()
    }
}
