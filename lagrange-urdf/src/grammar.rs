//! Elements and attributes that are read of a description, by the specification of the format.

/// An element that is read.
pub(crate) struct Element {
    pub(crate) name: &'static str,
    pub(crate) attributes: &'static [Attribute],
    /// Elements that it may hold, each with whether it must be there.
    pub(crate) children: &'static [(&'static Self, bool)],
    /// Elements that are left out without a note, since the equations do not depend on them.
    pub(crate) ignored: &'static [&'static str],
    /// True if a note names whatever else stands in it, since the equations may depend on that.
    pub(crate) is_complete: bool,
}

/// An attribute that is read.
pub(crate) struct Attribute {
    pub(crate) name: &'static str,
    pub(crate) value: Value,
    pub(crate) need: Need,
}

/// What an attribute holds.
#[derive(Clone, Copy)]
pub(crate) enum Value {
    Text,
    JointType,
    Numbers(Numbers),
}

/// Numbers with blanks between them.
#[derive(Clone, Copy)]
pub(crate) struct Numbers {
    pub(crate) count: usize,
    pub(crate) example: &'static str,
}

/// Whether an attribute may be left out.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Need {
    May,
    Must,
    /// It may be left out from version 1.2 of the format on.
    MustBefore12,
}

use Need::{May, Must, MustBefore12};

const fn text(name: &'static str, need: Need) -> Attribute {
    Attribute { name, value: Value::Text, need }
}

const fn number(name: &'static str, need: Need) -> Attribute {
    Attribute { name, value: Value::Numbers(Numbers { count: 1, example: "0.5" }), need }
}

const fn vector(name: &'static str, need: Need) -> Attribute {
    Attribute { name, value: Value::Numbers(Numbers { count: 3, example: "0 0 1" }), need }
}

const fn leaf(name: &'static str, attributes: &'static [Attribute]) -> Element {
    Element { name, attributes, children: &[], ignored: &[], is_complete: true }
}

const QUATERNION: Attribute = Attribute {
    name: "quat_xyzw",
    value: Value::Numbers(Numbers { count: 4, example: "0 0 0 1" }),
    need: May,
};
static ORIGIN: Element = leaf("origin", &[vector("xyz", May), vector("rpy", May), QUATERNION]);
static MASS: Element = leaf("mass", &[number("value", Must)]);
static INERTIA: Element = leaf(
    "inertia",
    &[
        number("ixx", Must),
        number("ixy", Must),
        number("ixz", Must),
        number("iyy", Must),
        number("iyz", Must),
        number("izz", Must),
    ],
);
static INERTIAL: Element =
    Element { children: &[(&ORIGIN, false), (&MASS, true), (&INERTIA, true)], ..leaf("inertial", &[]) };
static LINK: Element =
    Element { children: &[(&INERTIAL, false)], is_complete: false, ..leaf("link", &[text("name", Must)]) };
static PARENT: Element = leaf("parent", &[text("link", Must)]);
static CHILD: Element = leaf("child", &[text("link", Must)]);
static AXIS: Element = leaf("axis", &[vector("xyz", Must)]);
static LIMIT: Element = leaf(
    "limit",
    &[
        number("lower", May),
        number("upper", May),
        number("effort", MustBefore12),
        number("velocity", MustBefore12),
        number("acceleration", May),
        number("deceleration", May),
        number("jerk", May),
    ],
);
static DYNAMICS: Element = leaf("dynamics", &[number("damping", May), number("friction", May)]);
static MIMIC: Element =
    leaf("mimic", &[text("joint", Must), number("multiplier", May), number("offset", May)]);
static JOINT: Element = Element {
    children: &[
        (&ORIGIN, false),
        (&PARENT, true),
        (&CHILD, true),
        (&AXIS, false),
        (&LIMIT, false),
        (&DYNAMICS, false),
        (&MIMIC, false),
    ],
    ignored: &["calibration", "safety_controller"],
    ..leaf("joint", &[text("name", Must), Attribute { name: "type", value: Value::JointType, need: Must }])
};

/// The root. Of its elements there may be several.
pub(crate) static ROBOT: Element = Element {
    children: &[(&LINK, false), (&JOINT, false)],
    is_complete: false,
    ..leaf("robot", &[text("name", May), text("version", May)])
};
