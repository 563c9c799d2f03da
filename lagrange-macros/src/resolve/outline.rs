//! What the rest of a program relies on: how many of what there is, and which methods. It is found where something is
//! wrong too, as far as it can be, so that one error does not bring others about.

use super::Parameters;
use super::lower::{Lowering, Setting};
use super::scope::{Entity, Scope};
use super::value::Value;
use crate::contract::is_reserved;
use crate::diagnostics::Diagnostics;
use crate::syntax::{Constraint, Declaration, Expression, Kind, Name};
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
    /// How many numbers it is.
    pub(crate) length: usize,
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
    let forces = declaration.forces.iter().map(|force| &force.value);
    let powers = declaration.powers.iter().flat_map(|power| [&power.force, &power.velocity]);
    for expression in
        declaration.lagrangian.iter().chain(&declaration.dissipation).chain(forces).chain(powers)
    {
        lowering.lower(expression);
    }
    let rows = lowering.constraints(&declaration.constraints);
    let is_there = |constraint: &&Constraint| {
        !constraint.is_implied || rows.iter().any(|(label, _)| label.text == constraint.target.name.text)
    };
    let constraints = declaration.constraints.iter().filter(is_there);
    let constraints = constraints.map(|constraint| lowering.rows(constraint)).sum::<usize>();
    let observables = lowering.observables_seen(declaration);
    let parameters = lowering.parameters;
    let length = |coordinate: &crate::syntax::Coordinate| coordinate.length.unwrap_or(1);
    Outline {
        scalar: parameters.likely_scalar(declaration),
        coordinates: declaration
            .are_coordinates_read
            .then(|| declaration.coordinates.iter().map(length).sum()),
        constraints,
        parameters: parameters.entries.len(),
        observables,
    }
}

impl Lowering<'_> {
    /// How many equations a constraint is; all elements of a family are as many, and what cannot be told is one.
    fn rows(&mut self, constraint: &Constraint) -> usize {
        let elements = self.elements(&constraint.target);
        let first = elements.first().copied().flatten();
        let value = self.with_index(&constraint.target, first, |lowering| {
            lowering.residual(constraint).or_else(|| lowering.lower(&constraint.left))
        });
        elements.len().max(1) * value.map_or(1, |value| value.count())
    }

    fn observables_seen(&mut self, declaration: &Declaration) -> Vec<Observable> {
        self.setting = Setting::Observable;
        let mut seen: Vec<Observable> = Vec::new();
        for observable in &declaration.observables {
            let name = &observable.name;
            if is_reserved(&name.text) || seen.iter().any(|known| known.name.text == name.text) {
                continue;
            }
            let value = self.lower(&observable.value).unwrap_or(Value::Vector(Vec::new()));
            let length = value.as_vector().map_or(1, |entries| entries.len().max(1));
            let needs_solution =
                self.graph.symbols(&value.flat()).any(|symbol| Variable::of(symbol).is_solved());
            self.observables.push((name.text.clone(), value));
            seen.push(Observable { name: name.clone(), length, needs_solution });
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
                (_, Some(Entity::Function(index))) => self.functions[index].length,
                ("cross" | "der" | "quat_rotate" | "quat_mul" | "quat_conj", _) => vector,
                ("lambda", _) => {
                    contents.push(self.graph.symbol(Variable::Multiplier(0).symbol()));
                    None
                }
                _ => None,
            },
            Kind::Number(_) | Kind::Name(_) | Kind::Index(..) | Kind::Power(..) => None,
        };
        let sum = self.graph.total(contents);
        length.map_or(Value::Scalar(sum), |length| Value::vector(vec![sum; length]))
    }
}
