//! The Hamiltonian side, as it is to be read.

use std::ops::Range;

use super::formula::Formula;
use super::lines::{Equation, Line};
use super::reading::length;
use super::{Page, vector};
use crate::mechanics::{Conserved, ConservedKind, Hamilton, NoHamiltonian};
use crate::symbolic::Id;

/// Longer ones, in the signs that they take, say nothing to a reader.
const LONG: usize = 100;

/// Momenta of more coordinates are not read to see whether they are short.
const MANY: usize = 8;

impl Page<'_> {
    /// p = ∂L/∂q̇ of those that are not among the conserved quantities already.
    pub(super) fn momenta(&self) -> Vec<Line> {
        let has_hamiltonian = self.legible().is_ok();
        if !has_hamiltonian && self.derived.equations.momentum.len() > MANY {
            return Vec::new();
        }
        let others = self.all_momenta().into_iter().filter(|(rows, _)| !self.are_conserved(rows));
        let others: Vec<Line> = others.map(|(_, line)| line).collect();
        let size = |line: &Line| match &line.equation {
            Equation::Known(_, right) => Some(length(right)),
            _ => None,
        };
        let size: Option<usize> = others.iter().map(size).sum();
        let is_short = has_hamiltonian || size.is_some_and(|size| size <= LONG);
        if is_short { others } else { Vec::new() }
    }

    /// With the coordinates, one or those of a vector, that each is of.
    pub(super) fn all_momenta(&self) -> Vec<(Range<usize>, Line)> {
        self.by_vector(&self.derived.equations.momentum, Self::momentum, |text| momentum(text, 0))
    }

    pub(super) fn are_conserved(&self, rows: &Range<usize>) -> bool {
        let is_it = |i| move |known: &Conserved| known.quantity == ConservedKind::Momentum(i);
        rows.clone().all(|i| self.derived.facts.conserved.iter().any(is_it(i)))
    }

    /// H(t, q, p)
    pub(super) fn hamiltonian(&self) -> Vec<Line> {
        let hamilton = self.legible().into_iter();
        let line = |hamilton: &Hamilton| {
            Line::known(Formula::labelled("H", 0), self.expression(hamilton.hamiltonian))
        };
        hamilton.map(line).collect()
    }

    /// What is said in place of an H that is not written.
    pub(super) fn why_no_hamiltonian(&self) -> Option<String> {
        let why = match self.legible().err()? {
            NoHamiltonian::NotQuadratic => "L is not quadratic in the velocities",
            NoHamiltonian::Singular if self.problem.constraints.is_empty() => {
                return Some(
                    "there is none: the mass matrix is singular, and velocities do not follow from momenta"
                        .into(),
                );
            }
            NoHamiltonian::Singular => {
                "the mass matrix is singular, and constraints decide on the velocities"
            }
            NoHamiltonian::Long => "it is too long to be read",
        };
        Some(format!("not written out, as {why}: `hamiltonian` computes it"))
    }

    /// Where H is short enough for a reader.
    fn legible(&self) -> Result<&Hamilton, NoHamiltonian> {
        let hamilton = self.derived.hamilton.as_ref().map_err(|why| *why)?;
        match self.expression(hamilton.hamiltonian) {
            Ok(read) if length(&read) <= LONG => Ok(hamilton),
            _ => Err(NoHamiltonian::Long),
        }
    }

    /// q̇ = ∂H/∂p, ṗ = −∂H/∂q + Q + Fᵀλ
    pub(super) fn canonical(&self) -> Vec<Line> {
        let Ok(hamilton) = self.legible() else { return Vec::new() };
        let velocities = self.by_coordinate(&hamilton.velocities, |text| Formula::labelled(text, 1));
        let rates = self.by_coordinate(&hamilton.rates, |text| momentum(text, 1));
        velocities.into_iter().chain(rates).collect()
    }

    /// Fᵀλ of each coordinate that a constraint acts on.
    pub(super) fn constraint_forces(&self) -> Vec<Line> {
        let forces = &self.derived.equations.constraint_force;
        let mut lines = self.by_coordinate(forces, |text| Formula::labelled(&format!("R_{text}"), 0));
        let zero = Formula::sum(Vec::new());
        lines.retain(|line| !matches!(&line.equation, Equation::Known(_, right) if *right == zero));
        lines
    }

    /// An equation for each coordinate, or for each vector of coordinates whose equations are those of one.
    fn by_coordinate(&self, values: &[Id], left: impl Fn(&str) -> Formula) -> Vec<Line> {
        self.by_vector(values, Self::expression, left).into_iter().map(|(_, line)| line).collect()
    }

    fn by_vector(
        &self,
        values: &[Id],
        read: impl Fn(&Self, Id) -> Result<Formula, u64>,
        left: impl Fn(&str) -> Formula,
    ) -> Vec<(Range<usize>, Line)> {
        let mut lines = Vec::new();
        let mut first = 0;
        for labels in self.vectors() {
            let rows = first..first + labels.len();
            first = rows.end;
            // Without constraints there are no forces of them.
            let Some(parts) = values.get(rows.clone()) else { break };
            let whole = vector(&labels[0].text).filter(|_| labels.len() > 1);
            let whole = whole.and_then(|text| Some([left(text), self.vector_expression(parts)?]));
            match whole {
                Some([left, right]) => lines.push((rows, Line::of(Equation::Known(left, right)))),
                None => lines.extend(
                    rows.zip(labels)
                        .map(|(i, label)| (i..i + 1, Line::known(left(&label.text), read(self, values[i])))),
                ),
            }
        }
        lines
    }
}

/// p, with dots, of a coordinate.
pub(super) fn momentum(text: &str, dots: usize) -> Formula {
    Formula::labelled(&format!("p_{text}"), dots)
}
