//! Joints of every kind.

use super::algebra::{UNIT, scaled};
use super::draft::{Draft, Frame, axis};
use super::model::{Joint, Motion};
use lagrange_random::Random;

/// Each kind of joint: name, number of coordinates and function that draws it.
pub(super) const KINDS: [Kind; 15] = [
    ("fixed", 0, |_, _, _| ()),
    ("driven", 0, driven),
    ("revolute", 1, revolute),
    ("revolute about any axis", 1, revolute_about),
    ("half angles", 1, half_angles),
    ("prismatic", 1, prismatic),
    ("screw", 1, screw),
    ("cylindrical", 2, cylindrical),
    ("universal", 2, universal),
    ("matrix that turns", 2, matrix),
    ("curve", 2, curve),
    ("cartesian", 3, cartesian),
    ("Euler's angles", 3, angles),
    ("spherical", 3, spherical),
    ("free", 6, free),
];

pub(super) type Kind = (&'static str, usize, Draw);
type Draw = fn(&mut Draft, &mut Random, &mut Frame);

pub(super) const AXES: [&str; 3] = ["x", "y", "z"];

/// Draws a motion with a new coordinate: alone, with a factor, with a function of time, or geared to an earlier
/// coordinate.
fn motion(draft: &mut Draft, random: &mut Random) -> (String, Motion) {
    let others = draft.scalars.clone();
    let (name, i) = draft.coordinate(random, 1);
    match random.below(8) {
        0 => {
            let [k, a] = [random.between(0.5, 2.0), random.between(-1.0, 1.0)];
            let text = format!("{}*{name} + {}", draft.number_field(k), draft.number_field(a));
            (text, Motion { constant: a, linear: vec![(k, i)], ..Motion::default() })
        }
        1 => {
            draft.count("joint driven beside its coordinate");
            let (text, timed) = of_time(draft, random);
            (format!("{name} - ({text})"), Motion { linear: vec![(1.0, i)], ..timed.times(-1.0) })
        }
        2 | 3 if !others.is_empty() => {
            draft.count("geared joint");
            let other = others[random.below(others.len())];
            let k = random.between(-1.0, 1.0);
            let text = format!("{name} + {}*c{other}", draft.number_field(k));
            (text, Motion { linear: vec![(1.0, i), (k, other)], ..Motion::default() })
        }
        _ => (name, Motion::of(i)),
    }
}

fn of_time(draft: &mut Draft, random: &mut Random) -> (String, Motion) {
    let ([a, w, p], [b, c, _]) = (random.vector(), random.vector());
    let which = random.below(3);
    let (mut texts, mut motion) = (Vec::new(), Motion::default());
    if which != 0 {
        texts.push(format!("{}*t + {}*t^2", draft.number_field(b), draft.number_field(c)));
        motion.powers = [b, c];
    }
    if which != 1 {
        let names = [a, 2.0 * w, p].map(|number| draft.number_field(number));
        texts.push(format!("{}*sin({}*t + {})", names[0], names[1], names[2]));
        motion.waves.push([a, 2.0 * w, p]);
    }
    (texts.join(" + "), motion)
}

fn driven(draft: &mut Draft, random: &mut Random, frame: &mut Frame) {
    let (text, motion) = of_time(draft, random);
    if random.once_in(2) {
        let k = random.below(3);
        draft.step(frame, format!("rotate_{}({text})", AXES[k]), [Joint::Turn(UNIT[k], motion)]);
    } else {
        let along = random.vector();
        let text = format!("translate({}*({text}))", draft.vector_field(along));
        draft.step(frame, text, [Joint::Slide(along.map(|c| motion.times(c)))]);
    }
}

fn turned(draft: &mut Draft, random: &mut Random, frame: &mut Frame, k: usize) {
    let (text, angle) = motion(draft, random);
    draft.step(frame, format!("rotate_{}({text})", AXES[k]), [Joint::Turn(UNIT[k], angle)]);
}

fn revolute(draft: &mut Draft, random: &mut Random, frame: &mut Frame) {
    let k = random.below(3);
    turned(draft, random, frame, k);
}

fn revolute_about(draft: &mut Draft, random: &mut Random, frame: &mut Frame) {
    let (text, angle) = motion(draft, random);
    let (axis, direction) = axis(random);
    let text = format!("rotate({}, {text})", draft.vector_field(axis));
    draft.step(frame, text, [Joint::Turn(direction, angle)]);
}

/// A revolute joint, written as a quaternion that depends on one coordinate.
fn half_angles(draft: &mut Draft, random: &mut Random, frame: &mut Frame) {
    let (text, angle) = motion(draft, random);
    let k = random.below(3);
    let mut entries = [format!("cos(({text})/2)"), "0".into(), "0".into(), "0".into()];
    entries[k + 1] = format!("sin(({text})/2)");
    draft.step(frame, format!("rotate([{}])", entries.join(", ")), [Joint::Turn(UNIT[k], angle)]);
}

fn prismatic(draft: &mut Draft, random: &mut Random, frame: &mut Frame) {
    let (text, along) = motion(draft, random);
    if random.once_in(2) {
        let k = random.below(3);
        let mut entries = ["0", "0", "0"].map(String::from);
        entries[k] = text;
        let by = UNIT[k].map(|c| along.times(c));
        draft.step(frame, format!("translate([{}])", entries.join(", ")), [Joint::Slide(by)]);
    } else {
        let (axis, _) = axis(random);
        let text = format!("translate(({text})*{})", draft.vector_field(axis));
        draft.step(frame, text, [Joint::Slide(axis.map(|c| along.times(c)))]);
    }
}

fn screw(draft: &mut Draft, random: &mut Random, frame: &mut Frame) {
    let (text, angle) = motion(draft, random);
    let (k, pitch) = (random.below(3), random.between(-1.0, 1.0));
    draft.step(frame, format!("rotate_{}({text})", AXES[k]), [Joint::Turn(UNIT[k], angle.clone())]);
    let mut entries = ["0", "0", "0"].map(String::from);
    entries[k] = format!("{}*({text})", draft.number_field(pitch));
    let by = scaled(pitch, UNIT[k]).map(|c| angle.times(c));
    draft.step(frame, format!("translate([{}])", entries.join(", ")), [Joint::Slide(by)]);
}

fn cylindrical(draft: &mut Draft, random: &mut Random, frame: &mut Frame) {
    turned(draft, random, frame, 2);
    let (text, along) = motion(draft, random);
    let by = UNIT[2].map(|c| along.times(c));
    draft.step(frame, format!("translate([0, 0, {text}])"), [Joint::Slide(by)]);
}

fn universal(draft: &mut Draft, random: &mut Random, frame: &mut Frame) {
    let k = random.below(3);
    turned(draft, random, frame, k);
    turned(draft, random, frame, (k + 1) % 3);
}

/// A step by a product of two rotations, which are two links of the model.
fn matrix(draft: &mut Draft, random: &mut Random, frame: &mut Frame) {
    let k = random.below(3);
    let (other, direction) = axis(random);
    let (first, second) = (motion(draft, random), motion(draft, random));
    let text =
        format!("rotate(rot_{}({})*rot({}, {}))", AXES[k], first.0, draft.vector_field(other), second.0);
    draft.step(frame, text, [Joint::Turn(UNIT[k], first.1), Joint::Turn(direction, second.1)]);
}

/// Translation along a curved surface.
fn curve(draft: &mut Draft, random: &mut Random, frame: &mut Frame) {
    let ((x, i), (y, j)) = (draft.coordinate(random, 1), draft.coordinate(random, 1));
    let [a, b, c] = random.vector();
    let [p, q, r] = [a, b, c].map(|number| draft.number_field(number));
    let text = format!("translate([{x}, 2*{y} + {p}*{x}^2, {q}*{x}*{y} + {r}*{y}^2])");
    let by = [
        Motion::of(i),
        Motion { linear: vec![(2.0, j)], products: vec![(a, i, i)], ..Motion::default() },
        Motion { products: vec![(b, i, j), (c, j, j)], ..Motion::default() },
    ];
    draft.step(frame, text, [Joint::Slide(by)]);
}

fn cartesian(draft: &mut Draft, random: &mut Random, frame: &mut Frame) {
    if random.once_in(2) {
        let (name, first) = draft.coordinate(random, 3);
        let by = [0, 1, 2].map(|k| Motion::of(first + k));
        draft.step(frame, format!("translate({name})"), [Joint::Slide(by)]);
    } else {
        let [(x, a), (y, b), (z, c)] = [0; 3].map(|_| motion(draft, random));
        draft.step(frame, format!("translate([{x}, {y}, {z}])"), [Joint::Slide([a, b, c])]);
    }
}

fn angles(draft: &mut Draft, random: &mut Random, frame: &mut Frame) {
    [2, 1, 0].into_iter().for_each(|k| turned(draft, random, frame, k));
}

fn spherical(draft: &mut Draft, random: &mut Random, frame: &mut Frame) {
    let (name, first) = draft.ball(random);
    draft.step(frame, format!("rotate({name})"), [Joint::Ball(first)]);
}

fn free(draft: &mut Draft, random: &mut Random, frame: &mut Frame) {
    cartesian(draft, random, frame);
    spherical(draft, random, frame);
}
