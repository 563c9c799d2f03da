//! Loads on a tree beside gravity: forces, springs, friction, a magnetic field, and constraints.

use super::algebra::{difference, norm, times, transposed};
use super::draft::{Draft, Frame};
use super::model::{Load, Point, Tie};
use lagrange_random::Random;

/// Each load: name, n if one in n trees has it, and function that draws it.
pub(super) const LOADS: [(&str, usize, Draw); 7] = [
    ("spring", 3, spring),
    ("force by its potential", 5, force),
    ("force by its power", 5, push),
    ("torque by its power", 5, torque),
    ("damper", 5, damper),
    ("drag by its power", 5, drag),
    ("magnetic field", 5, charge),
];

type Draw = fn(&mut Draft, &mut Random, &[Frame]);

/// The name of a point's frame, and the point.
type Named<'f> = (&'f str, Point);

pub(super) fn loads(draft: &mut Draft, random: &mut Random, frames: &[Frame]) {
    forces(draft, random);
    for (name, times, draw) in LOADS {
        if random.once_in(times) {
            let before = draft.model.loads.len();
            draw(draft, random, frames);
            if draft.model.loads.len() > before {
                draft.count(name);
            }
        }
    }
}

/// Adds generalized forces on coordinates and quaternions.
fn forces(draft: &mut Draft, random: &mut Random) {
    for i in draft.scalars.clone() {
        if random.once_in(4) {
            draft.count("force on a coordinate");
            let [force, friction] = [random.between(-2.0, 2.0), random.between(0.0, 1.0)];
            let names = [force, friction].map(|number| draft.number_field(number));
            draft.attribute(format!("force(c{i}: {} - {}*c{i}_dot)", names[0], names[1]));
            draft.model.forces[i] += force - friction * draft.model.velocities[i];
        }
    }
    for tie in draft.model.ties.clone() {
        if let (Tie::Unit(first), true) = (tie, random.once_in(4)) {
            draft.count("force on a quaternion");
            let force = random.quaternion();
            let name = draft.field("[f64; 4]", force);
            draft.attribute(format!("force(c{first}: {name})"));
            (0..4).for_each(|k| draft.model.forces[first + k] += force[k]);
        }
    }
}

/// Random point, at rest in a random frame or in the fixed one.
fn point<'f>(random: &mut Random, frames: &'f [Frame]) -> Named<'f> {
    match frames.get(random.below(frames.len() + 1)) {
        Some(frame) => of(frame, random),
        None => ("fixed", Point { link: 0, at: random.vector() }),
    }
}

/// Random point, at rest in this frame.
fn of<'f>(frame: &'f Frame, random: &mut Random) -> Named<'f> {
    (&frame.name, Point { link: frame.link, at: random.vector() })
}

/// Text of a point, as the arguments of `position` or `velocity`.
fn written(draft: &mut Draft, (frame, point): Named<'_>) -> String {
    format!("{frame}, {}", draft.vector_field(point.at))
}

fn spring(draft: &mut Draft, random: &mut Random, frames: &[Frame]) {
    let (from, to) = (point(random, frames), point(random, frames));
    if from.0 == to.0 {
        return spring(draft, random, frames);
    }
    let [k, l] = [random.between(0.5, 5.0), random.between(0.0, 1.0)];
    let [a, b] = [from, to].map(|end| written(draft, end));
    let [stiffness, rest] = [k, l].map(|number| draft.number_field(number));
    draft.term(format!("(-{stiffness}/2*(norm(position({a}) - position({b})) - {rest})^2)"));
    draft.load(Load::Spring(from.1, to.1, k, l));
}

/// Adds a constant force by its potential, written in the axes of any frame.
fn force(draft: &mut Draft, random: &mut Random, frames: &[Frame]) {
    let (at, force) = (point(random, frames), random.vector());
    let (a, name) = (written(draft, at), draft.vector_field(force));
    let axes = &frames[random.below(frames.len())].name;
    draft.term(format!("dot(express(vector(fixed, {name}), {axes}), express(position({a}), {axes}))"));
    draft.load(Load::Given(at.1, force));
}

/// Random point of a frame that a coordinate moves.
fn moving_point<'f>(draft: &Draft, random: &mut Random, frames: &'f [Frame]) -> Named<'f> {
    let frame = &frames[random.below(frames.len())];
    if draft.model.is_moved(frame.link) { of(frame, random) } else { moving_point(draft, random, frames) }
}

fn damper(draft: &mut Draft, random: &mut Random, frames: &[Frame]) {
    let (at, c) = (moving_point(draft, random, frames), random.between(0.1, 1.0));
    let (a, name) = (written(draft, at), draft.number_field(c));
    draft.dissipation(format!("{name}/2*dot(velocity({a}), velocity({a}))"));
    draft.load(Load::Damper(at.1, c));
}

fn drag(draft: &mut Draft, random: &mut Random, frames: &[Frame]) {
    let (at, c) = (moving_point(draft, random, frames), random.between(0.1, 1.0));
    let (a, name) = (written(draft, at), draft.number_field(c));
    draft.attribute(format!("power(-{name}*velocity({a}), velocity({a}))"));
    draft.load(Load::Damper(at.1, c));
}

fn push(draft: &mut Draft, random: &mut Random, frames: &[Frame]) {
    let (at, force) = (moving_point(draft, random, frames), random.vector());
    let (a, name) = (written(draft, at), draft.vector_field(force));
    draft.attribute(format!("power(express(vector(fixed, {name}), {}), velocity({a}))", at.0));
    draft.load(Load::Given(at.1, force));
}

fn torque(draft: &mut Draft, random: &mut Random, frames: &[Frame]) {
    let turning: Vec<&Frame> = frames.iter().filter(|frame| draft.model.is_turned(frame.link)).collect();
    if !turning.is_empty() {
        let (frame, torque) = (turning[random.below(turning.len())], random.vector());
        let (f, name) = (&frame.name, draft.vector_field(torque));
        draft.attribute(format!("power({name}, angular_velocity({f}))"));
        draft.load(Load::Torque(frame.link, torque));
    }
}

/// Adds a unit charge in a magnetic field B: L = v·A with A = B × r/2.
fn charge(draft: &mut Draft, random: &mut Random, frames: &[Frame]) {
    let (at, field) = (point(random, frames), random.vector());
    let (a, name) = (written(draft, at), draft.vector_field(field));
    draft.term(format!("dot({name}, cross(position({a}), express(velocity({a}), fixed)))/2"));
    draft.load(Load::Magnetic(at.1, field));
}

/// Adds a constraint of this name that is independent of the others, if eight attempts find one.
pub(super) fn tied(draft: &mut Draft, random: &mut Random, frames: &[Frame], name: &str) {
    for _ in 0..8 {
        let (one, other) = (of(&frames[random.below(frames.len())], random), point(random, frames));
        let (kind, tie) = tie(draft, random, one.1, other.1);
        draft.tie(tie.clone(), name.into());
        if draft.model.is_tied_well() {
            draft.count(kind);
            let text = equation(draft, &tie, one.0, other.0);
            return draft.attribute(format!("constraint({name}: {text})"));
        }
        draft.untie();
    }
}

fn tie(draft: &Draft, random: &mut Random, one: Point, other: Point) -> (&'static str, Tie) {
    match random.below(6) {
        0..3 => {
            // Position of the point along the axes of the other frame.
            let poses = draft.model.poses();
            let (place, pose) = (draft.model.place(&poses, one).0, &poses[other.link]);
            let at = times(transposed(pose.axes), difference(place, pose.origin));
            ("two points held together", Tie::Together(one, Point { at, ..other }))
        }
        3 => ("two points at a distance", Tie::Distance(one, other)),
        4 => ("point on a plane", Tie::Level(one, random.below(3))),
        _ => ("skate", Tie::Skate(one, random.below(3))),
    }
}

/// Text of the constraint. Its right side is the value of the left side at the current state.
fn equation(draft: &mut Draft, tie: &Tie, one: &str, other: &str) -> String {
    let poses = draft.model.poses();
    let place = |draft: &Draft, point: Point| draft.model.place(&poses, point).0;
    match *tie {
        Tie::Together(a, b) => {
            let [a, b] = [(one, a), (other, b)].map(|point| written(draft, point));
            format!("position({a}) = position({b})")
        }
        Tie::Distance(a, b) => {
            let arm = difference(place(draft, a), place(draft, b));
            let length = draft.number_field(norm(arm));
            let [a, b] = [(one, a), (other, b)].map(|point| written(draft, point));
            format!("dot(position({a}) - position({b}), position({a}) - position({b})) = {length}^2")
        }
        Tie::Level(point, axis) => {
            let level = place(draft, point)[axis];
            let (a, level) = (written(draft, (one, point)), draft.number_field(level));
            format!("position({a})[{axis}] = {level}")
        }
        Tie::Skate(point, axis) => format!("velocity({})[{axis}] = 0", written(draft, (one, point))),
        Tie::Unit(first) => format!("dot(c{first}, c{first}) = 1"),
    }
}
