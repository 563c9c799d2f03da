//! What the rest of a program relies on: how many of what there is, and which methods. It is found where something is
//! wrong too, as far as it can be, so that one error does not bring others about.

use super::label::Label;
use super::lowering::{Lowering, Setting};
use super::parameters::Parameters;
use super::scope::{Entity, Scope};
use super::value::Value;
use crate::contract::is_reserved;
use crate::diagnostics::Diagnostics;
use crate::symbolic::Id;
use crate::syntax::{Constraint, Coordinate, Declaration, Expression, Kind, Name};
use crate::variables::Variable;

/// As many wrong values are looked into: each is read twice, and so is what is wrong in it.
const GUESSES: usize = 1000;

/// A system seen from outside.
pub(crate) struct Outline {
    /// The number type.
    pub(crate) scalar: syn::Type,
    /// How many coordinates there are; `None` where not all could be read.
    pub(crate) coordinates: Option<usize>,
    pub(crate) constraints: usize,
    pub(crate) parameters: usize,
    pub(crate) observables: Vec<Observable>,
}

/// An observable seen from outside.
pub(crate) struct Observable {
    pub(crate) name: Name,
    /// The lengths of the arrays that it is.
    pub(crate) lengths: Vec<usize>,
    pub(crate) needs_solution: bool,
}

/// Reads the expressions for what they are outside. Errors are not reported.
pub(crate) fn outline(declaration: &Declaration) -> Outline {
    let diagnostics = &mut Diagnostics::default();
    let scope = Scope::new(declaration, diagnostics);
    let parameters = Parameters::new(declaration, diagnostics);
    let mut lowering = Lowering::new(scope, parameters, declaration, diagnostics);
    lowering.is_guessing = true;
    // Once more for what is defined further down than where it is used.
    lowering.define_all();
    lowering.define_all();
    let alone = declaration.lagrangian.iter().chain(&declaration.dissipation).map(|alone| (&[][..], alone));
    let forces = declaration.forces.iter().map(|force| (&force.target.indices[..], &force.value));
    let powers = declaration.powers.iter();
    let powers =
        powers.flat_map(|power| [&power.force, &power.velocity].map(|part| (&power.indices[..], part)));
    for (indices, expression) in alone.chain(forces).chain(powers) {
        for element in lowering.elements(indices) {
            lowering.with_indices(indices, &element, |lowering| lowering.lower(expression));
        }
    }
    let rows = lowering.constraints(&declaration.constraints);
    let is_row_of = |label: &Label, name: &str| {
        label.text.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('['))
    };
    let count = |constraint: &Constraint| match constraint.is_implied {
        // Another constraint may say the same already.
        true => rows.iter().filter(|(label, _)| is_row_of(label, &constraint.target.name.text)).count(),
        false => lowering.rows(constraint),
    };
    let constraints = declaration.constraints.iter().map(count).sum::<usize>();
    let observables = lowering.observables_seen(declaration);
    let parameters = lowering.parameters;
    Outline {
        scalar: parameters.likely_scalar(declaration),
        coordinates: declaration
            .are_coordinates_read
            .then(|| declaration.coordinates.iter().map(Coordinate::count).sum()),
        constraints,
        parameters: parameters.entries.len(),
        observables,
    }
}

impl Lowering<'_> {
    /// How many equations a constraint is; all elements of a family are as many, and what cannot be told is one.
    fn rows(&mut self, constraint: &Constraint) -> usize {
        let indices = &constraint.target.indices;
        let elements = self.elements(indices);
        let first = elements.first().cloned().unwrap_or_default();
        let value = self.with_indices(indices, &first, |lowering| {
            lowering.residual(constraint).or_else(|| lowering.lower(&constraint.left))
        });
        elements.len().max(1) * value.map_or(1, |value| value.count())
    }

    fn observables_seen(&mut self, declaration: &Declaration) -> Vec<Observable> {
        self.setting = Setting::Observable;
        let mut seen: Vec<Observable> = Vec::new();
        for observable in &declaration.observables {
            let name = &observable.target.name;
            if is_reserved(&name.text) || seen.iter().any(|known| known.name.text == name.text) {
                continue;
            }
            let value = self.observed(observable).unwrap_or(Value::Scalar(Id::ZERO));
            let lengths = value.lengths();
            let needs_solution =
                self.graph.symbols(&value.flat()).any(|symbol| Variable::of(symbol).is_solved());
            self.observables.push((name.text.clone(), value));
            seen.push(Observable { name: name.clone(), lengths, needs_solution });
        }
        seen
    }

    /// In place of a value that is wrong: one of the shape that it seems to have, with all in it that is in its parts.
    pub(super) fn stand_in(&mut self, expression: &Expression) -> Value {
        self.guesses += 1;
        let is_simple = self.guesses <= GUESSES;
        let parts: Vec<Value> = expression
            .parts()
            .into_iter()
            .filter(|_| is_simple)
            .filter_map(|part| self.lower(part))
            .collect();
        // Time for what is not known: it is neither zero nor any other number.
        let mut contents = vec![self.graph.symbol(Variable::Time.symbol())];
        contents.extend(parts.iter().flat_map(Value::flat));
        let vector = parts.iter().find_map(Value::length);
        let length = match &expression.kind {
            Kind::Vector(items) => Some(items.len()),
            Kind::Slice(_) => vector,
            Kind::Negative(_) | Kind::Sum(_) | Kind::SumOver(_) | Kind::Product(_) => vector,
            Kind::Call(name, _) => match (name.text.as_str(), self.scope.get(&name.text)) {
                (_, Some(Entity::Function(index))) => self.functions[index].lengths.first().copied(),
                ("cross" | "der" | "quat_rotate" | "quat_mul" | "quat_conj", _) => vector,
                ("lambda", _) => {
                    contents.push(self.graph.symbol(Variable::Multiplier(0).symbol()));
                    None
                }
                _ => None,
            },
            Kind::Number(_) | Kind::Name(_) | Kind::Index(..) | Kind::Member(..) | Kind::Power(..) => None,
        };
        let sum = self.graph.total(contents);
        // No array is empty, as all that is made of them relies on.
        length.map_or(Value::Scalar(sum), |length| Value::vector(vec![sum; length.max(1)]))
    }
}
