//! Definitions and families: values by name, elements by index.

use std::collections::BTreeMap;

use super::lower::{Definition, Lowering};
use super::scope::{Entity, is_built_in};
use super::value::Value;
use crate::diagnostics::Place;
use crate::symbolic::Rational;
use crate::syntax::{Expression, Kind, Name, Slice, Target, TargetIndex};

/// The longest range: each of its indices is written out.
const RANGE_LIMIT: i128 = 10_000;
const NO_ELEMENTS: &str = "this is a scalar: it has no elements";

/// A field, and where an expression names it.
type Field<'e> = (usize, &'e Name);

impl Lowering<'_> {
    /// Gives the definitions their values, in the order written.
    pub(super) fn define_all(&mut self) {
        self.frames_after(0);
        for index in 0..self.defines.len() {
            self.define(index);
            self.frames_after(index + 1);
        }
    }

    fn define(&mut self, index: usize) {
        let define = &self.defines[index];
        let Some(Entity::Definition(first)) = self.scope.get(&define.target.name.text) else { return };
        if define.formals.is_some() {
            self.function_definition(index);
        } else {
            self.value_definition(index, first);
        }
    }

    fn function_definition(&mut self, index: usize) {
        let define = &self.defines[index];
        if !matches!(define.target.index, TargetIndex::None) {
            self.diagnostics.error(
                define.target.name.place,
                "a function is not a family: give it the index as an argument",
            );
        }
        let formals = define.formals.as_deref().unwrap_or_default();
        for (position, formal) in formals.iter().enumerate() {
            self.declare_local(formal);
            if formals[..position].iter().any(|earlier| earlier.text == formal.text) {
                self.diagnostics
                    .error(formal.place, format!("the argument `{}` is given twice", formal.text));
            }
        }
        let sound = self.names_are_known(index) || self.is_guessing;
        self.definitions[index] = if sound { Definition::Function } else { Definition::Wrong };
    }

    /// A function's body has a value only where it is called, but its names are checked at once.
    fn names_are_known(&mut self, index: usize) -> bool {
        let define = &self.defines[index];
        let mut local: Vec<String> =
            define.formals.iter().flatten().map(|formal| formal.text.clone()).collect();
        let mut names = Vec::new();
        define.body.names(&mut |name| names.push(name.clone()));
        define.body.indices(&mut |index| local.push(index.text.clone()));
        let mut sound = true;
        for name in names.iter().filter(|name| !local.contains(&name.text) && !is_built_in(&name.text)) {
            match self.scope.get(&name.text) {
                None => {
                    self.diagnostics.push(self.scope.unknown(name, &local));
                    sound = false;
                }
                Some(Entity::Definition(used)) if matches!(self.definitions[used], Definition::Pending) => {
                    self.too_early::<()>(used, name);
                    sound = false;
                }
                Some(_) => {}
            }
        }
        sound
    }

    fn value_definition(&mut self, index: usize, first: usize) {
        let define = &self.defines[index];
        for element in self.elements(&define.target) {
            let value = self.with_index(&define.target, element, |lowering| lowering.lower(&define.body));
            let Some(value) = value else {
                self.definitions[first] = Definition::Wrong;
                return;
            };
            let value = value.map(&mut |id| self.graph.defined(id));
            self.store(first, &define.target.name, element, value);
        }
        if matches!(self.definitions[first], Definition::Pending) {
            self.definitions[first] = Definition::Wrong;
        }
    }

    fn store(&mut self, first: usize, name: &Name, element: Option<usize>, value: Value) {
        match (element, &mut self.definitions[first]) {
            (None, slot) => *slot = Definition::Value(value),
            (Some(element), slot @ Definition::Pending) => {
                *slot = Definition::Family(BTreeMap::from([(element, value)]));
            }
            (Some(element), Definition::Family(elements)) => {
                let earlier = elements.insert(element, value);
                if earlier.is_some() {
                    let message = format!("`{}[{element}]` is defined twice", name.text);
                    self.diagnostics.error(name.place, message);
                }
            }
            _ => {}
        }
    }

    /// The indices that a target stands for: one `None` without brackets, nothing where they are wrong.
    pub(super) fn elements(&mut self, target: &Target) -> Vec<Option<usize>> {
        match &target.index {
            TargetIndex::None => vec![None],
            TargetIndex::Element(index) => match self.integer(index).map(usize::try_from) {
                Some(Ok(index)) => vec![Some(index)],
                Some(Err(_)) => {
                    self.diagnostics.error(index.place, "an index is not negative");
                    Vec::new()
                }
                None => Vec::new(),
            },
            TargetIndex::Family { index, from, to } => {
                match (self.declare_local(index), self.range(from, to)) {
                    (Some(()), Some(range)) => range.map(Some).collect(),
                    _ => Vec::new(),
                }
            }
        }
    }

    /// Runs `f` with the family's index bound to one of its values.
    pub(super) fn with_index<T>(
        &mut self,
        target: &Target,
        element: Option<usize>,
        f: impl FnOnce(&mut Self) -> T,
    ) -> T {
        let (TargetIndex::Family { index, .. }, Some(element)) = (&target.index, element) else {
            return f(self);
        };
        let value = Value::Scalar(self.graph.integer(element as i128));
        self.locals.push((index.text.clone(), value));
        let result = f(self);
        self.locals.pop();
        result
    }

    /// `from..to` with its ends in numbers; an empty one is an error.
    pub(super) fn range(&mut self, from: &Expression, to: &Expression) -> Option<std::ops::Range<usize>> {
        let (low, high) = (self.integer(from), self.integer(to));
        let (low, high) = (low?, high?);
        let place = from.place.to(to.place);
        if low < 0 {
            return self.report(from.place, "an index is not negative");
        }
        if high <= low {
            return self.report(place, format!("the range {low}..{high} is empty"));
        }
        if high > RANGE_LIMIT {
            return self.report(place, format!(
                "the range ends beyond {RANGE_LIMIT}: leave so many parts to a function, `#[function(U(x))]`, that loops over them"
            ));
        }
        Some(low as usize..high as usize)
    }

    /// `base[index]`
    pub(super) fn index(&mut self, base: &Expression, index: &Expression) -> Option<Value> {
        if let Kind::Name(name) = &base.kind
            && !self.locals.iter().any(|(local, _)| *local == name.text)
            && let Some(Entity::Definition(first)) = self.scope.get(&name.text)
            && !matches!(self.defines[first].target.index, TargetIndex::None)
        {
            return self.family_element(first, name, index);
        }
        if let Some((field, indices)) = self.element_of_field(base, index) {
            return self.field_element(field, &indices);
        }
        let (value, i) = (self.lower(base)?, self.integer(index)?);
        let Some(length) = value.length() else { return self.report(base.place, NO_ELEMENTS) };
        let i = self.checked(i, length, index.place)?;
        value.item(i)
    }

    /// `base[from..to]`, element by element: what is left out of a large field costs nothing.
    pub(super) fn slice(&mut self, Slice { base, from, to }: &Slice) -> Option<Value> {
        let range = self.range(from, to)?;
        let element = |i: usize| {
            let number = Kind::Number(Rational::from_integer(i as i128).into());
            self.index(base, &Expression { kind: number, place: from.place.to(to.place) })
        };
        range.map(element).collect::<Option<Vec<Value>>>().map(Value::Vector)
    }

    /// `i` where it is one of the indices 0 to `length` − 1.
    fn checked(&mut self, i: i128, length: usize, place: Place) -> Option<usize> {
        let found = usize::try_from(i).ok().filter(|&i| i < length);
        let last = length.saturating_sub(1);
        let wrong = || format!("the index {i} is out of range: the elements are 0 to {last}");
        found.or_else(|| self.report(place, wrong()))
    }

    /// The field, and its indices, where `base[index]` is an element of one.
    fn element_of_field<'e>(
        &self,
        base: &'e Expression,
        index: &'e Expression,
    ) -> Option<(Field<'e>, Vec<&'e Expression>)> {
        // As many indices may follow one another as there is room for: no recursion.
        let (mut base, mut indices) = (base, vec![index]);
        while let Kind::Index(inner, index) = &base.kind {
            indices.push(index);
            base = inner;
        }
        indices.reverse();
        match &base.kind {
            Kind::Name(name) if !self.locals.iter().any(|(local, _)| *local == name.text) => {
                match self.scope.get(&name.text)? {
                    Entity::Field(field) => Some(((field, name), indices)),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// Of a large field only the elements in use may cost.
    fn field_element(&mut self, (field, name): Field<'_>, indices: &[&Expression]) -> Option<Value> {
        let layout = self.parameters.layout(field, name.place, self.diagnostics)?;
        let mut path = Vec::new();
        for (level, index) in indices.iter().enumerate() {
            let i = self.integer(index)?;
            let Some(&length) = layout.lengths.get(level) else {
                let end = indices[..level].last().map_or(name.place, |before| before.place);
                return self.report(name.place.to(end), NO_ELEMENTS);
            };
            path.push(self.checked(i, length, index.place)?);
        }
        self.parameters.value(field, &path, name.place, &mut self.graph, self.diagnostics)
    }

    fn family_element(&mut self, first: usize, name: &Name, index: &Expression) -> Option<Value> {
        let i = self.integer(index)?;
        let text = &name.text;
        let missing = match &self.definitions[first] {
            Definition::Wrong => return None,
            Definition::Family(elements) => match usize::try_from(i).ok().and_then(|i| elements.get(&i)) {
                Some(value) => return Some(value.clone()),
                None => "no definition above gives it one".to_owned(),
            },
            _ => format!("begin with `#[define({text}[0] = …)]`"),
        };
        self.report(index.place, format!("`{text}[{i}]` has no value here: {missing}"))
    }

    /// The value of a definition that is used as a whole.
    pub(super) fn definition(&mut self, first: usize, name: &Name) -> Option<Value> {
        let text = &name.text;
        match &self.definitions[first] {
            Definition::Value(value) => Some(value.clone()),
            Definition::Wrong => None,
            Definition::Pending => self.too_early(first, name),
            Definition::Function => self.without_parentheses(name),
            Definition::Family(elements) => match (0..elements.len()).find(|i| !elements.contains_key(i)) {
                Some(i) => {
                    self.report(name.place, format!("`{text}` is no vector: `{text}[{i}]` is missing"))
                }
                None => Some(Value::Vector(elements.values().cloned().collect())),
            },
        }
    }

    /// A definition used before its turn: in a circle, or merely out of order.
    pub(super) fn too_early<T>(&mut self, index: usize, name: &Name) -> Option<T> {
        let text = &name.text;
        let message = match self.circle(index) {
            Some(circle) => format!("`{text}` is defined by itself: {circle}"),
            None => format!("`{text}` is defined further down: definitions come before what uses them"),
        };
        self.report(name.place, message)
    }

    /// A chain of definitions from `start` back to itself, by name.
    fn circle(&self, start: usize) -> Option<String> {
        let mut chains = vec![vec![start]];
        let mut seen = vec![start];
        while let Some(chain) = chains.pop() {
            let last = *chain.last()?;
            for next in self.mentioned(last) {
                if next == start {
                    let names =
                        chain.iter().chain([&start]).map(|&i| self.defines[i].target.name.text.as_str());
                    return Some(names.collect::<Vec<_>>().join(" → "));
                }
                if !seen.contains(&next) {
                    seen.push(next);
                    chains.push([&chain[..], &[next]].concat());
                }
            }
        }
        None
    }

    /// The definitions that one mentions.
    fn mentioned(&self, index: usize) -> Vec<usize> {
        let mut found = Vec::new();
        self.defines[index].body.names(&mut |name| {
            if let Some(Entity::Definition(index)) = self.scope.get(&name.text) {
                found.push(index);
            }
        });
        found
    }
}
