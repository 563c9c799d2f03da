//! What must hold of a description, and of the tree that its joints make.

use std::collections::HashSet;

use nalgebra::Matrix3;
use urdf_rs::{Dynamics, Inertial, Joint, JointType, Link, Mimic, Robot};

use crate::body;
use crate::tree::{Moving, by_joint};

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

/// Says by how much the largest principal moment exceeds the sum of the others, which no distribution of mass exceeds.
/// Of this moment 64 ε are allowed for the rounding of the eigenvalues: of 100,000 rods, whose excess is zero, the worst
/// needs between 8 ε and 16 ε. An excess in the 13th digit is seen.
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

/// Errors for links that nothing gives a mass or an inertia: their equations would have no solution.
pub(crate) fn weightless(links: &[Moving]) -> Vec<String> {
    let mut has_body: Vec<bool> = links.iter().map(|moving| !moving.body.is_nothing()).collect();
    for (k, moving) in links.iter().enumerate().rev() {
        if let (true, Some(parent), Some(_)) = (has_body[k], moving.parent, moving.joint) {
            has_body[parent] = true;
        }
    }
    let is_leaf = |k: usize| links.iter().all(|moving| moving.parent != Some(k));
    let resists = |k: usize, moving: &Moving| match moving.kind() {
        _ if moving.mimic().is_some() => true,
        JointType::Revolute | JointType::Continuous if is_leaf(k) => moving.body.about(&moving.axis()) != 0.0,
        JointType::Prismatic if is_leaf(k) => moving.body.m != 0.0,
        _ if moving.joint.is_none() => !moving.body.is_nothing(),
        _ => has_body[k],
    };
    let idle = links.iter().enumerate().filter(|(k, moving)| !resists(*k, moving)).map(|(_, moving)| moving);
    idle.map(|moving| match moving.joint {
        Some(joint) => format!(
            "link `{}` moves, and has neither mass nor inertia against the joint `{}`, nor has what it carries: give it \
             some, or --fix {}",
            moving.link.name, joint.name, joint.name
        ),
        None => format!("the root `{}` is free in space, and has no mass or inertia: give it some", moving.link.name),
    })
    .collect()
}

/// Notes on damping and friction that the equations do not have.
pub(crate) fn left_out(links: &[Moving], friction: bool) -> Vec<String> {
    let with = |is: &dyn Fn(&Moving, &Dynamics) -> bool| -> Vec<String> {
        let joints = links.iter().filter_map(|moving| Some((moving, moving.joint?)));
        let joints = joints
            .filter(|(moving, joint)| joint.dynamics.as_ref().is_some_and(|dynamics| is(moving, dynamics)));
        joints.map(|(_, joint)| format!("`{}`", joint.name)).collect()
    };
    let several = with(&|moving, of| !moving.is_simple() && (of.damping > 0.0 || of.friction > 0.0));
    let dry = with(&|moving, of| moving.is_simple() && of.friction > 0.0 && !friction);
    let note = |joints: Vec<String>, what: &str| {
        (!joints.is_empty()).then(|| format!("{what}: {}", joints.join(", ")))
    };
    let notes = [
        note(several, "damping and friction are left out of joints with several coordinates"),
        note(dry, "dry friction is left out without --friction, of the joints"),
    ];
    notes.into_iter().flatten().collect()
}

/// Errors for joints that mimic none that moves by a single coordinate, or each other.
pub(crate) fn mimic_errors(robot: &Robot, links: &[Moving]) -> Vec<String> {
    let joints = links.iter().filter_map(|moving| Some((moving, moving.joint?, moving.mimic()?)));
    let error = |(moving, joint, mimic): (&Moving, &Joint, &Mimic)| {
        let (name, other) = (&joint.name, &mimic.joint);
        match by_joint(links, other) {
            _ if !moving.is_simple() => {
                Some(format!("joint `{name}` has several coordinates, and cannot mimic"))
            }
            None => Some(format!("joint `{name}` mimics `{other}`, which is no joint that moves")),
            Some(index) if !links[index].is_simple() => {
                Some(format!("joint `{name}` mimics `{other}`, which has several coordinates"))
            }
            Some(_) => goes_round(robot, joint)
                .then(|| format!("joint `{name}` mimics `{other}`, which mimics it in turn")),
        }
    };
    joints.filter_map(error).collect()
}

/// True if the joints that are mimicked one after another never end.
fn goes_round(robot: &Robot, joint: &Joint) -> bool {
    let next = |joint: &Joint| {
        let name = &joint.mimic.as_ref()?.joint;
        robot.joints.iter().find(|joint| joint.name == *name)
    };
    let mut place = Some(joint);
    for _ in 0..=robot.joints.len() {
        place = place.and_then(next);
    }
    place.is_some()
}

#[cfg(test)]
mod tests {
    use urdf_rs::{Inertia, Mass};

    use super::*;

    /// A rod has the largest inertia that a body can have: one moment is the sum of the others, up to rounding.
    #[test]
    fn rods_in_any_direction_are_bodies() {
        for k in 0..100_000 {
            let (height, angle) = (f64::from(k) / 50_000.0 - 1.0, f64::from(k) * 2.399_963);
            let across = (1.0 - height * height).sqrt();
            let [x, y, z] = [across * angle.cos(), across * angle.sin(), height];
            let inertia = |scale: f64| Inertia {
                ixx: scale * (1.0 - x * x),
                ixy: -scale * x * y,
                ixz: -scale * x * z,
                iyy: scale * (1.0 - y * y),
                iyz: -scale * y * z,
                izz: scale * (1.0 - z * z),
            };
            let inertial =
                Inertial { mass: Mass { value: 1.0 }, inertia: inertia(0.037), ..Inertial::default() };
            let link = Link { name: "rod".to_owned(), inertial, visual: Vec::new(), collision: Vec::new() };
            assert_eq!(impossible_inertia(&link), None, "{x} {y} {z}");
        }
    }
}
