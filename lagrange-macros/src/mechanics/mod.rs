//! From a [`Problem`] to its equations of motion and what they tell, as the textbook does it.

mod completion;
mod conservation;
mod consistency;
mod constraints;
mod degree;
mod determinacy;
mod equations;
mod euler_lagrange;
mod evidence;
mod facts;
mod gauge;
mod gauss;
mod integrability;
mod linearization;
mod moment;

use crate::diagnostics::Diagnostics;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id, Rational};
use crate::variables::Variable;
pub(crate) use conservation::{Conserved, Quantity};
pub(crate) use constraints::ConstraintKind;
pub(crate) use equations::Equations;
pub(crate) use evidence::Evidence;
pub(crate) use facts::Facts;
pub(crate) use gauge::LinearPart;
pub(crate) use gauss::Form;
pub(crate) use integrability::{Classification, Integrability, Integrals, Kinds};
use linearization::linearize;
pub(crate) use linearization::{Linearization, arguments};

/// What follows from a problem. Its expressions are nodes of the problem's graph.
pub(crate) struct Derived {
    pub(crate) equations: Equations,
    pub(crate) facts: Facts,
    /// M q̈, as it is read
    pub(crate) inertia: Vec<Id>,
    /// `None` where exact arithmetic cannot write it
    pub(crate) linearization: Option<Linearization>,
}

/// All that follows from a problem; `None` where it has no equations of motion or something said of it is wrong,
/// which is then reported.
pub(crate) fn derive(graph: &mut Graph, problem: &Problem, diagnostics: &mut Diagnostics) -> Option<Derived> {
    let equations = Equations::derive(graph, problem, diagnostics)?;
    let facts = Facts::find(graph, problem, &equations, diagnostics);
    let inertia = equations.mass.iter().map(|row| inertia(graph, row)).collect();
    diagnostics.stop_at_fault(problem.place, graph)?;
    diagnostics.is_empty().then_some(())?;
    let linearization = linearize(graph, problem, &equations);
    Some(Derived { equations, facts, inertia, linearization })
}

/// Σ_j M_ij q̈_j of a row of M.
fn inertia(graph: &mut Graph, row: &[Id]) -> Id {
    let mut term = |(j, &mass)| {
        let acceleration = graph.symbol(Variable::Acceleration(j).symbol());
        (graph.mul(mass, acceleration), Rational::from_integer(1))
    };
    let terms: Vec<_> = row.iter().enumerate().map(&mut term).collect();
    graph.sum(terms)
}
