//! The Hamiltonian side, as it is to be read.

use super::formula::Formula;
use super::lines::{Equation, Line};
use super::reading::length;
use super::{Page, vector};
use crate::mechanics::Hamilton;
use crate::symbolic::Id;

/// Longer ones, in the signs that they take, say nothing to a reader.
const LONG: usize = 100;

impl Page<'_> {
    /// p = ∂L/∂q̇
    pub(super) fn momenta(&self) -> Vec<Line> {
        let Some(_) = self.legible() else { return Vec::new() };
        self.by_coordinate(&self.derived.equations.momentum, |text| momentum(text, 0))
    }

    /// H(t, q, p)
    pub(super) fn hamiltonian(&self) -> Vec<Line> {
        let hamilton = self.legible().into_iter();
        hamilton.map(|hamilton| self.known(Formula::labelled("H", 0), hamilton.hamiltonian)).collect()
    }

    /// Where H is short enough for a reader.
    fn legible(&self) -> Option<&Hamilton> {
        let hamilton = self.derived.hamilton.as_ref()?;
        let read = self.expression(hamilton.hamiltonian).ok()?;
        (length(&read) <= LONG).then_some(hamilton)
    }

    /// q̇ = ∂H/∂p, ṗ = −∂H/∂q + Q + Fᵀλ
    pub(super) fn canonical(&self) -> Vec<Line> {
        let Some(hamilton) = self.legible() else { return Vec::new() };
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
        let mut values = values.iter().copied();
        let lines = self.vectors().flat_map(|labels| {
            let values: Vec<Id> = values.by_ref().take(labels.len()).collect();
            let whole = vector(&labels[0].text).filter(|_| values.len() > 1);
            let whole =
                whole.and_then(|text| Some(Equation::Known(left(text), self.vector_expression(&values)?)));
            match whole {
                Some(equation) => vec![Line::of(equation)],
                None => labels
                    .iter()
                    .zip(values)
                    .map(|(label, value)| self.known(left(&label.text), value))
                    .collect(),
            }
        });
        lines.collect()
    }

    fn known(&self, left: Formula, right: Id) -> Line {
        Line::of(Equation::from(self.expression(right).map(|right| [left, right])))
    }
}

/// p, with dots, of a coordinate.
pub(super) fn momentum(text: &str, dots: usize) -> Formula {
    Formula::labelled(&format!("p_{text}"), dots)
}
