//! Statements about a system that need no simulation: cyclic coordinates, conserved quantities, form of the energy.

use super::conservation;
use super::conservation::{Conserved, ConservedKind, EnergyChange, Symmetry, found};
use super::energy_form::{self, EnergyForm};
use super::equations::Equations;
use super::evidence::{Evidence, vanishes};
use super::gauge::{self, LinearPart, TotalDerivative};
use super::moment::Moments;
use super::symmetries;
use crate::diagnostics::Diagnostics;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id};

/// Statements about the system as a whole. A statement that is missing is false or undecided.
#[derive(Debug)]
pub(crate) struct Facts {
    /// Indices of cyclic coordinates: L, the forces and the constraint forces depend on their velocities at most.
    pub(crate) cyclic: Vec<usize>,
    pub(crate) conserved: Vec<Conserved>,
    pub(crate) energy_form: EnergyForm,
    /// Terms that dE/dt may have, if E is not known to be conserved, with their values.
    pub(crate) energy_changes: Vec<(EnergyChange, Id)>,
    /// dE/dt along the motion, with multipliers as symbols; zero if E is conserved, whatever slides.
    pub(crate) energy_rate: Id,
    pub(crate) total_derivatives: Vec<TotalDerivative>,
    pub(crate) linear_part: LinearPart,
}

impl Facts {
    /// Symmetries and the form of the energy alone.
    pub(super) fn of_symmetries(symmetries: impl Iterator<Item = Symmetry>, is_even: bool) -> Self {
        let conserved = symmetries.map(|symmetry| Conserved {
            name: symmetry.name().to_owned(),
            quantity: ConservedKind::Total(symmetry, None, [Id::ZERO; 2]),
            evidence: Evidence::Proved,
        });
        Self {
            cyclic: Vec::new(),
            conserved: conserved.collect(),
            energy_form: if is_even { EnergyForm::Even(Evidence::Proved) } else { EnergyForm::General },
            energy_changes: Vec::new(),
            energy_rate: Id::ZERO,
            total_derivatives: Vec::new(),
            linear_part: LinearPart::Absent,
        }
    }

    /// Derives the statements, and reports quantities declared as conserved that are not.
    pub(super) fn find(
        graph: &mut Graph,
        problem: &Problem,
        equations: &Equations,
        diagnostics: &mut Diagnostics,
    ) -> Self {
        let mut moments = Moments::new(problem, equations, true);
        let (cyclic, mut conserved) = momenta(graph, &mut moments);
        conserved.extend(symmetries::totals(graph, problem, equations, &conserved));
        // The energy is said to be conserved while nothing slides.
        let mut at_rest = (!problem.frictions.is_empty()).then(|| Moments::new(problem, equations, false));
        let (energy, changes) = conservation::of_energy(graph, at_rest.as_mut().unwrap_or(&mut moments));
        let may_change = energy.is_none() || !problem.frictions.is_empty();
        let rates = changes.iter().filter(|_| may_change).map(|(_, part)| *part).collect::<Vec<_>>();
        let energy_rate = graph.total(rates);
        let energy_changes = changes.into_iter().filter(|_| energy.is_none()).collect();
        conserved.extend(energy);
        let said = conservation::of_observables(graph, &mut moments, diagnostics);
        conserved.retain(|found| !said.iter().any(|said| is_same(graph, problem, found, said)));
        conserved.extend(said);
        let (energy_form, even) = energy_form::find(graph, problem, equations);
        let linear_part = match even {
            Some(_) => LinearPart::Absent,
            None => gauge::linear_part(graph, problem, equations),
        };
        let total_derivatives = gauge::total_derivatives(graph, problem);
        Self { cyclic, conserved, energy_form, energy_changes, energy_rate, total_derivatives, linear_part }
    }
}

/// Returns whether a declared quantity has the name of one that was found, or is a total that was found.
fn is_same(graph: &mut Graph, problem: &Problem, found: &Conserved, said: &Conserved) -> bool {
    let is_equal = match (found.quantity, said.quantity) {
        (ConservedKind::Total(.., [total, _]), ConservedKind::Observable(observable, entry)) => {
            let difference = graph.sub(total, problem.observables[observable].values[entry]);
            vanishes(graph, problem, difference).is_some()
        }
        _ => false,
    };
    found.name == said.name || is_equal
}

/// Returns the cyclic coordinates and the conserved momenta. A momentum is conserved if L and the forces do not depend
/// on its coordinate and no constraint force acts along it.
fn momenta(graph: &mut Graph, moments: &mut Moments) -> (Vec<usize>, Vec<Conserved>) {
    let &mut Moments { problem, equations, .. } = moments;
    let (mut cyclic, mut conserved) = (Vec::new(), Vec::new());
    for a in 0..problem.coordinates.len() {
        let Some(free) = vanishes(graph, problem, equations.momentum_rate[a]) else { continue };
        let force = equations.constraint_force.get(a).copied().unwrap_or(Id::ZERO);
        let evidence = match vanishes(graph, problem, force) {
            Some(constrained) => {
                cyclic.push(a);
                Some(free.and(constrained))
            }
            // The constraint force along the coordinate is not zero in symbols, but it may vanish in every motion.
            None => found(graph, moments, equations.momentum[a]),
        };
        let (name, quantity) = (format!("p_{}", problem.coordinates[a].text), ConservedKind::Momentum(a));
        conserved.extend(evidence.map(|evidence| Conserved { name, quantity, evidence }));
    }
    (cyclic, conserved)
}
