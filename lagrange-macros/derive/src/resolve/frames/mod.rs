//! Frames: each lies in a frame declared before it. Quantities along its axes are lowered to scalars.

mod pose;
mod registry;
mod spatial;
mod step;

use std::cmp::Ordering;
use std::rc::Rc;

use super::label::element_name;
use super::lowering::Lowering;
use super::scope::Entity;
use super::unknown::{nearest, or_meant};
use super::value::Axes;
use crate::syntax::{Expression, FrameDeclaration, Kind, Name};
pub(crate) use pose::{Frame, Step, Triple, columns, named, sum, symmetric};
pub(super) use registry::FIXED;
pub(crate) use registry::{Body, Frames};
pub(crate) use spatial::is_of_frames;
pub(crate) use step::is_step;

fn name_of(declared: &FrameDeclaration, element: &[usize]) -> Rc<str> {
    element_name(&declared.target.name.text, element).into()
}

impl Lowering<'_> {
    /// Declares the frames that the source places after this number of definitions.
    pub(super) fn frames_after(&mut self, definitions: usize) {
        let frames = self.declared_frames;
        let of_now = |declared: &&FrameDeclaration| declared.definitions == definitions;
        for (index, declared) in frames.iter().enumerate().filter(|(_, declared)| of_now(declared)) {
            if !matches!(self.scope.get(&declared.target.name.text), Some(Entity::Frame)) {
                continue;
            }
            let indices = &declared.target.indices;
            let mut elements = self.elements(indices).into_iter();
            // Stops at the first element of a family that has an error: the following ones would repeat it.
            let mut declare = |element: Vec<usize>| {
                self.with_indices(indices, &element, |lowering| lowering.declare_frame(index, &element))
            };
            if elements.any(|element| declare(element).is_none()) {
                self.frames.named.extend(elements.map(|element| (name_of(declared, &element), None)));
            }
        }
    }

    fn declare_frame(&mut self, index: usize, element: &[usize]) -> Option<()> {
        let declared = &self.declared_frames[index];
        let name = name_of(declared, element);
        if let Some(axes) = self.frames.get(&name) {
            let known = axes.as_ref().map(|_| ());
            if self.frames.early.remove(&name) {
                return known;
            }
            // Guessing mode lowers every declaration twice, so a known name is no error.
            let message = || format!("the frame `{name}` is declared twice");
            return if self.is_guessing {
                Some(())
            } else {
                self.report(declared.target.name.place, message())
            };
        }
        let outer = self.frames.current.replace(name.clone());
        let parent = match &declared.parent {
            Some(parent) => {
                self.frames.asked.push((index, name.clone()));
                let axes = self.frame(parent);
                self.frames.asked.pop();
                axes.map(|axes| axes.frame)
            }
            None => Some(0),
        };
        // All steps are lowered before the result is checked, so that all errors are reported.
        let first = self.frames.all.len() - 1;
        let lies = declared.steps.iter().fold(parent, |before, step| {
            let lies = self.step(before.unwrap_or(0), first, step);
            before.and(lies)
        });
        let axes = lies.map(|frame| Axes { frame, name: name.clone() });
        self.frames.current = outer;
        self.frames.named.push((name, axes));
        lies.map(|_| ())
    }

    /// Declares a frame before its turn, if another frame lies in it. Elements of families may lie in each other,
    /// whatever the order of declaration.
    fn declare_early(&mut self, name: &Name, text: &str, element: &[i128]) {
        let Some(&(turn, _)) = self.frames.asked.first() else { return };
        let is_asked = self.frames.asked.iter().any(|(_, asked)| **asked == *text);
        let element: Option<Vec<usize>> = element.iter().map(|&k| usize::try_from(k).ok()).collect();
        let Some(element) = element.filter(|element| !element.is_empty() && !is_asked) else { return };
        let frames = self.declared_frames;
        for (index, declared) in frames.iter().enumerate().skip(turn) {
            let indices = &declared.target.indices;
            let is_called_so = declared.target.name.text == name.text;
            if is_called_so
                && declared.definitions == frames[turn].definitions
                && self.elements(indices).contains(&element)
            {
                let locals = std::mem::take(&mut self.locals);
                self.with_indices(indices, &element, |lowering| lowering.declare_frame(index, &element));
                self.locals = locals;
                self.frames.early.insert(text.into());
                return;
            }
        }
    }

    /// Resolves an expression that must name a frame.
    pub(super) fn frame(&mut self, expression: &Expression) -> Option<Axes> {
        let Some((name, indices)) = expression.element() else { return self.no_frame(expression) };
        match self.scope.get(&name.text) {
            Some(Entity::Frame) => {}
            None if name.text == FIXED && indices.is_empty() => {
                return Some(Axes { frame: 0, name: FIXED.into() });
            }
            _ => return self.no_frame(expression),
        }
        let mut text = name.text.clone();
        let mut element = Vec::new();
        for index in indices {
            let index = self.integer(index)?;
            text += &format!("[{index}]");
            element.push(index);
        }
        if self.frames.get(&text).is_none() {
            self.declare_early(name, &text, &element);
        }
        match self.frames.get(&text) {
            Some(axes) => axes.clone(),
            None => self.unknown_frame(expression, name, &text),
        }
    }

    /// Returns whether an expression can only mean a frame.
    pub(super) fn frame_is_meant(&self, expression: &Expression) -> bool {
        let Some((name, _)) = expression.element() else { return false };
        let entity = self.scope.get(&name.text);
        entity == Some(Entity::Frame) || (entity.is_none() && name.text == FIXED)
    }

    fn no_frame<T>(&mut self, expression: &Expression) -> Option<T> {
        let example = "frames are declared with `#[frame(body: translate(r), rotate_z(angle))]`, and the one that is at rest is `fixed`";
        let message = match &expression.kind {
            Kind::Name(name) => match self.scope.get(&name.text) {
                Some(entity) => {
                    format!("a frame belongs here, and `{}` is {}: {example}", name.text, entity.describe())
                }
                None => {
                    let names = self.frame_names();
                    let meant = match nearest(&name.text, names.iter().copied()) {
                        None if self.declared_frames.is_empty() => format!(": {example}"),
                        near => or_meant(&name.text, near, "frame", names.into_iter()),
                    };
                    format!("no frame is called `{}`{meant}", name.text)
                }
            },
            _ => format!("a frame belongs here, by its name: {example}"),
        };
        self.report(expression.place, message)
    }

    /// Reports a frame in the place of a value.
    pub(super) fn frame_alone<T>(&mut self, name: &Name) -> Option<T> {
        let text = &name.text;
        let message = format!(
            "`{text}` is a frame and has no value: what it is asked for is `position({text}, point)`, `velocity({text}, point)`, `angular_velocity({text})` or `kinetic({text}, m, c, I)`"
        );
        self.report(name.place, message)
    }

    /// Names of all frames; a family is listed once.
    fn frame_names(&self) -> Vec<&str> {
        let declared = self.declared_frames.iter().map(|declared| declared.target.name.text.as_str());
        let mut names: Vec<&str> = declared.chain([FIXED]).collect();
        names.dedup();
        names
    }

    /// Reports a frame that is declared later, or whose family lacks this element.
    fn unknown_frame<T>(&mut self, expression: &Expression, name: &Name, text: &str) -> Option<T> {
        let declared = self.declared_frames.iter().filter(|frame| frame.target.name.text == name.text);
        let wanted = declared.map(|frame| frame.target.indices.len()).max().unwrap_or(0);
        let given = expression.element().map_or(0, |(_, indices)| indices.len());
        let is_itself = self.frames.current.as_deref() == Some(text);
        let asked: Vec<&str> = self.frames.asked.iter().map(|(_, name)| &**name).collect();
        let circle = asked.iter().position(|asked| *asked == text).map(|start| &asked[start..]);
        let message = match given.cmp(&wanted) {
            _ if circle.is_some_and(|circle| circle.len() > 1) => {
                format!(
                    "`{text}` cannot lie in itself: {} in {text}",
                    circle.unwrap_or_default().join(" in ")
                )
            }
            _ if is_itself => format!("`{text}` cannot lie in itself, nor be placed by itself"),
            Ordering::Less => {
                let one = "[0]".repeat(wanted - given);
                format!("`{text}` are several frames: take one, such as `{text}{one}`")
            }
            Ordering::Greater if wanted == 0 => format!("`{}` is one frame, without an index", name.text),
            _ => format!(
                "`{text}` is not declared above: a frame is declared after the one that it is in, and before what uses it"
            ),
        };
        self.report(expression.place, message)
    }
}
