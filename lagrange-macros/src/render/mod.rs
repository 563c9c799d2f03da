//! The system and its equations as text, as LaTeX and as MathML. Nothing else writes any.

mod arrays;
mod binding;
mod derived;
mod digits;
mod energy;
mod facts;
mod formula;
mod hamilton;
mod html;
mod kinds;
mod latex;
mod lines;
mod names;
mod notation;
mod pieces;
mod reading;
mod remark;
mod spelling;
mod supplied;
#[cfg(test)]
mod tests;
mod written;

use crate::mechanics::Derived;
use crate::resolve::{Label, Problem};
use crate::symbolic::{Graph, Id};
use crate::syntax::{
    Constraint, Declaration, Define, Expression, FrameDeclaration, Power, Target, TargetIndex,
};
use arrays::Arrays;
use formula::Formula;
use lines::{Equation, Line, Section};
use notation::Notation;
use reading::{Names, Reading};
use rustc_hash::FxHashSet;

/// What is said of positions that three angles turn, one after another, and that are differentiated.
const IN_FRAMES: &str =
    "`der` differentiates here what three angles or more turn, one after another: say how the parts lie
  by `#[frame(…)]`, and what they do by `position(…)`, `velocity(…)` and `kinetic(…)`, and the accelerations
  take fewer operations (see lagrange_core::language#frames).";

/// The same system, written down.
pub(crate) struct Rendered {
    /// With definitions by their names or written out as is shorter, always by their names, and always written out; each as
    /// text, as LaTeX and as HTML with MathML.
    pub(crate) forms: [[String; 3]; 3],
    /// The total time derivatives in the Lagrangian, in the order of the facts.
    pub(crate) total_derivatives: Vec<String>,
}

/// Equations of a system while they are typeset.
struct Page<'a> {
    declaration: &'a Declaration,
    graph: &'a Graph,
    problem: &'a Problem,
    derived: &'a Derived,
    /// How many each node takes.
    symbols: Vec<u64>,
    /// Where each parameter stands among the fields.
    ranks: Vec<usize>,
    /// The definitions that neither the time nor the state changes.
    constants: FxHashSet<Id>,
    names: Names,
    readings: Vec<Reading<'a>>,
    arrays: Arrays,
}

/// Writes the system down.
pub(crate) fn render(
    declaration: &Declaration,
    graph: &Graph,
    problem: &Problem,
    derived: &Derived,
) -> Rendered {
    let constants = reading::constants(graph, problem);
    let mut page = Page {
        declaration,
        graph,
        problem,
        derived,
        symbols: lines::symbols(graph, problem),
        ranks: ranks(problem),
        names: Names::Shortest,
        readings: reading::readings(graph, problem, derived, &constants, Names::Shortest),
        constants,
        arrays: Arrays::of(problem),
    };
    let shortest = page.forms();
    let totals = page.total_derivatives();
    let total_derivatives = totals.iter().map(|formula| Notation::UNICODE.write(formula)).collect();
    let others = [Names::Kept, Names::WrittenOut].map(|names| match problem.names.is_empty() {
        true => shortest.clone(),
        false => {
            page.names = names;
            page.readings = reading::readings(graph, problem, derived, &page.constants, names);
            page.forms()
        }
    });
    let [kept, written_out] = others;
    Rendered { forms: [shortest, kept, written_out], total_derivatives }
}

fn ranks(problem: &Problem) -> Vec<usize> {
    let order = problem.parameters.by_field();
    let mut ranks = vec![0; order.len()];
    order.into_iter().enumerate().for_each(|(rank, parameter)| ranks[parameter] = rank);
    ranks
}

impl Page<'_> {
    /// As text, as LaTeX and as HTML.
    fn forms(&self) -> [String; 3] {
        let Self { problem, derived, .. } = self;
        let term = |formula| Line::of(Equation::Term(formula));
        let section = |heading, lines| Section { heading, lines, note: None };
        let sections = [
            section("Lagrangian", self.lagrangian()),
            Section {
                note: derived.equations.integrability.integrals.and_then(kinds::note),
                ..section("Constraints", self.constraints())
            },
            Section {
                note: problem.frames_are_cheaper.then(|| IN_FRAMES.to_owned()),
                ..section("Equations of motion", self.motion())
            },
            section("Constraint forces", self.constraint_forces()),
            section("Conserved", self.conserved()),
            section("Energy", self.changing_energy()),
            section("Momenta", self.momenta()),
            Section { note: self.why_no_hamiltonian(), ..section("Hamiltonian", self.hamiltonian()) },
            section("Hamilton's equations", self.canonical()),
            section(
                "Total time derivatives in the Lagrangian",
                self.total_derivatives().into_iter().map(term).collect(),
            ),
        ];
        let name = self.declaration.ident.to_string();
        let [in_latex, in_mathml] =
            [Notation::LATEX, Notation::MATHML].map(|notation| notation.with(&self.arrays));
        [
            lines::text(&name, &sections),
            latex::latex(in_latex, name.trim_start_matches("r#"), &sections),
            html::html(in_mathml, &sections),
        ]
    }

    fn lagrangian(&self) -> Vec<Line> {
        let Declaration { lagrangian, frames, defines, dissipation, forces, powers, .. } = self.declaration;
        let line = |left, right: &Expression| Line::of(Equation::Known(left, self.written(right)));
        let name = |text: &str| Formula::labelled(text, 0);
        let mut lines: Vec<Line> = Vec::new();
        let written_out = match self.names {
            Names::WrittenOut => self.expression(self.problem.lagrangian).ok(),
            _ => None,
        };
        lines.extend(lagrangian.as_ref().map(|lagrangian| match written_out {
            Some(right) => Line::of(Equation::Known(name("L"), right)),
            None => line(name("L"), lagrangian),
        }));
        lines.extend(frames.iter().map(|frame| self.frame(frame)));
        lines.extend(defines.iter().map(|define| line(self.defined(define), &define.body)));
        lines.extend(dissipation.as_ref().map(|function| line(name("D"), function)));
        lines.extend(forces.iter().map(|force| {
            let Target { name, indices } = &force.target;
            let base = format!("Q_{}", name.text);
            line(Formula::Name { base, dots: 0, indices: self.indices(indices) }, &force.value)
        }));
        lines.extend(powers.iter().map(|Power { indices, force, velocity }| {
            let factors = [force, velocity].map(|factor| self.written(factor)).to_vec();
            let left = Formula::Name { base: "P".to_owned(), dots: 0, indices: self.indices(indices) };
            Line::of(Equation::Known(left, Formula::Call("dot".to_owned(), factors)))
        }));
        lines
    }

    /// A frame by the one that it is in and the steps from there.
    fn frame(&self, FrameDeclaration { target, parent, steps, .. }: &FrameDeclaration) -> Line {
        let steps = parent.iter().chain(steps).map(|part| self.written(part)).collect();
        Line::of(Equation::Known(self.target(target), Formula::Product(steps, Vec::new())))
    }

    /// The left side of a definition.
    fn defined(&self, define: &Define) -> Formula {
        match &define.formals {
            Some(formals) => {
                let formals = formals.iter().map(|formal| Formula::labelled(&formal.text, 0));
                Formula::Call(define.target.name.text.clone(), formals.collect())
            }
            None => self.target(&define.target),
        }
    }

    pub(super) fn target(&self, Target { name, indices }: &Target) -> Formula {
        Formula::Name { base: name.text.clone(), dots: 0, indices: self.indices(indices) }
    }

    fn indices(&self, indices: &[TargetIndex]) -> Vec<Formula> {
        let index = |index: &TargetIndex| match index {
            TargetIndex::Element(element) => self.written(element),
            TargetIndex::Family { index, from, to } => {
                let [from, to] = [from, to].map(|end| Box::new(self.written(end)));
                Formula::Running { index: Some(index.text.clone()), from, to }
            }
        };
        indices.iter().map(index).collect()
    }

    fn constraints(&self) -> Vec<Line> {
        let line = |Constraint { target, left, right, is_implied }: &Constraint| {
            let name = &target.name.text;
            let is_it = |text: &str| text == name || text.starts_with(&format!("{name}["));
            let rows = self.problem.constraints.iter().enumerate();
            let rows = rows.filter(|(_, (label, _))| is_it(&label.text)).map(|(row, _)| row);
            let rows: Vec<usize> = rows.collect();
            // Another constraint may say the same already.
            if *is_implied && rows.is_empty() {
                return None;
            }
            Some(Line {
                label: Some(Notation::UNICODE.write(&self.target(target))),
                equation: Equation::Known(self.written(left), self.written(right)),
                remark: self.kinds(rows.into_iter()),
            })
        };
        self.declaration.constraints.iter().filter_map(line).collect()
    }

    /// Σ_j M_ij q̈_j = h_i + Σ_α λ_α F_αi, a row for each coordinate, or for a vector of coordinates.
    fn motion(&self) -> Vec<Line> {
        let Derived { equations, inertia, .. } = self.derived;
        let right = |i: usize| {
            let right = [Some(&equations.forcing[i]), equations.constraint_force.get(i)];
            right.into_iter().flatten().copied().filter(|&part| part != Id::ZERO).collect::<Vec<_>>()
        };
        let mut rows: Vec<(Id, Vec<Id>)> =
            inertia.iter().enumerate().map(|(i, &left)| (left, right(i))).collect();
        let lines = self.vectors().flat_map(|labels| {
            let others = rows.split_off(labels.len());
            let rows = std::mem::replace(&mut rows, others);
            let line = |text: &str, equation| {
                let label = Some(Notation::UNICODE.write(&Formula::labelled(text, 0)));
                Line { label, ..Line::of(equation) }
            };
            let whole = (labels.len() > 1).then(|| self.vector_row(&rows)).flatten();
            match (whole, vector(&labels[0].text)) {
                (Some([left, right]), Some(text)) => vec![line(text, Equation::Known(left, right))],
                _ => labels
                    .iter()
                    .zip(&rows)
                    .map(|(label, row)| line(&label.text, self.row(row.0, &row.1)))
                    .collect(),
            }
        });
        lines.collect()
    }

    /// The coordinates, with the components of each vector together.
    fn vectors(&self) -> impl Iterator<Item = &[Label]> {
        let are_together = |one: &Label, other: &Label| {
            vector(&one.text).is_some() && vector(&one.text) == vector(&other.text)
        };
        self.problem.coordinates.chunk_by(are_together)
    }
}

/// `r` of `r[0]`, `r[1]` of `r[1][0]`.
fn vector(text: &str) -> Option<&str> {
    text.strip_suffix(']')?.rsplit_once('[').map(|(vector, _)| vector)
}
