//! Names of arrays: vectors, matrices, and arrays of them.

use rustc_hash::FxHashSet;

use super::axes::named_axes;
use super::formula::Formula;
use super::letters::{Letters, PageQuantity};
use super::links::BodyNames;
use super::roots::{is_taken, taken};
use crate::mechanics::Derived;
use crate::resolve::Problem;

/// Set of array names, with empty brackets for each index: `r`, `p[]`, `link[].c`.
pub(super) struct Arrays(FxHashSet<String>);

impl Arrays {
    pub(super) fn of(problem: &Problem, derived: &Derived, letters: &Letters) -> Self {
        let turnings = &derived.turnings;
        let mut arrays = Self(FxHashSet::default());
        for label in &problem.coordinates {
            arrays.add(&label.text);
            let of_coordinate = [PageQuantity::Momentum, PageQuantity::ConstraintForce, PageQuantity::Force];
            of_coordinate.iter().for_each(|&quantity| arrays.add(&letters.text_of(quantity, &label.text)));
        }
        let totals = [PageQuantity::TotalMomentum, PageQuantity::AngularMomentum];
        totals.iter().for_each(|&total| arrays.add(&format!("{}[0]", letters.letter(total))));
        (0..problem.parameters.entries.len()).for_each(|k| arrays.add(&problem.parameters.name(k)));
        for turning in &turnings.all {
            let quaternion = problem.coordinates[turning.first].text.trim_end_matches("[0]");
            let [rate, inertia] = [PageQuantity::AngularVelocity, PageQuantity::Inertia]
                .map(|quantity| letters.text_of(quantity, quaternion));
            [rate, inertia].iter().for_each(|name| arrays.add(&format!("{name}[0]")));
        }
        named_axes(problem, turnings).iter().for_each(|axes| arrays.add(&format!("{}[0][0]", axes.text)));
        BodyNames::of(problem, derived, letters).iter().for_each(|names| arrays.add_bodies(names));
        let taken = taken(problem);
        let is_free = |name: &&str| !is_taken(&taken, name);
        let constraints = problem.constraints.iter().map(|(label, _)| &*label.text);
        constraints.filter(is_free).for_each(|name| arrays.add(name));
        problem.names.values().for_each(|name| arrays.add(name));
        problem.functions.iter().flat_map(|function| &function.names).for_each(|name| arrays.add(name));
        problem.observables.iter().flat_map(|observed| observed.names()).for_each(|name| arrays.add(&name));
        arrays
    }

    /// Adds every array that contains an entry.
    fn add(&mut self, entry: &str) {
        let mut key = key(&Formula::labelled(entry, 0)).unwrap_or_default();
        while key.ends_with("[]") {
            key.truncate(key.len() - 2);
            self.0.insert(key.clone());
        }
    }

    fn add_bodies(&mut self, BodyNames { links, bodies, .. }: &BodyNames) {
        let matrices =
            links.iter().flat_map(|link| &link.axes).chain(bodies.iter().map(|body| &body.inertia));
        matrices.for_each(|matrix| self.add(&format!("{matrix}[0][0]")));
        let of_bodies = bodies.iter().flat_map(|body| [&body.position, &body.force, &body.torque]);
        let vectors = links.iter().map(|link| &link.rate).chain(of_bodies);
        vectors.for_each(|vector| self.add(&format!("{vector}[0]")));
    }

    pub(super) fn contains(&self, formula: &Formula) -> bool {
        key(formula).is_some_and(|key| self.0.contains(&key))
    }
}

fn key(formula: &Formula) -> Option<String> {
    match formula {
        Formula::Name { base, indices, .. } => Some(base.clone() + &"[]".repeat(indices.len())),
        Formula::Member(of, member) => Some(format!("{}.{}", key(of)?, key(member)?)),
        _ => None,
    }
}
