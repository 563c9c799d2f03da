//! The struct with its fields, and the values of these.

use super::contacts::stops;
use super::{columns, one_line};
use crate::body::Body;
use crate::names::{Label, Labels};
use crate::number::rust;
use crate::options::Options;
use crate::robot::JointType;
use crate::tree::{Moving, Tree};

/// A field of the struct.
struct Field {
    name: String,
    class: &'static str,
    /// With the unit.
    meaning: String,
    value: String,
}

pub(super) fn fields(tree: &Tree, labels: &Labels, options: &Options) -> Vec<String> {
    let fields = all(tree, labels, options);
    let name = &labels.robot;
    let mut lines = vec![format!("pub struct {name} {{")];
    for field in &fields {
        lines.push(format!("    /// {}", field.meaning));
        lines.push(format!("    pub {}: {},", field.name, field.class));
    }
    lines.extend(["}", "", "#[rustfmt::skip]", "#[allow(clippy::approx_constant)]"].map(str::to_owned));
    lines.push(format!("impl Default for {name} {{"));
    lines.extend(
        [
            "    /// The robot of the description, without efforts.",
            "    fn default() -> Self {",
            "        Self {",
        ]
        .map(str::to_owned),
    );
    let rows: Vec<_> =
        fields.iter().map(|field| vec![format!("{}:", field.name), format!("{},", field.value)]).collect();
    lines.extend(columns(&rows).into_iter().map(|row| format!("            {row}")));
    lines.extend(["        }", "    }", "}"].map(str::to_owned));
    if !options.numbers {
        lines.extend(BODY.lines().map(str::to_owned));
    }
    lines
}

fn all(tree: &Tree, labels: &Labels, options: &Options) -> Vec<Field> {
    let meaning = "Acceleration of gravity along −z, in m/s².".to_owned();
    let mut fields = vec![Field { name: "g".to_owned(), class: "f64", meaning, value: "9.81".to_owned() }];
    let links = || tree.links.iter().zip(&labels.links);
    if !options.numbers {
        fields.extend(
            links()
                .filter(|(moving, _)| !moving.body.is_nothing())
                .map(|(moving, label)| body(moving, label)),
        );
    }
    for (moving, label) in links() {
        fields.extend(of_joint(moving, label, options));
    }
    if !tree.feet.is_empty() {
        let meaning =
            "Coefficient of friction of the floor, which the description does not state.".to_owned();
        fields.push(Field { name: labels.mu.clone(), class: "f64", meaning, value: rust(1.0) });
    }
    for (foot, name) in tree.feet.iter().zip(&labels.feet) {
        fields.push(contact(name, format!("Whether the link `{}` touches the floor.", one_line(foot.link))));
    }
    fields
}

fn body(moving: &Moving, label: &Label) -> Field {
    let meaning = format!("Body of the link `{}`.", one_line(&moving.link.name));
    Field { name: label.body.clone(), class: "Body", meaning, value: new(&moving.body) }
}

fn new(Body { m, centre, inertia: i }: &Body) -> String {
    let list =
        |entries: &[f64]| format!("[{}]", entries.iter().map(|x| rust(*x)).collect::<Vec<_>>().join(", "));
    let entries = [i[(0, 0)], i[(0, 1)], i[(0, 2)], i[(1, 1)], i[(1, 2)], i[(2, 2)]];
    format!("Body::new({}, {}, {})", rust(*m), list(centre.as_slice()), list(&entries))
}

fn of_joint(moving: &Moving, label: &Label, options: &Options) -> Vec<Field> {
    let Some(joint) = moving.joint else { return Vec::new() };
    let (joint, is_sliding) = (one_line(&joint.name), moving.kind() == JointType::Prismatic);
    let (effort, damping) = if is_sliding { ("N", "N s/m") } else { ("N m", "N m s/rad") };
    let number = |name: &String, meaning: String, value: f64| Field {
        name: name.clone(),
        class: "f64",
        meaning,
        value: rust(value),
    };
    let mut fields = Vec::new();
    if moving.is_driven() {
        fields.push(number(&label.tau, format!("Effort of the joint `{joint}`, in {effort}."), 0.0));
    }
    if moving.damping() > 0.0 && !options.numbers {
        fields.push(number(
            &label.damping,
            format!("Damping of the joint `{joint}`, in {damping}."),
            moving.damping(),
        ));
    }
    if moving.friction() > 0.0 && options.friction {
        let meaning = format!("Whether the joint `{joint}` sticks or slides.");
        let value = "Friction::default()".to_owned();
        fields.push(Field { name: label.friction.clone(), class: "Friction", meaning, value });
        if !options.numbers {
            let meaning = format!("Dry friction of the joint `{joint}`, in {effort}.");
            fields.push(number(&label.coulomb, meaning, moving.friction()));
        }
    }
    for (name, end) in stops(moving, label, options).into_iter().zip(["lower", "upper"]) {
        fields.push(contact(name, format!("Whether the joint `{joint}` is at its {end} limit.")));
    }
    fields
}

fn contact(name: &str, meaning: String) -> Field {
    Field { name: name.to_owned(), class: "Contact", meaning, value: "Contact::default()".to_owned() }
}

const BODY: &str = "
/// A rigid body in the axes of its link.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// Mass, in kg.
    pub m: f64,
    /// Centre of mass, in m.
    pub centre: Vector3<f64>,
    /// Inertia about the centre of mass, in kg m².
    pub inertia: Matrix3<f64>,
}

impl Body {
    /// The inertia is given by its entries xx, xy, xz, yy, yz, zz.
    pub fn new(m: f64, centre: [f64; 3], [xx, xy, xz, yy, yz, zz]: [f64; 6]) -> Self {
        let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        Self { m, centre: centre.into(), inertia }
    }
}";
