//! Limits of joints that are missing or that no motion keeps.

use crate::check::{in_quotes, note};
use crate::robot::{Joint, JointType, Limit};
use crate::tree::Moving;

/// Errors for limits that `clamp` would panic on.
pub(crate) fn errors(joint: &Joint) -> Vec<String> {
    let Some(Limit { position: [lower, upper], velocity, effort }) = joint.limit else { return Vec::new() };
    let name = &joint.name;
    let mut errors = Vec::new();
    if [lower, upper, velocity, effort].iter().any(|x| x.is_nan()) {
        errors.push(format!("joint `{name}`: one of its limits is no number"));
    }
    if is_bounded(joint.kind) && lower > upper {
        errors.push(format!(
            "joint `{name}`: its lower limit, {lower}, is above the upper, {upper}: exchange them, or correct a sign"
        ));
    }
    for (what, bound) in [("velocity", velocity), ("effort", effort)] {
        if bound < 0.0 {
            errors.push(format!(
                "joint `{name}`: the limit of its {what}, {bound}, is negative: write the magnitude"
            ));
        }
    }
    errors
}

/// True for joints of which URDF demands limits.
fn is_bounded(kind: JointType) -> bool {
    matches!(kind, JointType::Revolute | JointType::Prismatic)
}

/// Notes on limits that are missing, or that leave a joint no motion.
pub(crate) fn notes(links: &[Moving]) -> Vec<String> {
    let joints_with = |is: &dyn Fn(&Joint) -> bool| {
        in_quotes(
            links
                .iter()
                .filter(|moving| moving.is_simple())
                .filter_map(|moving| moving.joint)
                .filter(|joint| is(joint)),
        )
    };
    let of = |joint: &Joint| joint.limit.filter(|limit| !limit.is_unset());
    let missing = joints_with(&|joint| is_bounded(joint.kind) && joint.limit.is_none());
    let unset = joints_with(&|joint| joint.limit.is_some_and(|limit| limit.is_unset()));
    let still = joints_with(&|joint| {
        is_bounded(joint.kind) && of(joint).is_some_and(|limit| limit.position[0] == limit.position[1])
    });
    let weak = joints_with(&|joint| of(joint).is_some_and(|limit| limit.effort == 0.0));
    let slow = joints_with(&|joint| of(joint).is_some_and(|limit| limit.velocity == 0.0));
    [
        note(missing, "revolute and prismatic joints without <limit> are taken to have no limits"),
        note(unset, "limits that are all zero are taken as missing, of the joints"),
        note(still, "lower and upper limit are the same, of the joints"),
        note(weak, "the limit of the effort is zero, of the joints"),
        note(slow, "the limit of the velocity is zero, of the joints"),
    ]
    .into_iter()
    .flatten()
    .collect()
}
