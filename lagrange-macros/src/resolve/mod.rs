//! From a [`Declaration`] to a [`Problem`]: every name bound, every expression a scalar in the graph.

mod call;
mod family;
mod function;
mod lower;
mod parameters;
mod quaternion;
mod scope;
mod value;

use indexmap::IndexMap;
use rustc_hash::FxHashMap;

use crate::diagnostics::{Diagnostics, Place};
use crate::symbolic::{Graph, Id, Rational, Symbol};
use crate::syntax::{Constraint, Declaration, Expression, Sign, Target, TargetIndex};
use crate::variables::Variable;
pub(crate) use function::Supplied;
use lower::{Definition, Lowering, MultiplierGroup, Setting, is_literal_zero};
pub(crate) use lower::{fault_message, total_time_derivative};
pub(crate) use parameters::{Element, Parameters, is_no_number};
pub(crate) use scope::is_built_in;
use scope::{Entity, Scope};
use value::Value;

/// A mechanical system in the graph.
pub(crate) struct Problem {
    pub(crate) graph: Graph,
    pub(crate) coordinates: Vec<Label>,
    pub(crate) lagrangian: Id,
    /// The terms of the sum that the Lagrangian is, as written.
    pub(crate) terms: Vec<Id>,
    /// Where the Lagrangian stands.
    pub(crate) place: Place,
    /// Q of each coordinate without the dissipation.
    pub(crate) forces: Vec<Id>,
    pub(crate) dissipation: Option<(Id, Place)>,
    /// Φ or F q̇ + b as written: left − right.
    pub(crate) constraints: Vec<(Label, Id)>,
    pub(crate) observables: Vec<(Label, Vec<Id>)>,
    /// The observables that are said to be conserved, and where.
    pub(crate) conserved: Vec<(usize, Place)>,
    pub(crate) parameters: Parameters,
    pub(crate) functions: Vec<Supplied>,
    /// Names of nodes that are definitions.
    pub(crate) names: FxHashMap<Id, String>,
}

/// A name for users to read, and where it was given.
#[derive(Clone, Debug)]
pub(crate) struct Label {
    pub(crate) text: String,
    pub(crate) place: Place,
}

impl Problem {
    /// The interval from which random values of a symbol are drawn.
    pub(crate) fn range(&self, symbol: Symbol) -> (f64, f64) {
        match Variable::of(symbol) {
            Variable::Parameter(k) => self.parameters.ranges[self.parameters.entries[k].field],
            _ => (-1.25, 1.75),
        }
    }
}

/// Gives every expression its meaning; `None` where something was wrong, which is then reported.
pub(crate) fn problem(declaration: &Declaration, diagnostics: &mut Diagnostics) -> Option<Problem> {
    let scope = Scope::new(declaration, diagnostics);
    let functions = function::supplied(declaration, &scope, diagnostics);
    let parameters = Parameters::new(declaration, diagnostics);
    let mut lowering = Lowering::new(scope, parameters, declaration, diagnostics);
    lowering.define_all();
    let lagrangian = declaration.lagrangian.as_ref().and_then(|lagrangian| lowering.scalar(lagrangian));
    let terms = lowering.terms(declaration);
    let forces = lowering.forces(declaration);
    let dissipation =
        declaration.dissipation.as_ref().map(|function| (lowering.scalar(function), function.place));
    let constraints = lowering.constraints(&declaration.constraints);
    let observables = lowering.observables(declaration);
    let conserved = lowering.conserved(declaration, &observables);
    let names = lowering.names(declaration);
    let coordinates = labels(declaration);
    let Lowering { graph, parameters, diagnostics, .. } = lowering;
    let (place, lagrangian) = (declaration.lagrangian.as_ref()?.place, lagrangian?);
    let dissipation = match dissipation {
        Some((value, place)) => Some((value?, place)),
        None => None,
    };
    diagnostics.is_empty().then_some(Problem {
        graph,
        coordinates,
        lagrangian,
        terms,
        place,
        forces,
        dissipation,
        constraints,
        observables,
        conserved,
        parameters,
        functions,
        names,
    })
}

/// Flat names of the coordinates: `x`, `r[0]`, `r[1]`.
pub(crate) fn labels(declaration: &Declaration) -> Vec<Label> {
    let elements = declaration.coordinates.iter().flat_map(|coordinate| {
        let (text, place) = (&coordinate.name.text, coordinate.name.place);
        let element = move |i: Option<usize>| Label { text: element_name(text, i), place };
        match coordinate.length {
            None => vec![element(None)],
            Some(length) => (0..length).map(|i| element(Some(i))).collect(),
        }
    });
    elements.collect()
}

fn element_name(name: &str, index: Option<usize>) -> String {
    index.map_or_else(|| name.to_owned(), |i| format!("{name}[{i}]"))
}

/// `x` of a scalar, `x[0]`, `x[1]` of a vector, `x[0][1]` of rows.
fn entry_names(name: &str, value: &Value) -> Vec<String> {
    match value {
        Value::Scalar(_) => vec![name.to_owned()],
        Value::Vector(items) => {
            let rows = items.iter().enumerate();
            rows.flat_map(|(i, item)| entry_names(&format!("{name}[{i}]"), item)).collect()
        }
    }
}

impl Lowering<'_> {
    /// The Lagrangian term by term, once it is known to be right.
    fn terms(&mut self, declaration: &Declaration) -> Vec<Id> {
        let Some(lagrangian) = declaration.lagrangian.as_ref().filter(|_| self.diagnostics.is_empty()) else {
            return Vec::new();
        };
        let lower = |(sign, term): (Sign, &Expression)| {
            let value = self.scalar(term)?;
            Some(if sign == Sign::Minus { self.graph.neg(value) } else { value })
        };
        lagrangian.terms().into_iter().filter_map(lower).collect()
    }

    /// A conserved quantity has a rate of change, so it contains no accelerations and no multipliers.
    fn conserved(
        &mut self,
        declaration: &Declaration,
        observables: &[(Label, Vec<Id>)],
    ) -> Vec<(usize, Place)> {
        let mut conserved = Vec::new();
        for (index, (label, values)) in observables.iter().enumerate() {
            let written = declaration.observables.iter().find(|named| named.name.text == label.text);
            let Some(written) = written.filter(|named| named.is_conserved) else { continue };
            let solved =
                |symbol| matches!(Variable::of(symbol), Variable::Acceleration(_) | Variable::Multiplier(_));
            if self.graph.symbols(values).any(solved) {
                self.diagnostics.error(
                    written.value.place,
                    "a conserved quantity is a function of time, coordinates and velocities: accelerations and multipliers have no place in it",
                );
            }
            conserved.push((index, written.value.place));
        }
        conserved
    }

    fn forces(&mut self, declaration: &Declaration) -> Vec<Id> {
        let count = declaration.coordinates.iter().map(|coordinate| coordinate.length.unwrap_or(1)).sum();
        let mut forces = vec![Id::ZERO; count];
        for force in &declaration.forces {
            let name = &force.target.name;
            let Some(Entity::Coordinate(index)) = self.scope.get(&name.text) else {
                let coordinates = self.coordinates.iter().map(|coordinate| coordinate.name.text.as_str());
                let near = match self.scope.get(&name.text) {
                    Some(Entity::Velocity(index)) => Some(self.coordinates[index].name.text.as_str()),
                    _ => scope::nearest(&name.text, coordinates),
                };
                let advice = near.map(|near| format!(": did you mean `{near}`?")).unwrap_or_default();
                let message = format!("a force acts on a coordinate, and `{}` is none{advice}", name.text);
                self.diagnostics.error(name.place, message);
                continue;
            };
            for element in self.elements(&force.target) {
                let value = self.with_index(&force.target, element, |lowering| lowering.lower(&force.value));
                if let Some(value) = value {
                    self.add_force(&mut forces, index, element, &force.target, &force.value, &value);
                }
            }
        }
        forces
    }

    fn add_force(
        &mut self,
        forces: &mut [Id],
        coordinate: usize,
        element: Option<usize>,
        target: &Target,
        expression: &Expression,
        value: &Value,
    ) {
        let length = self.coordinates[coordinate].length;
        let offset = self.offsets[coordinate];
        let (start, wanted) = match (element, length) {
            (None, length) => (offset, length.unwrap_or(1)),
            (Some(i), Some(length)) if i < length => (offset + i, 1),
            (Some(i), _) => {
                let message = format!("there is no coordinate `{}[{i}]`", target.name.text);
                return self.diagnostics.error(target.name.place, message);
            }
        };
        let entries = value.flat();
        let is_vector = element.is_none() && length.is_some();
        if is_literal_zero(expression) {
            return;
        }
        if entries.len() != wanted || is_vector != value.as_vector().is_some() {
            let wanted = if is_vector { format!("a vector of {wanted}") } else { "a scalar".to_owned() };
            let message =
                format!("the force on `{}` is {wanted}, but this is {}", target.name.text, value.shape());
            return self.diagnostics.error(expression.place, message);
        }
        for (slot, entry) in forces[start..].iter_mut().zip(entries) {
            *slot = self.graph.add(*slot, entry);
        }
    }

    fn constraints(&mut self, constraints: &[Constraint]) -> Vec<(Label, Id)> {
        let mut rows: Vec<(Label, Id)> = Vec::new();
        let mut seen: IndexMap<String, (Place, bool)> = IndexMap::new();
        for constraint in constraints {
            let name = &constraint.target.name;
            let is_family = !matches!(constraint.target.index, TargetIndex::None);
            match seen.get(&name.text) {
                Some((place, family)) if !(is_family && *family) => {
                    let mut error = name.place.error(format!("two constraints are called `{}`", name.text));
                    error.combine(place.error("the other one is here"));
                    self.diagnostics.push(error);
                    continue;
                }
                _ => seen.insert(name.text.clone(), (name.place, is_family)),
            };
            for element in self.elements(&constraint.target) {
                self.constraint(constraint, element, &mut rows);
                if rows.len() > CONSTRAINT_LIMIT {
                    let message = format!("a system has at most {CONSTRAINT_LIMIT} constraints");
                    self.diagnostics.error(name.place, message);
                    return rows;
                }
            }
        }
        rows
    }

    fn constraint(&mut self, constraint: &Constraint, element: Option<usize>, rows: &mut Vec<(Label, Id)>) {
        let residual = self.with_index(&constraint.target, element, |lowering| lowering.residual(constraint));
        let Some(residual) = residual else { return };
        let name = &constraint.target.name;
        let mut row = rows.len();
        let symbols = residual.map(&mut |_| {
            row += 1;
            self.graph.symbol(Variable::Multiplier(row - 1).symbol())
        });
        let texts = entry_names(&element_name(&name.text, element), &residual);
        for (text, id) in texts.into_iter().zip(residual.flat()) {
            if rows.iter().any(|(label, _)| label.text == text) {
                self.diagnostics.error(name.place, format!("the constraint `{text}` is given twice"));
            }
            rows.push((Label { text, place: constraint.left.place.to(constraint.right.place) }, id));
        }
        match self.multipliers.iter_mut().find(|group| group.name == name.text) {
            Some(group) => group.elements.push((element, symbols)),
            None => self
                .multipliers
                .push(MultiplierGroup { name: name.text.clone(), elements: vec![(element, symbols)] }),
        }
    }

    /// left − right
    fn residual(&mut self, constraint: &Constraint) -> Option<Value> {
        let (left, right) = (self.lower(&constraint.left), self.lower(&constraint.right));
        let (left, right) = (left?, right?);
        if is_literal_zero(&constraint.right) {
            return Some(left);
        }
        if is_literal_zero(&constraint.left) {
            return Some(right.map(&mut |id| self.graph.neg(id)));
        }
        if left.shape() != right.shape() {
            let (left, right) = (left.shape(), right.shape());
            return self
                .report(constraint.right.place, format!("this is {right}, but the other side is {left}"));
        }
        let terms = [(left, Rational::from_integer(1)), (right, Rational::from_integer(-1))];
        Some(Value::combination(&terms, &mut self.graph))
    }

    fn observables(&mut self, declaration: &Declaration) -> Vec<(Label, Vec<Id>)> {
        self.setting = Setting::Observable;
        let mut observables = Vec::new();
        for (position, observable) in declaration.observables.iter().enumerate() {
            let name = &observable.name;
            if RESERVED.contains(&name.text.as_str()) {
                let message = format!("every system has a method `{}`: choose another name", name.text);
                self.diagnostics.error(name.place, message);
                continue;
            }
            let earlier =
                declaration.observables[..position].iter().find(|known| known.name.text == name.text);
            if let Some(earlier) = earlier {
                let mut error = name.place.error(format!("two observables are called `{}`", name.text));
                error.combine(earlier.name.place.error("the other one is here"));
                self.diagnostics.push(error);
                continue;
            }
            let Some(value) = self.lower(&observable.value) else { continue };
            if value.as_scalar().is_none() && value.as_vector().is_none() {
                let message = format!("an observable is a scalar or a vector, but this is {}", value.shape());
                self.diagnostics.error(observable.value.place, message);
                continue;
            }
            observables.push((Label { text: name.text.clone(), place: name.place }, value.flat()));
            self.observables.push((name.text.clone(), value));
        }
        observables
    }

    /// The names that definitions give to nodes; of two for one node, the first.
    fn names(&self, declaration: &Declaration) -> FxHashMap<Id, String> {
        let mut names = FxHashMap::default();
        for (define, definition) in declaration.defines.iter().zip(&self.definitions) {
            let name = &define.target.name.text;
            let elements: Vec<(Option<usize>, &Value)> = match definition {
                Definition::Value(value) => vec![(None, value)],
                Definition::Family(elements) => elements.iter().map(|(i, value)| (Some(*i), value)).collect(),
                _ => continue,
            };
            for (element, value) in elements {
                let texts = entry_names(&element_name(name, element), value);
                for (text, id) in texts.into_iter().zip(value.flat()) {
                    names.entry(id).or_insert(text);
                }
            }
        }
        names
    }
}

/// As many as coordinates, beyond which some would have to be dependent.
const CONSTRAINT_LIMIT: usize = 1000;

/// Methods that every system has, or will have, and associated constants beside.
pub(crate) const RESERVED: &[&str] = &[
    "NAME",
    "COORDINATES",
    "CONSTRAINTS",
    "CONSTRAINT_KINDS",
    "CONSTRAINT_CLASSES",
    "INTEGRALS",
    "OBSERVABLES",
    "FACTS",
    "conserved",
    "check_consistent",
    "lagrangian",
    "momentum",
    "momentum_rate",
    "mass_matrix",
    "forcing",
    "constraint_residual",
    "constraint_integral",
    "constraint_rate",
    "constraint_jacobian",
    "constraint_bias",
    "constraint_force",
    "accelerations",
    "observable",
    "solve",
    "make_consistent",
    "integrate",
    "integrate_with",
    "state_from",
    "energy",
    "hamiltonian",
    "equations",
    "hamilton_equations",
    "integrate_hamiltonian",
    "integrate_hamiltonian_with",
    "legendre",
    "legendre_near",
    "phase_state",
    "velocities",
    "linearize",
    "equilibrium",
    "clone",
    "clone_from",
    "fmt",
    "eq",
    "ne",
    "hash",
    "cmp",
    "partial_cmp",
    "default",
];
