//! Marker traits promise a structure: it is there in the numbers, at random states and parameters.
//!
//! The functions that check a promise take only systems that make it. The others must break it visibly. Which systems make it
//! is tested with the derive (`pipeline_tests/markers.rs`).

use std::rc::Rc;
use std::sync::Arc;

use lagrange_core::nalgebra::{Matrix3, Vector3};
use lagrange_core::prelude::*;
use lagrange_core::structure::{ConstantMassMatrix, HolonomicConstraints, Unconstrained, VelocityFreeForces};
use lagrange_core::{ConstraintKind, Lanes, Pack, StateOf, generic};
use lagrange_random::Random;
use lagrange_systems::SphericalPendulum;

use crate::by_hand::with_parameters;

/// Number of parameters, and of states for each, at random.
const DRAWS: usize = 10;

/// A ball on a spring.
#[derive(Default, Lagrangian)]
#[coordinates(r: [3])]
#[lagrangian(m/2*dot(r_dot, r_dot) - m*g*r[2] - k/2*(norm(r) - l)^2)]
struct Ball<T> {
    m: T,
    g: T,
    k: T,
    l: T,
}

/// A pendulum by the position of its bob, in which cos² + sin² has to be recognized. The support moves.
#[derive(Default, Lagrangian)]
#[coordinates(theta)]
#[define(p = [a*sin(w*t) + l*sin(theta), -l*cos(theta)])]
#[lagrangian(m/2*dot(der(p), der(p)) - m*g*p[1])]
struct Pendulum {
    m: f64,
    l: f64,
    g: f64,
    a: f64,
    w: f64,
}

/// A charge in a magnetic field, whose vector potential has a gauge term.
#[derive(Default, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + b/2*(x*y_dot - y*x_dot) + der(k*sin(x*y)))]
struct Charge {
    m: f64,
    b: f64,
    k: f64,
}

/// The gauge term alone adds no force.
#[derive(Default, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - k*x^2*y^2 + k*(x_dot + 2*y*y_dot)*exp(x + y^2))]
struct Gauge {
    m: f64,
    k: f64,
}

/// A mass that grows, and a thrust that compensates the force −ṁ ẋ.
#[derive(Default, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m*(1 + t)/2*x_dot^2 - k/2*x^2)]
#[force(x: m*x_dot)]
struct Growing {
    m: f64,
    k: f64,
}

/// Two rods in space, as frames.
#[derive(Default, Lagrangian)]
#[coordinates(yaw, pitch)]
#[parameter(inertia: symmetric)]
#[frame(column: rotate_z(yaw))]
#[frame(rod in column: translate(joint), rotate_y(pitch))]
#[lagrangian(kinetic(rod, m, centre, inertia) - m*g*position(rod, centre)[2])]
struct Arm {
    m: f64,
    joint: Vector3<f64>,
    centre: Vector3<f64>,
    inertia: Matrix3<f64>,
    g: f64,
}

/// A puck on a turntable.
#[derive(Default, Lagrangian)]
#[coordinates(x, y)]
#[frame(table: rotate_z(w*t))]
#[frame(puck in table: translate([x, y, 0]))]
#[lagrangian(m/2*norm(velocity(puck))^2)]
struct Turntable {
    m: f64,
    w: f64,
}

/// x₁² x₂ + x₁, a potential, or the inertia of a shape with these lengths.
#[derive(Default)]
struct Cubic;

impl Function<2, 1> for Cubic {
    fn eval<S: Scalar>(&self, [x, y]: [S; 2]) -> [S; 1] {
        [x * x * y + x]
    }
}

/// A function of the position as potential, and of parameters as inertia.
#[derive(Default, Lagrangian)]
#[coordinates(x, y)]
#[function(shape(a, b) = cubic)]
#[lagrangian(shape(m, l)/2*(x_dot^2 + y_dot^2) - shape(x, y))]
struct Supplied {
    m: f64,
    l: f64,
    cubic: Cubic,
}

fn state<L: Lagrangian<Scalar = f64>>(random: &mut Random) -> StateOf<L> {
    let mut vector = || generic::Array::from_fn(|_| random.signed()).into();
    let (q, v) = (vector(), vector());
    generic::State { t: random.between(0.0, 3.0), q, v }
}

/// Largest difference of entries, relative to the largest entry.
fn difference(x: &[f64], y: &[f64]) -> f64 {
    let pairs = x.iter().zip(y).map(|(x, y)| ((x - y).abs(), x.abs().max(y.abs())));
    let (difference, size) = pairs.fold((0.0_f64, 1e-300_f64), |(d, s), (x, y)| (d.max(x), s.max(y)));
    difference / size
}

/// The largest, for systems with random parameters: change of M between two states; deviation of the momenta from
/// M q̇ + a(q, t); change of h with the velocities.
fn changes<L: Linearized<Scalar = f64> + Default>() -> [f64; 3] {
    let (random, mut most) = (&mut Random(7), [0.0_f64; 3]);
    for _ in 0..DRAWS {
        let system: L = with_parameters(random);
        for _ in 0..DRAWS {
            let (here, there) = (state::<L>(random), state::<L>(random));
            let faster = generic::State { v: there.v, ..here };
            let mass = system.mass_matrix(&here);
            let (mut expected, mut rest) = (system.momentum(&faster), here.v);
            rest -= &there.v;
            expected.gemv(1.0, &mass, &rest, 1.0);
            let found = [
                difference(mass.as_slice(), system.mass_matrix(&there).as_slice()),
                difference(system.momentum(&here).as_slice(), expected.as_slice()),
                difference(system.forcing(&here).as_slice(), system.forcing(&faster).as_slice()),
            ];
            most = std::array::from_fn(|k| most[k].max(found[k]));
        }
    }
    most
}

fn has_constant_mass_matrix<L: ConstantMassMatrix + Linearized<Scalar = f64> + Default>() {
    let [mass, momentum, _] = changes::<L>();
    assert!(mass < 1e-13 && momentum < 1e-12, "{}: {mass}, {momentum}", L::NAME);
}

fn has_velocity_free_forces<L: VelocityFreeForces + Linearized<Scalar = f64> + Default>() {
    let [.., forces] = changes::<L>();
    assert!(forces < 1e-12, "{}: {forces}", L::NAME);
}

#[test]
fn promises_are_kept_at_all_states() {
    has_constant_mass_matrix::<Ball<f64>>();
    has_constant_mass_matrix::<Pendulum>();
    has_constant_mass_matrix::<Charge>();
    has_constant_mass_matrix::<Gauge>();
    has_constant_mass_matrix::<Turntable>();
    has_constant_mass_matrix::<Supplied>();
    has_velocity_free_forces::<Ball<f64>>();
    has_velocity_free_forces::<Pendulum>();
    has_velocity_free_forces::<Gauge>();
    has_velocity_free_forces::<Growing>();
    has_velocity_free_forces::<Supplied>();
    let others = [changes::<Growing>()[0], changes::<Arm>()[0], changes::<Charge>()[2]];
    let others = others.into_iter().chain([changes::<Arm>()[2], changes::<Turntable>()[2]]);
    assert!(others.clone().all(|change| change > 0.1), "{:?}", others.collect::<Vec<_>>());
}

#[test]
fn kinds_of_constraints_are_as_promised() {
    fn has_holonomic_constraints<L: HolonomicConstraints>() {
        assert!(L::CONSTRAINT_KINDS.iter().all(|kind| *kind == ConstraintKind::Holonomic), "{}", L::NAME);
    }
    fn has_no_constraints<L: Unconstrained>() {
        assert!(L::CONSTRAINTS.is_empty(), "{}", L::NAME);
    }
    has_holonomic_constraints::<Ball<f64>>();
    has_holonomic_constraints::<SphericalPendulum<f64>>();
    has_no_constraints::<Ball<f64>>();
    has_no_constraints::<Arm>();
}

/// A bound on a system holds for a pointer to it, and for every number type.
#[test]
fn pointers_and_lanes_have_the_markers_of_their_system() {
    fn all<L: ConstantMassMatrix + VelocityFreeForces + HolonomicConstraints + Unconstrained>(_: L) {}
    let ball = || Ball { m: 1.0, g: 9.81, k: 2.0, l: 0.5 };
    let one = ball();
    all(&one);
    all(Box::new(ball()));
    all(Rc::new(ball()));
    all(Arc::new(ball()));
    let packed: Ball<Lanes> = one.pack();
    all(packed);
}
