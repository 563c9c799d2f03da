//! A robot as text of Rust.

mod attributes;
mod contacts;
mod efforts;
mod fields;
mod limits;

use crate::names::Labels;
use crate::options::Options;
use crate::tree::Tree;

/// Returns the text.
pub(crate) fn write(name: &str, tree: &Tree, labels: &Labels, options: &Options, notes: &[String]) -> String {
    let rubs = options.friction && tree.links.iter().any(|moving| moving.friction() > 0.0);
    let touches = contacts::are_there(tree, options);
    let mut lines = head(name, options, [touches, rubs], notes);
    lines.push(format!(
        "/// The robot `{}`: a frame for each link that moves, a coordinate for each joint.",
        one_line(name)
    ));
    let does: Vec<&str> = [
        (options.limits && touches, "joints stop at their limits"),
        (rubs, "joints stick and slide"),
        (!tree.feet.is_empty(), "links touch the floor"),
    ]
    .into_iter()
    .filter_map(|(is, does)| is.then_some(does))
    .collect();
    if !does.is_empty() {
        let does = does.join(", its ");
        lines.push("///".to_owned());
        lines.push(format!("/// Its {does} in motions `robot.motion(start).with_contacts().to(end)`."));
    }
    lines.push("#[derive(Clone, Debug, Lagrangian)]".to_owned());
    if labels.have_capitals() {
        lines.push("#[allow(non_snake_case)]".to_owned());
    }
    lines.extend(attributes::attributes(tree, labels, options));
    lines.extend(fields::fields(tree, labels, options));
    lines.extend(limits::limits(tree, labels, options));
    lines.extend(efforts::efforts(tree, labels));
    lines.join("\n") + "\n"
}

/// A name as it stands in a comment.
fn one_line(name: &str) -> String {
    name.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn head(name: &str, options: &Options, [touches, rubs]: [bool; 2], notes: &[String]) -> Vec<String> {
    let mut lines = vec![
        format!(
            "// The robot `{}`, written by lagrange-urdf from its description, to be read and edited.",
            one_line(name)
        ),
        "// SI units, angles in rad; gravity is along −z.".to_owned(),
    ];
    lines.extend(notes.iter().map(|note| format!("// Note: {}.", one_line(note))));
    lines.push(String::new());
    match [touches, rubs] {
        [true, true] => lines.push("use lagrange_core::contact::{Contact, Friction};".to_owned()),
        [true, false] => lines.push("use lagrange_core::contact::Contact;".to_owned()),
        [false, true] => lines.push("use lagrange_core::contact::Friction;".to_owned()),
        [false, false] => {}
    }
    if !options.numbers {
        lines.push("use lagrange_core::nalgebra::{Matrix3, Vector3};".to_owned());
    }
    lines.extend(["use lagrange_core::prelude::*;".to_owned(), String::new()]);
    lines
}

/// Pads the cells of each column to the same width.
fn columns(rows: &[Vec<String>]) -> Vec<String> {
    let width = |column: usize| {
        rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..rows.iter().map(Vec::len).max().unwrap_or(0)).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).map(|(cell, width)| format!("{cell:width$}"));
        cells.collect::<Vec<_>>().join(" ").trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}
