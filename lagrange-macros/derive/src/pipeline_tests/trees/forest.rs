//! Random trees of frames, with bodies, loads and ties.

use super::algebra::{Matrix, UNIT, Vector, scaled, turn_by};
use super::draft::{Draft, Frame, inertia};
use super::joints::{AXES, KINDS, Kind};
use super::loads::{loads, tied};
use super::model::{Body, Joint, Motion, Point};
use lagrange_random::Random;

/// Number of small trees at the start, which take little time to derive.
const SMALL: u64 = 60;

/// Draws the tree of this number.
pub(super) fn tree(number: u64) -> Draft {
    let mut random = Random(number);
    let random = &mut random;
    let (most, enough) = match number {
        0..SMALL if random.once_in(6) => (4, 3),
        0..SMALL => (2, 2),
        _ => (8, 10),
    };
    let mut draft = Draft::default();
    draft.enough = enough;
    draft.model.time = random.between(-1.0, 1.0);
    let gravity = gravity(&mut draft, random);
    let mut frames = Vec::new();
    if random.once_in(10) {
        family(&mut draft, random, &gravity, &mut frames);
    }
    let largest = 1 + random.below(most);
    let more = (1 + random.below(largest)).saturating_sub(frames.len()).max(1);
    grow(&mut draft, random, &gravity, &mut frames, more);
    loads(&mut draft, random, &frames);
    // Half of the trees have a tie.
    if !random.once_in(2) {
        tied(&mut draft, random, &frames, "tie");
    }
    draft
}

/// Gravity as a field and its value: a vector, or a magnitude down an axis.
enum Gravity {
    None,
    Vector(String, Vector),
    Down(String, usize, f64),
}

/// Draws the long system of this number: 15 to 32 frames with a body each, in a chain or a tree, some with closed
/// loops. Most joints repeat a few kinds in turn, so that the emitted code contains loops.
pub(super) fn long(number: u64) -> Draft {
    let mut random = Random(number);
    let random = &mut random;
    let (mut draft, mut frames) = (Draft::default(), Vec::<Frame>::new());
    let mut scalars = Vec::new();
    draft.enough = 16;
    draft.model.time = random.between(-1.0, 1.0);
    let gravity = gravity(&mut draft, random);
    let few: Vec<Kind> = (0..=random.below(5)).map(|_| KINDS[random.below(KINDS.len())]).collect();
    // The mass matrix of a chain of 30 joints at arbitrary angles exceeds the length limit of a function.
    let most = if number % 3 == 1 { 32 } else { 22 };
    for i in 0..15 + random.below(most - 14) {
        let kind = if random.once_in(8) { KINDS[random.below(KINDS.len())] } else { few[i % few.len()] };
        let parent = match number % 3 {
            1 if random.once_in(2) => random.below(i + 1),
            _ => i,
        };
        let name = format!("f{i}");
        let on = parent.checked_sub(1).map_or_else(Frame::fixed, |parent: usize| frames[parent].clone());
        // Gears and varying masses depend on the previous coordinate. With an arbitrary coordinate the mass matrix
        // would be too long.
        let all = draft.scalars.len();
        scalars.extend(draft.scalars.drain(..all.saturating_sub(1)));
        let frame = framed(&mut draft, random, &on, name, Some(kind));
        body(&mut draft, random, &gravity, &frame);
        frames.push(Frame { light: 0, ..frame });
    }
    draft.scalars.splice(..0, scalars);
    loads(&mut draft, random, &frames);
    let loops = if number.is_multiple_of(2) { 1 + random.below(3) } else { 0 };
    (0..loops).for_each(|k| tied(&mut draft, random, &frames, &format!("tie{k}")));
    draft
}

fn gravity(draft: &mut Draft, random: &mut Random) -> Gravity {
    match random.below(4) {
        0 => Gravity::None,
        1 => {
            let g = random.between(1.0, 10.0);
            Gravity::Down(draft.number_field(g), random.below(3), g)
        }
        _ => {
            let g = scaled(5.0, random.vector());
            Gravity::Vector(draft.vector_field(g), g)
        }
    }
}

impl Gravity {
    /// Term of L for a mass at a point of a frame.
    fn term(&self, mass: &str, frame: &str, centre: &str) -> Option<String> {
        match self {
            Self::None => None,
            Self::Vector(g, _) => Some(format!("{mass}*dot({g}, position({frame}, {centre}))")),
            Self::Down(g, axis, _) => Some(format!("(-{mass}*{g}*position({frame}, {centre})[{axis}])")),
        }
    }

    fn acceleration(&self) -> Vector {
        match self {
            Self::None => [0.0; 3],
            Self::Vector(_, g) => *g,
            Self::Down(_, axis, g) => std::array::from_fn(|k| if k == *axis { -g } else { 0.0 }),
        }
    }
}

/// Adds a chain that is declared as a family, with arrays as fields.
fn family(draft: &mut Draft, random: &mut Random, gravity: &Gravity, frames: &mut Vec<Frame>) {
    draft.count("family");
    let length = 2 + random.below(3);
    let (name, first) = draft.coordinate(random, length);
    let numbers = |of: &mut dyn FnMut() -> Vec<f64>| (0..length).map(|_| of()).collect::<Vec<_>>();
    let arms = numbers(&mut || random.vector::<3>().to_vec());
    let turns = numbers(&mut || random.quaternion().to_vec());
    let masses = numbers(&mut || vec![random.between(0.5, 2.0)]);
    let centres = numbers(&mut || random.vector::<3>().to_vec());
    let inertias = numbers(&mut || inertia(random).concat());
    let mut field =
        |ty: &str, numbers: &[Vec<f64>]| draft.field(format!("[{ty}; {length}]"), numbers.concat());
    let (arm, place) = (field("Vector3<f64>", &arms), field("UnitQuaternion<f64>", &turns));
    let (mass, centre) = (field("f64", &masses), field("Vector3<f64>", &centres));
    let inertia = field("Matrix3<f64>", &inertias);
    let axis = random.below(3);
    let steps = format!("translate({arm}[i]), rotate({place}[i]), rotate_{}({name}[i])", AXES[axis]);
    draft.frame_attribute(format!("link[0]: {}", steps.replace("[i]", "[0]")));
    draft.frame_attribute(format!("link[i in 1..{length}] in link[i-1]: {steps}"));
    let weight = gravity.term(&format!("{mass}[i]"), "link[i]", &format!("{centre}[i]"));
    let weight = weight.map_or_else(String::new, |term| format!(" + {term}"));
    draft.term(format!(
        "sum(i in 0..{length}, kinetic(link[i], {mass}[i], {centre}[i], {inertia}[i]){weight})"
    ));
    let vector = |of: &[Vec<f64>], i: usize| -> Vector { [of[i][0], of[i][1], of[i][2]] };
    let mut frame = Frame { name: String::new(), link: 0, light: 0, steps: Vec::new() };
    for i in 0..length {
        let turn = turn_by([turns[i][0], turns[i][1], turns[i][2], turns[i][3]]);
        let joints = [
            Joint::Slide(vector(&arms, i).map(Motion::fixed)),
            Joint::Placed(turn),
            Joint::Turn(UNIT[axis], Motion::of(first + i)),
        ];
        draft.step(&mut frame, String::new(), joints);
        let at = vector(&centres, i);
        let rows: Matrix = std::array::from_fn(|j| vector(&[inertias[i][3 * j..3 * j + 3].to_vec()], 0));
        let (mass, growth) = (Motion::fixed(masses[i][0]), Motion::fixed(1.0));
        let (centre, gravity) = (Point { link: frame.link, at }, gravity.acceleration());
        draft.model.bodies.push(Body { mass, centre, inertia: rows, growth, gravity });
        frames.push(Frame { name: format!("link[{i}]"), ..frame.clone() });
    }
}

/// Adds `more` frames, each inside an earlier one or the fixed one.
fn grow(draft: &mut Draft, random: &mut Random, gravity: &Gravity, frames: &mut Vec<Frame>, more: usize) {
    let before = frames.len();
    let parents: Vec<Option<usize>> = (before..before + more)
        .map(|i| if random.once_in(2) { i.checked_sub(1) } else { random.below(i + 1).checked_sub(1) })
        .collect();
    for (i, &parent) in parents.iter().enumerate() {
        let is_leaf = !parents.contains(&Some(before + i));
        let on = parent.map_or_else(Frame::fixed, |parent| frames[parent].clone());
        let mut frame = framed(draft, random, &on, format!("f{}", before + i), None);
        if is_leaf || frame.light > 1 || !random.once_in(4) {
            bodies(draft, random, gravity, &mut frame);
        } else {
            draft.count("frame without a body");
        }
        frames.push(frame);
    }
    if frames.iter().all(|frame| !draft.model.is_moved(frame.link)) {
        grow(draft, random, gravity, frames, 1);
    }
}

/// Declares a frame of this name inside another one.
fn framed(draft: &mut Draft, random: &mut Random, on: &Frame, name: String, kind: Option<Kind>) -> Frame {
    let place = if on.name == "fixed" { String::new() } else { format!(" in {}", on.name) };
    let mut frame = Frame { name, steps: Vec::new(), ..on.clone() };
    frame.light += joint(draft, random, &mut frame, kind);
    draft.frame_attribute(format!("{}{place}: {}", frame.name, frame.steps.join(", ")));
    frame
}

/// Adds the steps of a frame, with a joint of this kind unless it has too many coordinates. Returns the number of
/// new coordinates.
fn joint(draft: &mut Draft, random: &mut Random, frame: &mut Frame, kind: Option<Kind>) -> usize {
    let start = draft.model.coordinates.len();
    let most = match frame.light {
        0 if start < draft.enough => 6,
        _ => 1,
    };
    let kinds = kind.into_iter().chain(std::iter::from_fn(|| Some(KINDS[random.below(KINDS.len())])));
    let (name, _, draw) = kinds.into_iter().find(|kind| kind.1 <= most).expect("one of many");
    draft.count(name);
    // Constant steps separate the two coordinates of a light frame, so that they act about different axes at
    // different places.
    if random.once_in(2) || name == "fixed" || frame.light > 0 {
        (0..=random.below(2).max(frame.light)).for_each(|_| draft.placed(random, frame));
    }
    draw(draft, random, frame);
    if random.once_in(4) {
        draft.placed(random, frame);
    }
    draft.model.coordinates.len() - start
}

/// Adds at least one body, so that the frame has an inertia in every direction.
fn bodies(draft: &mut Draft, random: &mut Random, gravity: &Gravity, frame: &mut Frame) {
    frame.light = 0;
    body(draft, random, gravity, frame);
    if random.once_in(6) {
        draft.count("second body");
        body(draft, random, gravity, frame);
    }
    if random.once_in(6) {
        draft.count("point mass beside a body");
        let ((m, mass), at) = (draft.mass(random), random.vector());
        let c = draft.vector_field(at);
        draft.term(format!("kinetic({}, {m}, {c})", frame.name));
        let (centre, inertia, growth) = (Point { link: frame.link, at }, [[0.0; 3]; 3], Motion::default());
        draft.model.bodies.push(Body { mass, centre, inertia, growth, gravity: [0.0; 3] });
    }
    if random.once_in(8) {
        slider(draft, random, gravity, frame);
    }
}

/// Adds a body whose centre moves along the frame with a coordinate.
fn slider(draft: &mut Draft, random: &mut Random, gravity: &Gravity, frame: &Frame) {
    draft.count("body with a centre that moves");
    let ((m, mass), at) = (draft.mass(random), random.vector());
    let c = draft.vector_field(at);
    let (i, inertia, growth) = draft.inertia(random);
    let (name, coordinate) = draft.coordinate(random, 1);
    let (f, c) = (&frame.name, format!("[{name}, {c}[1], {c}[2]]"));
    draft.term(format!("kinetic({f}, {m}, {c}, {i})"));
    if let Some(term) = gravity.term(&m, f, &c) {
        draft.term(term);
    }
    let joint = Joint::Slide([Motion::of(coordinate), Motion::fixed(at[1]), Motion::fixed(at[2])]);
    let mut slider = frame.clone();
    draft.step(&mut slider, String::new(), [joint]);
    let centre = Point { link: slider.link, at: [0.0; 3] };
    draft.model.bodies.push(Body { mass, centre, inertia, growth, gravity: gravity.acceleration() });
}

fn body(draft: &mut Draft, random: &mut Random, gravity: &Gravity, frame: &Frame) {
    let ((m, mass), at) = (draft.mass(random), random.vector());
    let c = draft.vector_field(at);
    let (i, inertia, growth) = draft.inertia(random);
    let (f, mut times) = (&frame.name, 1.0);
    match random.below(8) {
        0 => {
            draft.count("body by its velocities");
            draft.term(format!("{m}/2*dot(velocity({f}, {c}), velocity({f}, {c}))"));
            draft.term(format!("dot(angular_velocity({f}), {i}*angular_velocity({f}))/2"));
        }
        1 => {
            draft.count("two bodies at once");
            draft.term(format!("2*kinetic({f}, {m}, {c}, {i})"));
            times = 2.0;
        }
        _ => {
            draft.count("body");
            draft.term(format!("kinetic({f}, {m}, {c}, {i})"));
        }
    }
    let none = Gravity::None;
    let gravity = if random.once_in(8) { &none } else { gravity };
    if let Some(term) = gravity.term(&m, f, &c) {
        draft.term(format!("{times}*{term}"));
    }
    let (mass, growth, gravity) = (mass.times(times), growth.times(times), gravity.acceleration());
    let centre = Point { link: frame.link, at };
    draft.model.bodies.push(Body { mass, centre, inertia, growth, gravity });
}
