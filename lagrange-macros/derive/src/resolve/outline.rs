//! Outline of a system: the counts and methods that the rest of a program relies on. The outline is read as far as
//! possible even after errors, so that one error does not cause others in the code that uses the system.

use super::label::Label;
use super::lowering::{Lowering, Setting};
use super::many::Many;
use super::parameters::Parameters;
use super::scope::{Entity, Scope};
use super::value::Value;
use crate::contract::is_reserved;
use crate::diagnostics::Diagnostics;
use crate::symbolic::Id;
use crate::syntax::{Constraint, Coordinate, Declaration, Expression, Kind, Name};
use crate::variables::Variable;

/// Maximum number of erroneous values that get a stand-in from their parts. Each is lowered twice, and so are its
/// erroneous parts.
const GUESSES: usize = 1000;

/// Counts and observables of a system.
pub(crate) struct Outline {
    /// Scalar type of the system.
    pub(crate) scalar: syn::Type,
    /// Number of scalar coordinates; `None` if a coordinate could not be parsed.
    pub(crate) coordinates: Option<usize>,
    pub(crate) constraints: usize,
    pub(crate) parameters: usize,
    pub(crate) observables: Vec<Observable>,
}

/// Name and shape of an observable.
pub(crate) struct Observable {
    pub(crate) name: Name,
    /// Array lengths of its value; none for a scalar.
    pub(crate) lengths: Vec<usize>,
    pub(crate) needs_solution: bool,
}

/// Lowers all expressions to find the outline. Errors are not reported here.
pub(crate) fn outline(declaration: &Declaration) -> Outline {
    let diagnostics = &mut Diagnostics::default();
    let scope = Scope::new(declaration, diagnostics);
    let parameters = Parameters::new(declaration, diagnostics);
    let many = Many::of(declaration, &parameters, diagnostics);
    let mut lowering = Lowering::new(scope, (parameters, many), declaration, diagnostics);
    lowering.is_guessing = true;
    // The second pass resolves definitions that are used above the line that defines them.
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
    let rows = lowering.constraints(&declaration.constraints, &mut Vec::new());
    let is_row_of = |label: &Label, name: &str| {
        label.text.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('['))
    };
    let count = |constraint: &Constraint| match constraint.is_implied {
        // An implied constraint has no row of its own if a declared constraint already states it.
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
    /// Number of scalar equations of a constraint. Each element of a family has as many as the first. A constraint
    /// of unknown value counts as one equation.
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

    /// Stand-in for an erroneous value: has the shape that the expression suggests, and depends on all symbols of its
    /// parts.
    pub(super) fn stand_in(&mut self, expression: &Expression) -> Value {
        self.guesses += 1;
        let is_simple = self.guesses <= GUESSES;
        let parts: Vec<Value> = expression
            .parts()
            .into_iter()
            .filter(|_| is_simple)
            .filter_map(|part| self.lower(part))
            .collect();
        // The symbol t represents the unknown value: a number, such as zero, would let expressions simplify.
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
        // Later operations assume that no array is empty.
        length.map_or(Value::Scalar(sum), |length| Value::vector(vec![sum; length.max(1)]))
    }
}
