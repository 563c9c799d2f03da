//! Bodies whose places are arrays: of vectors, and of quaternions, which bring a constraint each.

use approx::assert_relative_eq;
use lagrange_core::nalgebra::{Matrix3, Quaternion, Vector3};
use lagrange_core::prelude::*;

/// Three bodies that fall freely, the last two of which are tied by a spring; there is room for a fourth that has no quaternion.
#[derive(Lagrangian)]
#[coordinates(r: [3, 3], q: [3, 4])]
#[parameter(inertia: symmetric)]
#[frame(body[i in 0..3]: translate(r[i]), rotate(q[i]))]
#[define(reach = position(body[2], arm) - position(body[1], arm))]
#[lagrangian(sum(i in 0..3, kinetic(body[i], m[i], [0, 0, 0], inertia[i]) - m[i]*g*r[i][2]) - k/2*dot(reach, reach))]
#[observable(spin[i in 0..3] = angular_velocity(body[i]))]
struct Bodies {
    m: [f64; 3],
    inertia: [Matrix3<f64>; 3],
    arm: Vector3<f64>,
    k: f64,
    g: f64,
}

#[test]
fn each_quaternion_brings_its_constraint() {
    assert_eq!(Bodies::CONSTRAINTS, ["q[0]", "q[1]", "q[2]"]);
    assert!(
        Bodies::equations().text().contains("q[i = 0 … 2]: q[i]·q[i] = 1"),
        "{}",
        Bodies::equations().text()
    );
}

/// m r̈ = F and I ω̇ + ω × I ω = τ of each body, with q̈ = ½ (q̇ ω + q ω̇).
#[test]
fn they_move_as_newton_and_euler_have_it() {
    let diagonal = |a, b, c| {
        Matrix3::from_diagonal(&Vector3::new(a, b, c))
            + Matrix3::new(0.0, 0.1, 0.2, 0.1, 0.0, -0.1, 0.2, -0.1, 0.0)
    };
    let inertia = [diagonal(1.0, 2.0, 2.5), diagonal(3.0, 2.0, 1.5), diagonal(0.7, 0.9, 0.8)];
    let bodies = Bodies { m: [1.0, 2.0, 0.5], inertia, arm: Vector3::new(0.3, -0.2, 0.5), k: 7.0, g: 9.81 };
    let at = |k: usize| (k * 29 % 17) as f64 / 8.0 - 0.9;
    let rough = State::new(std::array::from_fn(at), std::array::from_fn(|k| at(k + 40)));
    let (state, _) = bodies.make_consistent(&rough).unwrap();
    let three = |of: &[f64], i: usize| Vector3::from_column_slice(&of[3 * i..3 * i + 3]);
    let four = |of: &[f64], i: usize| {
        let [w, x, y, z] = of[9 + 4 * i..13 + 4 * i] else { panic!() };
        Quaternion::new(w, x, y, z)
    };
    let (q, v) = (state.q.as_slice(), state.v.as_slice());
    let turned =
        |i: usize, x: Vector3<f64>| (four(q, i) * Quaternion::from_imag(x) * four(q, i).conjugate()).imag();
    let reach = three(q, 2) + turned(2, bodies.arm) - three(q, 1) - turned(1, bodies.arm);
    let pulls = [Vector3::zeros(), bodies.k * reach, -bodies.k * reach];
    let solution = bodies.solve(&state).unwrap();
    let found = solution.accelerations.as_slice();
    let spins = bodies.spin(&state);
    for i in 0..3 {
        let fall = pulls[i] / bodies.m[i] - Vector3::new(0.0, 0.0, bodies.g);
        assert_relative_eq!(three(found, i), fall, max_relative = 1e-11, epsilon = 1e-12);
        let spin = 2.0 * (four(q, i).conjugate() * four(v, i)).imag();
        assert_relative_eq!(spins.row(i).transpose(), spin, max_relative = 1e-12);
        let back = (four(q, i).conjugate() * Quaternion::from_imag(pulls[i]) * four(q, i)).imag();
        let torque = bodies.arm.cross(&back) - spin.cross(&(inertia[i] * spin));
        let rate = inertia[i].lu().solve(&torque).unwrap();
        let turning =
            (four(v, i) * Quaternion::from_imag(spin) + four(q, i) * Quaternion::from_imag(rate)) * 0.5;
        assert_relative_eq!(four(found, i), turning, max_relative = 1e-10, epsilon = 1e-11);
    }
}

/// A row that turns no frame is free, and a constraint that is written is not doubled.
#[derive(Lagrangian)]
#[coordinates(q: [3, 4])]
#[frame(one: rotate(q[2]))]
#[frame(other: rotate(q[0]))]
#[lagrangian(kinetic(one, m, c, inertia) + kinetic(other, m, c, inertia) + dot(q_dot[1], q_dot[1])/2)]
#[constraint(unit: dot(q[0], q[0]) = 1)]
struct Two {
    m: f64,
    c: Vector3<f64>,
    inertia: Matrix3<f64>,
}

#[test]
fn only_what_turns_a_frame_is_of_length_1() {
    assert_eq!(Two::CONSTRAINTS, ["unit", "q[2]"]);
}

/// Two legs of three links each: a family of frames with two indices.
#[derive(Lagrangian)]
#[coordinates(x, a: [2, 3])]
#[frame(cart: translate([x, 0, 0]))]
#[frame(leg[i in 0..2, 0] in cart: translate([0, i*w, 0]), rotate_y(a[i][0]))]
#[frame(leg[i in 0..2, j in 1..3] in leg[i][j-1]: translate([0, 0, -l]), rotate_y(a[i][j]))]
#[lagrangian(m*x_dot^2/2 + sum(i in 0..2, sum(j in 0..3, kinetic(leg[i][j], m, [0, 0, -l]) - m*g*position(leg[i][j], [0, 0, -l])[2])))]
#[observable(foot[i in 0..2] = position(leg[i][2], [0, 0, -l]))]
struct Legs {
    m: f64,
    l: f64,
    w: f64,
    g: f64,
}

#[test]
fn frames_have_two_indices() {
    let legs = Legs { m: 1.0, l: 0.5, w: 0.4, g: 9.81 };
    let angles = [0.1, 0.5, -0.3, 1.0, 0.2, 0.4];
    let state = State::at_rest([2.0, angles[0], angles[1], angles[2], angles[3], angles[4], angles[5]]);
    let feet = legs.foot(&state);
    for i in 0..2 {
        let (mut angle, mut foot) = (0.0, Vector3::new(2.0, i as f64 * legs.w, 0.0));
        for j in 0..3 {
            angle += angles[3 * i + j];
            foot -= legs.l * Vector3::new(f64::sin(angle), 0.0, f64::cos(angle));
        }
        assert_relative_eq!(feet.row(i).transpose(), foot, max_relative = 1e-14);
    }
}
