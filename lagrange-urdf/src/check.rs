//! What must hold of a description, before anything is made of it.

use std::collections::HashSet;

use nalgebra::Matrix3;
use urdf_rs::{Inertial, Joint, JointType, Link, Robot};

use crate::body;

/// Returns all errors of single links and joints.
pub(crate) fn errors(robot: &Robot) -> Vec<String> {
    let mut errors = Vec::new();
    if robot.links.is_empty() {
        errors.push("the robot has no link".to_owned());
    }
    errors.extend(twice("links", robot.links.iter().map(|link| &link.name)));
    errors.extend(twice("joints", robot.joints.iter().map(|joint| &joint.name)));
    errors.extend(robot.links.iter().flat_map(link_errors));
    errors.extend(robot.joints.iter().flat_map(|joint| joint_errors(robot, joint)));
    errors
}

fn twice<'a>(what: &str, names: impl Iterator<Item = &'a String>) -> Vec<String> {
    let mut seen = HashSet::new();
    names
        .filter(|name| !seen.insert(*name))
        .map(|name| format!("two {what} have the name `{name}`"))
        .collect()
}

fn link_errors(link: &Link) -> Vec<String> {
    let (name, Inertial { origin, mass, inertia }) = (&link.name, &link.inertial);
    let entries = body::matrix(inertia);
    let mut numbers = origin.xyz.iter().chain(origin.rpy.iter()).chain(&entries).chain([&mass.value]);
    let mut errors = Vec::new();
    if !numbers.all(|x| x.is_finite()) {
        errors.push(format!("link `{name}`: a number of its inertia is not finite"));
    }
    if mass.value < 0.0 {
        errors.push(format!("link `{name}` has a negative mass, {}", mass.value));
    }
    errors
}

/// Says by how much the largest principal moment exceeds the sum of the others, which no distribution of mass exceeds;
/// rounding of the eigenvalues is allowed for.
pub(crate) fn impossible_inertia(link: &Link) -> Option<String> {
    let entries: Matrix3<f64> = body::matrix(&link.inertial.inertia);
    if !entries.iter().all(|x| x.is_finite()) {
        return None;
    }
    let mut moments = entries.symmetric_eigenvalues();
    moments.as_mut_slice().sort_by(f64::total_cmp);
    let (rounding, excess) = (64.0 * f64::EPSILON * moments.amax(), moments[2] - moments[0] - moments[1]);
    let list = format!("{:.4e}, {:.4e} and {:.4e} kg m²", moments[0], moments[1], moments[2]);
    let name = &link.name;
    if moments[0] < -rounding {
        return Some(format!(
            "link `{name}` has an inertia that no body has: a principal moment is negative, of {list}"
        ));
    }
    (excess > rounding).then(|| {
        format!(
            "link `{name}` has an inertia that no body has: of its principal moments, {list}, the largest exceeds the \
             sum of the others by {:.2} %",
            100.0 * excess / moments[2]
        )
    })
}

fn joint_errors(robot: &Robot, joint: &Joint) -> Vec<String> {
    let name = &joint.name;
    let mut errors = Vec::new();
    for (role, link) in [("parent", &joint.parent.link), ("child", &joint.child.link)] {
        if !robot.links.iter().any(|known| known.name == *link) {
            errors.push(format!("joint `{name}`: there is no link `{link}`, its {role}"));
        }
    }
    let mut numbers = joint.origin.xyz.iter().chain(joint.origin.rpy.iter()).chain(joint.axis.xyz.iter());
    if !numbers.all(|x| x.is_finite()) {
        errors.push(format!("joint `{name}`: a number of its origin or axis is not finite"));
    }
    let has_axis = !matches!(joint.joint_type, JointType::Fixed | JointType::Floating | JointType::Spherical);
    if has_axis && joint.axis.xyz.iter().all(|x| *x == 0.0) {
        errors.push(format!("joint `{name}` has an axis of length zero"));
    }
    if joint.dynamics.as_ref().is_some_and(|dynamics| !(dynamics.damping >= 0.0 && dynamics.friction >= 0.0))
    {
        errors.push(format!("joint `{name}` has negative damping or friction"));
    }
    errors
}
