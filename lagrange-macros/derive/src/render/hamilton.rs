//! Renders the Hamiltonian and Hamilton's equations.

use std::ops::Range;

use super::formula::Formula;
use super::length::length;
use super::letters::PageQuantity;
use super::lines::{Equation, Line};
use super::page::Page;
use crate::mechanics::{Conserved, ConservedKind, EnergyForm, Hamilton, NoHamiltonian};

/// Longest Hamiltonian, in symbols, that is written out. A longer one is illegible.
pub(super) const LONG: usize = 100;

/// Maximum number of coordinates whose momenta are expanded to find out whether they are short.
const MANY: usize = 8;

impl Page<'_> {
    /// Lines p = ∂L/∂q̇ of the momenta that are not listed as conserved: all of them beside a Hamiltonian, or short ones.
    pub(super) fn momenta(&self, has_hamiltonian: bool) -> Vec<Line> {
        if !has_hamiltonian && self.derived.equations.momentum.len() > MANY {
            return Vec::new();
        }
        if let Some(families) = self.families() {
            return families.momenta.clone();
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

    /// Line of each momentum, or vector of momenta, with the range of its coordinates.
    pub(super) fn all_momenta(&self) -> Vec<(Range<usize>, Line)> {
        let momenta = &self.derived.equations.momentum;
        let name = |text: &str| self.momentum_name(text, 0);
        self.by_vector(&self.problem.coordinates, momenta, Self::momentum, name)
    }

    pub(super) fn are_conserved(&self, rows: &Range<usize>) -> bool {
        let is_it = |i| move |known: &Conserved| known.quantity == ConservedKind::Momentum(i);
        rows.clone().all(|i| self.derived.facts.conserved.iter().any(is_it(i)))
    }

    /// Line of the Hamiltonian H(t, q, p), if it is short enough for a reader.
    pub(super) fn hamiltonian(&self) -> Result<Line, NoHamiltonian> {
        if let Some(line) = self.families().and_then(|families| families.hamiltonian.clone()) {
            return Ok(line);
        }
        let hamilton = self.derived.hamilton.as_ref().map_err(|why| *why)?;
        let written = self.written_out(hamilton).filter(|written| length(written) <= LONG);
        let name = self.letters.name(PageQuantity::Hamiltonian);
        written.map(|written| Line::known(name, Ok(written))).ok_or(NoHamiltonian::Long)
    }

    /// Formula of H: T + U, with squares (p − b)² where L has terms linear in the velocities; its terms by their degree in
    /// the momenta if these are no more than with squares.
    fn written_out(&self, hamilton: &Hamilton) -> Option<Formula> {
        let form = self.derived.facts.energy_form;
        let is_mixed = matches!(form, EnergyForm::Quadratic | EnergyForm::Moving);
        let by_degree = is_mixed.then(|| self.by_degree(hamilton.hamiltonian)).flatten();
        let all = [by_degree, self.energy(hamilton.energies)];
        let apart = all.into_iter().flatten().min_by_key(|formula| (formula.terms(), length(formula)));
        apart.or_else(|| self.expression(hamilton.hamiltonian).ok())
    }

    /// Explains why H is not written out.
    pub(super) fn why_no_hamiltonian(&self, why: NoHamiltonian) -> String {
        let why = match why {
            NoHamiltonian::NotSolved => "no closed form of the velocities by the momenta is known",
            NoHamiltonian::Singular if self.problem.constraints.is_empty() => {
                return "there is none: the mass matrix is singular, and velocities do not follow from momenta"
                    .into();
            }
            NoHamiltonian::Singular => {
                "the mass matrix is singular, and constraints decide on the velocities"
            }
            NoHamiltonian::Long => "it is too long to be read",
        };
        format!("not written out, as {why}: `hamiltonian` computes it")
    }

    /// Hamilton's equations q̇ = ∂H/∂p, ṗ = −∂H/∂q + Q + Fᵀλ.
    pub(super) fn canonical(&self) -> Vec<Line> {
        if let Some(families) = self.families() {
            return families.canonical.clone();
        }
        let Ok(hamilton) = &self.derived.hamilton else { return Vec::new() };
        let velocities = self.by_coordinate(&hamilton.velocities, |text| Formula::labelled(text, 1));
        let rates = self.by_coordinate(&hamilton.rates, |text| self.momentum_name(text, 1));
        velocities.into_iter().chain(rates).collect()
    }
}
