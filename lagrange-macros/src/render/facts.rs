//! The conserved quantities and the total time derivatives, as they are to be read.

use super::derived::derived;
use super::formula::Formula;
use super::lines::{Equation, Line, READABLE, symbols_to_read};
use super::symbols::Notation;
use super::written::written;
use crate::mechanics::{Conserved, Derived, Evidence, Facts, Quantity};
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id};
use crate::syntax::{Declaration, Expression, Sign};

/// A line for each conserved quantity.
pub(super) fn conserved(
    declaration: &Declaration,
    graph: &Graph,
    problem: &Problem,
    Derived { equations, facts, .. }: &Derived,
) -> Vec<Line> {
    let said = |name: &str| {
        declaration.observables.iter().find(|known| known.is_conserved && known.name.text == name)
    };
    let line = |Conserved { name, quantity, evidence }: &Conserved| {
        let (left, right, remark) = match *quantity {
            Quantity::Momentum(a) => (&**name, Err(equations.momentum[a]), held(*evidence)),
            Quantity::Energy => ("E", Err(equations.energy), energy(*evidence, facts)),
            // A vector is written as such, once.
            Quantity::Observable(observable, 0) => {
                let name = &*problem.observables[observable].0.text;
                (name, Ok(written(&said(name)?.value, problem)), held(*evidence))
            }
            Quantity::Observable(..) => return None,
        };
        let equation = either(Formula::labelled(left, 0), right, graph, problem);
        Some(Line { remark: remark.to_owned(), ..Line::of(equation) })
    };
    facts.conserved.iter().filter_map(line).collect()
}

/// An equation with a formula, or with what is derived if that can be read.
fn either(left: Formula, right: Result<Formula, Id>, graph: &Graph, problem: &Problem) -> Equation {
    match right {
        Ok(formula) => Equation::Known(left, formula),
        Err(id) => match symbols_to_read(graph, problem, &[id])[&id] {
            size if size > READABLE => Equation::TooLong(size),
            _ => Equation::Known(left, derived(id, graph, problem)),
        },
    }
}

fn energy(evidence: Evidence, facts: &Facts) -> &'static str {
    match (facts.energy_is_t_plus_u.is_some(), evidence) {
        (true, Evidence::Proved) => "T + U",
        (true, Evidence::Held(_)) => "T + U; conserved in all random motions tried",
        (false, Evidence::Proved) => "not T + U",
        (false, Evidence::Held(_)) => "not T + U; conserved in all random motions tried",
    }
}

fn held(evidence: Evidence) -> &'static str {
    match evidence {
        Evidence::Proved => "",
        Evidence::Held(_) => "in all random motions tried",
    }
}

/// The terms of the Lagrangian that are total time derivatives, as formulas.
pub(super) fn total_derivatives(declaration: &Declaration, problem: &Problem, facts: &Facts) -> Vec<Formula> {
    let terms = declaration.lagrangian.as_ref().map(Expression::terms).unwrap_or_default();
    let term = |index: &usize| {
        let (sign, term) = terms[*index];
        written(term, problem).signed(sign == Sign::Minus)
    };
    let totals = facts.total_derivatives.iter();
    totals.map(|total| Formula::sum(total.terms.iter().map(term).collect())).collect()
}

/// The same as text.
pub(super) fn texts(formulas: &[Formula]) -> Vec<String> {
    formulas.iter().map(|formula| Notation::Unicode.write(formula)).collect()
}
