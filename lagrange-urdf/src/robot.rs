//! Links and joints of a description.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use crate::pose::{Pose, roll_pitch_yaw};
use crate::syntax::version;
use crate::xml::Node;

/// A robot as described.
#[derive(Debug)]
pub(crate) struct Robot {
    pub(crate) name: String,
    pub(crate) links: Vec<Link>,
    pub(crate) joints: Vec<Joint>,
}

#[derive(Debug)]
pub(crate) struct Link {
    pub(crate) name: String,
    pub(crate) inertial: Inertial,
}

/// Mass and inertia; zero where the description has none.
#[derive(Debug)]
pub(crate) struct Inertial {
    /// Place of the axes of the inertia, in those of the link.
    pub(crate) origin: Pose,
    /// In kg.
    pub(crate) mass: f64,
    /// About the centre of mass, in kg m².
    pub(crate) inertia: Matrix3<f64>,
}

#[derive(Debug)]
pub(crate) struct Joint {
    pub(crate) name: String,
    pub(crate) kind: JointType,
    /// Place of the child in the parent while the joint is at 0.
    pub(crate) origin: Pose,
    pub(crate) parent: String,
    pub(crate) child: String,
    /// As stated, of any length.
    pub(crate) axis: Vector3<f64>,
    pub(crate) limit: Option<Limit>,
    /// In N m s/rad or N s/m.
    pub(crate) damping: f64,
    /// In N m or N.
    pub(crate) friction: f64,
    pub(crate) mimic: Option<Mimic>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum JointType {
    Revolute,
    Continuous,
    Prismatic,
    Fixed,
    Floating,
    Planar,
    Spherical,
}

impl JointType {
    const ALL: [(&str, Self); 7] = [
        ("revolute", Self::Revolute),
        ("continuous", Self::Continuous),
        ("prismatic", Self::Prismatic),
        ("fixed", Self::Fixed),
        ("floating", Self::Floating),
        ("planar", Self::Planar),
        ("spherical", Self::Spherical),
    ];

    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(known, _)| *known == name).map(|(_, kind)| *kind)
    }

    pub(crate) fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, kind)| *kind == self).map_or("", |(name, _)| name)
    }

    /// All names.
    pub(crate) fn names() -> String {
        Self::ALL.map(|(name, _)| name).join(", ")
    }
}

/// Limits of a joint, in rad or m, s, N m or N.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limit {
    pub(crate) position: [f64; 2],
    pub(crate) velocity: f64,
    pub(crate) effort: f64,
}

impl Limit {
    pub(crate) const NONE: Self =
        Self { position: [f64::NEG_INFINITY, f64::INFINITY], velocity: f64::INFINITY, effort: f64::INFINITY };

    /// True if all are zero, as exporters write them where the designer has set none.
    pub(crate) fn is_unset(&self) -> bool {
        self.position == [0.0; 2] && self.velocity == 0.0 && self.effort == 0.0
    }
}

/// The joint is at `multiplier` times the coordinate of another, plus `offset`.
#[derive(Debug)]
pub(crate) struct Mimic {
    pub(crate) joint: String,
    pub(crate) multiplier: f64,
    pub(crate) offset: f64,
}

impl Robot {
    /// Reads the root element of a description in which [`check`](crate::syntax::check) has found no error.
    pub(crate) fn of(root: &Node) -> Self {
        let version = version(root);
        Self {
            name: text(root, "name"),
            links: root.children("link").map(link).collect(),
            joints: root.children("joint").map(|node| joint(node, version)).collect(),
        }
    }
}

fn link(node: &Node) -> Link {
    let inertial = node.child("inertial");
    let inertia = inertial.and_then(|node| node.child("inertia"));
    let [xx, xy, xz, yy, yz, zz] =
        ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"].map(|name| number(inertia, name, 0.0));
    Link {
        name: text(node, "name"),
        inertial: Inertial {
            origin: inertial.map_or(Pose::HERE, origin),
            mass: number(inertial.and_then(|node| node.child("mass")), "value", 0.0),
            inertia: Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz),
        },
    }
}

fn joint(node: &Node, version: (u32, u32)) -> Joint {
    let end = |tag| node.child(tag).map_or(String::new(), |end| text(end, "link"));
    let dynamics = node.child("dynamics");
    Joint {
        name: text(node, "name"),
        kind: JointType::named(&text(node, "type")).unwrap_or(JointType::Fixed),
        origin: origin(node),
        parent: end("parent"),
        child: end("child"),
        axis: node.child("axis").and_then(|node| numbers(node, "xyz")).map_or(Vector3::x(), Vector3::from),
        limit: node.child("limit").map(|node| limit(node, version)),
        damping: number(dynamics, "damping", 0.0),
        friction: number(dynamics, "friction", 0.0),
        mimic: node.child("mimic").map(|node| Mimic {
            joint: text(node, "joint"),
            multiplier: number(Some(node), "multiplier", 1.0),
            offset: number(Some(node), "offset", 0.0),
        }),
    }
}

/// From version 1.2 on, what is not stated has no limit; before, it is zero.
fn limit(node: &Node, version: (u32, u32)) -> Limit {
    let stated = |name, without| number(Some(node), name, if version < (1, 2) { 0.0 } else { without });
    let Limit { position: [lower, upper], velocity, effort } = Limit::NONE;
    Limit {
        position: [stated("lower", lower), stated("upper", upper)],
        velocity: stated("velocity", velocity),
        effort: stated("effort", effort),
    }
}

fn origin(node: &Node) -> Pose {
    let Some(node) = node.child("origin") else { return Pose::HERE };
    let turned = || {
        let [x, y, z, w] = numbers(node, "quat_xyzw")?;
        let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)).to_rotation_matrix();
        Some(roll_pitch_yaw(rotation.matrix()))
    };
    Pose {
        xyz: numbers(node, "xyz").unwrap_or([0.0; 3]).into(),
        rpy: numbers(node, "rpy").or_else(turned).unwrap_or([0.0; 3]),
    }
}

fn text(node: &Node, name: &str) -> String {
    node.attribute(name).unwrap_or_default().to_owned()
}

fn number(node: Option<&Node>, name: &str, without: f64) -> f64 {
    node.and_then(|node| numbers(node, name)).map_or(without, |[x]| x)
}

fn numbers<const N: usize>(node: &Node, name: &str) -> Option<[f64; N]> {
    let words = node.attribute(name)?.split_whitespace();
    let numbers: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
    numbers.try_into().ok()
}
