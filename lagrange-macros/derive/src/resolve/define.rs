//! Definitions: values, functions and families by name.

use std::rc::Rc;

use super::family::Family;
use super::frames::{FIXED, is_of_frames};
use super::label::element_name;
use super::lowering::{Definition, Lowering, Progress};
use super::scope::{Entity, is_built_in};
use super::value::Value;
use crate::diagnostics::Place;
use crate::syntax::Name;

impl Lowering<'_> {
    /// Lowers all definitions in the order written.
    pub(super) fn define_all(&mut self) {
        self.progress = Progress::default();
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
        } else if self.is_part_of(index, first) {
            self.value_definition(index, first);
        }
    }

    /// True if definition `index` has the name and the number of indices of `first`, the first definition of this
    /// name, and no arguments. It then defines elements of the same family, or the same value.
    fn is_part_of(&self, index: usize, first: usize) -> bool {
        let [one, other] = [index, first].map(|index| &self.defines[index]);
        let is_one = one.target.name.text == other.target.name.text;
        is_one && one.formals.is_none() && one.target.indices.len() == other.target.indices.len()
    }

    fn function_definition(&mut self, index: usize) {
        let define = &self.defines[index];
        if define.target.is_family() {
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

    /// Checks the names in the body of a function; the body itself is lowered at each call.
    fn names_are_known(&mut self, index: usize) -> bool {
        let define = &self.defines[index];
        let mut local: Vec<String> =
            define.formals.iter().flatten().map(|formal| formal.text.clone()).collect();
        let mut names = Vec::new();
        define.body.names(&mut |name| names.push(name.clone()));
        define.body.indices(&mut |index| local.push(index.text.clone()));
        let has_frames = !self.declared_frames.is_empty();
        let is_given = |text: &str| is_built_in(text) || has_frames && (is_of_frames(text) || text == FIXED);
        let mut sound = true;
        for name in names.iter().filter(|name| !local.contains(&name.text) && !is_given(&name.text)) {
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
        if self.is_open_definition(first) || self.is_open_family(&self.defines[index].target.indices) {
            return self.open_definition(index, first);
        }
        for element in &*self.elements_of(index) {
            if self.progress.early.contains(&(index, element.clone())) {
                continue;
            }
            if self.define_element(index, first, element).is_none() {
                return;
            }
        }
        if matches!(self.definitions[first], Definition::Pending) {
            self.definitions[first] = Definition::Wrong;
        }
    }

    /// Element indices of a definition. They do not depend on the locals of the expression that needs them.
    fn elements_of(&mut self, index: usize) -> Rc<[Vec<usize>]> {
        if let Some(known) = self.progress.elements.get(&index) {
            return known.clone();
        }
        let outer = std::mem::take(&mut self.locals);
        let elements: Rc<[_]> = self.elements(&self.defines[index].target.indices).into();
        self.locals = outer;
        self.progress.elements.insert(index, elements.clone());
        elements
    }

    fn define_element(&mut self, index: usize, first: usize, element: &[usize]) -> Option<()> {
        let define = &self.defines[index];
        self.progress.current.push((index, element.to_vec()));
        let outer = (std::mem::take(&mut self.locals), std::mem::take(&mut self.many.ranges));
        let value =
            self.with_indices(&define.target.indices, element, |lowering| lowering.lower(&define.body));
        (self.locals, self.many.ranges) = outer;
        self.progress.current.pop();
        let Some(value) = value else {
            self.definitions[first] = Definition::Wrong;
            return None;
        };
        let value = value.map(&mut |id| self.graph.defined(id));
        self.store(first, &define.target.name, element, value);
        Some(())
    }

    fn store(&mut self, first: usize, name: &Name, element: &[usize], value: Value) {
        let definition = &mut self.definitions[first];
        if element.is_empty() {
            *definition = Definition::Value(value);
            return;
        }
        if matches!(definition, Definition::Pending) {
            *definition = Definition::Family(Family::default());
        }
        let Definition::Family(family) = definition else { return };
        if !family.insert(element.to_vec(), value) {
            let message = format!("`{}` is defined twice", element_name(&name.text, element));
            self.diagnostics.error(name.place, message);
        }
    }

    /// Element of a family, or an array of the elements whose indices begin with `path`.
    pub(super) fn element(&mut self, first: usize, name: &str, path: &[i128], place: Place) -> Option<Value> {
        let indices = path.iter().map(|&i| usize::try_from(i).ok()).collect::<Option<Vec<usize>>>();
        let found = match (&self.definitions[first], &indices) {
            (Definition::Wrong, _) => return None,
            (Definition::Family(family), Some(indices)) => family.part(indices),
            _ => None,
        };
        let rank = self.defines[first].target.indices.len();
        match (found, &indices) {
            (Some(value), _) if path.len() == rank => return Some(value),
            (Some(value), Some(indices)) => return self.array(first, indices, value, place),
            (None, Some(indices)) => {
                if let Some(index) = self.coming(first, indices) {
                    return self.element_before_its_turn(index, first, indices, place);
                }
            }
            _ => {}
        }
        let missing = match &self.definitions[first] {
            Definition::Family(_) => "no definition above gives it one".to_owned(),
            _ if self.progress.current.first().is_some_and(|(turn, _)| *turn < first) => {
                format!("`{name}` is defined further down")
            }
            _ => {
                let first = indices.unwrap_or_else(|| vec![0; rank]);
                format!("begin with `#[define({} = …)]`", element_name(name, &first))
            }
        };
        let text = path.iter().fold(name.to_owned(), |text, i| format!("{text}[{i}]"));
        self.report(place, format!("`{text}` has no value here: {missing}"))
    }

    /// Finds the definition, the current one or a later one, that will give this element. Elements of families may use
    /// each other in any order.
    fn coming(&mut self, first: usize, element: &[usize]) -> Option<usize> {
        let turn = self.progress.current.first().filter(|(_, element)| !element.is_empty())?.0;
        let last = self.defines.len();
        let is_given = |index: &usize| {
            self.is_part_of(*index, first)
                && self.elements_of(*index).binary_search_by(|known| (**known).cmp(element)).is_ok()
        };
        (turn..last).find(is_given)
    }

    fn element_before_its_turn(
        &mut self,
        index: usize,
        first: usize,
        element: &[usize],
        place: Place,
    ) -> Option<Value> {
        let needed = (index, element.to_vec());
        if let Some(start) = self.progress.current.iter().position(|current| *current == needed) {
            let circle = self.progress.current[start..].iter().chain([&needed]);
            let names: Vec<String> = circle
                .map(|(index, element)| element_name(&self.defines[*index].target.name.text, element))
                .collect();
            return self.report(place, format!("`{}` is defined by itself: {}", names[0], names.join(" → ")));
        }
        self.define_element(index, first, element)?;
        self.progress.early.insert(needed);
        match &self.definitions[first] {
            Definition::Family(family) => family.part(element),
            _ => None,
        }
    }

    /// Array of the elements whose indices begin with `indices`. Reports gaps and unequal shapes.
    fn array(&mut self, first: usize, indices: &[usize], value: Value, place: Place) -> Option<Value> {
        let Definition::Family(family) = &self.definitions[first] else { return Some(value) };
        if let Some(gap) = family.gap(indices) {
            let name = &self.defines[first].target.name.text;
            let [whole, missing] = [indices, &gap].map(|indices| element_name(name, indices));
            return self.report(place, format!("`{whole}` is no vector: `{missing}` is missing"));
        }
        self.even(value, place)
    }

    /// Value of a definition that is named without indices.
    pub(super) fn definition(&mut self, first: usize, name: &Name) -> Option<Value> {
        let value = match &self.definitions[first] {
            Definition::Value(value) => return Some(value.clone()),
            Definition::Wrong => return None,
            Definition::Pending => return self.too_early(first, name),
            Definition::Function => return self.without_parentheses(name),
            Definition::Open | Definition::Recursion(_) => {
                let text = &name.text;
                let message = format!("take an element of this family, `{text}[i]`");
                return self.report(name.place, message);
            }
            Definition::Family(family) => family.part(&[])?,
        };
        self.array(first, &[], value, name.place)
    }

    /// Reports a definition used before its turn: it is circular, or out of order.
    pub(super) fn too_early<T>(&mut self, index: usize, name: &Name) -> Option<T> {
        let text = &name.text;
        let message = match self.circle(index) {
            Some(circle) => format!("`{text}` is defined by itself: {circle}"),
            None => format!("`{text}` is defined further down: definitions come before what uses them"),
        };
        self.report(name.place, message)
    }

    /// Spells a chain of definitions from `start` back to itself, if there is one.
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

    /// Definitions whose names occur in the body of definition `index`.
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
