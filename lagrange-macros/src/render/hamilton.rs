//! The Hamiltonian side, as it is to be read.

use super::Page;
use super::formula::Formula;
use super::lines::{Equation, Line};
use super::reading::length;
use crate::mechanics::Hamilton;
use crate::symbolic::Id;

/// Longer ones, in the signs that they take, say nothing to a reader.
const LONG: usize = 100;

impl Page<'_> {
    /// p, with dots, of a coordinate.
    pub(super) fn momentum(&self, i: usize, dots: usize) -> Formula {
        Formula::labelled(&format!("p_{}", self.problem.coordinates[i].text), dots)
    }

    /// p = ∂L/∂q̇
    pub(super) fn momenta(&self) -> Vec<Line> {
        let momenta =
            self.derived.hamilton.iter().flat_map(|_| self.derived.equations.momentum.iter().enumerate());
        momenta.map(|(i, &momentum)| self.known(self.momentum(i, 0), momentum)).collect()
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
        let coordinates = self.problem.coordinates.iter().map(|label| Formula::labelled(&label.text, 1));
        let velocities = coordinates.zip(&hamilton.velocities).map(|(left, &right)| self.known(left, right));
        let rates = hamilton.rates.iter().enumerate();
        velocities.chain(rates.map(|(i, &rate)| self.known(self.momentum(i, 1), rate))).collect()
    }

    /// Fᵀλ of each coordinate that a constraint acts on.
    pub(super) fn constraint_forces(&self) -> Vec<Line> {
        let forces = self.derived.equations.constraint_force.iter().zip(&self.problem.coordinates);
        let acting = forces.filter(|(force, _)| **force != Id::ZERO);
        acting
            .map(|(&force, label)| self.known(Formula::labelled(&format!("R_{}", label.text), 0), force))
            .collect()
    }

    fn known(&self, left: Formula, right: Id) -> Line {
        Line::of(Equation::from(self.expression(right).map(|right| [left, right])))
    }
}
