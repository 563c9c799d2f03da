//! Renders the energy function, and identifies it as T + U only if that is certain.

use super::formula::Formula;
use super::length::length;
use super::letters::PageQuantity;
use super::lines::{Equation, Line};
use super::page::Page;
use super::remark::{Fragment, Remark};
use crate::mechanics::{ConservedKind, EnergyChange, EnergyForm, Evidence};
use crate::symbolic::Id;
use crate::variables::Variable;

/// Longest potential energy, in symbols, that is repeated in the remark on the energy.
const LONG: usize = 30;

fn sum(terms: [Formula; 2]) -> Fragment {
    Fragment::Formula(Formula::Sum(terms.to_vec()))
}

impl Page<'_> {
    /// Line of a conserved energy.
    pub(super) fn conserved_energy(&self, evidence: Evidence) -> Line {
        let mut remark = self.energy_form();
        if let Evidence::Held(_) = evidence {
            remark.push(Fragment::words("; conserved in all random motions tried"));
        }
        if self.loses_energy_at_impacts() {
            remark.push(Fragment::words("; between impacts"));
        }
        if !self.problem.frictions.is_empty() {
            remark.push(Fragment::words("; while nothing slides"));
        }
        self.energy_line(remark)
    }

    /// False if no contact is stated, or if all are elastic by one law and without friction: the multipliers of fixed gaps do no
    /// work, but friction that stops a velocity takes its energy.
    fn loses_energy_at_impacts(&self) -> bool {
        let contacts = &self.problem.contacts;
        let is_elastic = |restitution| restitution == Id::ONE;
        let are_elastic = contacts
            .iter()
            .all(|contact| is_elastic(contact.restitution) && contact.impact == contacts[0].impact);
        !are_elastic || !contacts.is_empty() && !self.problem.frictions.is_empty()
    }

    /// Line of an energy that changes, and its rate with the terms that contribute to it; these alone if the rate is long or
    /// fields switch parts of it.
    pub(super) fn changing_energy(&self) -> Vec<Line> {
        let facts = &self.derived.facts;
        if facts.conserved.iter().any(|conserved| conserved.quantity == ConservedKind::Energy) {
            return Vec::new();
        }
        let mut remark = self.energy_form();
        let changes: Vec<Formula> = facts.energy_changes.iter().map(|(part, _)| self.change(*part)).collect();
        if changes.is_empty() {
            return vec![self.energy_line(remark)];
        }
        let rate = Formula::Call("der".to_owned(), vec![self.letters.name(PageQuantity::Energy)]);
        let changes = Fragment::Formula(Formula::sum(changes));
        let of_turnings = self.derived.turnings.energy.map(|[_, rate]| rate);
        let known = Some(of_turnings.unwrap_or(facts.energy_rate))
            .filter(|_| self.problem.parameters.switches.is_empty());
        let known = known.and_then(|rate| self.expression(rate).ok());
        match [known, self.energy_rate_by_bodies()].into_iter().flatten().min_by_key(length) {
            Some(written) => {
                let line = Line::of(Equation::Known(rate, written));
                vec![self.energy_line(remark), Line { remark: Remark::of(vec![changes]), ..line }]
            }
            None => {
                remark.extend([
                    Fragment::words("; "),
                    Fragment::Formula(rate),
                    Fragment::words(" is "),
                    changes,
                ]);
                vec![self.energy_line(remark)]
            }
        }
    }

    pub(super) fn energy_line(&self, remark: Vec<Fragment>) -> Line {
        let of_turnings = || self.energy_of_turnings().filter(|_| self.bodies.is_none());
        let of_families = || self.families().and_then(|families| families.energy.clone()).map(Ok);
        let energy =
            self.energy_by_bodies().map(Ok).or_else(of_turnings).or_else(of_families).unwrap_or_else(|| {
                let apart = self.derived.energies.and_then(|energies| self.energy(energies));
                apart.map_or_else(|| self.quantity(self.derived.equations.energy), Ok)
            });
        Line { remark: Remark::of(remark), ..Line::known(self.letters.name(PageQuantity::Energy), energy) }
    }

    pub(super) fn energy_form(&self) -> Vec<Fragment> {
        let letter = |quantity| self.letters.name(quantity);
        let t_plus_u = || sum([letter(PageQuantity::Kinetic), letter(PageQuantity::Potential)]);
        let of_degree = |degree| self.letters.name_of(PageQuantity::Lagrangian, degree, 0);
        match self.derived.facts.energy_form {
            EnergyForm::Sum(_) => vec![t_plus_u()],
            EnergyForm::Even(_) if !self.has_moving_masses() => self.if_potential(t_plus_u()),
            EnergyForm::Moving => {
                vec![Fragment::words("not "), t_plus_u(), Fragment::words(", as positions move with time")]
            }
            EnergyForm::Even(_) | EnergyForm::Quadratic => {
                let parts = sum([of_degree("2"), of_degree("0").negated()]);
                vec![parts, Fragment::words(" by degree in the velocities")]
            }
            EnergyForm::General => {
                let product = vec![letter(PageQuantity::Momentum), Formula::labelled("q", 1)];
                let product = Formula::Call("dot".to_owned(), product);
                vec![sum([product, letter(PageQuantity::Lagrangian).negated()])]
            }
        }
    }

    /// True if the mass matrix contains the time: −L₀ is hardly a potential where coordinates move, as the length of a
    /// pendulum that is pulled in.
    fn has_moving_masses(&self) -> bool {
        self.graph.symbols(&self.derived.inertia).any(|symbol| matches!(Variable::of(symbol), Variable::Time))
    }

    /// T + U on the condition that U is −L at rest, which L alone cannot decide.
    fn if_potential(&self, t_plus_u: Fragment) -> Vec<Fragment> {
        let letter = |quantity| Fragment::Formula(self.letters.name(quantity));
        let is = [Fragment::words(" if "), letter(PageQuantity::Potential), Fragment::words(" is ")];
        let potential = self.derived.energies.map(|[_, potential]| potential);
        let written = potential.and_then(|potential| self.part_of_energy(potential).ok());
        let (sum, potential) = match (potential, written) {
            (Some(Id::ZERO), _) => (letter(PageQuantity::Kinetic), vec![Fragment::words("0")]),
            (_, Some(written)) if length(&written) <= LONG && self.families().is_none() => {
                (t_plus_u, vec![Fragment::Formula(written)])
            }
            _ => {
                let negative = self.letters.name(PageQuantity::Lagrangian).negated();
                (t_plus_u, vec![Fragment::Formula(negative), Fragment::words(" at rest")])
            }
        };
        [sum].into_iter().chain(is).chain(potential).collect()
    }

    /// Contribution to the rate of change of the energy: −∂L/∂t, Q·q̇ or −λ·b.
    fn change(&self, part: EnergyChange) -> Formula {
        let letter = |quantity| self.letters.name(quantity);
        let product = |one, other| Formula::Call("dot".to_owned(), vec![one, other]);
        match part {
            EnergyChange::Time => {
                let (function, by) =
                    (Box::new(letter(PageQuantity::Lagrangian)), vec![self.variable(Variable::Time)]);
                Formula::Partial { function, by, arguments: Vec::new() }.negated()
            }
            EnergyChange::Forces => product(letter(PageQuantity::Force), Formula::labelled("q", 1)),
            EnergyChange::Constraints => {
                product(letter(PageQuantity::Multiplier), letter(PageQuantity::Inhomogeneous)).negated()
            }
        }
    }
}
