//! Attributes of the struct: coordinates, frames, Lagrangian, forces, observables.

use nalgebra::Vector3;

use super::{contacts, one_line};
use crate::body::Body;
use crate::names::{Label, Labels};
use crate::number::{expression, vector};
use crate::options::Options;
use crate::robot::JointType;
use crate::steps;
use crate::tree::{Moving, Tool, Tree};

/// Longest line into which an attribute is folded.
const WIDTH: usize = 110;

pub(super) fn attributes(tree: &Tree, labels: &Labels, options: &Options) -> Vec<String> {
    let links = || tree.links.iter().zip(&labels.links);
    let tools = || tree.tools.iter().zip(&labels.tools);
    let frames = links().map(|(moving, label)| frame(moving, label, labels));
    let frames = frames.chain(tools().filter_map(|(tool, name)| tool_frame(tool, name, labels)));
    let bodies = links().filter(|(moving, _)| !options.numbers && !moving.body.is_nothing());
    let bodies = bodies.map(|(_, label)| format!("{}: {{m, centre: [3], inertia: symmetric}}", label.body));
    let driven = links().filter(|(moving, _)| moving.is_driven());
    let rubbing = links().filter(|(moving, _)| options.friction && moving.friction() > 0.0);
    [
        vec![all_coordinates(tree, labels)],
        attribute("define", mimics(tree, labels).map(Statement::from)),
        attribute("frame", frames),
        attribute("parameter", bodies.map(Statement::from)),
        lagrangian(tree, labels, options),
        attribute("force", driven.map(|(_, label)| format!("{}: {}", label.q, label.tau).into())),
        dissipation(tree, labels, options),
        attribute("contact", contacts::statements(tree, labels, options).map(Statement::from)),
        attribute("friction", rubbing.map(|(moving, label)| friction(moving, label, options).into())),
        attribute(
            "observable",
            tools().flat_map(|(tool, name)| observables(tool, name, labels)).map(Statement::from),
        ),
    ]
    .concat()
}

/// One statement of an attribute, with a comment above it.
struct Statement {
    comment: Option<String>,
    lines: Vec<String>,
}

impl From<String> for Statement {
    fn from(line: String) -> Self {
        Self { comment: None, lines: vec![line] }
    }
}

/// All statements of a kind in one attribute: rustc takes only 127 attributes unless it is asked to take more.
fn attribute(kind: &str, statements: impl Iterator<Item = Statement>) -> Vec<String> {
    let statements: Vec<Statement> = statements.collect();
    let Some(last) = statements.len().checked_sub(1) else { return Vec::new() };
    let lines = statements.iter().enumerate().flat_map(|(k, Statement { comment, lines })| {
        let mut lines: Vec<String> = comment.iter().chain(lines).map(|line| format!("    {line}")).collect();
        if let Some(line) = lines.last_mut().filter(|_| k < last) {
            line.push(';');
        }
        lines
    });
    let lines = [format!("#[{kind}(")].into_iter().chain(lines).chain([")]".to_owned()]).collect();
    if statements.iter().any(|statement| statement.comment.is_some()) { lines } else { folded(lines) }
}

fn friction(moving: &Moving, label: &Label, options: &Options) -> String {
    let bound = if options.numbers { expression(moving.friction()) } else { label.coulomb.clone() };
    format!("{}: {}, limit: {bound}, sliding: {bound}", label.friction, rate(moving, label))
}

/// Names of the coordinates of a link that mimics none, each with its length: 1 for a number.
pub(super) fn coordinates<'a>(moving: &Moving, label: &'a Label) -> Vec<(&'a str, usize)> {
    match moving.kind() {
        JointType::Floating => vec![(&label.q, 3), (&label.turn, 4)],
        JointType::Planar => vec![(&label.q, 3)],
        JointType::Spherical => vec![(&label.q, 4)],
        _ => vec![(&label.q, 1)],
    }
}

fn all_coordinates(tree: &Tree, labels: &Labels) -> String {
    let links = tree.links.iter().zip(&labels.links).filter(|(moving, _)| moving.mimic().is_none());
    let entries = links.flat_map(|(moving, label)| coordinates(moving, label));
    let entries = entries.map(|(name, length)| match length {
        1 => name.to_owned(),
        _ => format!("{name}: [{length}]"),
    });
    format!("#[coordinates({})]", entries.collect::<Vec<_>>().join(", "))
}

/// Definitions in place of the coordinates of mimic joints, each after the one that it needs.
fn mimics(tree: &Tree, labels: &Labels) -> impl Iterator<Item = String> {
    let mut found = Vec::new();
    for (moving, label) in tree.links.iter().zip(&labels.links) {
        let Some(mimic) = moving.mimic() else { continue };
        let Some(other) = tree.by_joint(&mimic.joint) else { continue };
        let value = steps::mimic(&labels.links[other].q, mimic.multiplier, mimic.offset);
        found.push((tree.depth(moving), format!("{} = {value}", label.q)));
    }
    found.sort_by_key(|(depth, _)| *depth);
    found.into_iter().map(|(_, line)| line)
}

fn frame(moving: &Moving, label: &Label, labels: &Labels) -> Statement {
    let mut steps = steps::place(&moving.origin);
    steps.extend(steps::motion(moving.kind(), &moving.axis(), &label.q, &label.turn));
    let within = moving.parent.map_or(String::new(), |parent| format!(" in {}", labels.links[parent].frame));
    Statement { comment: Some(comment(moving)), lines: placed(&label.frame, &within, &steps) }
}

fn comment(moving: &Moving) -> String {
    let joint = match moving.joint {
        Some(joint) => format!("by the {} joint `{}`", moving.kind().name(), one_line(&joint.name)),
        None => "free in space".to_owned(),
    };
    let merged =
        moving.merged.iter().map(|name| format!("`{}`", one_line(name))).collect::<Vec<_>>().join(", ");
    let with = if merged.is_empty() { String::new() } else { format!(", with {merged} fixed to it") };
    format!("// `{}`, {joint}{with}", one_line(&moving.link.name))
}

/// Frame of a tool that is not itself the frame of a moving link.
fn tool_frame(tool: &Tool, name: &str, labels: &Labels) -> Option<Statement> {
    let steps = steps::place(&tool.place);
    let lines = || placed(name, &format!(" in {}", labels.links[tool.host].frame), &steps);
    (!steps.is_empty()).then(|| Statement { comment: None, lines: lines() })
}

fn observables(tool: &Tool, name: &str, labels: &Labels) -> [String; 3] {
    let is_host = steps::place(&tool.place).is_empty();
    let frame = if is_host { &labels.links[tool.host].frame } else { name };
    let velocity = format!("express(velocity({frame}), fixed)");
    [
        format!("{name}_position = position({frame})"),
        format!("{name}_velocity = {velocity}"),
        format!("{name}_jacobian = jacobian({velocity})"),
    ]
}

/// Kinetic energies less potential energies, one a line.
fn lagrangian(tree: &Tree, labels: &Labels, options: &Options) -> Vec<String> {
    let links = || tree.links.iter().zip(&labels.links).filter(|(moving, _)| !moving.body.is_nothing());
    let properties = |moving: &Moving, label: &Label| match options.numbers {
        true => numbers(&moving.body),
        false => ["m", "centre", "inertia"].map(|member| format!("{}.{member}", label.body)),
    };
    let kinetic = links().map(|(moving, label)| {
        let [m, centre, inertia] = properties(moving, label);
        format!("kinetic({}, {m}, {centre}, {inertia})", label.frame)
    });
    let heights = links().filter(|(moving, _)| moving.body.m > 0.0).map(|(moving, label)| {
        let [m, centre, _] = properties(moving, label);
        format!("{m}*position({}, {centre})[2]", label.frame)
    });
    let heights: Vec<String> = sum("        ", heights);
    let mut lines = vec!["#[lagrangian(".to_owned()];
    lines.extend(sum("    ", kinetic));
    if !heights.is_empty() {
        lines.push("    - g*(".to_owned());
        lines.extend(heights);
        lines.push("    )".to_owned());
    }
    lines.push(")]".to_owned());
    lines
}

/// Terms, one a line.
fn sum(indent: &str, terms: impl Iterator<Item = String>) -> Vec<String> {
    terms.enumerate().map(|(k, term)| format!("{indent}{}{term}", if k == 0 { "" } else { "+ " })).collect()
}

fn numbers(body: &Body) -> [String; 3] {
    let rows = body.inertia.row_iter().map(|row| vector(row.transpose().as_slice()));
    let inertia = format!("[{}]", rows.collect::<Vec<_>>().join(", "));
    let centre =
        if body.centre == Vector3::zeros() { "[0, 0, 0]".to_owned() } else { vector(body.centre.as_slice()) };
    [expression(body.m), centre, inertia]
}

/// Rate of a joint with a single coordinate.
fn rate(moving: &Moving, label: &Label) -> String {
    if moving.mimic().is_some() { format!("der({})", label.q) } else { format!("{}_dot", label.q) }
}

fn dissipation(tree: &Tree, labels: &Labels, options: &Options) -> Vec<String> {
    let links = tree.links.iter().zip(&labels.links).filter(|(moving, _)| moving.damping() > 0.0);
    let terms: Vec<String> = links
        .map(|(moving, label)| {
            let factor = if options.numbers { expression(moving.damping()) } else { label.damping.clone() };
            format!("{factor}/2*{}^2", rate(moving, label))
        })
        .collect();
    if terms.is_empty() {
        return Vec::new();
    }
    let mut lines = vec!["#[dissipation(".to_owned()];
    lines.extend(sum("    ", terms.into_iter()));
    lines.push(")]".to_owned());
    folded(lines)
}

/// A frame by its steps, on one line if it fits there.
fn placed(name: &str, carrier: &str, steps: &[String]) -> Vec<String> {
    let line = format!("{name}{carrier}: {}", steps.join(", "));
    if line.chars().count() <= WIDTH - "    ;".len() {
        return vec![line];
    }
    let last = steps.len().saturating_sub(1);
    let steps =
        steps.iter().enumerate().map(|(k, step)| format!("    {step}{}", if k == last { "" } else { "," }));
    [format!("{name}{carrier}:")].into_iter().chain(steps).collect()
}

/// An attribute on one line if it fits there.
fn folded(lines: Vec<String>) -> Vec<String> {
    let parts: Vec<&str> = lines.iter().map(|line| line.trim_start()).collect();
    let line = parts.join(" ").replace("( ", "(").replace(" )]", ")]");
    if line.chars().count() <= WIDTH { vec![line] } else { lines }
}
