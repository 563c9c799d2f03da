//! Steps from a link to the next, across a joint.

use nalgebra::Vector3;

use crate::number::{angle, expression, vector};
use crate::pose::Pose;
use crate::robot::JointType;

/// Steps of the place of a joint in its parent: the translation, then yaw, pitch, roll. Zeros are left out.
pub(crate) fn place(pose: &Pose) -> Vec<String> {
    let mut steps = Vec::new();
    if pose.xyz != Vector3::zeros() {
        steps.push(format!("translate({})", vector(pose.xyz.as_slice())));
    }
    for (k, axis) in [(2, 'z'), (1, 'y'), (0, 'x')] {
        if pose.rpy[k] != 0.0 {
            steps.push(format!("rotate_{axis}({})", angle(pose.rpy[k])));
        }
    }
    steps
}

/// Steps of the motion of a joint whose coordinate is called `q`, and its orientation `turn` if it has one of its own.
pub(crate) fn motion(kind: JointType, axis: &Vector3<f64>, q: &str, turn: &str) -> Vec<String> {
    match kind {
        JointType::Revolute | JointType::Continuous => vec![rotation(axis, q)],
        JointType::Prismatic => vec![translation(axis, q)],
        JointType::Planar => {
            let [u, v] = plane(axis);
            let within = format!("{q}[0]*{} + {q}[1]*{}", vector(u.as_slice()), vector(v.as_slice()));
            vec![format!("translate({within})"), rotation(axis, &format!("{q}[2]"))]
        }
        JointType::Floating => vec![format!("translate({q})"), format!("rotate({turn})")],
        JointType::Spherical => vec![format!("rotate({q})")],
        JointType::Fixed => Vec::new(),
    }
}

/// Index and sign of the coordinate axis that this one of length 1 is.
fn along(axis: &Vector3<f64>) -> Option<(usize, f64)> {
    let k = axis.iamax();
    let others_are_zero = (0..3).all(|other| other == k || axis[other] == 0.0);
    others_are_zero.then(|| (k, axis[k].signum()))
}

fn rotation(axis: &Vector3<f64>, q: &str) -> String {
    match along(axis) {
        Some((k, sign)) => format!("rotate_{}({}{q})", ["x", "y", "z"][k], minus(sign)),
        None => format!("rotate({}, {q})", vector(axis.as_slice())),
    }
}

fn translation(axis: &Vector3<f64>, q: &str) -> String {
    let Some((k, sign)) = along(axis) else { return format!("translate({q}*{})", vector(axis.as_slice())) };
    let mut entries = ["0"; 3].map(str::to_owned);
    entries[k] = format!("{}{q}", minus(sign));
    format!("translate([{}])", entries.join(", "))
}

fn minus(sign: f64) -> &'static str {
    if sign < 0.0 { "-" } else { "" }
}

/// Axes of a plane with this normal of length 1, to the right-hand rule: x and y where the normal is z.
pub(crate) fn plane(normal: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let mut first = Vector3::zeros();
    first[(normal.iamax() + 1) % 3] = 1.0;
    let first = (first - normal * normal.dot(&first)).normalize();
    [first, normal.cross(&first)]
}

/// Coordinate of a mimic joint, `factor` times that of another plus `offset`.
pub(crate) fn mimic(of: &str, factor: f64, offset: f64) -> String {
    let product = match factor {
        1.0 => of.to_owned(),
        -1.0 => format!("-{of}"),
        _ => format!("{}*{of}", expression(factor)),
    };
    match offset {
        0.0 => product,
        _ if offset < 0.0 => format!("{product} - {}", expression(-offset)),
        _ => format!("{product} + {}", expression(offset)),
    }
}
