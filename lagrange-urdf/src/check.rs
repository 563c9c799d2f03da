//! What must hold of a description, and of the tree that its joints make.

use std::collections::HashSet;

use nalgebra::Vector3;

use crate::limits;
use crate::names::suggestion;
use crate::robot::{Inertial, Joint, JointType, Link, Mimic, Robot};
use crate::tree::{Moving, by_joint};

/// Returns all errors of single links and joints.
pub(crate) fn errors(robot: &Robot) -> Vec<String> {
    if robot.links.is_empty() {
        return vec!["the robot has no `<link name=\"…\"/>`: add it, or expand xacro first".to_owned()];
    }
    let mut errors = Vec::new();
    errors.extend(twice("links", robot.links.iter().map(|link| &link.name)));
    errors.extend(twice("joints", robot.joints.iter().map(|joint| &joint.name)));
    errors.extend(robot.links.iter().flat_map(link_errors));
    errors.extend(robot.joints.iter().flat_map(joint_errors));
    errors
}

/// Errors for joints whose parent or child does not exist.
pub(crate) fn missing_links(robot: &Robot) -> Vec<String> {
    let known: Vec<&str> = robot.links.iter().map(|link| link.name.as_str()).collect();
    let ends = robot.joints.iter().flat_map(|joint| {
        [("parent", &joint.parent), ("child", &joint.child)].map(|(role, link)| (&joint.name, role, link))
    });
    ends.filter(|(.., link)| !known.contains(&link.as_str()))
        .map(|(joint, role, link)| {
            format!("joint `{joint}`: there is no link `{link}`, its {role}{}", suggestion(link, &known))
        })
        .collect()
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
    let mut numbers = origin.xyz.iter().chain(&origin.rpy).chain(inertia).chain([mass]);
    let mut errors = Vec::new();
    if !numbers.all(|x| x.is_finite()) {
        errors.push(format!("link `{name}`: a number of its inertia is not finite"));
    }
    if *mass < 0.0 {
        errors.push(format!("link `{name}` has a negative mass, {mass}"));
    }
    errors
}

/// Says by how much the largest principal moment exceeds the sum of the others, which no distribution of mass exceeds.
/// Of this moment 64 ε are allowed for the rounding of the eigenvalues: of 100,000 rods, whose excess is zero, the worst
/// needs between 8 ε and 16 ε. An excess in the 13th digit is seen.
pub(crate) fn impossible_inertia(link: &Link) -> Option<String> {
    let entries = link.inertial.inertia;
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

fn joint_errors(joint: &Joint) -> Vec<String> {
    let name = &joint.name;
    let mut errors = Vec::new();
    let mut numbers = joint.origin.xyz.iter().chain(&joint.origin.rpy).chain(&joint.axis);
    if !numbers.all(|x| x.is_finite()) {
        errors.push(format!("joint `{name}`: a number of its origin or axis is not finite"));
    }
    let has_axis = !matches!(joint.kind, JointType::Fixed | JointType::Floating | JointType::Spherical);
    if has_axis && joint.axis == Vector3::zeros() {
        errors.push(format!("joint `{name}` has an axis of length zero"));
    }
    if !(joint.damping >= 0.0 && joint.friction >= 0.0) {
        errors.push(format!("joint `{name}` has negative damping or friction"));
    }
    errors.extend(limits::errors(joint));
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
    let with = |is: &dyn Fn(&Moving, &Joint) -> bool| {
        let joints = links.iter().filter_map(|moving| Some((moving, moving.joint?)));
        in_quotes(joints.filter(|(moving, joint)| is(moving, joint)).map(|(_, joint)| joint))
    };
    let several = with(&|moving, of| !moving.is_simple() && (of.damping > 0.0 || of.friction > 0.0));
    let dry = with(&|moving, of| moving.is_simple() && of.friction > 0.0 && !friction);
    let notes = [
        note(several, "damping and friction are left out of joints with several coordinates"),
        note(dry, "dry friction is left out without --friction, of the joints"),
    ];
    notes.into_iter().flatten().collect()
}

/// Names of joints, separated by commas.
pub(crate) fn in_quotes<'a>(joints: impl Iterator<Item = &'a Joint>) -> String {
    joints.map(|joint| format!("`{}`", joint.name)).collect::<Vec<_>>().join(", ")
}

/// A note on joints, if there are any.
pub(crate) fn note(joints: String, what: &str) -> Option<String> {
    (!joints.is_empty()).then(|| format!("{what}: {joints}"))
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
            None => {
                let known: Vec<&str> = robot.joints.iter().map(|joint| joint.name.as_str()).collect();
                Some(if known.contains(&other.as_str()) {
                    format!("joint `{name}` mimics `{other}`, which does not move")
                } else {
                    let meant = suggestion(other, &known);
                    format!("joint `{name}` mimics `{other}`: there is no joint of this name{meant}")
                })
            }
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
    use nalgebra::Matrix3;

    use super::*;
    use crate::pose::Pose;

    /// A rod has the largest inertia that a body can have: one moment is the sum of the others, up to rounding.
    #[test]
    fn rods_in_any_direction_are_bodies() {
        for k in 0..100_000 {
            let (height, angle) = (f64::from(k) / 50_000.0 - 1.0, f64::from(k) * 2.399_963);
            let across = (1.0 - height * height).sqrt();
            let [x, y, z] = [across * angle.cos(), across * angle.sin(), height];
            let axis = Vector3::new(x, y, z);
            let inertia = (Matrix3::identity() - axis * axis.transpose()) * 0.037;
            let inertial = Inertial { origin: Pose::HERE, mass: 1.0, inertia };
            let link = Link { name: "rod".to_owned(), inertial };
            assert_eq!(impossible_inertia(&link), None, "{x} {y} {z}");
        }
    }
}
