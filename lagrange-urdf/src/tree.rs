//! Links that move, parents first, with all that is fixed to them.

use std::collections::HashMap;

use nalgebra::Vector3;

use crate::body::Body;
use crate::check;
use crate::names::suggestion;
use crate::options::Options;
use crate::pose::Pose;
use crate::robot::{Joint, JointType, Link, Mimic, Robot};

/// A robot without fixed joints.
pub(crate) struct Tree<'a> {
    /// Each after the one that carries it.
    pub(crate) links: Vec<Moving<'a>>,
    /// Links of `--tool`, with the moving link that each is part of and its place in there.
    pub(crate) tools: Vec<Tool<'a>>,
    /// Links of `--contact`, in the same way.
    pub(crate) feet: Vec<Tool<'a>>,
}

/// A link that moves relative to the one that carries it.
pub(crate) struct Moving<'a> {
    pub(crate) link: &'a Link,
    /// Index of the moving link that carries it; none where that is at rest.
    pub(crate) parent: Option<usize>,
    /// Place of the joint in the carrier.
    pub(crate) origin: Pose,
    /// None of a root that is free in space.
    pub(crate) joint: Option<&'a Joint>,
    /// Of the link and all that is fixed to it.
    pub(crate) body: Body,
    /// Names of links that are fixed to it and have a body.
    pub(crate) merged: Vec<&'a str>,
}

impl Moving<'_> {
    pub(crate) fn kind(&self) -> JointType {
        self.joint.map_or(JointType::Floating, |joint| joint.kind)
    }

    /// Axis of the joint, of length 1.
    pub(crate) fn axis(&self) -> Vector3<f64> {
        let axis = self.joint.map_or(Vector3::z(), |joint| joint.axis);
        axis / axis.norm()
    }

    /// True with a single coordinate.
    pub(crate) fn is_simple(&self) -> bool {
        matches!(self.kind(), JointType::Revolute | JointType::Continuous | JointType::Prismatic)
    }

    /// What it follows in place of a coordinate of its own.
    pub(crate) fn mimic(&self) -> Option<&Mimic> {
        self.joint?.mimic.as_ref()
    }

    /// True with an effort: with a single coordinate of its own.
    pub(crate) fn is_driven(&self) -> bool {
        self.is_simple() && self.mimic().is_none()
    }

    /// Viscous damping, 0 without.
    pub(crate) fn damping(&self) -> f64 {
        self.joint.filter(|_| self.is_simple()).map_or(0.0, |joint| joint.damping)
    }

    /// Dry friction, 0 without.
    pub(crate) fn friction(&self) -> f64 {
        self.joint.filter(|_| self.is_simple()).map_or(0.0, |joint| joint.friction)
    }
}

/// A link with observables.
pub(crate) struct Tool<'a> {
    pub(crate) link: &'a str,
    pub(crate) host: usize,
    pub(crate) place: Pose,
}

/// Where a link is: within a moving link, or at rest.
#[derive(Clone, Copy)]
struct Site {
    host: Option<usize>,
    pose: Pose,
}

impl<'a> Tree<'a> {
    /// Returns the tree, or all that is wrong with it.
    pub(crate) fn new(robot: &'a Robot, options: &Options) -> Result<Self, Vec<String>> {
        let root = root(robot)?;
        let (links, sites) = grow(robot, root, options.floating);
        let mut errors: Vec<_> = lost(robot, &sites).into_iter().collect();
        errors.extend(check::weightless(&links));
        errors.extend(check::mimic_errors(robot, &links));
        if links.is_empty() && errors.is_empty() {
            errors.push(
                "no link of the robot moves: all joints are fixed, or --floating is missing".to_owned(),
            );
        }
        let mut named = |option: &str, names: &[String]| {
            let mut found = Vec::new();
            for name in names {
                match tool(&sites, option, name) {
                    Ok(tool) => found.push(tool),
                    Err(error) => errors.push(error),
                }
            }
            found
        };
        let (tools, feet) = (named("--tool", &options.tools), named("--contact", &options.contacts));
        if errors.is_empty() { Ok(Self { links, tools, feet }) } else { Err(errors) }
    }

    /// Index of the link that a joint moves.
    pub(crate) fn by_joint(&self, name: &str) -> Option<usize> {
        by_joint(&self.links, name)
    }

    /// Number of joints that are mimicked one after another, until one with a coordinate.
    pub(crate) fn depth(&self, moving: &Moving) -> usize {
        let next = |moving: &&Moving| Some(&self.links[self.by_joint(&moving.mimic()?.joint)?]);
        std::iter::successors(Some(moving), next).count() - 1
    }
}

/// Index of the link that a joint moves.
pub(crate) fn by_joint(links: &[Moving], name: &str) -> Option<usize> {
    links.iter().position(|moving| moving.joint.is_some_and(|joint| joint.name == name))
}

/// The only link that no joint carries.
fn root(robot: &Robot) -> Result<&Link, Vec<String>> {
    let carriers = |link: &Link| robot.joints.iter().filter(|joint| joint.child == link.name).count();
    let mut errors = Vec::new();
    for link in robot.links.iter().filter(|link| carriers(link) > 1) {
        let joints = robot.joints.iter().filter(|joint| joint.child == link.name);
        let names = list(joints.map(|joint| joint.name.as_str()));
        errors.push(format!(
            "link `{}` is the child of several joints, {names}: a loop must be cut, and closed by a constraint",
            link.name
        ));
    }
    let roots: Vec<_> = robot.links.iter().filter(|link| carriers(link) == 0).collect();
    match roots[..] {
        [root] if errors.is_empty() => return Ok(root),
        [_] => {}
        [] => errors.push("every link is the child of a joint: the joints go round in a cycle".to_owned()),
        _ => {
            let names = list(roots.iter().map(|link| link.name.as_str()));
            errors.push(format!(
                "there are {} roots, {names}: all but one must be the child of a joint",
                roots.len()
            ));
        }
    }
    Err(errors)
}

fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// Goes from the root to the leaves, each branch to its end, in the order of the description. Returns the moving links,
/// and where each link that was reached is.
fn grow<'a>(robot: &'a Robot, root: &'a Link, floating: bool) -> (Vec<Moving<'a>>, HashMap<&'a str, Site>) {
    let links: HashMap<&str, &Link> = robot.links.iter().map(|link| (link.name.as_str(), link)).collect();
    let mut children: HashMap<&str, Vec<&Joint>> = HashMap::new();
    for joint in robot.joints.iter().rev() {
        children.entry(&joint.parent).or_default().push(joint);
    }
    let (mut moving, mut sites) = (Vec::new(), HashMap::new());
    let at_rest = Site { host: None, pose: Pose::HERE };
    let start = if floating { depart(&mut moving, root, at_rest, None) } else { at_rest };
    sites.insert(root.name.as_str(), start);
    let mut waiting: Vec<&Joint> = children.get(root.name.as_str()).cloned().unwrap_or_default();
    while let Some(joint) = waiting.pop() {
        let (Some(&link), Some(&carrier)) =
            (links.get(joint.child.as_str()), sites.get(joint.parent.as_str()))
        else {
            continue;
        };
        let origin = carrier.pose.then(&joint.origin);
        let site = Site { host: carrier.host, pose: origin };
        let site = match joint.kind {
            JointType::Fixed => stay(&mut moving, link, site),
            _ => depart(&mut moving, link, site, Some(joint)),
        };
        sites.insert(link.name.as_str(), site);
        waiting.extend(children.get(link.name.as_str()).into_iter().flatten());
    }
    (moving, sites)
}

/// Adds a link that moves from this site.
fn depart<'a>(moving: &mut Vec<Moving<'a>>, link: &'a Link, from: Site, joint: Option<&'a Joint>) -> Site {
    let body = Body::of(&link.inertial);
    moving.push(Moving { link, parent: from.host, origin: from.pose, joint, body, merged: Vec::new() });
    Site { host: Some(moving.len() - 1), pose: Pose::HERE }
}

/// Adds the body of a link that is fixed at this site to the one that it is part of.
fn stay<'a>(moving: &mut [Moving<'a>], link: &'a Link, site: Site) -> Site {
    let body = Body::of(&link.inertial);
    if let Some(host) = site.host.filter(|_| !body.is_nothing()) {
        moving[host].body = moving[host].body.with(&body.at(&site.pose));
        moving[host].merged.push(&link.name);
    }
    site
}

/// Links that no path of joints leads to from the root: they hang on a cycle.
fn lost(robot: &Robot, sites: &HashMap<&str, Site>) -> Option<String> {
    let lost = robot.links.iter().map(|link| link.name.as_str()).filter(|name| !sites.contains_key(name));
    let names = list(lost);
    (!names.is_empty()).then(|| format!("the joints of {names} go round in a cycle"))
}

fn tool<'a>(sites: &HashMap<&'a str, Site>, option: &str, name: &str) -> Result<Tool<'a>, String> {
    let Some((link, site)) = sites.get_key_value(name) else {
        let known: Vec<&str> = sites.keys().copied().collect();
        return Err(format!("{option} {name}: there is no link of this name{}", suggestion(name, &known)));
    };
    match site.host {
        Some(host) => Ok(Tool { link, host, place: site.pose }),
        None => Err(format!("{option} {name}: the link does not move")),
    }
}
