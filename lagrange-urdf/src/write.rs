//! A robot as text of Rust.

mod attributes;
mod fields;
mod limits;

use crate::names::Labels;
use crate::options::Options;
use crate::tree::Tree;

/// Returns the text.
pub(crate) fn write(name: &str, tree: &Tree, labels: &Labels, options: &Options, notes: &[String]) -> String {
    let rubs = options.friction && tree.links.iter().any(|moving| moving.friction() > 0.0);
    let mut lines = head(name, options, rubs, notes);
    lines.push(format!(
        "/// The robot `{}`: a frame for each link that moves, a coordinate for each joint.",
        one_line(name)
    ));
    if rubs {
        lines.push("///".to_owned());
        lines.push(
            "/// Its joints stick and slide in motions `robot.motion(start).with_contacts().to(end)`."
                .to_owned(),
        );
    }
    lines.push("#[derive(Clone, Debug, Lagrangian)]".to_owned());
    if labels.have_capitals() {
        lines.push("#[allow(non_snake_case)]".to_owned());
    }
    lines.extend(attributes::attributes(tree, labels, options));
    lines.extend(fields::fields(tree, labels, options));
    lines.extend(limits::limits(tree, labels));
    lines.join("\n") + "\n"
}

/// A name as it stands in a comment.
fn one_line(name: &str) -> String {
    name.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn head(name: &str, options: &Options, rubs: bool, notes: &[String]) -> Vec<String> {
    let mut lines = vec![
        format!(
            "// The robot `{}`, written by lagrange-urdf from its description, to be read and edited.",
            one_line(name)
        ),
        "// SI units, angles in rad; gravity is along −z.".to_owned(),
    ];
    lines.extend(notes.iter().map(|note| format!("// Note: {}.", one_line(note))));
    lines.push(String::new());
    if rubs {
        lines.push("use lagrange_core::contact::Friction;".to_owned());
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
