//! Renders equations of motion and constraint forces, one line for each coordinate or vector of coordinates.

use std::ops::Range;

use super::formula::Formula;
use super::lines::{Equation, Line};
use super::notation::Notation;
use super::page::Page;
use crate::mechanics::{Derived, Turning};
use crate::resolve::Label;
use crate::symbolic::Id;

impl Page<'_> {
    /// Rows Σ_j M_ij q̈_j = h_i + Σ_α λ_α F_αi, one for each coordinate or vector of coordinates.
    pub(super) fn motion(&self) -> Vec<Line> {
        let Derived { equations, inertia, .. } = self.derived;
        let right = |i: usize| {
            let right = [Some(&equations.printed_forcing[i]), equations.printed_force.get(i)];
            right.into_iter().flatten().copied().filter(|&part| part != Id::ZERO).collect::<Vec<_>>()
        };
        let mut rows: Vec<(Id, Vec<Id>)> =
            inertia.iter().enumerate().map(|(i, &left)| (left, right(i))).collect();
        self.derived.turnings.coupled.iter().for_each(|(i, row)| rows[*i] = row.clone());
        let mut first = 0;
        let lines = self.vectors().flat_map(|labels| {
            let turning = self.derived.turnings.all.iter().find(|turning| turning.first == first);
            let own = first;
            first += labels.len();
            let others = rows.split_off(labels.len());
            let rows = std::mem::replace(&mut rows, others);
            let line = |text: &str, equation| {
                let label = Some(Notation::UNICODE.write(&Formula::labelled(text, 0)));
                Line { label, ..Line::of(equation) }
            };
            let whole = (labels.len() > 1).then(|| self.vector_row(own, &rows)).flatten();
            if let Some(turning) = turning {
                return self.turning(turning, labels);
            }
            match (whole, vector(&labels[0].text)) {
                (Some([left, right]), Some(text)) => vec![line(text, Equation::Known(left, right))],
                _ => labels
                    .iter()
                    .zip(own..)
                    .zip(&rows)
                    .map(|((label, own), row)| line(&label.text, self.row(own, row.0, &row.1)))
                    .collect(),
            }
        });
        lines.collect()
    }

    /// Coordinates in groups: the components of each vector together, all others alone.
    fn vectors(&self) -> impl Iterator<Item = &[Label]> {
        let are_together = |one: &Label, other: &Label| {
            vector(&one.text).is_some() && vector(&one.text) == vector(&other.text)
        };
        self.problem.coordinates.chunk_by(are_together)
    }

    /// Constraint force Fᵀλ on each coordinate that a constraint acts on.
    pub(super) fn constraint_forces(&self) -> Vec<Line> {
        let forces = &self.derived.equations.printed_force;
        let by_vector =
            self.by_vector(forces, Self::expression, |text| Formula::labelled(&format!("R_{text}"), 0));
        let lines = by_vector.into_iter().filter_map(|(rows, line)| {
            let of = |turning: &&Turning| (turning.first..turning.first + 4).contains(&rows.start);
            let turns = |turning: &&Turning| turning.constraint.0 != [Id::ZERO; 3];
            match self.derived.turnings.all.iter().find(of).filter(|_| rows.len() == 1).filter(turns) {
                Some(turning) => (turning.first == rows.start).then(|| self.force_on_quaternion(turning)),
                None => Some(line),
            }
        });
        let mut lines: Vec<Line> = lines.collect();
        let zero = Formula::sum(Vec::new());
        lines.retain(|line| !matches!(&line.equation, Equation::Known(_, right) if *right == zero));
        lines
    }

    /// One equation for each coordinate, or for each vector whose components form one vector equation.
    pub(super) fn by_coordinate(&self, values: &[Id], left: impl Fn(&str) -> Formula) -> Vec<Line> {
        self.by_vector(values, Self::expression, left).into_iter().map(|(_, line)| line).collect()
    }

    pub(super) fn by_vector(
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
            // Without constraints there are no constraint forces.
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

/// Name without its last index: `r` for `r[0]`, `r[1]` for `r[1][0]`.
pub(super) fn vector(text: &str) -> Option<&str> {
    text.strip_suffix(']')?.rsplit_once('[').map(|(vector, _)| vector)
}
