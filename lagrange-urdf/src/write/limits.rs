//! Limits of the coordinates.

use super::attributes::coordinates;
use super::columns;
use crate::names::{Label, Labels};
use crate::number::rust;
use crate::options::Options;
use crate::robot::{JointType, Limit};
use crate::tree::{Moving, Tree};

pub(super) fn limits(tree: &Tree, labels: &Labels, options: &Options) -> Vec<String> {
    if !tree.links.iter().any(|moving| limit(moving).is_some()) {
        return Vec::new();
    }
    let links = || tree.links.iter().zip(&labels.links);
    let mut lines: Vec<String> = LIMIT.lines().map(str::to_owned).collect();
    lines.push(String::new());
    lines.push(format!("impl {} {{", labels.robot));
    let known = match options.limits {
        true => "Limits of the coordinates, in their order. The equations know positions alone, as contacts.",
        false => "Limits of the coordinates, in their order, which the equations do not know.",
    };
    let rows = links().filter(|(moving, _)| moving.mimic().is_none());
    let rows: Vec<_> = rows.flat_map(|(moving, label)| rows_of(moving, label)).collect();
    lines.extend(constant("LIMITS", known, &rows));
    let mimics = links().filter(|(moving, _)| moving.mimic().is_some());
    let mimics: Vec<_> = mimics.filter_map(|(moving, label)| Some(row(&label.q, limit(moving)?))).collect();
    if !mimics.is_empty() {
        lines.extend(constant("MIMIC_LIMITS", "Limits of joints that mimic others.", &mimics));
    }
    lines.push("}".to_owned());
    lines
}

fn constant(name: &str, meaning: &str, rows: &[Vec<String>]) -> Vec<String> {
    let mut lines = vec![
        format!("    /// {meaning}"),
        "    #[rustfmt::skip]".to_owned(),
        "    #[allow(dead_code, clippy::approx_constant, reason = \"for those who read the limits, as described\")]"
            .to_owned(),
        format!("    pub const {name}: [Limit; {}] = [", rows.len()),
    ];
    lines.extend(columns(rows).into_iter().map(|row| format!("        {row}")));
    lines.push("    ];".to_owned());
    lines
}

/// Limits of the joint of a link. `None` if it has several coordinates, or states no limits.
pub(super) fn limit(moving: &Moving) -> Option<Limit> {
    let limit = moving.joint.filter(|_| moving.is_simple())?.limit.filter(|limit| !limit.is_unset())?;
    let position = if moving.kind() == JointType::Continuous { Limit::NONE.position } else { limit.position };
    Some(Limit { position, ..limit })
}

/// One row for each coordinate of a joint.
fn rows_of(moving: &Moving, label: &Label) -> Vec<Vec<String>> {
    if moving.is_simple() {
        return vec![row(&label.q, limit(moving).unwrap_or(Limit::NONE))];
    }
    let vectors = coordinates(moving, label).into_iter();
    let names = vectors.flat_map(|(name, length)| (0..length).map(move |k| format!("{name}[{k}]")));
    names.map(|name| row(&name, Limit::NONE)).collect()
}

fn row(coordinate: &str, Limit { position: [lower, upper], velocity, effort }: Limit) -> Vec<String> {
    vec![
        format!("Limit {{ coordinate: \"{coordinate}\","),
        format!("position: [{},", rust(lower)),
        format!("{}],", rust(upper)),
        format!("velocity: {},", rust(velocity)),
        format!("effort: {} }},", rust(effort)),
    ]
}

const LIMIT: &str = r#"
/// Limits of a coordinate, infinite where there are none.
#[allow(dead_code, reason = "for those who read the limits")]
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// Its name.
    pub coordinate: &'static str,
    /// Least and greatest position, in rad or m.
    pub position: [f64; 2],
    /// Greatest speed, in rad/s or m/s.
    pub velocity: f64,
    /// Greatest effort, in N m or N.
    pub effort: f64,
}"#;
