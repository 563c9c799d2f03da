//! Constraints, observables and conserved quantities.

use indexmap::IndexMap;
use rustc_hash::FxHashMap;

use super::expression::is_literal_zero;
use super::family::Family;
use super::label::{Label, element_name, entry_names};
use super::lowering::{Definition, Lowering, MultiplierGroup, Setting};
use super::parameters::SwitchReading;
use super::problem::Observed;
use super::value::Value;
use crate::contract::is_reserved;
use crate::diagnostics::Place;
use crate::symbolic::{Id, Rational};
use crate::syntax::{Constraint, Declaration, Expression, Law, Name, Named, Sign};
use crate::variables::Variable;

/// Maximum number of constraints. It equals the limit on coordinates: more constraints would be dependent.
const CONSTRAINT_LIMIT: usize = 1000;

impl Lowering<'_> {
    /// Signed terms of the Lagrangian; empty after any error.
    pub(super) fn terms(&mut self, declaration: &Declaration) -> Vec<Id> {
        let Some(lagrangian) = declaration.lagrangian.as_ref().filter(|_| self.diagnostics.is_empty()) else {
            return Vec::new();
        };
        let lower = |(sign, term): (Sign, &Expression)| {
            let value = self.scalar(term)?;
            Some(if sign == Sign::Minus { self.graph.neg(value) } else { value })
        };
        lagrangian.terms().into_iter().filter_map(lower).collect()
    }

    /// Rejects `min`, `max` and `clamp` in expressions whose derivatives enter the equations of motion.
    pub(super) fn reject_kink(&mut self, what: &str, value: Id, place: Place) {
        let all = self.many.with_bodies(&self.graph, &[value]);
        if let Some(argument) = all.into_iter().find_map(|value| self.graph.kink(value)) {
            let place = self.kinks.get(&argument).copied().unwrap_or(place);
            let message = format!(
                "`min`, `max` and `clamp` have no place in {what}, whose slopes must be smooth: they limit forces and observables"
            );
            self.diagnostics.error(place, message);
        }
    }

    /// Conserved observables. Their time derivative must exist, so they contain no accelerations and no multipliers.
    pub(super) fn conserved(
        &mut self,
        declaration: &Declaration,
        observables: &[Observed],
    ) -> Vec<(usize, Place)> {
        let mut conserved = Vec::new();
        for (index, Observed { label, values, .. }) in observables.iter().enumerate() {
            let written = declaration.observables.iter().find(|named| named.target.name.text == label.text);
            let Some(written) = written.filter(|named| named.is_conserved) else { continue };
            if self.graph.symbols(values).any(|symbol| Variable::of(symbol).is_solved()) {
                self.diagnostics.error(
                    written.value.place,
                    "a conserved quantity is a function of time, coordinates and velocities: accelerations and multipliers have no place in it",
                );
            }
            conserved.push((index, written.value.place));
        }
        conserved
    }

    /// Constraints, and the forces of friction with the velocities that they act along.
    pub(super) fn constraints(
        &mut self,
        constraints: &[Constraint],
        powers: &mut Vec<(Id, Id)>,
    ) -> Vec<(Label, Id)> {
        let mut rows: Vec<(Label, Id)> = Vec::new();
        let mut seen: IndexMap<String, (Place, usize)> = IndexMap::new();
        for constraint in constraints {
            let name = &constraint.target.name;
            let indices = &constraint.target.indices;
            let is_one_of = |known: &usize| constraint.target.is_family() && *known == indices.len();
            match seen.get(&name.text) {
                Some((place, _)) if constraint.is_implied => {
                    let name = &name.text;
                    let message = format!(
                        "the frame that `{name}` turns brings a constraint of this name, `dot({name}, {name}) = 1`: choose another name"
                    );
                    self.diagnostics.error(*place, message);
                    continue;
                }
                Some((place, known)) if !is_one_of(known) => {
                    self.twice(name, *place, "constraints");
                    continue;
                }
                _ => seen.insert(name.text.clone(), (name.place, indices.len())),
            };
            let elements = self.elements(indices);
            let last = elements.last().cloned().unwrap_or_default();
            for element in elements {
                self.constraint(constraint, [&element, &last], &mut rows, powers);
                if rows.len() > CONSTRAINT_LIMIT {
                    let message = format!("a system has at most {CONSTRAINT_LIMIT} constraints");
                    self.diagnostics.error(name.place, message);
                    return rows;
                }
            }
        }
        rows
    }

    fn twice(&mut self, name: &Name, other: Place, what: &str) {
        let message = format!("two {what} are called `{}`", name.text);
        self.diagnostics.push(name.place.error_beside(message, other, "the other one is here"));
    }

    fn constraint(
        &mut self,
        constraint: &Constraint,
        [element, last]: [&[usize]; 2],
        rows: &mut Vec<(Label, Id)>,
        powers: &mut Vec<(Id, Id)>,
    ) {
        let indices = &constraint.target.indices;
        let residual = self.with_indices(indices, element, |lowering| lowering.residual(constraint));
        let Some(residual) = residual else {
            self.failed_constraints.push(constraint.target.name.text.clone());
            return;
        };
        if constraint.is_implied && (!self.is_of_frame(&residual) || self.is_among(&residual, rows)) {
            return;
        }
        let place = constraint.left.place.to(constraint.right.place);
        residual.flat().into_iter().for_each(|row| self.reject_kink("a constraint", row, place));
        let entry = self.entry_of_state(constraint, [element, last]);
        match &constraint.law {
            Law::Equation => {}
            Law::Contact { restitution, impact } => {
                self.contact((restitution.as_ref(), *impact), (constraint, element), rows.len(), entry);
                self.check_gap(&residual, place);
            }
            law => self.friction(law, (constraint, element), (&residual, rows.len()), entry, powers),
        }
        let mut component = 0;
        let mut switches = Vec::new();
        // A switch of 0 leaves the equation 0 = 0, and no force.
        let residual = residual.map(&mut |row| {
            let sticks = SwitchReading::Sticks(component);
            let holds = if constraint.law.is_friction() { sticks } else { SwitchReading::Holds };
            let switch = entry.map(|entry| self.read(entry, holds));
            component += 1;
            switches.push(switch);
            switch.map_or(row, |switch| self.graph.mul(switch, row))
        });
        let name = &constraint.target.name;
        let mut row = rows.len();
        let symbols = residual.map(&mut |_| {
            row += 1;
            self.graph.symbol(Variable::Multiplier(row - 1).symbol())
        });
        let texts = entry_names(&element_name(&name.text, element), &residual.shape().lengths);
        for ((text, id), switch) in texts.into_iter().zip(residual.flat()).zip(switches) {
            if rows.iter().any(|(label, _)| label.text == text) {
                self.diagnostics.error(name.place, format!("the constraint `{text}` is given twice"));
            }
            self.switches.push(switch);
            rows.push((Label { text, place: constraint.left.place.to(constraint.right.place) }, id));
        }
        let known = self.multipliers.iter().position(|group| group.name == name.text);
        let group = known.unwrap_or_else(|| {
            self.multipliers.push(MultiplierGroup { name: name.text.clone(), elements: Family::default() });
            self.multipliers.len() - 1
        });
        self.multipliers[group].elements.insert(element.to_vec(), symbols);
    }

    /// Returns whether the residual |q|² − 1 belongs to a quaternion that turns a frame. After an error this may be
    /// unknown, so the outline assumes it.
    fn is_of_frame(&mut self, residual: &Value) -> bool {
        let Some(residual) = residual.as_scalar() else { return self.is_guessing };
        let (square, graph) = (self.graph.add(residual, Id::ONE), &mut self.graph);
        self.is_guessing || self.frames.quaternions.iter().any(|q| graph.dot(q, q) == square)
    }

    /// First of the four coordinates of each quaternion that turns a frame, among this many coordinates.
    pub(super) fn quaternions(&mut self, coordinates: usize) -> Vec<usize> {
        let mut at = |i: usize| self.graph.symbol(Variable::Coordinate(i).symbol());
        let fours: Vec<[Id; 4]> =
            (3..coordinates).map(|last| [last - 3, last - 2, last - 1, last].map(&mut at)).collect();
        (0..fours.len()).filter(|&first| self.frames.quaternions.contains(&fours[first])).collect()
    }

    /// Returns whether the residual times ±1 or ±½ is already a constraint.
    fn is_among(&mut self, residual: &Value, rows: &[(Label, Id)]) -> bool {
        let Some(residual) = residual.as_scalar() else { return false };
        let factors = [(1, 1), (-1, 1), (1, 2), (-1, 2)].map(|(above, below)| Rational::new(above, below));
        let multiples = factors.map(|factor| self.graph.sum([(residual, factor)]));
        rows.iter().any(|(_, row)| multiples.contains(row))
    }

    /// Residual of a constraint: left side − right side.
    pub(super) fn residual(&mut self, constraint: &Constraint) -> Option<Value> {
        let (left, right) = (self.lower(&constraint.left), self.lower(&constraint.right));
        let (left, right) = (left?, right?);
        if is_literal_zero(&constraint.right) {
            return Some(left);
        }
        if is_literal_zero(&constraint.left) {
            return Some(right.map(&mut |id| self.graph.neg(id)));
        }
        self.meeting(&left.shape(), &right, constraint.right.place, "the other side")?;
        self.along_what_axes(&[(&left, constraint.left.place), (&right, constraint.right.place)])?;
        let terms = [(left, Rational::from_integer(1)), (right, Rational::from_integer(-1))];
        Some(Value::combination(&terms, &mut self.graph))
    }

    pub(super) fn observables(&mut self, declaration: &Declaration) -> Vec<Observed> {
        self.setting = Setting::Observable;
        let mut observables = Vec::new();
        for (position, observable) in declaration.observables.iter().enumerate() {
            let name = &observable.target.name;
            if is_reserved(&name.text) {
                let message = format!("every system has a method `{}`: choose another name", name.text);
                self.diagnostics.error(name.place, message);
                continue;
            }
            let earlier =
                declaration.observables[..position].iter().find(|known| known.target.name.text == name.text);
            if let Some(earlier) = earlier {
                self.twice(name, earlier.target.name.place, "observables");
                continue;
            }
            let is_known = self.refuse_open_observable(&observable.target);
            let Some(value) = is_known.and_then(|()| self.observed(observable)) else { continue };
            let lengths = value.lengths();
            if lengths.len() > 2 {
                let message =
                    format!("an observable is a scalar, a vector or a matrix, but this is {}", value.shape());
                self.diagnostics.error(observable.value.place, message);
                continue;
            }
            let label = Label { text: name.text.clone(), place: name.place };
            observables.push(Observed { label, lengths, values: value.flat() });
            self.observables.push((name.text.clone(), value));
        }
        observables
    }

    /// Value of an observable; the elements of a family form an array.
    pub(super) fn observed(&mut self, Named { target, value, .. }: &Named) -> Option<Value> {
        let mut family = Family::default();
        for element in self.elements(&target.indices) {
            let value = self.with_indices(&target.indices, &element, |lowering| lowering.lower(value))?;
            family.insert(element, value);
        }
        if let Some(gap) = family.gap(&[]) {
            let missing = element_name(&target.name.text, &gap);
            let message = format!("the elements of an observable begin at 0: `{missing}` is missing");
            return self.report(target.name.place, message);
        }
        self.even(family.part(&[])?, value.place)
    }

    /// Names that definitions give to nodes; the first name wins.
    pub(super) fn names(&self, declaration: &Declaration) -> FxHashMap<Id, String> {
        let mut names = FxHashMap::default();
        for (name, value) in self.defined(declaration) {
            let texts = entry_names(&name, &value.shape().lengths);
            for (text, id) in texts.into_iter().zip(value.flat()) {
                names.entry(id).or_insert(text);
            }
        }
        names
    }

    /// Names of the definitions that are vectors, with the numbers of their components.
    pub(super) fn vectors(&self, declaration: &Declaration) -> Vec<(String, usize)> {
        let vector = |(name, value): (String, &Value)| match value.shape().lengths[..] {
            [length] => Some((name, length)),
            _ => None,
        };
        self.defined(declaration).filter_map(vector).collect()
    }

    /// Values of the definitions and of the elements of families, by name.
    fn defined(&self, declaration: &Declaration) -> impl Iterator<Item = (String, &Value)> {
        declaration.defines.iter().zip(&self.definitions).flat_map(|(define, definition)| {
            let elements: Vec<(&[usize], &Value)> = match definition {
                Definition::Value(value) => vec![(&[], value)],
                Definition::Family(family) => family.iter().collect(),
                _ => Vec::new(),
            };
            let name = |element| element_name(&define.target.name.text, element);
            elements.into_iter().map(move |(element, value)| (name(element), value))
        })
    }
}
