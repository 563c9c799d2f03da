//! Vectors and frames of the language: their text and their values.
//!
//! A frame is a rotation matrix and an origin, multiplied out. Velocities are derivatives of positions and axes
//! along the motion. No angular velocity and no twist is propagated from frame to frame.

use super::draft::{ATOM, Draft, PRODUCT, SUM, Step, Vector};
use super::here::Here;
use super::jet::Jet;
use crate::symbolic::Function;

type Triple = [Jet; 3];
type Rows = [Triple; 3];

impl Vector {
    pub(super) fn text(&self, draft: &Draft) -> String {
        self.written(draft).0
    }

    /// Text of the vector, in parentheses if an index cannot follow it directly.
    pub(super) fn atom(&self, draft: &Draft) -> String {
        let (text, place) = self.written(draft);
        if place < ATOM { format!("({text})") } else { text }
    }

    fn written(&self, draft: &Draft) -> (String, u8) {
        let at = |vector: &Self, least: u8| {
            let (text, place) = vector.written(draft);
            if place < least { format!("({text})") } else { text }
        };
        let frame = |k: usize| &draft.frames[k].name;
        let text = match self {
            Self::Entries(terms) => {
                let texts = terms.each_ref().map(|term| term.text(draft));
                format!("[{}]", texts.join(", "))
            }
            Self::Coordinate(i) => draft.block(*i, ""),
            Self::Velocity(i) => draft.block(*i, "_dot"),
            Self::Parameter(k) => draft.whole(*k),
            Self::Sum(vectors) => {
                return (format!("{} + {}", at(&vectors[0], SUM), at(&vectors[1], SUM)), SUM);
            }
            Self::Scaled(parts) => {
                return (format!("{}*{}", parts.0.at(PRODUCT, draft), at(&parts.1, ATOM)), PRODUCT);
            }
            Self::Cross(vectors) => format!("cross({}, {})", vectors[0].text(draft), vectors[1].text(draft)),
            Self::Turned(i, v) => format!("quat_rotate({}, {})", draft.block(*i, ""), v.text(draft)),
            Self::Supplied(k, x) => format!("u{k}({})", x.text(draft)),
            Self::Der(v) => format!("der({})", v.text(draft)),
            Self::Position(k, v) => format!("position({}, {})", frame(*k), v.text(draft)),
            Self::Speed(k, v) => format!("velocity({}, {})", frame(*k), v.text(draft)),
            Self::Spin(k) => format!("angular_velocity({})", frame(*k)),
            Self::Along(k, v) => format!("vector({}, {})", frame(*k), v.text(draft)),
            Self::Express(v, [_, to]) => format!("express({}, {})", v.text(draft), frame(*to)),
        };
        (text, ATOM)
    }

    pub(super) fn value(&self, draft: &Draft, here: &Here) -> Triple {
        let of = |vector: &Self| vector.value(draft, here);
        let rate = |vector: Triple| vector.map(|x| x.rate(here.order));
        match self {
            Self::Entries(terms) => terms.each_ref().map(|term| term.value(draft, here)),
            Self::Coordinate(i) => std::array::from_fn(|k| here.coordinates[i + k].clone()),
            Self::Velocity(i) => std::array::from_fn(|k| here.velocities[i + k].clone()),
            Self::Parameter(i) => std::array::from_fn(|k| Jet::number(here.parameters[i + k])),
            Self::Sum(vectors) => sum(of(&vectors[0]), of(&vectors[1])),
            Self::Scaled(parts) => scaled(&parts.0.value(draft, here), of(&parts.1)),
            Self::Cross(vectors) => cross(&of(&vectors[0]), &of(&vectors[1])),
            Self::Turned(i, v) => turned(&quaternion(*i, here), of(v)),
            Self::Supplied(k, x) => {
                let here = here.with_arguments(vec![x.value(draft, here)]);
                std::array::from_fn(|output| draft.supplied[*k].results[output].value(draft, &here))
            }
            Self::Der(v) => rate(v.value(draft, &here.later())),
            Self::Position(k, v) => placed(*k, &of(v), draft, here),
            Self::Speed(k, v) => {
                let later = here.later();
                let speed = rate(placed(*k, &v.value(draft, &later), draft, &later));
                times(&transposed(&pose(*k, draft, here).0), &speed)
            }
            // Rᵀ Ṙ is the cross-product matrix of ω.
            Self::Spin(k) => {
                let axes = transposed(&pose(*k, draft, here).0);
                let rates = transposed(&pose(*k, draft, &here.later()).0.map(rate));
                [(2, 1), (0, 2), (1, 0)].map(|(i, j)| dot(&axes[i], &rates[j]))
            }
            Self::Along(_, v) => of(v),
            Self::Express(v, [from, to]) => {
                let fixed = times(&pose(*from, draft, here).0, &of(v));
                times(&transposed(&pose(*to, draft, here).0), &fixed)
            }
        }
    }
}

impl Step {
    pub(super) fn text(&self, draft: &Draft) -> String {
        match self {
            Self::Translate(by) => format!("translate({})", by.text(draft)),
            Self::About(axis, angle) => format!("rotate_{}({})", ["x", "y", "z"][*axis], angle.text(draft)),
            Self::Rotate(axis, angle) => format!("rotate({}, {})", axis.text(draft), angle.text(draft)),
            Self::Quaternion(i) => format!("rotate({})", draft.block(*i, "")),
        }
    }

    /// Rotation matrix, with the images of the three axes as columns, and displacement of the origin.
    fn value(&self, draft: &Draft, here: &Here) -> (Rows, Triple) {
        let turned =
            |turn: &dyn Fn(Triple) -> Triple| transposed(&UNIT.map(|axis| turn(axis.map(Jet::number))));
        let rotation = match self {
            Self::Translate(by) => return (UNIT.map(|row| row.map(Jet::number)), by.value(draft, here)),
            Self::About(axis, angle) => {
                let (axis, angle) = (UNIT[*axis].map(Jet::number), angle.value(draft, here));
                turned(&|v| about(&axis, &angle, &v))
            }
            Self::Rotate(axis, angle) => {
                let (axis, angle) = (axis.value(draft, here), angle.value(draft, here));
                let axis = scaled(&(Jet::number(1.0) / dot(&axis, &axis).sqrt()), axis);
                turned(&|v| about(&axis, &angle, &v))
            }
            Self::Quaternion(i) => {
                let q = quaternion(*i, here);
                let square = q.iter().fold(Jet::number(0.0), |sum, x| sum + x.clone() * x.clone());
                turned(&|v| self::turned(&q, v).map(|x| x / square.clone()))
            }
        };
        (rotation, [0.0; 3].map(Jet::number))
    }
}

/// ½ m |ṙ|² + ½ tr(Ṙ J Ṙᵀ), J = ½ tr(I) 1 − I, from the rates of the centre and of the axes.
pub(super) fn kinetic(
    k: usize,
    mass: &Jet,
    centre: &Vector,
    inertia: usize,
    draft: &Draft,
    here: &Here,
) -> Jet {
    let later = here.later();
    let rate = |vector: Triple| vector.map(|x| x.rate(here.order));
    let speed = rate(placed(k, &centre.value(draft, &later), draft, &later));
    let axes = pose(k, draft, &later).0.map(rate);
    let entry = |i: usize, j: usize| Jet::number(here.parameters[inertia + 3 * i + j]);
    let half = Jet::number(0.5);
    let trace = half.clone() * (entry(0, 0) + entry(1, 1) + entry(2, 2));
    let moments = |i: usize, j: usize| if i == j { trace.clone() - entry(i, j) } else { -entry(i, j) };
    let mut sum = mass.clone() * dot(&speed, &speed);
    for row in &axes {
        for i in 0..3 {
            for j in 0..3 {
                sum = sum + moments(i, j) * row[i].clone() * row[j].clone();
            }
        }
    }
    half * sum
}

const UNIT: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Axes of a frame, as columns, and its origin.
fn pose(k: usize, draft: &Draft, here: &Here) -> (Rows, Triple) {
    let frame = &draft.frames[k];
    let rest = || (UNIT.map(|row| row.map(Jet::number)), [0.0; 3].map(Jet::number));
    let before = frame.parent.map_or_else(rest, |parent| pose(parent, draft, here));
    let here = here.at_index(frame.index);
    frame.steps.iter().fold(before, |(axes, origin), step| {
        let (turn, by) = step.value(draft, &here);
        let columns = transposed(&turn).map(|column| times(&axes, &column));
        (transposed(&columns), sum(origin, times(&axes, &by)))
    })
}

/// Position of a point of a frame, along the fixed axes.
fn placed(k: usize, point: &Triple, draft: &Draft, here: &Here) -> Triple {
    let (axes, origin) = pose(k, draft, here);
    sum(origin, times(&axes, point))
}

fn quaternion(first: usize, here: &Here) -> [Jet; 4] {
    std::array::from_fn(|k| here.coordinates[first + k].clone())
}

/// q v q̄ = (w² − u²) v + 2 (u·v) u + 2 w u × v for q = (w, u).
fn turned([w, x, y, z]: &[Jet; 4], v: Triple) -> Triple {
    let u = [x.clone(), y.clone(), z.clone()];
    let two = Jet::number(2.0);
    let along = two.clone() * dot(&u, &v);
    let across = scaled(&(two * w.clone()), cross(&u, &v));
    let stay = w.clone() * w.clone() - dot(&u, &u);
    sum(sum(scaled(&stay, v), scaled(&along, u)), across)
}

/// Rotates v about an axis of length 1 (Rodrigues): v cos α + a × v sin α + a (a·v) (1 − cos α)
fn about(axis: &Triple, angle: &Jet, v: &Triple) -> Triple {
    let (sine, cosine) = (angle.apply(Function::Sin), angle.apply(Function::Cos));
    let versine = Jet::number(1.0) - cosine.clone();
    let across = scaled(&sine, cross(axis, v));
    let along = scaled(&(versine * dot(axis, v)), axis.clone());
    sum(sum(scaled(&cosine, v.clone()), across), along)
}

fn sum(a: Triple, b: Triple) -> Triple {
    let ([a, b, c], [x, y, z]) = (a, b);
    [a + x, b + y, c + z]
}

fn scaled(factor: &Jet, vector: Triple) -> Triple {
    vector.map(|x| factor.clone() * x)
}

pub(super) fn dot([a, b, c]: &Triple, [x, y, z]: &Triple) -> Jet {
    a.clone() * x.clone() + b.clone() * y.clone() + c.clone() * z.clone()
}

fn cross(a: &Triple, b: &Triple) -> Triple {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i].clone() * b[j].clone() - a[j].clone() * b[i].clone())
}

fn times(rows: &Rows, v: &Triple) -> Triple {
    rows.each_ref().map(|row| dot(row, v))
}

fn transposed(rows: &Rows) -> Rows {
    std::array::from_fn(|i| std::array::from_fn(|j| rows[j][i].clone()))
}
