//! Lowers expressions to the graph: binds names and checks shapes.

use num_traits::Zero;

use super::access::Access;
use super::lowering::{Lowering, Setting};
use super::many::{Affine, loops_instead};
use super::scope::{Entity, is_built_in};
use super::value::Value;
use crate::diagnostics::{Place, fault_message};
use crate::symbolic::{Fault, Id, Rational};
use crate::syntax::{Expression, Kind, Name};
use crate::variables::Variable;

/// Maximum depth of an expression, including calls of definitions. Deeper ones would overflow the compiler's stack.
const DEPTH_LIMIT: usize = 600;
/// Maximum number of lowered expressions in total. Only a runaway definition needs more.
const STEP_LIMIT: usize = 1 << 20;
/// Maximum number of scalars in all lowered values together: nested vectors can grow without bound too.
const NUMBER_LIMIT: usize = 1 << 24;

impl Lowering<'_> {
    /// Lowers an expression to its value. `None` means that every error in it has been reported.
    pub(super) fn lower(&mut self, expression: &Expression) -> Option<Value> {
        self.steps += 1;
        if self.steps > STEP_LIMIT || self.depth > DEPTH_LIMIT || self.numbers > NUMBER_LIMIT {
            return self.runaway(expression.place);
        }
        self.depth += 1;
        let mut value = self.lower_kind(expression);
        if value.is_none() && self.is_guessing {
            value = Some(self.stand_in(expression));
        }
        self.depth -= 1;
        self.numbers += value.as_ref().map_or(0, Value::count);
        if let Some(fault) = self.graph.take_fault() {
            return self.fault(fault, expression.place);
        }
        value
    }

    fn lower_kind(&mut self, expression: &Expression) -> Option<Value> {
        let place = expression.place;
        match &expression.kind {
            Kind::Number(value) => Some(Value::Scalar(self.graph.scaled(*value))),
            Kind::Name(name) => self.name(name),
            Kind::Index(base, index) => {
                self.open_element(expression).unwrap_or_else(|| self.index(base, index))
            }
            Kind::Slice(slice) => self.slice(slice),
            Kind::Member(..) => self.member(expression),
            Kind::Call(name, arguments) => self.call(name, arguments, place),
            Kind::SumOver(sum) => self.sum_over(sum),
            Kind::Negative(inner) => {
                let value = self.lower(inner)?;
                Some(value.map(&mut |id| self.graph.neg(id)))
            }
            Kind::Sum(terms) => self.sum(terms),
            Kind::Product(factors) => self.product(factors),
            Kind::Power(base, exponent) => self.power(base, exponent),
            Kind::Vector(items) => self.vector(items, place),
        }
    }

    /// Lowers an expression that must be a scalar.
    pub(super) fn scalar(&mut self, expression: &Expression) -> Option<Id> {
        self.of_kind(expression, "scalar", Value::as_scalar)
    }

    /// Lowers an expression that must be a vector of scalars.
    pub(super) fn vector_of(&mut self, expression: &Expression) -> Option<Vec<Id>> {
        self.of_kind(expression, "vector", Value::as_vector)
    }

    pub(super) fn of_kind<T>(
        &mut self,
        at: &Expression,
        kind: &str,
        part: fn(&Value) -> Option<T>,
    ) -> Option<T> {
        let value = self.lower(at)?;
        self.part(&value, at.place, kind, part)
    }

    pub(super) fn part<T>(
        &mut self,
        value: &Value,
        place: Place,
        kind: &str,
        part: fn(&Value) -> Option<T>,
    ) -> Option<T> {
        let wrong = |shape| format!("a {kind} belongs here, but this is {shape}");
        part(value).or_else(|| self.report(place, wrong(value.shape())))
    }

    /// Entries of a value that must be a vector of scalars.
    pub(super) fn vector_in(&mut self, value: &Value, place: Place) -> Option<Vec<Id>> {
        self.part(value, place, "vector", Value::as_vector)
    }

    /// Values of several expressions; `None` if one of them has none.
    pub(super) fn lower_all(&mut self, expressions: &[Expression]) -> Option<Vec<Value>> {
        // All expressions are lowered before the result is checked, so that all errors are reported.
        let values: Vec<_> = expressions.iter().map(|expression| self.lower(expression)).collect();
        values.into_iter().collect()
    }

    /// Evaluates an expression that must be an integer constant.
    pub(super) fn integer(&mut self, expression: &Expression) -> Option<i128> {
        let id = self.scalar(expression)?;
        let value = self.graph.as_number(id).filter(Rational::is_integer).map(|value| value.to_integer());
        value.or_else(|| {
            let message = match Affine::read(&self.graph, id) {
                Some(_) => "this is known when the program runs, but the length of the array while compiling: make the field a `Vec`, and name its length, `#[parameter(name: [n])]`",
                None => "an index or a bound is a whole number known while compiling",
            };
            self.report(expression.place, message)
        })
    }

    fn runaway<T>(&mut self, place: Place) -> Option<T> {
        // Report this once: later reports would only repeat it.
        let first = self.steps <= STEP_LIMIT + 1;
        self.steps = STEP_LIMIT + 2;
        if !first {
            return None;
        }
        let place = self.calls.first().copied().unwrap_or(place);
        let loops = loops_instead(self.coordinates);
        self.report(
            place,
            format!("with all that it is defined by, this grows beyond what can be derived{loops}"),
        )
    }

    pub(super) fn fault<T>(&mut self, fault: Fault, place: Place) -> Option<T> {
        self.report(place, fault_message(fault))
    }

    fn name(&mut self, name: &Name) -> Option<Value> {
        if let Some((_, value)) = self.locals.iter().rev().find(|(local, _)| *local == name.text) {
            return Some(value.clone());
        }
        if let Some(field) = self.scope.shadowing(&name.text) {
            let text = &name.text;
            let message = format!("`{text}` is built in, and a field of this struct bears that name too");
            let note = format!("rename this field, or do not use `{text}` in expressions");
            self.diagnostics.push(name.place.error_beside(message, field, note));
            return None;
        }
        match name.text.as_str() {
            "t" => return Some(Value::Scalar(self.graph.symbol(Variable::Time.symbol()))),
            "pi" => return Some(Value::Scalar(self.graph.pi())),
            text if is_built_in(text) => return self.without_parentheses(name),
            _ => {}
        }
        if let Some(found) = self.open_alone(name) {
            return found;
        }
        match self.scope.get(&name.text) {
            Some(Entity::Field(field)) if let Some(length) = self.many.length_in(field, &mut self.graph) => {
                Some(Value::Scalar(length))
            }
            Some(Entity::Field(field)) => self.field_value(&Access { field, name, parts: Vec::new() }),
            Some(Entity::Coordinate(index)) => Some(self.variable(index, Variable::Coordinate)),
            Some(Entity::Velocity(index)) => Some(self.variable(index, Variable::Velocity)),
            Some(Entity::Acceleration(index)) => self.acceleration(index, name.place),
            Some(Entity::Definition(index)) => self.definition(index, name),
            Some(Entity::Function(_)) => self.without_parentheses(name),
            Some(Entity::Frame) => self.frame_alone(name),
            None => match self.many.length_called(&name.text, &mut self.graph) {
                Some(length) => Some(Value::Scalar(length)),
                None => self.observable(name),
            },
        }
    }

    pub(super) fn without_parentheses<T>(&mut self, name: &Name) -> Option<T> {
        let text = &name.text;
        self.report(name.place, format!("`{text}` is a function: write `{text}(…)`"))
    }

    fn variable(&mut self, index: usize, variable: fn(usize) -> Variable) -> Value {
        let (offset, coordinate) = (self.offsets[index], &self.coordinates[index]);
        let entries = (offset..).take(coordinate.count());
        let entries: Vec<Id> = entries.map(|i| self.graph.symbol(variable(i).symbol())).collect();
        Value::array(&coordinate.lengths, &entries)
    }

    fn acceleration(&mut self, index: usize, place: Place) -> Option<Value> {
        if self.setting != Setting::Observable {
            return self.report(place, NO_ACCELERATIONS);
        }
        Some(self.variable(index, Variable::Acceleration))
    }

    fn observable(&mut self, name: &Name) -> Option<Value> {
        if self.setting == Setting::Observable
            && let Some((_, value)) = self.observables.iter().find(|(known, _)| *known == name.text)
        {
            return Some(value.clone());
        }
        let more: Vec<String> = self.locals.iter().map(|(local, _)| local.clone()).collect();
        self.diagnostics.push(self.scope.unknown(name, &more));
        None
    }

    /// d/dt of every scalar in `value`. Reports accelerations at `place` where the setting forbids them.
    pub(super) fn rate_of(&mut self, value: &Value, place: Place) -> Option<Value> {
        self.many.follow_totals(&mut self.graph, &mut self.rate, &value.flat());
        let rate = value.map(&mut |id| self.rate.of(&mut self.graph, id));
        let accelerations = |symbol| matches!(Variable::of(symbol), Variable::Acceleration(_));
        if self.setting != Setting::Observable && self.graph.symbols(&rate.flat()).any(accelerations) {
            return self.report(place, NO_ACCELERATIONS);
        }
        if self.graph.symbols(&value.flat()).any(|symbol| Variable::of(symbol).is_solved()) {
            return self.report(place, "accelerations and multipliers have no time derivative here");
        }
        Some(rate)
    }

    /// Checks the name of a formal argument or a running index: it may shadow any name but `t` and `pi`.
    pub(super) fn declare_local(&mut self, name: &Name) -> Option<()> {
        match name.text.as_str() {
            "t" | "pi" => {
                self.report(name.place, format!("`{}` keeps its meaning: choose another name", name.text))
            }
            _ => Some(()),
        }
    }
}

const NO_ACCELERATIONS: &str =
    "accelerations are what the equations are solved for: they may appear in observables only";

pub(super) fn is_literal_zero(expression: &Expression) -> bool {
    matches!(&expression.kind, Kind::Number(value) if value.fraction.is_zero())
}
