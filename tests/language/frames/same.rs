//! Systems in frames, and the same systems written without.

use approx::assert_relative_eq;
use lagrange_core::nalgebra::{Matrix3, SVector, Vector3};
use lagrange_core::prelude::*;

/// Declares systems with the same fields.
macro_rules! systems {
    ($fields:tt $($(#[$attribute:meta])* $name:ident;)*) => {
        $($(#[$attribute])*
        struct $name $fields)*
    };
}

fn assert_close<const N: usize>(ours: SVector<f64, N>, theirs: SVector<f64, N>, tolerance: f64) {
    let scale = theirs.amax();
    assert_relative_eq!(ours, theirs, epsilon = tolerance * scale);
}

systems! {
    { m: f64, g: f64, centre: Vector3<f64>, inertia: Matrix3<f64> }
    /// A heavy top by a quaternion.
    #[derive(Lagrangian)]
    #[coordinates(q: [4])]
    #[frame(body: rotate(q))]
    #[lagrangian(kinetic(body, m, centre, inertia) - m*g*position(body, centre)[2])]
    #[observable(force_on_length = lambda(q))]
    #[observable(spin = angular_velocity(body))]
    Top;
    /// The same as a formula.
    #[derive(Lagrangian)]
    #[coordinates(q: [4])]
    #[define(w = quat_rate_body(q, q_dot))]
    #[lagrangian(m/2*dot(cross(w, centre), cross(w, centre)) + dot(w, inertia*w)/2 - m*g*quat_rotate(q, centre)[2])]
    #[constraint(unit: dot(q, q) = 1)]
    Formula;
}

#[test]
fn a_body_turned_by_a_quaternion_brings_its_constraint_which_does_nothing() {
    assert_eq!(Top::CONSTRAINTS, ["q"]);
    let (centre, inertia) =
        (Vector3::new(0.1, 0.2, 0.5), Matrix3::from_diagonal(&Vector3::new(2.0, 1.5, 1.0)));
    let (m, g) = (1.0, 9.81);
    let (top, formula) = (Top { m, g, centre, inertia }, Formula { m, g, centre, inertia });
    let (c, s) = (0.75_f64.sqrt(), 0.5);
    let start = State::new([c, s, 0.0, 0.0], [-0.3 * s, 0.3 * c, -10.0 * s, 10.0 * c]);
    let ours = top.solve(&start).unwrap();
    assert_close(ours.accelerations, formula.solve(&start).unwrap().accelerations, 1e-12);
    // Nothing depends on the length of q: what keeps it 1 has no work to do.
    assert!(top.force_on_length(&start, &ours).abs() < 1e-12);
    assert_relative_eq!(top.spin(&start), SVector::from([0.6, 0.0, 20.0]), epsilon = 1e-14);
}

systems! {
    { m: f64, inertia: Matrix3<f64> }
    /// The constraint of its length is written, and not doubled.
    #[derive(Lagrangian)]
    #[coordinates(r: [3], q: [4])]
    #[frame(body: translate(r), rotate(q))]
    #[lagrangian(kinetic(body, m, [0, 0, 0], inertia))]
    #[constraint(length: (1 - dot(q, q))/2 = 0)]
    #[constraint(track: r[2] = 0)]
    Written;
    /// It comes last where it is not; several in the order of the frames, not of the coordinates.
    #[derive(Lagrangian)]
    #[coordinates(r: [3], p: [4], q: [4])]
    #[frame(body: translate(r), rotate(q))]
    #[frame(wheel in body: rotate(p))]
    #[lagrangian(kinetic(body, m, [0, 0, 0], inertia) + kinetic(wheel, m, [0, 0, 0], inertia))]
    #[constraint(track: r[2] = 0)]
    Unwritten;
}

#[test]
fn a_unit_constraint_is_there_once_and_last() {
    assert_eq!(Written::CONSTRAINTS, ["length", "track"]);
    assert_eq!(Unwritten::CONSTRAINTS, ["track", "q", "p"]);
}

systems! {
    { m: f64, a: f64, g: Vector3<f64>, n: Vector3<f64>, w: f64 }
    /// Milton (8.4)–(8.7): a ball on a plane with the normal n that turns at the rate w.
    #[derive(Lagrangian)]
    #[coordinates(r: [3], q: [4])]
    #[define(inertia = 2/5 * m * a^2)]
    #[define(Omega = quat_rate(q, q_dot))]
    #[lagrangian(m/2 * dot(r_dot, r_dot) + inertia/2 * dot(Omega, Omega) + m*dot(g, r))]
    #[constraint(rolling: r_dot - a*cross(Omega, n) = w*cross(n, r))]
    #[constraint(unit: dot(q, q) = 1)]
    #[observable(spin = Omega)]
    Ball;
    /// The same as a body.
    #[derive(Lagrangian)]
    #[coordinates(r: [3], q: [4])]
    #[frame(ball: translate(r), rotate(q))]
    #[define(inertia = 2/5 * m * a^2 * identity(3))]
    #[define(Omega = express(angular_velocity(ball), fixed))]
    #[lagrangian(kinetic(ball, m, [0, 0, 0], inertia) + m*dot(g, r))]
    #[constraint(rolling: express(velocity(ball), fixed) - a*cross(Omega, n) = vector(fixed, w*cross(n, r)))]
    #[observable(spin = Omega)]
    RollingBody;
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
