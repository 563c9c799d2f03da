//! Converts the user's input to formulas: the Lagrangian, definitions, forces and constraints.

use indexmap::IndexMap;
use num_traits::{One, Zero};

use super::formula::Formula;
use super::letters::PageQuantity;
use super::lines::{Equation, Line};
use super::notation::Notation;
use super::page::Page;
use super::reading::Names;
use super::remark::{Fragment, Remark};
use crate::symbolic::{Rational, Scaled};
use crate::syntax::{
    Constraint, Declaration, Define, Expression, Force, FrameDeclaration, ImpactLaw, Kind, Law, Name,
    Operator, Power, Sign, Target, TargetIndex, normal_form,
};

impl Page<'_> {
    pub(super) fn lagrangian(&self) -> Vec<Line> {
        let Declaration { lagrangian, frames, defines, dissipation, powers, .. } = self.declaration;
        let line = |left, right: &Expression| Line::of(Equation::Known(left, self.written(right)));
        let letter = |quantity| self.letters.name(quantity);
        let mut lines: Vec<Line> = Vec::new();
        let written_out = match self.names {
            Names::WrittenOut => self.expression(self.problem.lagrangian).ok(),
            _ => None,
        };
        lines.extend(lagrangian.as_ref().map(|lagrangian| match written_out {
            Some(right) => Line::of(Equation::Known(letter(PageQuantity::Lagrangian), right)),
            None => line(letter(PageQuantity::Lagrangian), lagrangian),
        }));
        lines.extend(frames.iter().map(|frame| self.frame(frame)));
        lines.extend(defines.iter().map(|define| line(self.defined(define), &define.body)));
        lines.extend(dissipation.as_ref().map(|function| line(letter(PageQuantity::Dissipation), function)));
        lines.extend(self.forces());
        lines.extend(powers.iter().map(|Power { indices, force, velocity }| {
            let factors = [force, velocity].map(|factor| self.written(factor)).to_vec();
            let left = Formula::Name {
                base: self.letters.letter(PageQuantity::Power).to_owned(),
                dots: 0,
                indices: self.indices(indices),
            };
            Line::of(Equation::Known(left, Formula::Call("dot".to_owned(), factors)))
        }));
        lines
    }

    /// Forces on coordinates, one line for each target.
    fn forces(&self) -> Vec<Line> {
        let mut sums: IndexMap<String, (Formula, Vec<Formula>)> = IndexMap::new();
        for Force { target: Target { name, indices }, value } in &self.declaration.forces {
            let base = self.letters.text_of(PageQuantity::Force, &name.text);
            let left = Formula::Name { base, dots: 0, indices: self.indices(indices) };
            let key = Notation::UNICODE.write(&left);
            sums.entry(key).or_insert_with(|| (left, Vec::new())).1.push(self.written(value));
        }
        let line = |(left, parts)| Line::of(Equation::Known(left, total(parts)));
        sums.into_values().map(line).collect()
    }

    /// Line of a frame: its parent, and the steps from there.
    fn frame(&self, FrameDeclaration { target, parent, steps, .. }: &FrameDeclaration) -> Line {
        let steps = parent.iter().chain(steps).map(|part| self.written(part)).collect();
        Line::of(Equation::Known(self.target(target), Formula::Product(steps, Vec::new())))
    }

    /// Left side of a definition.
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

    pub(super) fn constraints(&self) -> Vec<Line> {
        let line = |Constraint { target, left, right, is_implied, when, law }: &Constraint| {
            let name = &target.name.text;
            let is_it = |text: &str| text == name || text.starts_with(&format!("{name}["));
            let rows = self.problem.constraints.iter().enumerate();
            let rows = rows.filter(|(_, (label, _))| is_it(&label.text)).map(|(row, _)| row);
            let rows: Vec<usize> = rows.collect();
            // A declared constraint may already state the implied one, which then has no row.
            if *is_implied && rows.is_empty() {
                return None;
            }
            let mut equation = Equation::Known(self.written(left), self.written(right));
            if let Law::Contact { .. } = law {
                equation = self.complementarity(target, left, right);
            }
            let kinds = if law.is_friction() { Remark::default() } else { self.kinds(rows.into_iter()) };
            let remark = self.law(target, when.as_ref(), law, kinds);
            let label = Some(Notation::UNICODE.write(&self.target(target)));
            Some(Line { label, equation, remark })
        };
        self.declaration.constraints.iter().filter_map(line).collect()
    }

    /// The gap of a contact, left − right, and its multiplier.
    fn complementarity(&self, target: &Target, left: &Expression, right: &Expression) -> Equation {
        let [left, right] = [left, right].map(|side| self.written(side));
        let is_zero = right == Formula::sum(Vec::new());
        let gap = if is_zero { left } else { Formula::sum(vec![left, right.negated()]) };
        Equation::Complementary(gap, self.multiplier(&target.name.text, &target.indices))
    }

    /// Multiplier of an element of constraints.
    fn multiplier(&self, name: &str, indices: &[TargetIndex]) -> Formula {
        let index = |index: &TargetIndex| match index {
            TargetIndex::Element(element) => Notation::UNICODE.write(&self.written(element)),
            TargetIndex::Family { index, .. } => index.text.clone(),
        };
        let indices: String = indices.iter().map(|part| format!("[{}]", index(part))).collect();
        Formula::Multiplier(name.to_owned() + &indices)
    }

    /// What holds beside the equation of a constraint, or in place of it.
    fn law(&self, target: &Target, when: Option<&Name>, law: &Law, mut remark: Remark) -> Remark {
        let state = |is: &str| {
            let field = when.map_or_else(String::new, |field| field.text.clone());
            vec![
                Fragment::words("while "),
                Fragment::Formula(Formula::labelled(&field, 0)),
                Fragment::words(is),
            ]
        };
        let bounded = |bound: Formula| {
            let force =
                Formula::Call("abs".to_owned(), vec![self.multiplier(&target.name.text, &target.indices)]);
            vec![Fragment::Formula(force), Fragment::words(" ≤ "), Fragment::Formula(bound)]
        };
        let (limit, sliding) = match law {
            Law::Equation => {
                when.into_iter().for_each(|_| remark.and(state(" is true")));
                return remark;
            }
            Law::Contact { restitution, impact } => {
                let zero = || Formula::sum(Vec::new());
                let restitution = restitution.as_ref().map_or_else(zero, |law| self.written(law));
                let mut remarks = vec![Fragment::words("restitution "), Fragment::Formula(restitution)];
                if *impact == ImpactLaw::Poisson {
                    remarks.push(Fragment::words(" by Poisson's law"));
                }
                remark.and(remarks);
                return remark;
            }
            Law::Coulomb { limit, sliding } => {
                let force = |coefficient: &Expression| {
                    let press = self.multiplier(when.map_or("", |contact| &contact.text), &target.indices);
                    let factors = vec![self.written(coefficient), press];
                    Formula::product(Scaled::from(Rational::one()), factors, Vec::new())
                };
                (limit.as_ref().map(force), force(sliding))
            }
            Law::Dry { limit, sliding } => {
                (limit.as_ref().map(|limit| self.written(limit)), self.written(sliding))
            }
        };
        remark.and(state(" sticks"));
        let is_stated = limit.is_some();
        remark.and(bounded(limit.unwrap_or_else(|| sliding.clone())));
        if is_stated {
            remark.and(vec![Fragment::words("slides with "), Fragment::Formula(sliding)]);
        }
        remark
    }

    pub(super) fn written(&self, expression: &Expression) -> Formula {
        let boxed = |part: &Expression| Box::new(self.written(part));
        let all = |parts: &[Expression]| parts.iter().map(|part| self.written(part)).collect();
        let term = |(sign, term): &(Sign, Expression)| self.written(term).signed(*sign == Sign::Minus);
        match &expression.kind {
            Kind::Number(value) => Formula::number(*value),
            Kind::Name(name) if name.text == "pi" => Formula::Pi,
            Kind::Name(name) => self.named(&name.text),
            Kind::Index(base, index) => self.written(base).indexed(self.written(index)),
            Kind::Member(base, member) => {
                let name = Formula::Name { base: member.text.clone(), dots: 0, indices: Vec::new() };
                Formula::Member(boxed(base), Box::new(name))
            }
            Kind::Slice(slice) => {
                let (from, to) = (boxed(&slice.from), boxed(&slice.to));
                self.written(&slice.base).indexed(Formula::Running { index: None, from, to })
            }
            Kind::Call(name, arguments) => call(&name.text, all(arguments)),
            Kind::SumOver(sum) => Formula::SumOver {
                index: sum.index.text.clone(),
                from: boxed(&sum.from),
                to: boxed(&sum.to),
                body: boxed(&sum.body),
            },
            Kind::Negative(part) => self.written(part).negated(),
            Kind::Sum(terms) => Formula::Sum(terms.iter().map(term).collect()),
            Kind::Product(factors) => self.product(factors),
            Kind::Power(base, exponent) => Formula::Power(boxed(base), boxed(exponent)),
            Kind::Vector(items) => Formula::Vector(all(items)),
        }
    }

    /// Collects numeric factors in front: `m/2` reads as ½ m.
    fn product(&self, factors: &[(Operator, Expression)]) -> Formula {
        let (mut above, mut below, mut number) = (Vec::new(), Vec::new(), Scaled::from(Rational::one()));
        for (operator, factor) in factors {
            let exponent = if *operator == Operator::Times { 1 } else { -1 };
            let gathered = match &factor.kind {
                Kind::Number(value) => value.power(exponent).and_then(|value| number.times(value)),
                _ => None,
            };
            if let Some(gathered) = gathered {
                number = gathered;
                continue;
            }
            let (is_negative, magnitude) = self.written(factor).sign_and_magnitude();
            number.fraction = if is_negative { -number.fraction } else { number.fraction };
            if *operator == Operator::Times { above.push(magnitude) } else { below.push(magnitude) }
        }
        Formula::product(number, above, below)
    }

    /// Formula of a name. `x_dot` becomes x with a dot if x is a coordinate.
    fn named(&self, text: &str) -> Formula {
        let coordinates = || self.problem.coordinates.iter().map(|label| label.text.as_str());
        let is_coordinate =
            |name: &str| coordinates().any(|text| text == name || text.starts_with(&format!("{name}[")));
        for (suffix, combining, dots) in [("_dot", '\u{307}', 1), ("_ddot", '\u{308}', 2)] {
            let dotted = |base: &&str| normal_form(&format!("{base}{combining}")) == text;
            let base = text.strip_suffix(suffix).filter(|base| is_coordinate(base));
            if let Some(base) = base.or_else(|| coordinates().find(dotted)) {
                return Formula::Name { base: base.to_owned(), dots, indices: Vec::new() };
            }
        }
        Formula::Name { base: text.to_owned(), dots: 0, indices: Vec::new() }
    }
}

fn call(name: &str, mut arguments: Vec<Formula>) -> Formula {
    match (name, arguments.len()) {
        ("sqrt", 1) => Formula::Root(Box::new(arguments.remove(0))),
        _ => Formula::Call(name.to_owned(), arguments),
    }
}

/// Sum of forces on one coordinate, whose numbers are added.
fn total(forces: Vec<Formula>) -> Formula {
    let mut number = Rational::zero();
    let mut terms: Vec<Formula> = Vec::new();
    for force in forces {
        match force {
            Formula::Number(value) => number += value,
            force => terms.push(force),
        }
    }
    if !number.is_zero() || terms.is_empty() {
        terms.push(Formula::Number(number));
    }
    Formula::sum(terms)
}
