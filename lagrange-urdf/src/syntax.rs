//! Checks elements and attributes against the grammar, and says where they are wrong.

use crate::grammar::{Attribute, Element, Need, Numbers, ROBOT, Value};
use crate::names::nearest;
use crate::robot::JointType;
use crate::xml::{Node, XACRO};

/// What was found in a description.
#[derive(Default)]
pub(crate) struct Found {
    pub(crate) errors: Vec<String>,
    /// Attributes and elements that are not read, the first place of each, and their number.
    unread: Vec<(String, String, usize)>,
}

impl Found {
    /// Notes on what is not read within links and joints.
    pub(crate) fn notes(&self) -> impl Iterator<Item = String> {
        self.unread.iter().map(|(what, place, count)| match count {
            1 => format!("{place}: {what} is not read"),
            _ => format!("{place}, and {} more: {what} is not read", count - 1),
        })
    }
}

/// Checks the root and all that is read of it.
pub(crate) fn check(root: &Node) -> Found {
    let mut found = Found::default();
    if root.tag == ROBOT.name {
        let context = Context { owner: None, version: version(root) };
        found.element(root, &ROBOT, &context);
    } else {
        found.errors.push(format!("the root element is `{}`: that of URDF is `robot`", root.tag));
    }
    found
}

/// Version of the format, 1.0 where none is stated.
pub(crate) fn version(root: &Node) -> (u32, u32) {
    let stated = root.attribute("version").and_then(|text| {
        let (major, minor) = text.trim().split_once('.')?;
        Some((major.parse().ok()?, minor.parse().ok()?))
    });
    stated.unwrap_or((1, 0))
}

/// Link or joint that an element is part of.
struct Context {
    owner: Option<String>,
    version: (u32, u32),
}

impl Context {
    fn place(&self, node: &Node) -> String {
        let owner = self.owner.iter().map(|owner| format!("{owner}, ")).collect::<String>();
        format!("{owner}line {}", node.line)
    }
}

impl Found {
    fn element(&mut self, node: &Node, element: &Element, context: &Context) {
        self.attributes(node, element, context);
        for child in &node.children {
            match element.children.iter().find(|(known, _)| known.name == child.tag) {
                Some((known, _)) if element.name == ROBOT.name => {
                    let owner = Some(child.label());
                    self.element(child, known, &Context { owner, ..*context });
                }
                Some((known, _)) => self.element(child, known, context),
                None => self.unknown_element(child, element, context),
            }
        }
        for (child, is_needed) in element.children.iter().filter(|_| element.name != ROBOT.name) {
            let (place, count) = (context.place(node), node.children(child.name).count());
            if count > 1 {
                self.errors
                    .push(format!("{place}: `{}` has {count} of `{}`: leave one", node.tag, child.name));
            } else if count == 0 && *is_needed {
                self.errors.push(format!("{place}: `{}` is without `{}`: add it", node.tag, example(child)));
            }
        }
    }

    fn attributes(&mut self, node: &Node, element: &Element, context: &Context) {
        let place = context.place(node);
        for attribute in element.attributes {
            let must = match attribute.need {
                Need::Must => true,
                Need::MustBefore12 => context.version < (1, 2),
                Need::May => false,
            };
            match node.attribute(attribute.name) {
                Some(text) => self.errors.extend(wrong(attribute, text).map(|wrong| {
                    format!("{place}: `{}=\"{text}\"` of `{}` {wrong}", attribute.name, node.tag)
                })),
                None if must => {
                    self.errors.push(format!("{place}: `{}` is without `{}`", node.tag, filled(attribute)));
                }
                None => {}
            }
        }
        if element.name == "origin" && node.attribute("quat_xyzw").is_some() {
            if node.attribute("rpy").is_some() {
                self.errors.push(format!("{place}: `origin` has both `rpy` and `quat_xyzw`: leave one"));
            } else if context.version < (1, 1) {
                self.errors.push(format!(
                    "{place}: `quat_xyzw` is read from version 1.1 on: write `<robot version=\"1.1\" …>`, or `rpy`"
                ));
            }
        }
        let known: Vec<&str> = element.attributes.iter().map(|known| known.name).collect();
        for (name, _) in &node.attributes {
            if !known.contains(&name.as_str()) && !name.contains(':') {
                self.unknown(name, &known, "attribute", element, place.clone());
            }
        }
    }

    fn unknown_element(&mut self, child: &Node, element: &Element, context: &Context) {
        let place = context.place(child);
        if child.tag.starts_with("xacro:") {
            self.errors.push(format!("{place}: `{}` is not of URDF: {XACRO}", child.tag));
        } else if !child.tag.contains(':') && !element.ignored.contains(&child.tag.as_str()) {
            let known: Vec<&str> = element.children.iter().map(|(known, _)| known.name).collect();
            self.unknown(&child.tag, &known, "element", element, place);
        }
    }

    /// A name that is similar to one that is read is an error. Of others that are not read a note tells within elements
    /// on which the equations depend.
    fn unknown(&mut self, name: &str, known: &[&'static str], kind: &str, element: &Element, place: String) {
        let tag = element.name;
        if let Some(near) = nearest(name, known) {
            self.errors.push(format!("{place}: `{tag}` has no {kind} `{name}`: did you mean `{near}`?"));
        } else if element.is_complete {
            let what = format!("the {kind} `{name}` of `{tag}`");
            match self.unread.iter_mut().find(|(unread, ..)| *unread == what) {
                Some((.., count)) => *count += 1,
                None => self.unread.push((what, place, 1)),
            }
        }
    }
}

/// Says what is wrong with the value of an attribute, and what to write.
fn wrong(attribute: &Attribute, text: &str) -> Option<String> {
    if text.contains("${") || text.contains("$(") {
        return Some(format!("is not expanded: {XACRO}"));
    }
    match attribute.value {
        Value::Text => None,
        Value::JointType => {
            let is_known = JointType::named(text).is_some();
            (!is_known).then(|| format!("is no type of a joint: they are {}", JointType::names()))
        }
        Value::Numbers(Numbers { count, example }) => {
            let words: Vec<&str> = text.split_whitespace().collect();
            let write = format!("write `{}=\"{example}\"` or the like", attribute.name);
            if let Some(word) = words.iter().find(|word| word.parse::<f64>().is_err()) {
                Some(format!("has `{word}` for a number: {write}, in SI units without their names"))
            } else if words.len() != count {
                let number = if words.len() == 1 { "number" } else { "numbers" };
                Some(format!("has {} {number} in place of {count}: {write}", words.len()))
            } else {
                None
            }
        }
    }
}

/// The element as one writes it.
fn example(element: &Element) -> String {
    let attributes = element.attributes.iter().filter(|attribute| attribute.need == Need::Must);
    let attributes: String = attributes.map(|attribute| format!(" {}", filled(attribute))).collect();
    format!("<{}{attributes}/>", element.name)
}

/// The attribute as one writes it.
fn filled(attribute: &Attribute) -> String {
    let value = match attribute.value {
        Value::Text => "…",
        Value::JointType => JointType::Revolute.name(),
        Value::Numbers(Numbers { example, .. }) => example,
    };
    format!("{}=\"{value}\"", attribute.name)
}
