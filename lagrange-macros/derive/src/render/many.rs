//! Renders systems of any number of bodies: one equation for all elements, others for the first and the last ones.

use num_traits::One;

use super::formula::Formula;
use super::hamilton::LONG;
use super::length::length;
use super::letters::PageQuantity;
use super::lines::{self, Equation, Line, Section};
use super::notation::Notation;
use super::page::Page;
use super::reading::Names;
use super::remark::{Fragment, Remark};
use super::{FROM_ZERO, Forms, html, latex};
use crate::diagnostics::Diagnostics;
use crate::mechanics::many::{
    ElementRows, ElementSum, ManyConserved, ManyConstraint, ManyEquations, Over, Pattern, Region,
};
use crate::mechanics::{self, Derived, Symmetry};
use crate::resolve::many::{Affine, Range, Total, totals};
use crate::resolve::{Limit, Problem, families, vector};
use crate::symbolic::{Graph, Id, Rational};
use crate::syntax::{Constraint, Declaration};

/// Renders a system whose number of bodies is known at run time.
pub(crate) fn render_many(
    declaration: &Declaration,
    graph: &Graph,
    problem: &Problem,
    equations: &ManyEquations,
) -> Forms {
    let derived = context(equations);
    let page = |names| Page::new(declaration, graph, problem, &derived, names).many_forms(equations);
    let shortest = page(Names::Shortest);
    let [kept, written_out] = [Names::Kept, Names::WrittenOut].map(|names| match problem.names.is_empty() {
        true => shortest.clone(),
        false => page(names),
    });
    [shortest, kept, written_out]
}

/// Facts that the reading of expressions depends on.
fn context(equations: &ManyEquations) -> Derived {
    Derived::of_expressions(equations.conserved.iter().map(|conserved| conserved.symmetry), equations.is_even)
}

/// Equations stated once for all elements of an array.
pub(super) struct FamilyLines {
    pub(super) motion: Vec<Line>,
    /// Lines of the total momentum and the total angular momentum, if they are conserved.
    pub(super) totals: Vec<(Symmetry, Line)>,
    pub(super) energy: Option<Formula>,
    pub(super) momenta: Vec<Line>,
    pub(super) hamiltonian: Option<Line>,
    pub(super) canonical: Vec<Line>,
}

impl FamilyLines {
    /// Derives the equations of a declaration once for all elements; `None` if they have no such form.
    pub(super) fn of(declaration: &Declaration, names: Names) -> Option<Self> {
        let (mut graph, mut problem) = families(declaration)?;
        let equations = mechanics::many::derive(&mut graph, &mut problem, &mut Diagnostics::default())?;
        equations.rows.iter().all(Option::is_some).then_some(())?;
        let derived = context(&equations);
        let page = Page::new(declaration, &graph, &problem, &derived, names);
        let energy = match page.energy_of_all(&equations.energies).equation {
            Equation::Known(_, energy) => Some(energy),
            _ => None,
        };
        Some(Self {
            motion: page.rows_of_all(&equations),
            totals: equations
                .conserved
                .iter()
                .filter_map(|conserved| Some((conserved.symmetry, page.conserved_vector(conserved)?)))
                .collect(),
            energy,
            momenta: page.momenta_of_all(&equations),
            hamiltonian: page.hamiltonian_of_all(&equations),
            canonical: page.canonical_of_all(&equations),
        })
    }
}

impl Page<'_> {
    fn many_forms(&self, equations: &ManyEquations) -> [String; 3] {
        let section = |heading, lines| Section { heading, lines, note: None };
        let has_energy = !equations.energies.is_empty();
        let energy: Vec<Line> =
            has_energy.then(|| self.energy_of_all(&equations.energies)).into_iter().collect();
        let (conserved, changing) = match equations.energy_is_conserved {
            true => (energy, Vec::new()),
            false => (Vec::new(), energy),
        };
        let vectors = equations.conserved.iter().filter_map(|conserved| self.conserved_vector(conserved));
        let mut sections = vec![
            section("Lagrangian", self.lagrangian()),
            section("Constraints", self.constraints_of_all(equations)),
            Section {
                note: self.unwritten(equations).or_else(|| self.carried(equations)),
                ..section("Equations of motion", self.rows_of_all(equations))
            },
            section("Conserved", vectors.chain(conserved).collect()),
            section("Energy", changing),
            section("Momenta", self.momenta_of_all(equations)),
            section("Hamiltonian", self.hamiltonian_of_all(equations).into_iter().collect()),
            section("Hamilton's equations", self.canonical_of_all(equations)),
        ];
        // The Lagrangian and the constraints are as the user wrote them.
        for section in &mut sections[2..] {
            section.lines.iter_mut().for_each(|line| line.map(|formula| self.as_written(formula)));
        }
        let name = self.declaration.ident.to_string();
        let [in_latex, in_mathml] =
            [Notation::LATEX, Notation::MATHML].map(|notation| self.notation(notation));
        let text = lines::text(self.notation(Notation::UNICODE), &name, &sections);
        sections[0].note = Some(FROM_ZERO.to_owned());
        [
            text,
            latex::latex(in_latex, name.trim_start_matches("r#"), &sections),
            html::html(in_mathml, &sections),
        ]
    }

    fn constraints_of_all(&self, equations: &ManyEquations) -> Vec<Line> {
        let line = |(stated, derived): (&Constraint, &ManyConstraint)| {
            let is_scleronomic = derived.rows.iter().all(|row| row.is_homogeneous);
            let kind = match (derived.rows[0].residual, is_scleronomic) {
                (None, _) => "on the velocities",
                (Some(_), true) => "holonomic",
                (Some(_), false) => "holonomic, rheonomic",
            };
            Line {
                label: Some(Notation::UNICODE.write(&self.target(&stated.target))),
                equation: Equation::Known(self.written(&stated.left), self.written(&stated.right)),
                remark: Remark::of(vec![Fragment::words(kind)]),
            }
        };
        self.declaration.constraints.iter().zip(&equations.constraints).map(line).collect()
    }

    /// Note on arrays whose elements have no equation of one form.
    fn unwritten(&self, equations: &ManyEquations) -> Option<String> {
        let missing = equations.rows.iter().zip(&self.problem.many.arrays).filter(|(rows, _)| rows.is_none());
        let names: Vec<String> = missing.map(|(_, array)| format!("`{}`", array.name)).collect();
        let names = names.join(", ");
        (!names.is_empty())
            .then(|| format!("Not written out for {names}: its elements have no equation of one form."))
    }

    /// Note on multipliers that no constraint has, and on how the equations are solved.
    fn carried(&self, equations: &ManyEquations) -> Option<String> {
        let length = &equations.recursion.as_ref()?.length;
        let names = self.problem.many.recursions.iter().map(|recursion| {
            let name = &self.problem.many.array(recursion.array).name;
            format!("λ_{name} on `{name}`")
        });
        let (names, length) =
            (names.collect::<Vec<_>>().join(", "), length.text(|unknown| self.problem.many.name(unknown)));
        Some(format!(
            "Definitions exert forces: {names}. They are eliminated from the last element to the first; a step costs time proportional to {length}."
        ))
    }

    fn rows_of_all(&self, equations: &ManyEquations) -> Vec<Line> {
        let rows = equations.rows.iter().flat_map(|rows| match rows {
            Some(rows) => rows.iter().flat_map(|rows| self.element_rows(rows)).collect(),
            None => Vec::new(),
        });
        rows.collect()
    }

    /// The equation of a vector, or those of its components.
    fn element_rows(&self, element: &ElementRows) -> Vec<Line> {
        let remark = self.remark_on(&element.region);
        let labels = |number: usize| &self.problem.coordinates[element.rows[number].0].text;
        let whole = (element.rows.len() > 1).then(|| self.vector_equation(element)).flatten();
        let line = |text: &str, equation: Equation| {
            let mut line = Line::labelled(&Formula::labelled(text, 0), equation);
            line.remark = Remark::of(remark.clone());
            line
        };
        if let (Some([left, right]), Some(text)) = (whole, vector(labels(0))) {
            return vec![line(text, Equation::Known(left, right))];
        }
        let row = |number: usize| line(labels(number), self.component(element, number));
        (0..element.rows.len()).map(row).collect()
    }

    /// Lines name = value of all elements, each of a vector or of its components.
    fn values_of_all(&self, rows: &[Vec<ElementRows>], name: &dyn Fn(&str) -> Formula) -> Option<Vec<Line>> {
        let mut lines = Vec::new();
        for element in rows.iter().flatten() {
            let labels = |number: usize| &self.problem.coordinates[element.rows[number].0].text;
            let line = |text: &str, value: Formula| {
                let remark = Remark::of(self.remark_on(&element.region));
                Line { remark, ..Line::of(Equation::Known(name(text), value)) }
            };
            let whole = (element.rows.len() > 1).then(|| self.vector_value(element)).flatten();
            match (whole, vector(labels(0))) {
                (Some(value), Some(text)) => lines.push(line(text, value)),
                _ => {
                    for number in 0..element.rows.len() {
                        lines.push(line(labels(number), self.value_of(element, number)?));
                    }
                }
            }
        }
        Some(lines)
    }

    fn vector_value(&self, element: &ElementRows) -> Option<Formula> {
        let own: Vec<Id> = element.rows.iter().map(|row| row.2).collect();
        let own = match own.iter().all(|&id| id == Id::ZERO) {
            true => Formula::sum(Vec::new()),
            false => self.vector_expression(&own)?,
        };
        let sums = element.sums.iter().map(|ElementSum { over, values }| {
            Some(self.over(element, over, self.vector_expression(values)?))
        });
        Some(total(own, sums.collect::<Option<Vec<_>>>()?))
    }

    fn value_of(&self, element: &ElementRows, number: usize) -> Option<Formula> {
        let own = self.expression(element.rows[number].2).ok()?;
        let sums = element.sums.iter().filter(|sum| sum.values[number] != Id::ZERO);
        let sums = sums.map(|ElementSum { over, values }| {
            Some(self.over(element, over, self.expression(values[number]).ok()?))
        });
        Some(total(own, sums.collect::<Option<Vec<_>>>()?))
    }

    fn momenta_of_all(&self, equations: &ManyEquations) -> Vec<Line> {
        let rows: Option<Vec<Vec<ElementRows>>> = equations.momenta.iter().cloned().collect();
        let lines = rows.and_then(|rows| self.values_of_all(&rows, &|text| self.momentum_name(text, 0)));
        lines.unwrap_or_default()
    }

    fn hamiltonian_of_all(&self, equations: &ManyEquations) -> Option<Line> {
        let energies = &equations.hamilton.as_ref()?.energies;
        let parts: Result<Vec<Formula>, u64> = energies
            .iter()
            .map(|Pattern { ranges, body, .. }| Ok(self.summed_over(ranges, self.part_of_energy(*body)?)))
            .collect();
        let hamiltonian = Formula::sum(parts.ok()?);
        (length(&hamiltonian) <= LONG).then_some(())?;
        Some(Line::of(Equation::Known(self.letters.name(PageQuantity::Hamiltonian), hamiltonian)))
    }

    fn canonical_of_all(&self, equations: &ManyEquations) -> Vec<Line> {
        let Some(hamilton) = &equations.hamilton else { return Vec::new() };
        let velocities = self.values_of_all(&hamilton.velocities, &|text| Formula::labelled(text, 1));
        let rates = self.values_of_all(&hamilton.rates, &|text| self.momentum_name(text, 1));
        match (velocities, rates) {
            (Some(velocities), Some(rates)) => [velocities, rates].into_iter().flatten().collect(),
            _ => Vec::new(),
        }
    }

    fn vector_equation(&self, element: &ElementRows) -> Option<[Formula; 2]> {
        if element.sums.is_empty() {
            let rows: Vec<(Id, Vec<Id>)> =
                element.rows.iter().map(|&(_, inertia, force)| (inertia, vec![force])).collect();
            return self.vector_row(element.rows[0].0, &rows);
        }
        let vector = |ids: Vec<Id>| match ids.iter().all(|&id| id == Id::ZERO) {
            true => Some(Formula::sum(Vec::new())),
            false => self.vector_expression(&ids),
        };
        let left = vector(element.rows.iter().map(|row| row.1).collect())?;
        let own = vector(element.rows.iter().map(|row| row.2).collect())?;
        let sums: Option<Vec<Formula>> = element
            .sums
            .iter()
            .map(|sum| Some(self.over(element, &sum.over, self.vector_expression(&sum.values)?)))
            .collect();
        Some([left, total(own, sums?)])
    }

    fn component(&self, element: &ElementRows, number: usize) -> Equation {
        let (slot, inertia, force) = element.rows[number];
        let is_alone = element.sums.iter().all(|sum| sum.values[number] == Id::ZERO);
        if is_alone {
            return self.row(slot, inertia, &[force]);
        }
        let sides = || {
            let (left, own) = (self.expression(inertia)?, self.expression(force)?);
            let sums = element.sums.iter().filter(|sum| sum.values[number] != Id::ZERO);
            let sums: Result<Vec<Formula>, u64> = sums
                .map(|ElementSum { over, values }| {
                    Ok(self.over(element, over, self.expression(values[number])?))
                })
                .collect();
            Ok([left, total(own, sums?)])
        };
        sides().into()
    }

    /// Sum of a body over other elements.
    fn over(&self, element: &ElementRows, over: &Over, body: Formula) -> Formula {
        let [own, other] = [0, 1].map(|level| Formula::labelled(&self.problem.many.level_name(level), 0));
        let own = if let Region::Element(at) = &element.region { self.affine(at) } else { own };
        let condition = match over {
            Over::Range(range) => return self.sum_over_range(range, 1, body),
            Over::Others(_) => ([other.clone(), own], "≠"),
            Over::Entries(_, entry) => {
                let text = self.problem.many.index_text(entry, &self.problem.parameters);
                ([Formula::labelled(&text, 0), own], "=")
            }
        };
        taken_out(body, &other, |body| {
            let (condition, sign) = condition;
            Formula::SumWhere { condition: Box::new(condition), sign, body: Box::new(body) }
        })
    }

    pub(super) fn sum_over_range(&self, range: &Range, level: usize, body: Formula) -> Formula {
        let index = self.problem.many.level_name(level);
        let [from, to] = [&range.from, &range.to].map(|bound| Box::new(self.affine(bound)));
        taken_out(body, &Formula::labelled(&index, 0), |body| Formula::SumOver {
            index,
            from,
            to,
            body: Box::new(body),
        })
    }

    /// Renders the sums, and the calls of `min`, `max` and `clamp`, in expressions, inner ones first.
    pub(super) fn write_sums_and_limits(&mut self) {
        let mut limits: Vec<&Limit> = self.derived.limits(self.problem).collect();
        for k in 0..=self.problem.many.totals.len() {
            let is_ready =
                |limit: &&Limit| totals(self.graph, &limit.arguments).into_iter().all(|total| total < k);
            let (ready, others): (Vec<&Limit>, Vec<&Limit>) = limits.into_iter().partition(is_ready);
            limits = others;
            for Limit { value, name, arguments } in ready {
                let arguments = arguments.iter().map(|&argument| self.derived(argument)).collect();
                self.entries.insert(*value, Formula::Call(name.clone(), arguments));
            }
            let Some(Total { level, range, body }) = self.problem.many.totals.get_index(k) else { continue };
            let body = self.expression(*body).unwrap_or_else(|_| Formula::labelled("…", 0));
            let formula = self.sum_over_range(range, *level, body);
            self.totals.push(formula);
        }
    }

    fn summed_over(&self, ranges: &[Range], body: Formula) -> Formula {
        ranges.iter().enumerate().rfold(body, |body, (level, range)| self.sum_over_range(range, level, body))
    }

    fn affine(&self, number: &Affine) -> Formula {
        Formula::index(&number.text(|unknown| self.problem.many.name(unknown)))
    }

    fn remark_on(&self, region: &Region) -> Vec<Fragment> {
        let range = match region {
            Region::Element(_) | Region::All { length: None } => return Vec::new(),
            Region::Interior => return vec![Fragment::words("for elements that are not at an edge")],
            Region::All { length: Some(length) } => &Range::up_to(length),
            Region::Within(range) => range,
        };
        let [from, to] = [&range.from, &range.to].map(|bound| Box::new(self.affine(bound)));
        let index = Some(self.problem.many.level_name(0));
        vec![Fragment::words("for "), Fragment::Formula(Formula::Running { index, from, to })]
    }

    fn energy_of_all(&self, energies: &[Pattern]) -> Line {
        let parts: Result<Vec<Formula>, u64> = energies
            .iter()
            .map(|Pattern { ranges, body, .. }| Ok(self.summed_over(ranges, self.part_of_energy(*body)?)))
            .collect();
        let remark = Remark::of(self.energy_form());
        Line { remark, ..Line::known(self.letters.name(PageQuantity::Energy), parts.map(Formula::sum)) }
    }

    fn conserved_vector(&self, ManyConserved { symmetry, patterns, .. }: &ManyConserved) -> Option<Line> {
        let part = |(ranges, values): &(Vec<Range>, Vec<Id>)| {
            let body = match &values[..] {
                [value] => self.expression(*value).ok(),
                values => self.vector_expression(values),
            };
            Some(self.summed_over(ranges, body?))
        };
        let parts: Option<Vec<Formula>> = patterns.iter().map(part).collect();
        Some(Line::of(Equation::Known(self.letters.name(symmetry.quantity()), Formula::sum(parts?))))
    }
}

fn total(own: Formula, sums: Vec<Formula>) -> Formula {
    let mut all = vec![own];
    all.retain(|own| *own != Formula::sum(Vec::new()));
    all.extend(sums);
    Formula::sum(all)
}

/// Writes Σ of a body. The sign and factors without the running index precede the Σ.
fn taken_out(body: Formula, index: &Formula, sum: impl FnOnce(Formula) -> Formula) -> Formula {
    let (is_negative, magnitude) = body.sign_and_magnitude();
    let Formula::Product(above, below) = magnitude else { return sum(magnitude).signed(is_negative) };
    let (inside, outside): (Vec<Formula>, Vec<Formula>) =
        above.into_iter().partition(|factor| factor.contains(index));
    let (below, below_outside): (Vec<Formula>, Vec<Formula>) =
        below.into_iter().partition(|factor| factor.contains(index));
    let body = Formula::product(Rational::one().into(), inside, below);
    let (mut number, mut factors) = (Rational::one(), Vec::new());
    for factor in outside {
        match factor {
            Formula::Number(value) => number *= value,
            factor => factors.push(factor),
        }
    }
    let divisors = below_outside.into_iter().filter(|factor| match factor {
        Formula::Number(value) => {
            number /= value;
            false
        }
        _ => true,
    });
    let divisors = divisors.collect();
    factors.push(sum(body));
    Formula::product(number.into(), factors, divisors).signed(is_negative)
}
