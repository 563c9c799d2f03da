//! Limits of the joints.

use super::columns;
use crate::names::Labels;
use crate::number::rust;
use crate::robot::{JointType, Limit};
use crate::tree::{Moving, Tree};

pub(super) fn limits(tree: &Tree, labels: &Labels) -> Vec<String> {
    let limited = tree.links.iter().zip(&labels.links);
    let rows: Vec<_> =
        limited.filter_map(|(moving, label)| Some(row(moving, &label.q, limit(moving)?))).collect();
    if rows.is_empty() {
        return Vec::new();
    }
    let mut lines: Vec<String> = LIMIT.lines().map(str::to_owned).collect();
    lines.push(String::new());
    lines.push(format!("impl {} {{", labels.robot));
    lines.push("    /// Limits of the joints, which the equations do not know.".to_owned());
    lines.extend(
        [
            "    #[rustfmt::skip]",
            "    #[allow(dead_code, clippy::approx_constant, reason = \"for those who read the limits, as described\")]",
        ]
        .map(str::to_owned),
    );
    lines.push(format!("    pub const LIMITS: [Limit; {}] = [", rows.len()));
    lines.extend(columns(&rows).into_iter().map(|row| format!("        {row}")));
    lines.extend(["    ];", "}"].map(str::to_owned));
    lines
}

/// Limits of a joint that has some.
fn limit(moving: &Moving) -> Option<Limit> {
    moving.joint.filter(|_| moving.is_simple())?.limit.filter(|limit| !limit.is_unset())
}

fn row(moving: &Moving, q: &str, limit: Limit) -> Vec<String> {
    let (lower, upper) = match moving.kind() {
        JointType::Continuous => (f64::NEG_INFINITY, f64::INFINITY),
        _ => limit.position.into(),
    };
    vec![
        format!("Limit {{ joint: \"{q}\","),
        format!("position: [{},", rust(lower)),
        format!("{}],", rust(upper)),
        format!("velocity: {},", rust(limit.velocity)),
        format!("effort: {} }},", rust(limit.effort)),
    ]
}

const LIMIT: &str = r#"
/// Limits of a joint.
#[allow(dead_code, reason = "for those who read the limits")]
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// Name of the joint, as in the coordinates.
    pub joint: &'static str,
    /// Least and greatest position, in rad or m.
    pub position: [f64; 2],
    /// Greatest speed, in rad/s or m/s.
    pub velocity: f64,
    /// Greatest effort, in N m or N.
    pub effort: f64,
}"#;
