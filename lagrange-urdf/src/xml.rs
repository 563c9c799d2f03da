//! XML as a tree of elements with their lines.

use xml::common::Position;
use xml::reader::{Error, EventReader, XmlEvent};

/// Hint for files that are not expanded.
pub(crate) const XACRO: &str = "expand xacro first, by `xacro robot.urdf.xacro > robot.urdf`";

/// An element.
#[derive(Debug)]
pub(crate) struct Node {
    /// Name, with its prefix.
    pub(crate) tag: String,
    pub(crate) line: u64,
    /// Names and values, in the order of the text.
    pub(crate) attributes: Vec<(String, String)>,
    pub(crate) children: Vec<Self>,
}

impl Node {
    /// Value of an attribute.
    pub(crate) fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }

    /// The first child of this name.
    pub(crate) fn child(&self, tag: &str) -> Option<&Self> {
        self.children(tag).next()
    }

    pub(crate) fn children(&self, tag: &str) -> impl Iterator<Item = &Self> {
        self.children.iter().filter(move |child| child.tag == tag)
    }

    /// Name of the element for messages: with the attribute `name` if it has one.
    pub(crate) fn label(&self) -> String {
        let name = self.attribute("name").map(|name| format!(" `{name}`"));
        format!("{}{}", self.tag, name.unwrap_or_default())
    }
}

/// Returns the root, or what is wrong.
pub(crate) fn parse(text: &str) -> Result<Node, String> {
    let mut reader = EventReader::new(text.as_bytes());
    let mut open: Vec<Node> = Vec::new();
    loop {
        let event = reader.next().map_err(|error| not_xml(&error, open.last()))?;
        match event {
            XmlEvent::StartElement { name, attributes, .. } => {
                let attributes = attributes
                    .into_iter()
                    .map(|attribute| (attribute.name.borrow().to_repr(), attribute.value))
                    .collect();
                let (tag, line) = (name.borrow().to_repr(), reader.position().row + 1);
                open.push(Node { tag, line, attributes, children: Vec::new() });
            }
            XmlEvent::EndElement { .. } => {
                let Some(node) = open.pop() else { continue };
                match open.last_mut() {
                    Some(parent) => parent.children.push(node),
                    None => return Ok(node),
                }
            }
            XmlEvent::EndDocument => return Err(format!("the description is empty: {ROOT}")),
            _ => {}
        }
    }
}

const ROOT: &str = "it is XML with the root element `robot`";

/// Says what the innermost open element is: a missing end is noticed only by the next.
fn not_xml(error: &Error, open: Option<&Node>) -> String {
    let (line, message) = (error.position().row + 1, error.msg());
    let is_open = message.contains("end of stream") || message.contains("closing tag");
    let hint = match open {
        _ if message.contains("xacro") => XACRO.to_owned(),
        Some(node) if is_open => {
            format!("{} of line {} is not closed: write `</{}>` or `/>`", node.label(), node.line, node.tag)
        }
        Some(node) => format!("the mistake is within {} of line {}", node.label(), node.line),
        None => format!("the description cannot be read: {ROOT}"),
    };
    format!("line {line}: {message}: {hint}")
}
