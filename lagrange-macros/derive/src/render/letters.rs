//! Symbols that the page defines: L, E, H, momenta p, … Each is the first of its letters that reads like no name of the system,
//! with indices or without: where a field E is a vector, the energy is ℰ.

use rustc_hash::FxHashSet;

use super::formula::Formula;
use super::roots::{names_of, written_base};
use crate::mechanics::{Conserved, ConservedKind, Derived, EnergyForm, Symmetry};
use crate::resolve::{Problem, vector};
use crate::syntax::Declaration;

/// Quantity that has a symbol on the page.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum PageQuantity {
    Lagrangian,
    Energy,
    Hamiltonian,
    Kinetic,
    Potential,
    /// Potential beside the bodies of a page.
    PotentialBesideBodies,
    Dissipation,
    /// Momentum of a coordinate.
    Momentum,
    Power,
    /// Momentum of all vectors together.
    TotalMomentum,
    AngularMomentum,
    /// Force of constraint on a coordinate.
    ConstraintForce,
    /// Force on a coordinate.
    Force,
    /// Multiplier of a constraint.
    Multiplier,
    /// Angular velocity of a quaternion.
    AngularVelocity,
    /// Moments of inertia of the body that a quaternion turns.
    Inertia,
    /// The term b of constraints F q̇ + b = 0.
    Inhomogeneous,
}

use PageQuantity::*;

/// Letters of each symbol, in the order of [`PageQuantity`].
const LETTERS: [(PageQuantity, &[&str]); 17] = [
    (Lagrangian, &["L", "ℒ"]),
    (Energy, &["E", "ℰ"]),
    (Hamiltonian, &["H", "ℋ"]),
    (Kinetic, &["T", "K"]),
    (Potential, &["U", "V", "Phi"]),
    (PotentialBesideBodies, &["V", "W"]),
    (Dissipation, &["D", "ℱ"]),
    (Momentum, &["p", "P", "Pi"]),
    (Power, &["P", "𝒫"]),
    (TotalMomentum, &["P", "Pi"]),
    (AngularMomentum, &["J", "𝒥"]),
    (ConstraintForce, &["R", "ℛ"]),
    (Force, &["Q", "𝒬"]),
    (Multiplier, &["lambda", "Lambda"]),
    (AngularVelocity, &["omega", "Omega"]),
    (Inertia, &["I", "Theta"]),
    (Inhomogeneous, &["b", "beta"]),
];

/// Letter of each symbol of a page, as it is written in attributes: `lambda`.
pub(super) struct Letters([String; LETTERS.len()]);

impl Symmetry {
    /// The total that it conserves.
    pub(super) fn quantity(self) -> PageQuantity {
        match self {
            Self::Translation => TotalMomentum,
            Self::Rotation => AngularMomentum,
        }
    }
}

impl Letters {
    pub(super) fn of(declaration: &Declaration, problem: &Problem, derived: &Derived) -> Self {
        let taken = taken(declaration, problem);
        let is_free = |name: &str| !taken.contains(&written_base(name));
        let (mut chosen, mut on_page) = (Vec::new(), FxHashSet::default());
        for (quantity, letters) in LETTERS {
            let behind = behind(quantity, problem, derived);
            let fits = |letter: &String| {
                !on_page.contains(letter) && behind.iter().all(|behind| is_free(&format!("{letter}{behind}")))
            };
            let numbered = (1..).map(|number| format!("{}_{number}", letters[0]));
            let mut all = letters.iter().map(|&letter| letter.to_owned()).chain(numbered);
            let letter = all.find(fits).expect("numbers do not end");
            on_page.extend((!behind.is_empty()).then(|| letter.clone()));
            chosen.push(letter);
        }
        Self(std::array::from_fn(|place| std::mem::take(&mut chosen[place])))
    }

    pub(super) fn letter(&self, quantity: PageQuantity) -> &str {
        &self.0[quantity as usize]
    }

    pub(super) fn name(&self, quantity: PageQuantity) -> Formula {
        Formula::labelled(self.letter(quantity), 0)
    }

    /// Flat name of a symbol of a coordinate or quaternion: `p_x` of the momentum of `x`.
    pub(super) fn text_of(&self, quantity: PageQuantity, text: &str) -> String {
        format!("{}_{text}", self.letter(quantity))
    }

    /// The symbol of a coordinate or quaternion, with dots.
    pub(super) fn name_of(&self, quantity: PageQuantity, text: &str, dots: usize) -> Formula {
        Formula::labelled(&self.text_of(quantity, text), dots)
    }

    /// The name with the first letter of its symbol, by which programs ask for its row: `p_x` for P_x.
    pub(super) fn standard(&self, name: &Formula) -> Formula {
        let Formula::Name { base, dots, indices } = name else { return name.clone() };
        let found = LETTERS.iter().zip(&self.0).find_map(|((_, letters), chosen)| {
            let behind = base.strip_prefix(chosen.as_str())?;
            (behind.is_empty() || behind.starts_with('_')).then(|| format!("{}{behind}", letters[0]))
        });
        Formula::Name { base: found.unwrap_or_else(|| base.clone()), dots: *dots, indices: indices.clone() }
    }
}

/// What stands behind the letter of a symbol wherever the page has it: `_x` for the momentum of x. Nothing if it is not on the page.
fn behind(quantity: PageQuantity, problem: &Problem, derived: &Derived) -> Vec<String> {
    let facts = &derived.facts;
    let coordinates = || problem.coordinates.iter().map(|label| &*label.text).collect();
    let quaternions = || {
        let first = derived.turnings.all.iter().map(|turning| &*problem.coordinates[turning.first].text);
        first.filter_map(vector).collect()
    };
    let has_total = |symmetry| {
        let is_it = |conserved: &Conserved| matches!(conserved.quantity, ConservedKind::Total(of, ..) if of == symmetry);
        facts.conserved.iter().any(is_it)
    };
    let changes = !facts.energy_changes.is_empty();
    let (names, is_alone): (Vec<&str>, bool) = match quantity {
        Lagrangian => (vec!["0", "2"], true),
        Momentum => (coordinates(), matches!(facts.energy_form, EnergyForm::General)),
        ConstraintForce => (coordinates(), false),
        Force => (coordinates(), changes),
        Multiplier => (problem.constraints.iter().map(|(label, _)| &*label.text).collect(), changes),
        Power => (Vec::new(), !problem.powers.is_empty()),
        TotalMomentum => (Vec::new(), has_total(Symmetry::Translation)),
        AngularMomentum => (Vec::new(), has_total(Symmetry::Rotation)),
        AngularVelocity | Inertia => (quaternions(), false),
        _ => (Vec::new(), true),
    };
    let below = names.into_iter().map(|name| format!("_{name}"));
    is_alone.then(String::new).into_iter().chain(below).collect()
}

/// Names of the system, as they are written without indices.
fn taken(declaration: &Declaration, problem: &Problem) -> FxHashSet<String> {
    let formals = declaration.defines.iter().filter_map(|define| define.formals.as_ref()).flatten();
    let formals = formals.map(|formal| formal.text.clone());
    let frames = problem.frame_names.iter().map(|(_, name)| name.clone());
    let constraints = problem.constraints.iter().map(|(label, _)| label.text.clone());
    let conserved = declaration.observables.iter().filter(|observable| observable.is_conserved);
    let conserved = conserved.map(|observable| observable.target.name.text.clone());
    let all = names_of(problem).chain(formals).chain(frames).chain(constraints).chain(conserved);
    all.map(|name| written_base(&name)).collect()
}
