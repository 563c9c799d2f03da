//! Renders a system and its equations as text, LaTeX and MathML.

mod arrays;
mod axes;
mod binding;
mod chain_rule;
mod derived;
mod digits;
mod energy;
mod energy_of_bodies;
mod facts;
mod formula;
mod hamilton;
mod html;
mod kinds;
mod latex;
mod length;
mod letters;
mod lines;
mod links;
mod many;
mod motion;
mod names;
mod notation;
mod order;
mod page;
mod pieces;
mod potential;
mod product;
mod reading;
mod remark;
mod resultants;
mod roots;
mod spelling;
mod supplied;
#[cfg(test)]
mod tests;
mod turning;
mod written;

use crate::mechanics::Derived;
use crate::resolve::Problem;
use crate::symbolic::Graph;
use crate::syntax::Declaration;
use formula::Formula;
use lines::{Equation, Line, Section};
use many::FamilyLines;
pub(crate) use many::render_many;
use notation::Notation;
use page::Page;
use reading::Names;

/// Advice on a system that differentiates positions turned by three or more successive angles.
const IN_FRAMES: &str =
    "`der` differentiates here what three angles or more turn, one after another: say how the parts lie
  by `#[frame(…)]`, and what they do by `position(…)`, `velocity(…)` and `kinetic(…)`, and the accelerations
  take fewer operations (see lagrange_core::language#frames).";

/// Note on subscripts, which text does not have: there an element is `r[2]`, as in the program.
const FROM_ZERO: &str = "Indices count from 0, as in the program.";

/// Equations in readable form. Outer index: form of definitions, which is the shorter of the two, by name, or written out. Inner
/// index: text, LaTeX, HTML with MathML.
pub(crate) type Forms = [[String; 3]; 3];

/// Written forms of a system.
pub(crate) struct Rendered {
    pub(crate) forms: Forms,
    /// Terms of the Lagrangian that are total time derivatives, in the order of the facts.
    pub(crate) total_derivatives: Vec<String>,
}

/// Renders a system in all forms.
pub(crate) fn render(
    declaration: &Declaration,
    graph: &Graph,
    problem: &Problem,
    derived: &Derived,
) -> Rendered {
    let page = |names| Page {
        families: FamilyLines::of(declaration, names),
        ..Page::new(declaration, graph, problem, derived, names)
    };
    let mut shortest = page(Names::Shortest);
    let totals = shortest.total_derivatives();
    let total_derivatives = totals.iter().map(|formula| Notation::UNICODE.write(formula)).collect();
    let shortest = shortest.forms();
    let [kept, written_out] = [Names::Kept, Names::WrittenOut].map(|names| match problem.names.is_empty() {
        true => shortest.clone(),
        false => page(names).forms(),
    });
    Rendered { forms: [shortest, kept, written_out], total_derivatives }
}

impl Page<'_> {
    /// Renders the page as text, as LaTeX and as HTML.
    fn forms(&mut self) -> [String; 3] {
        let motion = self.motion();
        let Self { problem, derived, .. } = *self;
        let term = |formula| Line::of(Equation::Term(formula));
        let section = |heading, lines| Section { heading, lines, note: None };
        let mut sections = vec![
            section("Lagrangian", self.lagrangian()),
            Section {
                note: derived.equations.integrability.integrals.and_then(kinds::note),
                ..section("Constraints", self.constraints())
            },
            Section {
                note: problem.frames_are_cheaper.then(|| IN_FRAMES.to_owned()),
                ..section("Equations of motion", motion)
            },
            section(
                "Constraint forces",
                self.multipliers().into_iter().chain(self.constraint_forces()).collect(),
            ),
            section("Conserved", self.conserved()),
            section("Energy", self.changing_energy()),
        ];
        let (hamiltonian, canonical, why_none) = match self.hamiltonian() {
            Ok(line) => (vec![line], self.canonical(), None),
            Err(why) => (Vec::new(), Vec::new(), Some(self.why_no_hamiltonian(why))),
        };
        sections.extend([
            section("Momenta", self.momenta(why_none.is_none())),
            Section { note: why_none, ..section("Hamiltonian", hamiltonian) },
            section("Hamilton's equations", canonical),
            section(
                "Total time derivatives in the Lagrangian",
                self.total_derivatives().into_iter().map(term).collect(),
            ),
        ]);
        // The Lagrangian and the constraints are as the user wrote them.
        for section in &mut sections[2..] {
            section.lines.iter_mut().for_each(|line| line.map(|formula| self.as_written(formula)));
        }
        let mut roots = self.root_lines(sections[1..].iter().flat_map(|section| &section.lines));
        let bodies = self.mentioned_of_bodies(&sections[1..]);
        let lines = sections[1..].iter().flat_map(|section| &section.lines).chain(&bodies);
        roots.extend(self.axes_lines(lines));
        roots.extend(bodies);
        roots.iter_mut().for_each(|line| line.map(|formula| self.as_written(formula)));
        sections[0].lines.extend(roots);
        let name = self.declaration.ident.to_string();
        let [in_latex, in_mathml] =
            [Notation::LATEX, Notation::MATHML].map(|notation| self.notation(notation));
        let text = lines::text(self.notation(Notation::UNICODE), &name, &sections);
        let mut lines = sections.iter().flat_map(|section| &section.lines);
        let has_elements = lines.any(|line| line.any(Formula::has_numbered_element));
        sections[0].note = has_elements.then(|| FROM_ZERO.to_owned());
        [
            text,
            latex::latex(in_latex, name.trim_start_matches("r#"), &sections),
            html::html(in_mathml, &sections),
        ]
    }
}
