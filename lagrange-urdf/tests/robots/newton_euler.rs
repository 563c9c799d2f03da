//! Forces of a motion from a description by the recursion of Newton and Euler, on the links as they are described: fixed
//! joints are joints without a motion, and nothing is merged. J. Y. S. Luh, M. W. Walker, R. P. C. Paul, *Journal of Dynamic
//! Systems, Measurement, and Control* 102 (1980).

use lagrange_core::nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};
use urdf_rs::{Joint, JointType, Link, Robot};

type V = Vector3<f64>;

/// Value, rate and acceleration of a coordinate.
#[derive(Clone, Copy, Default)]
pub(crate) struct Rates(pub(crate) f64, pub(crate) f64, pub(crate) f64);

/// Coordinates by the names of the description: those of a joint in turn, `place` and `turn` of a root in space.
pub(crate) type Coordinates<'a> = &'a dyn Fn(&str, usize) -> Rates;

/// A motion of one link on another.
enum Motion {
    None,
    Slides(V, Rates),
    Turns(V, Rates),
    Quaternion([Rates; 4]),
}

struct Element {
    parent: usize,
    rotation: Rotation3<f64>,
    offset: V,
    motion: Motion,
    /// Mass, centre and inertia about it.
    body: (f64, V, Matrix3<f64>),
    /// Coordinate that the force acts on, and how often.
    row: Option<(String, usize, f64)>,
}

/// Motion of the axes of a link and of its origin, in these axes. The acceleration has gravity's in it.
#[derive(Clone, Copy, Default)]
struct Twist {
    spin: V,
    spin_rate: V,
    acceleration: V,
}

fn pose(pose: &urdf_rs::Pose) -> (Rotation3<f64>, V) {
    let [r, p, y] = *pose.rpy;
    (Rotation3::from_euler_angles(r, p, y), V::from(*pose.xyz))
}

/// A joint's coordinate, through the joints that it mimics; the last one with its factor.
fn resolve(robot: &Robot, name: &str, of: Coordinates) -> (Rates, String, f64) {
    let joint = robot.joints.iter().find(|joint| joint.name == name).expect("a joint");
    let Some(mimic) = &joint.mimic else { return (of(name, 0), name.to_owned(), 1.0) };
    let (Rates(q, v, a), driver, factor) = resolve(robot, &mimic.joint, of);
    let k = mimic.multiplier.unwrap_or(1.0);
    (Rates(k * q + mimic.offset.unwrap_or(0.0), k * v, k * a), driver, k * factor)
}

fn turned(q: [Rates; 4]) -> (Rotation3<f64>, V, V) {
    let [q, v, a] =
        [q.map(|q| q.0), q.map(|q| q.1), q.map(|q| q.2)].map(|[w, x, y, z]| Quaternion::new(w, x, y, z));
    let rotation = UnitQuaternion::new_unchecked(q).to_rotation_matrix();
    (rotation, 2.0 * (q.conjugate() * v).imag(), 2.0 * (q.conjugate() * a).imag())
}

/// Links and joints one after another, the first at rest. Joints of several coordinates are several elements without bodies.
struct Elements<'a> {
    robot: &'a Robot,
    of: Coordinates<'a>,
    all: Vec<Element>,
    /// Links, each with its element.
    placed: Vec<(&'a str, usize)>,
}

fn unit(k: usize) -> V {
    V::from_fn(|i, _| f64::from(u8::from(i == k % 3)))
}

fn body(link: &Link) -> (f64, V, Matrix3<f64>) {
    let (turn, centre) = pose(&link.inertial.origin);
    let i = &link.inertial.inertia;
    let inertia = Matrix3::new(i.ixx, i.ixy, i.ixz, i.ixy, i.iyy, i.iyz, i.ixz, i.iyz, i.izz);
    (link.inertial.mass.value, centre, turn.matrix() * inertia * turn.matrix().transpose())
}

impl<'a> Elements<'a> {
    fn of(robot: &'a Robot, floating: bool, of: Coordinates<'a>) -> Vec<Element> {
        let mut elements = Self { robot, of, all: Vec::new(), placed: Vec::new() };
        elements.push(0, Motion::None, None);
        let is_root = |link: &&Link| robot.joints.iter().all(|joint| joint.child.link != link.name);
        let root = robot.links.iter().find(is_root).expect("a root");
        if floating {
            (0..3).for_each(|k| elements.moving(Motion::Slides(unit(k), of("place", k)), "place", k));
            elements.quaternion("turn");
        }
        elements.arrive(root);
        while let Some(joint) = robot.joints.iter().find(|joint| {
            elements.index(&joint.parent.link).is_some() && elements.index(&joint.child.link).is_none()
        }) {
            elements.joint(joint);
        }
        elements.all
    }

    fn index(&self, link: &str) -> Option<usize> {
        self.placed.iter().find(|(name, _)| *name == link).map(|(_, index)| *index)
    }

    fn push(&mut self, parent: usize, motion: Motion, row: Option<(String, usize, f64)>) {
        let body = (0.0, V::zeros(), Matrix3::zeros());
        self.all.push(Element {
            parent,
            rotation: Rotation3::identity(),
            offset: V::zeros(),
            motion,
            body,
            row,
        });
    }

    /// On the last element, by the coordinate of this joint with this index.
    fn moving(&mut self, motion: Motion, name: &str, index: usize) {
        self.push(self.all.len() - 1, motion, Some((name.to_owned(), index, 1.0)));
    }

    fn quaternion(&mut self, name: &str) {
        self.moving(Motion::Quaternion([0, 1, 2, 3].map(|k| (self.of)(name, k))), name, 0);
    }

    /// Gives the last element the body of a link.
    fn arrive(&mut self, link: &'a Link) {
        self.all.last_mut().expect("an element").body = body(link);
        self.placed.push((&link.name, self.all.len() - 1));
    }

    fn joint(&mut self, joint: &'a Joint) {
        self.push(self.index(&joint.parent.link).expect("placed"), Motion::None, None);
        let place = self.all.last_mut().expect("an element");
        (place.rotation, place.offset) = pose(&joint.origin);
        self.motions(joint);
        let robot = self.robot;
        self.arrive(robot.links.iter().find(|link| link.name == joint.child.link).expect("a link"));
    }

    fn motions(&mut self, joint: &Joint) {
        let (name, axis) = (joint.name.as_str(), V::from(*joint.axis.xyz).normalize());
        match joint.joint_type {
            JointType::Fixed => {}
            JointType::Revolute | JointType::Continuous | JointType::Prismatic => {
                let (rates, driver, factor) = resolve(self.robot, name, self.of);
                let is_sliding = joint.joint_type == JointType::Prismatic;
                let motion =
                    if is_sliding { Motion::Slides(axis, rates) } else { Motion::Turns(axis, rates) };
                self.push(self.all.len() - 1, motion, Some((driver, 0, factor)));
            }
            JointType::Planar => {
                // The axes of the plane that are written: the first is that of the space after the largest entry of the
                // normal, as near as the plane allows.
                let second = axis.cross(&unit(axis.iamax() + 1)).normalize();
                self.moving(Motion::Slides(second.cross(&axis), (self.of)(name, 0)), name, 0);
                self.moving(Motion::Slides(second, (self.of)(name, 1)), name, 1);
                self.moving(Motion::Turns(axis, (self.of)(name, 2)), name, 2);
            }
            JointType::Spherical => self.quaternion(name),
            JointType::Floating => unreachable!("none here"),
        }
    }
}

impl Element {
    /// Rotation and offset, with the motion of the joint.
    fn place(&self) -> (Rotation3<f64>, V) {
        match &self.motion {
            Motion::None => (self.rotation, self.offset),
            Motion::Slides(axis, q) => (Rotation3::identity(), axis * q.0),
            Motion::Turns(axis, q) => (Rotation3::new(axis * q.0), V::zeros()),
            Motion::Quaternion(q) => (turned(*q).0, V::zeros()),
        }
    }

    fn carried(&self, by: Twist) -> Twist {
        let (rotation, p) = self.place();
        let back = rotation.inverse();
        let (spin, spin_rate) = (back * by.spin, back * by.spin_rate);
        let carried = by.acceleration + by.spin_rate.cross(&p) + by.spin.cross(&by.spin.cross(&p));
        let acceleration = back * carried;
        match self.motion {
            Motion::None => Twist { spin, spin_rate, acceleration },
            Motion::Slides(axis, q) => {
                let own = axis * q.2 + 2.0 * spin.cross(&(axis * q.1));
                Twist { spin, spin_rate, acceleration: acceleration + own }
            }
            Motion::Turns(axis, q) => Twist {
                spin: spin + axis * q.1,
                spin_rate: spin_rate + axis * q.2 + spin.cross(&(axis * q.1)),
                acceleration,
            },
            Motion::Quaternion(q) => {
                let (_, own, own_rate) = turned(q);
                Twist { spin: spin + own, spin_rate: spin_rate + own_rate + spin.cross(&own), acceleration }
            }
        }
    }
}

impl Element {
    /// Force and moment about the origin that move the body so.
    fn wrench(&self, Twist { spin, spin_rate, acceleration }: Twist) -> (V, V) {
        let (m, c, inertia) = self.body;
        let force = m * (acceleration + spin_rate.cross(&c) + spin.cross(&spin.cross(&c)));
        (force, inertia * spin_rate + spin.cross(&(inertia * spin)) + c.cross(&force))
    }

    /// Generalized forces of the coordinates of the joint.
    fn rows(&self, force: V, moment: V) -> Vec<(String, usize, f64)> {
        let Some((name, index, factor)) = &self.row else { return Vec::new() };
        let one = |row: f64| vec![(name.clone(), *index, factor * row)];
        match self.motion {
            Motion::None => Vec::new(),
            Motion::Slides(axis, _) => one(axis.dot(&force)),
            Motion::Turns(axis, _) => one(axis.dot(&moment)),
            // The power n·ω with ω = 2 Im(q̄ q̇) is Q·q̇ with Q = 2 q n.
            Motion::Quaternion(q) => {
                let [w, x, y, z] = q.map(|q| q.0);
                let push = 2.0 * (Quaternion::new(w, x, y, z) * Quaternion::from_imag(moment));
                let entries = [push.w, push.i, push.j, push.k].into_iter().enumerate();
                entries.map(|(k, entry)| (name.clone(), k, entry)).collect()
            }
        }
    }
}

/// Generalized forces without friction and damping, each with its joint and its index among the joint's coordinates.
pub(crate) fn forces(robot: &Robot, floating: bool, g: f64, of: Coordinates) -> Vec<(String, usize, f64)> {
    let elements = Elements::of(robot, floating, of);
    let mut twists = vec![Twist { acceleration: V::new(0.0, 0.0, g), ..Twist::default() }];
    for element in &elements[1..] {
        twists.push(element.carried(twists[element.parent]));
    }
    let mut wrenches = vec![(V::zeros(), V::zeros()); elements.len()];
    let mut found = Vec::new();
    for (k, element) in elements.iter().enumerate().skip(1).rev() {
        let (force, moment) = element.wrench(twists[k]);
        let (force, moment) = (wrenches[k].0 + force, wrenches[k].1 + moment);
        found.extend(element.rows(force, moment));
        let (rotation, p) = element.place();
        let (force, moment) = (rotation * force, rotation * moment);
        let below = &mut wrenches[element.parent];
        *below = (below.0 + force, below.1 + moment + p.cross(&force));
    }
    found
}
