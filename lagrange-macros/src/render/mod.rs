//! The system and its equations as text and as LaTeX. Nothing else writes any.

mod binding;
mod facts;
mod formula;
mod kinds;
mod notation;
mod supplied;
mod symbols;
#[cfg(test)]
mod tests;

use rustc_hash::FxHashMap;

use crate::mechanics::{Derived, Equations};
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id};
use crate::syntax::{Declaration, Define, Name, TargetIndex};
use formula::{Formula, derived, written};
use notation::Notation;

/// A row of more symbols than this is not for reading.
const READABLE: u64 = 250;

/// The same system, written twice.
pub(crate) struct Rendered {
    pub(crate) text: String,
    pub(crate) latex: String,
    /// The total time derivatives in the Lagrangian, in the order of the facts.
    pub(crate) total_derivatives: Vec<String>,
}

/// A heading and the lines below it: a label, an equation and a remark. The note says what concerns all lines.
struct Section {
    heading: &'static str,
    lines: Vec<Line>,
    note: Option<String>,
}

struct Line {
    label: Option<String>,
    equation: Equation,
    remark: String,
}

enum Equation {
    Known(Formula, Formula),
    /// No equation but a single expression.
    Term(Formula),
    /// Why it is not written out.
    TooLong(u64),
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
    let term = |formula| Line { label: None, equation: Equation::Term(formula), remark: String::new() };
    let sections = [
        Section { heading: "Lagrangian", lines: lagrangian(declaration, problem), note: None },
        Section {
            heading: "Constraints",
            lines: constraints(declaration, graph, problem, equations),
            note: equations.integrability.integrals.and_then(kinds::note),
        },
        Section { heading: "Equations of motion", lines: motion(graph, problem, derived), note: None },
        Section {
            heading: "Conserved",
            lines: facts::conserved(declaration, graph, problem, equations, facts),
            note: None,
        },
        Section {
            heading: "Total time derivatives in the Lagrangian",
            lines: total_derivatives.into_iter().map(term).collect(),
            note: None,
        },
    ];
    let name = declaration.ident.to_string();
    Rendered { text: text(&name, &sections), latex: latex(&sections), total_derivatives: texts }
}

fn lagrangian(declaration: &Declaration, problem: &Problem) -> Vec<Line> {
    let line = |left: Formula, right: &crate::syntax::Expression| Line {
        label: None,
        equation: Equation::Known(left, written(right, problem)),
        remark: String::new(),
    };
    let name = |text: &str| Formula::labelled(text, 0);
    let mut lines: Vec<Line> = Vec::new();
    lines.extend(declaration.lagrangian.as_ref().map(|lagrangian| line(name("L"), lagrangian)));
    lines.extend(declaration.defines.iter().map(|define| line(defined(define, problem), &define.body)));
    lines.extend(declaration.dissipation.as_ref().map(|function| line(name("D"), function)));
    lines.extend(declaration.forces.iter().map(|force| {
        let coordinate = Notation::Unicode.write(&target(&force.target.name, &force.target.index, problem));
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
        None => target(&define.target.name, &define.target.index, problem),
    }
}

fn target(name: &Name, index: &TargetIndex, problem: &Problem) -> Formula {
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
    let line = |constraint: &crate::syntax::Constraint| {
        let name = &constraint.target.name.text;
        let is_it = |text: &str| text == name || text.starts_with(&format!("{name}["));
        let rows = (0..problem.constraints.len()).filter(|&row| is_it(&problem.constraints[row].0.text));
        Line {
            label: Some(Notation::Unicode.write(&target(
                &constraint.target.name,
                &constraint.target.index,
                problem,
            ))),
            equation: Equation::Known(
                written(&constraint.left, problem),
                written(&constraint.right, problem),
            ),
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
        Line { label: Some(label), equation, remark: String::new() }
    };
    sides.into_iter().enumerate().map(equation).collect()
}

/// How many symbols each node would take written out, where what is shared is written again.
fn symbols_to_read(graph: &Graph, problem: &Problem, roots: &[Id]) -> FxHashMap<Id, u64> {
    let mut sizes = FxHashMap::default();
    for id in graph.reachable(roots) {
        let mut size = 1_u64;
        if !problem.names.contains_key(&id) {
            graph.operands(id, |operand| size = size.saturating_add(sizes[&operand]));
        }
        sizes.insert(id, size);
    }
    sizes
}

fn text(name: &str, sections: &[Section]) -> String {
    let mut text = format!("{name}\n");
    for Section { heading, lines, note } in sections.iter().filter(|section| !section.lines.is_empty()) {
        text += &format!("\n{heading}\n");
        let width =
            lines.iter().filter_map(|line| line.label.as_ref()).map(|label| label.chars().count()).max();
        for Line { label, equation, remark } in lines {
            let label = match (label, width) {
                (Some(label), Some(width)) => {
                    let padding = " ".repeat(width - label.chars().count());
                    format!("{label}:{padding} ")
                }
                _ => String::new(),
            };
            let equation = match equation {
                Equation::Known(left, right) => Notation::Unicode.equation(left, right),
                Equation::Term(formula) => Notation::Unicode.write(formula),
                Equation::TooLong(size) => format!("… ({size} symbols)"),
            };
            let remark = if remark.is_empty() { String::new() } else { format!("   ({remark})") };
            text += &format!("  {label}{equation}{remark}\n");
        }
        text.extend(note.iter().map(|note| format!("  {note}\n")));
    }
    text
}

fn latex(sections: &[Section]) -> String {
    let mut latex = String::from("\\begin{align*}\n");
    for line in sections.iter().flat_map(|section| &section.lines) {
        let equation = match &line.equation {
            Equation::Known(left, right) => {
                format!("{} &= {}", Notation::Latex.write(left), Notation::Latex.write(right))
            }
            Equation::Term(formula) => {
                format!(r"&{} = \text{{total time derivative}}", Notation::Latex.write(formula))
            }
            Equation::TooLong(size) => format!(r"&\text{{({size} symbols)}}"),
        };
        latex += &format!("  {equation} \\\\\n");
    }
    latex + "\\end{align*}\n"
}
