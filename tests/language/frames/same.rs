//! Systems in frames, and the same systems written without.

use approx::assert_relative_eq;
use lagrange_core::nalgebra::{Matrix3, Rotation3, SVector, Vector3};
use lagrange_core::prelude::*;

/// A robot arm of six revolute joints, with any placements and inertias.
#[derive(Lagrangian)]
#[coordinates(q: [6])]
#[frame(link[0]: rotate(place[0]), rotate_z(q[0]))]
#[frame(link[i in 1..6] in link[i-1]: translate(arm[i]), rotate(place[i]), rotate_z(q[i]))]
#[lagrangian(sum(i in 0..6, kinetic(link[i], m[i], centre[i], inertia[i]) - m[i]*g*position(link[i], centre[i])[2]))]
#[force(q: torque)]
struct Arm {
    place: [Rotation3<f64>; 6],
    arm: [Vector3<f64>; 6],
    centre: [Vector3<f64>; 6],
    inertia: [Matrix3<f64>; 6],
    m: [f64; 6],
    g: f64,
    torque: [f64; 6],
}

/// The same by the rates of positions along the fixed axes.
#[derive(Lagrangian)]
#[coordinates(q: [6])]
#[define(axes[0] = place[0]*rot_z(q[0]))]
#[define(axes[i in 1..6] = axes[i-1]*place[i]*rot_z(q[i]))]
#[define(at[0] = [0, 0, 0])]
#[define(at[i in 1..6] = at[i-1] + axes[i-1]*arm[i])]
#[define(c[i in 0..6] = at[i] + axes[i]*centre[i])]
#[define(spin[0] = place[0]*[0, 0, q_dot[0]])]
#[define(spin[i in 1..6] = spin[i-1] + axes[i]*[0, 0, q_dot[i]])]
#[define(w[i in 0..6] = spin[i]*axes[i])]
#[lagrangian(sum(i in 0..6, m[i]/2*dot(der(c[i]), der(c[i])) + dot(w[i], inertia[i]*w[i])/2 - m[i]*g*c[i][2]))]
#[force(q: torque)]
struct World {
    place: [Rotation3<f64>; 6],
    arm: [Vector3<f64>; 6],
    centre: [Vector3<f64>; 6],
    inertia: [Matrix3<f64>; 6],
    m: [f64; 6],
    g: f64,
    torque: [f64; 6],
}

macro_rules! arm {
    ($name:ident) => {{
        let number = |i: usize, k: usize| ((i * 7 + k * 3) as f64 * 0.618).fract() - 0.4;
        let vector = |i: usize| Vector3::new(number(i, 1), number(i, 2), number(i, 3));
        let root = |i: usize| Matrix3::from_fn(|r, c| number(i, 3 * r + c));
        $name {
            place: core::array::from_fn(|i| Rotation3::from_scaled_axis(3.0 * vector(i))),
            arm: core::array::from_fn(|i| vector(i + 6)),
            centre: core::array::from_fn(|i| vector(i + 12)),
            inertia: core::array::from_fn(|i| root(i) * root(i).transpose() + Matrix3::identity() * 0.1),
            m: core::array::from_fn(|i| 1.0 + number(i, 0)),
            g: 9.81,
            torque: core::array::from_fn(|i| number(i, 5)),
        }
    }};
}

fn assert_close<const N: usize>(ours: SVector<f64, N>, theirs: SVector<f64, N>, tolerance: f64) {
    let scale = theirs.amax();
    assert_relative_eq!(ours, theirs, epsilon = tolerance * scale);
}

#[test]
fn an_arm_accelerates_as_by_positions_along_the_fixed_axes() {
    let (arm, world) = (arm!(Arm), arm!(World));
    for k in 0..10 {
        let number = |i: usize| ((k * 13 + i * 5) as f64 * 0.618).fract() * 4.0 - 2.0;
        let state = State::new(core::array::from_fn(number), core::array::from_fn(|i| number(i + 6)));
        let ours = arm.solve(&state).unwrap();
        assert_close(ours.accelerations, world.solve(&state).unwrap().accelerations, 1e-11);
        assert_relative_eq!(arm.energy(&state), world.energy(&state), max_relative = 1e-13);
        assert_relative_eq!(arm.mass_matrix(&state), world.mass_matrix(&state), epsilon = 1e-13);
        assert_close(arm.momentum(&state), world.momentum(&state), 1e-13);
    }
}

/// A heavy top by a quaternion.
#[derive(Lagrangian)]
#[coordinates(q: [4])]
#[frame(body: rotate(q))]
#[lagrangian(kinetic(body, m, centre, inertia) - m*g*position(body, centre)[2])]
#[observable(force_on_length = lambda(q))]
#[observable(spin = angular_velocity(body))]
struct Top {
    m: f64,
    g: f64,
    centre: Vector3<f64>,
    inertia: Matrix3<f64>,
}

/// The same as a formula.
#[derive(Lagrangian)]
#[coordinates(q: [4])]
#[define(w = quat_rate_body(q, q_dot))]
#[lagrangian(m/2*dot(cross(w, centre), cross(w, centre)) + dot(w, inertia*w)/2 - m*g*quat_rotate(q, centre)[2])]
#[constraint(unit: dot(q, q) = 1)]
struct Formula {
    m: f64,
    g: f64,
    centre: Vector3<f64>,
    inertia: Matrix3<f64>,
}

#[test]
fn a_body_turned_by_a_quaternion_brings_its_constraint_which_does_nothing() {
    assert_eq!(Top::CONSTRAINTS, ["q"]);
    let (centre, inertia) =
        (Vector3::new(0.1, 0.2, 0.5), Matrix3::from_diagonal(&Vector3::new(2.0, 1.5, 1.0)));
    let top = Top { m: 1.0, g: 9.81, centre, inertia };
    let formula = Formula { m: 1.0, g: 9.81, centre, inertia };
    let (c, s) = (0.75_f64.sqrt(), 0.5);
    let start = State::new([c, s, 0.0, 0.0], [-0.3 * s, 0.3 * c, -10.0 * s, 10.0 * c]);
    let ours = top.solve(&start).unwrap();
    assert_close(ours.accelerations, formula.solve(&start).unwrap().accelerations, 1e-12);
    // Nothing depends on the length of q: what keeps it 1 has no work to do.
    assert!(top.force_on_length(&start, &ours).abs() < 1e-12);
    assert_relative_eq!(top.spin(&start), SVector::from([0.6, 0.0, 20.0]), epsilon = 1e-14);
    let path = top.integrate(start, 2.0, Dop853::with_tolerance(1e-11)).unwrap();
    let theirs = formula.integrate(start, 2.0, Dop853::with_tolerance(1e-11)).unwrap();
    assert_close(path.end().state().q, theirs.end().state().q, 1e-8);
    assert!(path.drift().iter().all(|quantity| quantity.largest < 1e-7));
}

/// The constraint of its length is written, and not doubled.
#[derive(Lagrangian)]
#[coordinates(r: [3], q: [4])]
#[frame(body: translate(r), rotate(q))]
#[lagrangian(kinetic(body, m, [0, 0, 0], inertia))]
#[constraint(length: (1 - dot(q, q))/2 = 0)]
#[constraint(track: r[2] = 0)]
struct Written {
    m: f64,
    inertia: Matrix3<f64>,
}

/// It comes last where it is not; several in the order of the frames, not of the coordinates.
#[derive(Lagrangian)]
#[coordinates(r: [3], p: [4], q: [4])]
#[frame(body: translate(r), rotate(q))]
#[frame(wheel in body: rotate(p))]
#[lagrangian(kinetic(body, m, [0, 0, 0], inertia) + kinetic(wheel, m, [0, 0, 0], inertia))]
#[constraint(track: r[2] = 0)]
struct Unwritten {
    m: f64,
    inertia: Matrix3<f64>,
}

#[test]
fn a_unit_constraint_is_there_once_and_last() {
    assert_eq!(Written::CONSTRAINTS, ["length", "track"]);
    assert_eq!(Unwritten::CONSTRAINTS, ["track", "q", "p"]);
}

/// Milton (8.44): a bob in the frame of the rotating Earth.
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[define(v = r_dot)]
#[define(W = [0, rate*cos(latitude), rate*sin(latitude)])]
#[lagrangian(m/2*dot(v, v) + m*dot(v, cross(W, r)) + m/2*dot(cross(W, r), cross(W, r)) - m*g*r[2])]
#[constraint(string: (dot(r, r) - l^2)/2 = 0)]
struct Bob {
    m: f64,
    g: f64,
    l: f64,
    rate: f64,
    latitude: f64,
}

/// The same: x points east, y north, z up.
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[frame(site: rotate_z(rate*t), rotate_x(pi/2 - latitude))]
#[lagrangian(kinetic(site, m, r) - m*g*r[2])]
#[constraint(string: (dot(r, r) - l^2)/2 = 0)]
struct Foucault {
    m: f64,
    g: f64,
    l: f64,
    rate: f64,
    latitude: f64,
}

#[test]
fn a_pendulum_on_the_turning_earth_has_the_equations_of_the_rotating_frame() {
    let (bob, site) = (
        Bob { m: 2.0, g: 9.8, l: 3.0, rate: 0.3, latitude: 0.8 },
        Foucault { m: 2.0, g: 9.8, l: 3.0, rate: 0.3, latitude: 0.8 },
    );
    let mut state = State::new([1.0, 2.0, -2.0], [2.0, -1.0, 0.0]);
    state.t = 1.7;
    let (ours, theirs) = (site.solve(&state).unwrap(), bob.solve(&state).unwrap());
    assert_close(ours.accelerations, theirs.accelerations, 1e-13);
    assert_close(ours.multipliers, theirs.multipliers, 1e-13);
    assert_relative_eq!(site.energy(&state), bob.energy(&state), max_relative = 1e-13);
}

/// Milton (8.4)–(8.7): a ball on a plane with the normal n that turns at the rate w.
#[derive(Lagrangian)]
#[coordinates(r: [3], q: [4])]
#[define(inertia = 2/5 * m * a^2)]
#[define(Omega = quat_rate(q, q_dot))]
#[lagrangian(m/2 * dot(r_dot, r_dot) + inertia/2 * dot(Omega, Omega) + m*dot(g, r))]
#[constraint(rolling: r_dot - a*cross(Omega, n) = w*cross(n, r))]
#[constraint(unit: dot(q, q) = 1)]
#[observable(spin = Omega)]
struct Ball {
    m: f64,
    a: f64,
    g: Vector3<f64>,
    n: Vector3<f64>,
    w: f64,
}

/// The same as a body.
#[derive(Lagrangian)]
#[coordinates(r: [3], q: [4])]
#[frame(ball: translate(r), rotate(q))]
#[define(inertia = 2/5 * m * a^2 * identity(3))]
#[define(Omega = express(angular_velocity(ball), fixed))]
#[lagrangian(kinetic(ball, m, [0, 0, 0], inertia) + m*dot(g, r))]
#[constraint(rolling: express(velocity(ball), fixed) - a*cross(Omega, n) = vector(fixed, w*cross(n, r)))]
#[observable(spin = Omega)]
struct RollingBody {
    m: f64,
    a: f64,
    g: Vector3<f64>,
    n: Vector3<f64>,
    w: f64,
}

#[test]
fn a_body_that_rolls_has_the_equations_of_the_ball() {
    let (m, a, g, w) = (0.5, 0.1, Vector3::new(0.3, 0.0, -9.81), 3.0);
    let n = Vector3::new(0.1, 0.2, 0.9).normalize();
    let (ball, body) = (Ball { m, a, g, n, w }, RollingBody { m, a, g, n, w });
    let rough = State::new([0.5, 0.1, 0.2, 1.0, 0.2, 0.3, 0.4], [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]);
    let (state, _) = ball.make_consistent(&rough).unwrap();
    let (ours, theirs) = (body.solve(&state).unwrap(), ball.solve(&state).unwrap());
    assert_close(ours.accelerations, theirs.accelerations, 1e-12);
    // The contact force; what keeps |q| = 1 has work to do where L depends on the length.
    let rolling = |multipliers: SVector<f64, 4>| multipliers.fixed_rows::<3>(0).into_owned();
    assert_close(rolling(ours.multipliers), rolling(theirs.multipliers), 1e-12);
    assert_relative_eq!(body.spin(&state), ball.spin(&state), max_relative = 1e-12);
    assert_relative_eq!(body.energy(&state), ball.energy(&state), max_relative = 1e-12);
}
