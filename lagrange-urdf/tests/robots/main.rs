//! Robots that are written by hand: what is made of them, and how it moves.

mod newton_euler;

use std::path::{Path, PathBuf};

use lagrange_core::Sample;
use lagrange_core::contact::{Friction, MoreauJean};
use lagrange_core::nalgebra::{Const, DMatrix, DVector, Rotation3, SVector, Vector3};
use lagrange_core::prelude::*;
use lagrange_urdf::{Options, import};
use newton_euler::{Rates, forces};
use urdf_rs::Robot;

#[rustfmt::skip]
#[allow(unreachable_pub)]
mod two_link { include!("two_link.rs"); }
#[rustfmt::skip]
#[allow(unreachable_pub)]
mod rubbing { include!("rubbing.rs"); }
#[rustfmt::skip]
#[allow(unreachable_pub)]
mod gripper { include!("gripper.rs"); }
#[rustfmt::skip]
#[allow(unreachable_pub)]
mod standing { include!("standing.rs"); }
#[rustfmt::skip]
#[allow(unreachable_pub)]
mod hopper { include!("hopper.rs"); }

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/robots").join(name)
}

fn read(name: &str) -> String {
    std::fs::read_to_string(file(name)).expect("a file of these tests")
}

/// Compares what is written of a description with a file; with `UPDATE_ROBOTS=1` writes that.
fn is_written(description: &str, expected: &str, options: &Options) {
    let written = import(&read(description), options).expect("a robot").rust;
    if std::env::var_os("UPDATE_ROBOTS").is_some() {
        std::fs::write(file(expected), &written).expect("written");
    }
    assert_eq!(written, read(expected));
}

#[test]
fn texts_are_as_they_were() {
    let options = Options { tools: vec!["tip".to_owned()], ..Options::default() };
    is_written("two_link.urdf", "two_link.rs", &options);
    let options =
        Options { friction: true, numbers: true, name: Some("rubbing".to_owned()), ..Options::default() };
    is_written("two_link.urdf", "rubbing.rs", &options);
    is_written("gripper.urdf", "gripper.rs", &Options::default());
    let options = Options { floating: true, numbers: true, ..Options::default() };
    is_written("hopper.urdf", "hopper.rs", &options);
    let (contacts, name) = (["shank".to_owned(), "foot".to_owned()].into(), Some("standing".to_owned()));
    let options = Options { limits: true, contacts, name, friction: true, ..Options::default() };
    is_written("standing.urdf", "standing.rs", &options);
}

/// Limits and states can be gone through together.
#[test]
fn there_is_a_limit_for_each_coordinate() {
    use {gripper::CartAndGripper, hopper::Hopper, two_link::TwoLink};
    assert_eq!(TwoLink::LIMITS.map(|limit| limit.coordinate), TwoLink::COORDINATES);
    assert_eq!(CartAndGripper::LIMITS.map(|limit| limit.coordinate), CartAndGripper::COORDINATES);
    assert_eq!(Hopper::LIMITS.map(|limit| limit.coordinate), Hopper::COORDINATES);
    assert_eq!(CartAndGripper::MIMIC_LIMITS.map(|limit| limit.coordinate), ["tilt", "right_finger"]);
}

/// Numbers from −1 to 1, the same in every run (Marsaglia's xorshift).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, n: usize) -> DVector<f64> {
        DVector::from_fn(n, |_, _| self.next())
    }
}

/// A description, and where the coordinates of its joints are among those of the system.
struct Reference {
    robot: Robot,
    floating: bool,
    /// Joint of the description, index of its first coordinate, number of them.
    joints: &'static [(&'static str, usize, usize)],
    /// Damping along each coordinate, by hand.
    damping: &'static [(usize, f64)],
}

impl Reference {
    fn quaternions(&self) -> impl Iterator<Item = usize> {
        self.joints.iter().filter(|(_, _, count)| *count == 4).map(|(_, first, _)| *first)
    }

    fn index(&self, name: &str, k: usize) -> usize {
        let (_, first, _) = self.joints.iter().find(|(joint, ..)| *joint == name).expect("a joint");
        first + k
    }

    /// Forces for these accelerations, and without gravity if g is 0.
    fn forces(&self, g: f64, q: &DVector<f64>, v: &DVector<f64>, a: &DVector<f64>) -> DVector<f64> {
        let of = |name: &str, k: usize| {
            let i = self.index(name, k);
            Rates(q[i], v[i], a[i])
        };
        let mut sum = DVector::zeros(q.len());
        for (name, k, force) in forces(&self.robot, self.floating, g, &of) {
            sum[self.index(&name, k)] += force;
        }
        sum
    }

    fn mass_matrix(&self, q: &DVector<f64>) -> DMatrix<f64> {
        let n = q.len();
        let zero = DVector::zeros(n);
        let column = |k| self.forces(0.0, q, &zero, &DVector::from_fn(n, |i, _| f64::from(u8::from(i == k))));
        DMatrix::from_columns(&(0..n).map(column).collect::<Vec<_>>())
    }

    fn damped(&self, v: &DVector<f64>) -> DVector<f64> {
        let mut sum = DVector::zeros(v.len());
        for &(i, damping) in self.damping {
            sum[i] += damping * v[i];
        }
        sum
    }

    /// A state whose quaternions have length 1 and rates across.
    fn state(&self, n: usize, random: &mut Random) -> (DVector<f64>, DVector<f64>) {
        let (mut q, mut v) = (random.vector(n) * 2.0, random.vector(n) * 3.0);
        for first in self.quaternions() {
            let turn = q.rows(first, 4).normalize();
            let along = turn.dot(&v.rows(first, 4));
            v.rows_mut(first, 4).axpy(-along, &turn, 1.0);
            q.rows_mut(first, 4).copy_from(&turn);
        }
        (q, v)
    }
}

impl Reference {
    /// Accelerations of these efforts: M a + h = τ, and for each quaternion q·a = −|v|².
    fn accelerations(&self, g: f64, [q, v, efforts]: [&DVector<f64>; 3]) -> DVector<f64> {
        let n = q.len();
        let turns: Vec<usize> = self.quaternions().collect();
        let size = n + turns.len();
        let (mut matrix, mut right) = (DMatrix::zeros(size, size), DVector::zeros(size));
        matrix.view_mut((0, 0), (n, n)).copy_from(&self.mass_matrix(q));
        let h = self.forces(g, q, v, &DVector::zeros(n)) + self.damped(v);
        right.rows_mut(0, n).copy_from(&(efforts - h));
        for (k, &first) in turns.iter().enumerate() {
            for i in first..first + 4 {
                matrix[(n + k, i)] = q[i];
                matrix[(i, n + k)] = q[i];
                right[n + k] -= v[i] * v[i];
            }
        }
        matrix.lu().solve(&right).expect("a regular matrix").rows(0, n).into_owned()
    }
}

/// Agreement to 1e-11 of the largest entry.
fn near(found: &[f64], expected: &[f64], what: &str) {
    let largest = expected.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    assert_eq!(found.len(), expected.len());
    for (k, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert!((found - expected).abs() <= 1e-11 * largest, "{what}[{k}]: {found} for {expected}");
    }
}

/// Compares mass matrix, forces of a motion and accelerations at random states. The efforts are set by `drive`, which
/// returns them as generalized forces.
fn compare<L, const N: usize, const M: usize>(
    mut system: L,
    reference: &Reference,
    drive: impl Fn(&mut L, &mut Random) -> DVector<f64>,
) where
    L: Simulate + Lagrangian<Scalar = f64, N = Const<N>, M = Const<M>>,
{
    let g = 9.81;
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    for _ in 0..200 {
        let (q, v) = reference.state(N, &mut random);
        let entries = |x: &DVector<f64>| -> [f64; N] { std::array::from_fn(|i| x[i]) };
        let state = State::new(entries(&q), entries(&v));
        near(system.mass_matrix(&state).as_slice(), reference.mass_matrix(&q).as_slice(), "mass matrix");
        let efforts = drive(&mut system, &mut random);
        let a = random.vector(N) * 5.0;
        let expected = reference.forces(g, &q, &v, &a) + reference.damped(&v) - &efforts;
        let found = system.inverse_dynamics(&state, &entries(&a).into(), &SVector::zeros());
        near(found.as_slice(), expected.as_slice(), "inverse dynamics");
        let expected = reference.accelerations(g, [&q, &v, &efforts]);
        let found = system.solve(&state).expect("accelerations").accelerations;
        near(found.as_slice(), expected.as_slice(), "accelerations");
    }
}

fn two_links() -> Reference {
    Reference {
        robot: urdf_rs::read_from_string(&read("two_link.urdf")).expect("a robot"),
        floating: false,
        joints: &[("shoulder", 0, 1), ("elbow", 1, 1)],
        damping: &[(0, 0.3), (1, 0.1)],
    }
}

#[test]
fn an_arm_moves_as_by_newton_and_euler() {
    compare(two_link::TwoLink::default(), &two_links(), |arm, random| {
        let efforts = random.vector(2) * 10.0;
        [arm.tau_shoulder, arm.tau_elbow] = [efforts[0], efforts[1]];
        efforts
    });
}

/// A friction that slides is an effort against the motion, here of 0.5 N m.
#[test]
fn a_joint_with_dry_friction_moves_as_by_newton_and_euler() {
    compare(rubbing::Rubbing::default(), &two_links(), |arm, random| {
        let mut efforts = random.vector(2) * 10.0;
        let direction = random.next().signum();
        arm.shoulder_friction = Friction::Slides([direction, 0.0]);
        [arm.tau_shoulder, arm.tau_elbow] = [efforts[0], efforts[1]];
        efforts[0] -= 0.5 * direction;
        efforts
    });
}

/// The tip by its turns one after another; its velocity by the Jacobian, and by differences of its places.
#[test]
fn a_tool_has_a_place_and_a_jacobian() {
    let arm = two_link::TwoLink::default();
    let state = State::new([0.3, -0.7], [0.5, -0.2]);
    let along = arm.tip_jacobian(&state) * state.v;
    near(along.as_slice(), arm.tip_velocity(&state).as_slice(), "velocity");
    // A step along the velocity, by differences of the fourth order.
    let at = |h: f64| arm.tip_position(&State::at_rest(state.q + state.v * h));
    let h = 1e-3;
    let slope = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
    near(slope.as_slice(), arm.tip_velocity(&state).as_slice(), "slope");
    let turn = |axis: Vector3<f64>, angle: f64| Rotation3::new(axis.normalize() * angle);
    let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
    let quarter = std::f64::consts::FRAC_PI_2;
    let shoulder = turn(z, quarter) * turn(y, 0.2) * turn(z, 0.3);
    let elbow = turn(z, 0.5) * turn(x, -1.2) * turn(Vector3::new(1.0, 2.0, -2.0), -0.7);
    // The x-axis of the tool points down.
    let tip = Vector3::new(0.0, 0.0, 0.25 - 0.1);
    let expected = Vector3::new(0.1, 0.0, 0.4) + shoulder * (Vector3::new(0.0, 0.05, 0.3) + elbow * tip);
    near(arm.tip_position(&state).as_slice(), expected.as_slice(), "tip");
}

#[test]
fn a_tree_with_joints_that_mimic_moves_as_by_newton_and_euler() {
    let reference = Reference {
        robot: urdf_rs::read_from_string(&read("gripper.urdf")).expect("a robot"),
        floating: false,
        joints: &[("cart", 0, 1), ("t", 1, 1), ("left-finger", 2, 1), ("sliding", 3, 3)],
        // The tilt is the finger's position with the other sign, and its damping acts on it.
        damping: &[(0, 4.0), (2, 1.5), (2, 0.02)],
    };
    compare(gripper::CartAndGripper::default(), &reference, |robot, random| {
        let mut efforts = random.vector(6) * 10.0;
        efforts.rows_mut(3, 3).fill(0.0);
        [robot.tau_cart, robot.tau_t_joint, robot.tau_left_finger] = [efforts[0], efforts[1], efforts[2]];
        efforts
    });
}

#[test]
fn a_robot_in_space_moves_as_by_newton_and_euler() {
    let reference = Reference {
        robot: urdf_rs::read_from_string(&read("hopper.urdf")).expect("a robot"),
        floating: true,
        joints: &[("place", 0, 3), ("turn", 3, 4), ("HIP", 7, 1), ("KNEE", 8, 1), ("ball", 9, 4)],
        damping: &[(8, 0.7)],
    };
    compare(hopper::Hopper::default(), &reference, |robot, random| {
        let mut efforts = random.vector(13) * 10.0;
        efforts.rows_mut(0, 7).fill(0.0);
        efforts.rows_mut(9, 4).fill(0.0);
        [robot.tau_HIP, robot.tau_KNEE] = [efforts[7], efforts[8]];
        efforts
    });
}

/// Where it comes to rest, the floor carries its weight, and no joint is beyond its limits on the way.
#[test]
fn a_leg_collapses_onto_the_floor_within_its_limits() {
    let mut robot = standing::Standing::default();
    robot.set_efforts(&[0.0, 0.5, -3.0]);
    assert_eq!((robot.tau_hip, standing::Standing::EFFORTS[1]), (0.5, "tau_hip"));
    let start = State::at_rest([-0.3, 0.3, 0.5]);
    let path = robot.motion(start).by_time_stepping(MoreauJean::with_step(1e-3)).to(6.0).expect("it moves");
    for step in path.steps() {
        let [slide, knee] = [step.state().q[0], step.state().q[2]];
        assert!(slide.abs() < 2.0 + 1e-9 && knee > 0.2 - 1e-9 && knee < 2.5 + 1e-9, "{step:?}");
    }
    let last = path.end();
    let of = |name| last.multiplier(name).expect("a contact");
    assert!(last.state().v.norm() < 1e-9, "{last:?}");
    let stops = ["knee_lower", "knee_upper"];
    let pushed = |step: Sample<_>| stops.iter().any(|name| step.multiplier(name).expect("a contact") > 0.0);
    assert!(path.steps().any(pushed), "no limit of the knee acts");
    assert!((of("shank_floor") + of("foot_floor") - 4.2 * 9.81).abs() < 1e-6, "{last:?}");
}
