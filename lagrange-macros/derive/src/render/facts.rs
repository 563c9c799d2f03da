//! Renders conserved quantities and total time derivatives.

use super::formula::Formula;
use super::length::length;
use super::lines::{Equation, LINE, Line};
use super::page::Page;
use super::remark::{Fragment, Remark};
use crate::mechanics::{Conserved, ConservedKind, Evidence, Symmetry};
use crate::resolve::vectors;
use crate::symbolic::Id;
use crate::syntax::{Expression, Sign};

impl Page<'_> {
    /// One line for each conserved quantity.
    pub(super) fn conserved(&self) -> Vec<Line> {
        self.derived
            .facts
            .conserved
            .iter()
            .filter_map(|conserved| self.conserved_quantity(conserved))
            .collect()
    }

    fn conserved_quantity(&self, Conserved { quantity, evidence, .. }: &Conserved) -> Option<Line> {
        let line = match *quantity {
            ConservedKind::Momentum(a) => self.conserved_momentum(a)?,
            ConservedKind::Total(symmetry, component, values) => {
                self.conserved_total(symmetry, component, values)?
            }
            ConservedKind::Energy => return Some(self.conserved_energy(*evidence)),
            // A conserved vector is written once, at its first component.
            ConservedKind::Observable(observable, 0) => {
                let name = &*self.problem.observables[observable].label.text;
                let mut said = self.declaration.observables.iter().filter(|known| known.is_conserved);
                let said = said.find(|known| known.target.name.text == name)?;
                Line::of(Equation::Known(self.target(&said.target), self.written(&said.value)))
            }
            ConservedKind::Observable(..) => return None,
        };
        let mut remark = Remark::of(held(*evidence));
        // A momentum without a multiplier in its equation has no impulse either. One that was tried may have a multiplier that is
        // zero where no force presses bodies together.
        let has_impulses =
            matches!(quantity, ConservedKind::Observable(..)) || matches!(evidence, Evidence::Held(_));
        if has_impulses && !self.problem.contacts.is_empty() {
            remark.and(vec![Fragment::words("between impacts")]);
        }
        Some(Line { remark, ..line })
    }

    /// A vector of momenta that are all conserved is written once, at its first component.
    fn conserved_momentum(&self, a: usize) -> Option<Line> {
        let (rows, line) = self.all_momenta().into_iter().find(|(rows, _)| rows.contains(&a))?;
        if self.are_conserved(&rows) {
            let line = if rows.len() == 1 { self.shorter_momentum(line, a) } else { line };
            return (rows.start == a).then_some(line);
        }
        let momentum = self.momentum(self.derived.equations.momentum[a]);
        Some(self.shorter_momentum(
            Line::known(self.momentum_name(&self.problem.coordinates[a].text, 0), momentum),
            a,
        ))
    }

    /// A total whose components are all conserved is written once, at its first component. Beyond a line, it is a sum of momenta.
    fn conserved_total(&self, symmetry: Symmetry, component: Option<usize>, values: [Id; 2]) -> Option<Line> {
        let all = self.derived.facts.conserved.iter().filter_map(|conserved| match conserved.quantity {
            ConservedKind::Total(of, Some(_), values) if of == symmetry => Some(values),
            _ => None,
        });
        let all: Vec<[Id; 2]> = all.collect();
        let dimension = vectors(&self.problem.coordinates).map(<[_]>::len).filter(|n| *n <= 3).max();
        let is_whole = dimension == Some(all.len());
        let written = |k: usize| match is_whole {
            true => self.vector_expression(&all.iter().map(|values| values[k]).collect::<Vec<_>>()),
            false => self.momentum(values[k]).ok(),
        };
        let fits = |formula: &Formula| length(formula) <= LINE;
        let of_families =
            self.families().filter(|_| is_whole).into_iter().flat_map(|families| &families.totals);
        if let Some((_, line)) = of_families.clone().find(|(of, _)| *of == symmetry) {
            return (component.is_none_or(|component| component == 0)).then(|| line.clone());
        }
        let formula = written(0).filter(fits).or_else(|| written(1))?;
        let letter = self.letters.letter(symmetry.quantity());
        let (is_first, name) = match component.filter(|_| !is_whole) {
            Some(k) => (true, format!("{letter}[{k}]")),
            None => (component.is_none_or(|k| k == 0), letter.to_owned()),
        };
        is_first.then(|| Line::known(Formula::labelled(&name, 0), Ok(formula)))
    }

    /// Terms of the Lagrangian that are total time derivatives.
    pub(super) fn total_derivatives(&self) -> Vec<Formula> {
        let terms = self.declaration.lagrangian.as_ref().map(Expression::terms).unwrap_or_default();
        let term = |index: &usize| {
            let (sign, term) = terms[*index];
            self.written(term).signed(sign == Sign::Minus)
        };
        let totals = self.derived.facts.total_derivatives.iter();
        totals.map(|total| Formula::sum(total.terms.iter().map(term).collect())).collect()
    }
}

fn held(evidence: Evidence) -> Vec<Fragment> {
    match evidence {
        Evidence::Proved => Vec::new(),
        Evidence::Held(_) => vec![Fragment::words("in all random motions tried")],
    }
}
