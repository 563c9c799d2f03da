//! Marker traits promise a structure: it is there in the numbers, at random states and parameters.
//!
//! The functions that check a promise take only systems that make it. The others must break it visibly.

use std::rc::Rc;
use std::sync::Arc;

use lagrange_core::nalgebra::{Matrix3, Vector3};
use lagrange_core::prelude::*;
use lagrange_core::structure::{ConstantMassMatrix, HolonomicConstraints, Unconstrained, VelocityFreeForces};
use lagrange_core::{ConstraintKind, StateOf, generic};
use lagrange_random::Random;

/// Number of parameters, and of states for each, at random.
const DRAWS: usize = 20;

/// A ball on a spring.
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[lagrangian(m/2*dot(r_dot, r_dot) - m*g*r[2] - k/2*(norm(r) - l)^2)]
struct Ball<T> {
    m: T,
    g: T,
    k: T,
    l: T,
}

/// A pendulum by the position of its bob, in which cos² + sin² has to be recognized. The support moves.
#[derive(Lagrangian)]
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

/// The second angle makes M depend on the coordinates.
#[derive(Lagrangian)]
#[coordinates(theta: [2])]
#[define(p = l*[sin(theta[0]), -cos(theta[0])])]
#[define(q = p + l*[sin(theta[1]), -cos(theta[1])])]
#[lagrangian(m/2*(dot(der(p), der(p)) + dot(der(q), der(q))) - m*g*(p[1] + q[1]))]
struct DoublePendulum {
    m: f64,
    l: f64,
    g: f64,
}

/// Two balls at the ends of a rod, the first on a curve.
#[derive(Lagrangian)]
#[coordinates(r: [2, 2])]
#[lagrangian(m/2*(dot(r_dot[0], r_dot[0]) + dot(r_dot[1], r_dot[1])) - m*g*(r[0][1] + r[1][1]))]
#[constraint(rod: norm(r[1] - r[0])^2 = l^2)]
#[constraint(curve: r[0][1] = k*sin(r[0][0]))]
struct Dumbbell {
    m: f64,
    g: f64,
    k: f64,
    l: f64,
}

/// A charge in a magnetic field, whose vector potential has a gauge term.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + b/2*(x*y_dot - y*x_dot) + der(k*sin(x*y)))]
struct Charge {
    m: f64,
    b: f64,
    k: f64,
}

/// The gauge term alone adds no force.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - k*x^2*y^2 + k*(x_dot + 2*y*y_dot)*exp(x + y^2))]
struct Gauge {
    m: f64,
    k: f64,
}

/// A driven, damped oscillator.
#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2*x_dot^2 - k/2*x^2)]
#[dissipation(c/2*x_dot^2)]
#[force(x: f*cos(w*t))]
struct Damped {
    m: f64,
    k: f64,
    c: f64,
    f: f64,
    w: f64,
}

/// A mass that grows, and a thrust that compensates the force −ṁ ẋ.
#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m*(1 + t)/2*x_dot^2 - k/2*x^2)]
#[force(x: m*x_dot)]
struct Growing {
    m: f64,
    k: f64,
}

/// A ball that rolls along x without slipping, as a constraint on velocities.
#[derive(Lagrangian)]
#[coordinates(x, phi)]
#[lagrangian(m/2*x_dot^2 + m*a^2/5*phi_dot^2 - k/2*x^2)]
#[constraint(no_slip: x_dot - a*phi_dot = 0)]
struct Rolling {
    m: f64,
    a: f64,
    k: f64,
}

/// A rotor that turns about its own axis while it translates, as a frame.
#[derive(Lagrangian)]
#[coordinates(r: [3], turn)]
#[parameter(inertia: symmetric)]
#[frame(rotor: translate(r), rotate_z(turn))]
#[lagrangian(kinetic(rotor, m, [0, 0, c], inertia) - m*g*position(rotor, [0, 0, c])[2])]
struct Rotor {
    m: f64,
    c: f64,
    inertia: Matrix3<f64>,
    g: f64,
}

/// Two rods in space, as frames.
#[derive(Lagrangian)]
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
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[frame(table: rotate_z(w*t))]
#[frame(puck in table: translate([x, y, 0]))]
#[lagrangian(m/2*norm(velocity(puck))^2)]
struct Turntable {
    m: f64,
    w: f64,
}

/// A body whose orientation is a unit quaternion.
#[derive(Lagrangian)]
#[coordinates(q: [4])]
#[frame(body: rotate(q))]
#[lagrangian(kinetic(body, m, [0, 0, c], k*identity(3)) - m*position(body, [0, 0, c])[2])]
struct Top {
    m: f64,
    c: f64,
    k: f64,
}

/// x₁² x₂ + x₁, a potential, or the inertia of a shape with these lengths.
struct Cubic;

impl Function<2, 1> for Cubic {
    fn eval<S: Scalar>(&self, [x, y]: [S; 2]) -> [S; 1] {
        [x * x * y + x]
    }
}

/// A function of the position as potential, and of parameters as inertia.
#[derive(Lagrangian)]
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
fn difference<'a>(x: impl IntoIterator<Item = &'a f64>, y: impl IntoIterator<Item = &'a f64>) -> f64 {
    let pairs = x.into_iter().zip(y).map(|(x, y)| ((x - y).abs(), x.abs().max(y.abs())));
    let (difference, size) = pairs.fold((0.0_f64, 1e-300_f64), |(d, s), (x, y)| (d.max(x), s.max(y)));
    difference / size
}

/// Change of M between two states, and deviation of the momenta from M q̇ + a(q, t).
fn of_mass_matrix<L: Lagrangian<Scalar = f64>>(system: &L, random: &mut Random) -> [f64; 2] {
    let (here, there) = (state::<L>(random), state::<L>(random));
    let mass = system.mass_matrix(&here);
    let change = difference(mass.iter(), system.mass_matrix(&there).iter());
    let mut expected = system.momentum(&generic::State { v: there.v, ..here });
    let mut rest = here.v;
    rest -= &there.v;
    expected.gemv(1.0, &mass, &rest, 1.0);
    [change, difference(system.momentum(&here).iter(), expected.iter())]
}

/// Change of h with the velocities.
fn of_forces<L: Lagrangian<Scalar = f64>>(system: &L, random: &mut Random) -> f64 {
    let here = state::<L>(random);
    let faster = generic::State { v: state::<L>(random).v, ..here };
    difference(system.forcing(&here).iter(), system.forcing(&faster).iter())
}

/// Calls `check` for systems like this one, with random parameters.
fn draws<L: Linearized<Scalar = f64>>(system: &mut L, mut check: impl FnMut(&L, &mut Random)) {
    let random = &mut Random(7);
    for _ in 0..DRAWS {
        for index in 0..L::PARAMETERS.len() {
            assert!(system.set_parameter(index, random.positive()));
        }
        for _ in 0..DRAWS {
            check(system, random);
        }
    }
}

fn has_constant_mass_matrix<L: ConstantMassMatrix + Linearized<Scalar = f64>>(mut system: L) {
    draws(&mut system, |system, random| {
        let [change, rest] = of_mass_matrix(system, random);
        assert!(change < 1e-13, "{}: {change}", L::NAME);
        assert!(rest < 1e-12, "{}: {rest}", L::NAME);
    });
}

fn has_velocity_free_forces<L: VelocityFreeForces + Linearized<Scalar = f64>>(mut system: L) {
    draws(&mut system, |system, random| {
        let change = of_forces(system, random);
        assert!(change < 1e-12, "{}: {change}", L::NAME);
    });
}

fn has_another_mass_matrix<L: Linearized<Scalar = f64>>(mut system: L) {
    let mut greatest = 0.0;
    draws(&mut system, |system, random| greatest = of_mass_matrix(system, random)[0].max(greatest));
    assert!(greatest > 0.1, "{}: {greatest}", L::NAME);
}

fn has_other_forces<L: Linearized<Scalar = f64>>(mut system: L) {
    let mut greatest = 0.0;
    draws(&mut system, |system, random| greatest = of_forces(system, random).max(greatest));
    assert!(greatest > 0.1, "{}: {greatest}", L::NAME);
}

fn has_holonomic_constraints<L: HolonomicConstraints>(_: &L) {
    assert!(L::CONSTRAINT_KINDS.iter().all(|kind| *kind == ConstraintKind::Holonomic), "{}", L::NAME);
}

fn has_no_constraints<L: Unconstrained>(_: &L) {
    assert!(L::CONSTRAINTS.is_empty(), "{}", L::NAME);
}

const BALL: Ball<f64> = Ball { m: 1.0, g: 9.81, k: 2.0, l: 0.5 };
const PENDULUM: Pendulum = Pendulum { m: 1.0, l: 2.0, g: 9.81, a: 0.1, w: 3.0 };
const DOUBLE_PENDULUM: DoublePendulum = DoublePendulum { m: 1.0, l: 2.0, g: 9.81 };
const DUMBBELL: Dumbbell = Dumbbell { m: 1.0, g: 9.81, k: 0.5, l: 1.0 };
const CHARGE: Charge = Charge { m: 1.0, b: 2.0, k: 0.5 };
const GAUGE: Gauge = Gauge { m: 1.0, k: 2.0 };
const DAMPED: Damped = Damped { m: 1.0, k: 2.0, c: 0.3, f: 1.0, w: 2.0 };
const GROWING: Growing = Growing { m: 1.0, k: 2.0 };
const ROLLING: Rolling = Rolling { m: 1.0, a: 0.1, k: 2.0 };
const TURNTABLE: Turntable = Turntable { m: 1.0, w: 2.0 };
const TOP: Top = Top { m: 1.0, c: 0.5, k: 1.0 };
const SUPPLIED: Supplied = Supplied { m: 1.0, l: 2.0, cubic: Cubic };

fn rotor() -> Rotor {
    Rotor { m: 1.0, c: 0.5, inertia: Matrix3::identity(), g: 9.81 }
}

fn arm() -> Arm {
    let (joint, centre) = (Vector3::new(0.2, 0.0, 0.5), Vector3::new(0.0, 0.0, 0.3));
    Arm { m: 1.0, joint, centre, inertia: Matrix3::identity(), g: 9.81 }
}

#[test]
fn a_constant_mass_matrix_is_the_same_at_all_states() {
    has_constant_mass_matrix(BALL);
    has_constant_mass_matrix(PENDULUM);
    has_constant_mass_matrix(DUMBBELL);
    has_constant_mass_matrix(CHARGE);
    has_constant_mass_matrix(GAUGE);
    has_constant_mass_matrix(DAMPED);
    has_constant_mass_matrix(ROLLING);
    has_constant_mass_matrix(rotor());
    has_constant_mass_matrix(TURNTABLE);
    has_constant_mass_matrix(SUPPLIED);
    has_another_mass_matrix(DOUBLE_PENDULUM);
    has_another_mass_matrix(GROWING);
    has_another_mass_matrix(arm());
    has_another_mass_matrix(TOP);
}

#[test]
fn velocity_free_forces_are_the_same_at_all_velocities() {
    has_velocity_free_forces(BALL);
    has_velocity_free_forces(PENDULUM);
    has_velocity_free_forces(DUMBBELL);
    has_velocity_free_forces(GAUGE);
    has_velocity_free_forces(GROWING);
    has_velocity_free_forces(ROLLING);
    has_velocity_free_forces(rotor());
    has_velocity_free_forces(SUPPLIED);
    has_other_forces(DOUBLE_PENDULUM);
    has_other_forces(CHARGE);
    has_other_forces(DAMPED);
    has_other_forces(arm());
    has_other_forces(TURNTABLE);
    has_other_forces(TOP);
}

#[test]
fn kinds_of_constraints_are_as_promised() {
    has_holonomic_constraints(&BALL);
    has_holonomic_constraints(&DUMBBELL);
    has_holonomic_constraints(&TOP);
    has_no_constraints(&BALL);
    has_no_constraints(&arm());
}

/// A bound on a system holds for a pointer to it.
#[test]
fn pointers_forward_markers() {
    fn all<L: ConstantMassMatrix + VelocityFreeForces + HolonomicConstraints + Unconstrained>(_: L) {}
    all(&BALL);
    all(Box::new(BALL));
    all(Rc::new(BALL));
    all(Arc::new(BALL));
}

/// Markers hold for every number type.
#[test]
fn lanes_have_the_markers_of_their_system() {
    use lagrange_core::{Lanes, Pack};
    fn all<L: ConstantMassMatrix + VelocityFreeForces + HolonomicConstraints + Unconstrained>(_: &L) {}
    let packed: Ball<Lanes> = BALL.pack();
    all(&packed);
}
