//! The Hamiltonian side, as it is to be read.

use std::ops::Range;

use super::formula::Formula;
use super::length::length;
use super::lines::{Equation, Line};
use super::page::Page;
use crate::mechanics::{Conserved, ConservedKind, Hamilton, NoHamiltonian};

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
        self.by_vector(&self.derived.equations.momentum, Self::momentum, |text| Formula::momentum(text, 0))
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
        let rates = self.by_coordinate(&hamilton.rates, |text| Formula::momentum(text, 1));
        velocities.into_iter().chain(rates).collect()
    }
}
