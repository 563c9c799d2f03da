//! The system and its equations as text and as LaTeX. Nothing else writes any.

mod binding;
mod derived;
mod facts;
mod formula;
mod kinds;
mod lines;
mod notation;
mod supplied;
mod symbols;
#[cfg(test)]
mod tests;
mod written;

use crate::mechanics::{Derived, Equations};
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id};
use crate::syntax::{Constraint, Declaration, Define, Expression, Target, TargetIndex};
use derived::derived;
use formula::Formula;
use lines::{Equation, Line, READABLE, Section, symbols_to_read};
use symbols::Notation;
use written::written;

/// The same system, written twice.
pub(crate) struct Rendered {
    pub(crate) text: String,
    pub(crate) latex: String,
    /// The total time derivatives in the Lagrangian, in the order of the facts.
    pub(crate) total_derivatives: Vec<String>,
}

/// Writes the system down.
pub(crate) fn render(
    declaration: &Declaration,
    graph: &Graph,
    problem: &Problem,
    derived: &Derived,
) -> Rendered {
    let Derived { equations, facts, .. } = derived;
    let total_derivatives = facts::total_derivatives(declaration, problem, facts);
    let texts = facts::texts(&total_derivatives);
    let term = |formula| Line::of(Equation::Term(formula));
    let section = |heading, lines| Section { heading, lines, note: None };
    let sections = [
        section("Lagrangian", lagrangian(declaration, problem)),
        Section {
            note: equations.integrability.integrals.and_then(kinds::note),
            ..section("Constraints", constraints(declaration, graph, problem, equations))
        },
        section("Equations of motion", motion(graph, problem, derived)),
        section("Conserved", facts::conserved(declaration, graph, problem, derived)),
        section(
            "Total time derivatives in the Lagrangian",
            total_derivatives.into_iter().map(term).collect(),
        ),
    ];
    let name = declaration.ident.to_string();
    Rendered { text: lines::text(&name, &sections), latex: lines::latex(&sections), total_derivatives: texts }
}

fn lagrangian(declaration: &Declaration, problem: &Problem) -> Vec<Line> {
    let line = |left, right: &Expression| Line::of(Equation::Known(left, written(right, problem)));
    let name = |text: &str| Formula::labelled(text, 0);
    let mut lines: Vec<Line> = Vec::new();
    lines.extend(declaration.lagrangian.as_ref().map(|lagrangian| line(name("L"), lagrangian)));
    lines.extend(declaration.defines.iter().map(|define| line(defined(define, problem), &define.body)));
    lines.extend(declaration.dissipation.as_ref().map(|function| line(name("D"), function)));
    lines.extend(declaration.forces.iter().map(|force| {
        let coordinate = Notation::Unicode.write(&target(&force.target, problem));
        line(name(&format!("Q_{coordinate}")), &force.value)
    }));
    lines
}

/// The left side of a definition.
fn defined(define: &Define, problem: &Problem) -> Formula {
    match &define.formals {
        Some(formals) => {
            let formals = formals.iter().map(|formal| Formula::labelled(&formal.text, 0));
            Formula::Call(define.target.name.text.clone(), formals.collect())
        }
        None => target(&define.target, problem),
    }
}

fn target(Target { name, index }: &Target, problem: &Problem) -> Formula {
    let index = match index {
        TargetIndex::None => None,
        TargetIndex::Element(element) => Some(written(element, problem)),
        TargetIndex::Family { index, from, to } => {
            let [from, to] = [from, to].map(|end| Box::new(written(end, problem)));
            Some(Formula::Running { index: index.text.clone(), from, to })
        }
    };
    Formula::Name { base: name.text.clone(), dots: 0, indices: index.into_iter().collect() }
}

fn constraints(
    declaration: &Declaration,
    graph: &Graph,
    problem: &Problem,
    equations: &Equations,
) -> Vec<Line> {
    let line = |Constraint { target, left, right }: &Constraint| {
        let name = &target.name.text;
        let is_it = |text: &str| text == name || text.starts_with(&format!("{name}["));
        let rows = (0..problem.constraints.len()).filter(|&row| is_it(&problem.constraints[row].0.text));
        Line {
            label: Some(Notation::Unicode.write(&self::target(target, problem))),
            equation: Equation::Known(written(left, problem), written(right, problem)),
            remark: kinds::remark(rows, graph, problem, &equations.integrability),
        }
    };
    declaration.constraints.iter().map(line).collect()
}

/// Σ_j M_ij q̈_j = h_i + Σ_α λ_α F_αi, a row for each coordinate.
fn motion(graph: &Graph, problem: &Problem, Derived { equations, inertia, .. }: &Derived) -> Vec<Line> {
    let sides: Vec<(Id, Vec<Id>)> = (0..problem.coordinates.len())
        .map(|i| {
            let right = [Some(&equations.forcing[i]), equations.constraint_force.get(i)];
            let right = right.into_iter().flatten().copied().filter(|&part| part != Id::ZERO).collect();
            (inertia[i], right)
        })
        .collect();
    let parts: Vec<Id> = sides.iter().flat_map(|(left, right)| right.iter().chain([left])).copied().collect();
    let sizes = symbols_to_read(graph, problem, &parts);
    let equation = |(i, (left, right)): (usize, (Id, Vec<Id>))| {
        let size = right.iter().chain([&left]).fold(0, |size: u64, part| size.saturating_add(sizes[part]));
        let equation = match size <= READABLE {
            true => {
                let right = right.iter().map(|&part| derived(part, graph, problem)).collect();
                Equation::Known(derived(left, graph, problem), Formula::sum(right))
            }
            false => Equation::TooLong(size),
        };
        let label = Notation::Unicode.write(&Formula::labelled(&problem.coordinates[i].text, 0));
        Line { label: Some(label), ..Line::of(equation) }
    };
    sides.into_iter().enumerate().map(equation).collect()
}
