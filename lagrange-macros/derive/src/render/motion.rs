//! Renders equations of motion and constraint forces, one line for each coordinate or vector of coordinates.

use std::ops::Range;

use super::formula::Formula;
use super::letters::PageQuantity;
use super::lines::{Equation, Line};
use super::page::Page;
use super::resultants::Speed;
use crate::mechanics::{Derived, Turning};
use crate::resolve::{Label, vector, vectors};
use crate::symbolic::Id;

/// Lines of an equation of motion and of the names in it, and the velocities whose equations these are.
pub(super) struct MotionRow {
    pub(super) speeds: Vec<Speed>,
    pub(super) lines: Vec<Line>,
}

impl Page<'_> {
    /// Equations of motion. If one of them or the energy is too long to be read, all that take more than a line are given by
    /// the forces and torques on bodies.
    pub(super) fn motion(&mut self) -> Vec<Line> {
        let rows = self.rows();
        let lines = rows.iter().map(|row| row.lines.len()).sum::<usize>();
        if let Some(families) = self.families.as_mut().filter(|families| families.motion.len() < lines) {
            self.is_by_families = true;
            return std::mem::take(&mut families.motion);
        }
        let has_energy = || !self.energy_line(Vec::new()).is_too_long();
        if rows.iter().flat_map(|row| &row.lines).any(Line::is_too_long) || !has_energy() {
            self.name_bodies();
        }
        let lines = rows.into_iter().flat_map(|row| match self.by_bodies(&row) {
            Some(lines) => lines,
            None => row.lines,
        });
        let mut lines: Vec<Line> = lines.collect();
        lines.extend(self.resultant_lines(&lines));
        lines
    }

    /// Rows Σ_j M_ij q̈_j = h_i + Σ_α λ_α F_αi, one for each coordinate or vector of coordinates.
    fn rows(&self) -> Vec<MotionRow> {
        let Derived { equations, inertia, .. } = self.derived;
        let right = |i: usize| {
            let right = [Some(&equations.printed_forcing[i]), equations.printed_force.get(i)];
            right.into_iter().flatten().copied().filter(|&part| part != Id::ZERO).collect::<Vec<_>>()
        };
        let mut rows: Vec<(Id, Vec<Id>)> =
            inertia.iter().enumerate().map(|(i, &left)| (left, right(i))).collect();
        self.derived.turnings.coupled.iter().for_each(|(i, row)| rows[*i] = row.clone());
        let mut first = 0;
        let lines = vectors(&self.problem.coordinates).flat_map(|labels| {
            let turning = self.derived.turnings.all.iter().position(|turning| turning.first == first);
            let own = first;
            first += labels.len();
            let others = rows.split_off(labels.len());
            let rows = std::mem::replace(&mut rows, others);
            let row = |text: &str, own: Range<usize>, equation| {
                let line = Line::labelled(&Formula::labelled(text, 0), equation);
                MotionRow { speeds: own.map(Speed::Coordinate).collect(), lines: vec![line] }
            };
            let whole = (labels.len() > 1).then(|| self.vector_row(own, &rows)).flatten();
            if let Some(turning) = turning {
                return self.turning(turning, labels);
            }
            match (whole, vector(&labels[0].text)) {
                (Some([left, right]), Some(text)) => {
                    vec![row(text, own..first, Equation::Known(left, right))]
                }
                _ => labels
                    .iter()
                    .zip(own..)
                    .zip(&rows)
                    .map(|((label, own), sides)| {
                        row(&label.text, own..own + 1, self.row(own, sides.0, &sides.1))
                    })
                    .collect(),
            }
        });
        lines.collect()
    }

    /// The equations of a row by forces and torques on bodies; `None` if the row fits on a line, or if they are too long, too.
    fn by_bodies(&self, row: &MotionRow) -> Option<Vec<Line>> {
        let is_short = row.lines.first().is_some_and(Line::is_short);
        (!is_short && !row.speeds.is_empty()).then_some(())?;
        row.speeds.iter().map(|&speed| self.row_by_bodies(speed)).collect()
    }

    /// Multipliers as functions of the state, where these fit on a line.
    pub(super) fn multipliers(&self) -> Vec<Line> {
        let labels: Vec<Label> = self.problem.constraints.iter().map(|(label, _)| label.clone()).collect();
        let values = self.derived.multipliers.as_deref().unwrap_or_default();
        let name = |text: &str| Formula::Multiplier(text.to_owned());
        let lines = self.by_vector(&labels, values, Self::factored, name).into_iter();
        lines.map(|(_, line)| line).filter(Line::is_short).collect()
    }

    /// Constraint force Fᵀλ on each coordinate that a constraint acts on.
    pub(super) fn constraint_forces(&self) -> Vec<Line> {
        let forces = &self.derived.equations.printed_force;
        let by_vector = self.by_vector(&self.problem.coordinates, forces, Self::expression, |text| {
            self.letters.name_of(PageQuantity::ConstraintForce, text, 0)
        });
        let lines = by_vector.into_iter().map(|(rows, line)| {
            let by_names =
                (self.bodies.is_some() && rows.len() == 1).then(|| self.constraint_force(rows.start));
            let left = |i: usize| {
                self.letters.name_of(PageQuantity::ConstraintForce, &self.problem.coordinates[i].text, 0)
            };
            let line = by_names.map(|force| Line::known(left(rows.start), force)).unwrap_or(line);
            (rows, line)
        });
        let lines = lines.filter_map(|(rows, line)| {
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
        self.by_vector(&self.problem.coordinates, values, Self::expression, left)
            .into_iter()
            .map(|(_, line)| line)
            .collect()
    }

    /// Lines of values that belong to coordinates or constraints with these labels.
    pub(super) fn by_vector(
        &self,
        labels: &[Label],
        values: &[Id],
        read: impl Fn(&Self, Id) -> Result<Formula, u64>,
        left: impl Fn(&str) -> Formula,
    ) -> Vec<(Range<usize>, Line)> {
        let mut lines = Vec::new();
        let mut first = 0;
        for labels in vectors(labels) {
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
