//! Limits of the joints.

use urdf_rs::{JointLimit, JointType};

use super::columns;
use crate::names::Labels;
use crate::number::rust;
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

/// Limits of a joint that has some: those of an element that is missing are all zero.
fn limit<'a>(moving: &Moving<'a>) -> Option<&'a JointLimit> {
    let joint = moving.joint.filter(|_| moving.is_simple())?;
    (joint.limit != JointLimit::default()).then_some(&joint.limit)
}

fn row(moving: &Moving, q: &str, limit: &JointLimit) -> Vec<String> {
    let (lower, upper) = match moving.kind() {
        JointType::Continuous => (f64::NEG_INFINITY, f64::INFINITY),
        _ => (limit.lower, limit.upper),
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
