//! The algebra of vectors, one rule a test.

use lagrange_core::nalgebra::{Matrix2, SMatrix, Vector2, Vector3};
use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [3], q: [4], x)]
#[define(twice(v) = 2*v)]
#[define(rate(v) = der(v))]
#[define(length2(v) = dot(v, v))]
#[define(x_index = 1)]
#[define(p[i in 0..3] = [x^i, r[i], i])]
#[lagrangian(dot(r_dot, r_dot)/2 + dot(q_dot, q_dot)/2 + x_dot^2/2)]
#[observable(square_of_norm = norm(r)^2)]
#[observable(fourth_of_norm = norm(r)^4)]
#[observable(square_of_abs = abs(x)^2)]
#[observable(slope_of_norm_squared = der(norm(r)^2))]
#[observable(slope_of_abs_squared = der(abs(x)^2))]
#[observable(plus_zero = r + 0)]
#[observable(zero_minus = 0 - r)]
#[observable(zero_cross = dot(r, 0*r))]
#[observable(half = r/2)]
#[observable(opposite = -r)]
#[observable(left = 3*r)]
#[observable(right = r*x)]
#[observable(entry = (r - a)[1])]
#[observable(made = [x, 2*x])]
#[observable(part = (2*q)[1..4])]
#[observable(part_of_field = a[0..2] - rows[1][x_index..3])]
#[observable(part_of_family = p[1..3][1])]
#[observable(of_scalar = twice(x))]
#[observable(of_vector = twice(r))]
#[observable(of_velocity = twice(r_dot))]
#[observable(of_matrix = twice(stiffness)*b)]
#[observable(rate_of_scalar = rate(x^3))]
#[observable(rate_of_vector = rate(x*r))]
#[observable(length_of_two = length2([x, 3]))]
#[observable(length_of_three = length2(r))]
#[observable(middle = p[1][0] + p[2][1])]
#[observable(whole = p[2])]
#[observable(sum_of_vectors = sum(i in 0..3, p[i]))]
#[observable(product_of_vectors = cross(r, a))]
#[observable(triple = dot(cross(r, a), r_dot))]
#[observable(by_array = rows*a)]
#[observable(by_matrix = stiffness*b)]
#[observable(by_row = rows[1])]
#[observable(by_cell = stiffness[0][1])]
#[observable(turned = quat_rotate(q, r))]
#[observable(turning = quat_rate(q, q_dot))]
#[observable(turning_body = quat_rate_body(q, q_dot))]
struct Kit {
    a: Vector3<f64>,
    b: Vector2<f64>,
    stiffness: Matrix2<f64>,
    rows: [[f64; 3]; 2],
}

fn kit() -> Kit {
    Kit {
        a: Vector3::new(1.0, -2.0, 4.0),
        b: Vector2::new(3.0, 5.0),
        stiffness: Matrix2::new(1.0, 2.0, 3.0, 4.0),
        rows: [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]],
    }
}

/// r = (1, 2, 3), q = (1, 2, −1, 3)/√15, x = −2; their velocities (2, −1, 1), (…), 5.
fn state() -> State<f64, 8> {
    let q = [1.0, 2.0, -1.0, 3.0].map(|q: f64| q / 15.0_f64.sqrt());
    State::new([1.0, 2.0, 3.0, q[0], q[1], q[2], q[3], -2.0], [2.0, -1.0, 1.0, 0.3, -0.7, 0.2, 0.5, 5.0])
}

#[test]
fn the_square_of_a_length_is_a_dot_product() {
    let (kit, state) = (kit(), state());
    assert_eq!(kit.square_of_norm(&state), 14.0);
    assert_eq!(kit.fourth_of_norm(&state), 196.0);
    assert_eq!(kit.square_of_abs(&state), 4.0);
}

#[test]
fn squares_of_lengths_have_a_rate_at_rest_and_at_the_origin() {
    let (kit, rest) = (kit(), State::new([0.0; 8], [1.0; 8]));
    assert_eq!(kit.slope_of_norm_squared(&rest), 0.0);
    assert_eq!(kit.slope_of_abs_squared(&rest), 0.0);
    assert_eq!(kit.slope_of_norm_squared(&state()), 2.0 * (2.0 - 2.0 + 3.0));
    assert_eq!(kit.slope_of_abs_squared(&state()), -20.0);
}

#[test]
fn vectors_take_numbers_and_signs_and_the_literal_zero() {
    let (kit, state) = (kit(), state());
    assert_eq!(kit.plus_zero(&state), Vector3::new(1.0, 2.0, 3.0));
    assert_eq!(kit.zero_minus(&state), -Vector3::new(1.0, 2.0, 3.0));
    assert_eq!(kit.zero_cross(&state), 0.0);
    let r = Vector3::new(1.0, 2.0, 3.0);
    assert_eq!(kit.half(&state), r / 2.0);
    assert_eq!(kit.opposite(&state), -r);
    assert_eq!(kit.left(&state), r * 3.0);
    assert_eq!(kit.right(&state), r * -2.0);
    assert_eq!(kit.entry(&state), 4.0);
    assert_eq!(kit.made(&state), Vector2::new(-2.0, -4.0));
}

#[test]
fn a_slice_is_a_vector_of_some_elements() {
    let (kit, state) = (kit(), state());
    let q = state.q;
    assert_eq!(kit.part(&state), Vector3::new(q[4], q[5], q[6]) * 2.0);
    assert_eq!(kit.part_of_field(&state), Vector2::new(1.0 - 5.0, -2.0 - 6.0));
    assert_eq!(kit.part_of_family(&state), Vector3::new(4.0, 3.0, 2.0));
}

#[test]
fn arguments_bring_their_shapes_to_each_call_and_have_rates() {
    let (kit, state) = (kit(), state());
    assert_eq!(kit.of_scalar(&state), -4.0);
    assert_eq!(kit.of_vector(&state), Vector3::new(2.0, 4.0, 6.0));
    assert_eq!(kit.of_velocity(&state), Vector3::new(4.0, -2.0, 2.0));
    assert_eq!(kit.of_matrix(&state), Vector2::new(26.0, 58.0));
    assert_eq!(kit.length_of_two(&state), 13.0);
    assert_eq!(kit.length_of_three(&state), 14.0);
    // (x³)˙ = 3 x² ẋ and (x r)˙ = ẋ r + x ṙ
    assert_eq!(kit.rate_of_scalar(&state), 60.0);
    assert_eq!(kit.rate_of_vector(&state), Vector3::new(5.0 - 4.0, 10.0 + 2.0, 15.0 - 2.0));
    // p[i] = (xⁱ, rᵢ, i)
    assert_eq!(kit.middle(&state), -2.0 + 3.0);
    assert_eq!(kit.whole(&state), Vector3::new(4.0, 3.0, 2.0));
    assert_eq!(kit.sum_of_vectors(&state), Vector3::new(3.0, 6.0, 3.0));
}

#[test]
fn products_are_those_of_nalgebra() {
    let (kit, state) = (kit(), state());
    let (r, v) = (Vector3::new(1.0, 2.0, 3.0), Vector3::new(2.0, -1.0, 1.0));
    assert_eq!(kit.product_of_vectors(&state), r.cross(&kit.a));
    assert_eq!(kit.triple(&state), r.cross(&kit.a).dot(&v));
    let rows = SMatrix::<f64, 2, 3>::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0);
    assert_eq!(kit.by_array(&state), rows * kit.a);
    assert_eq!(kit.by_matrix(&state), kit.stiffness * kit.b);
    assert_eq!(kit.by_row(&state), Vector3::new(4.0, 5.0, 6.0));
    assert_eq!(kit.by_cell(&state), 2.0);
}

/// A quaternion turns as nalgebra's does; its rate is what turns the vector: (R v)˙ = ω × R v for constant v.
#[test]
fn quaternions_turn_vectors_and_rates_are_angular_velocities() {
    use lagrange_core::nalgebra::{Quaternion, UnitQuaternion};
    let (kit, mut state) = (kit(), state());
    let q = Quaternion::new(state.q[3], state.q[4], state.q[5], state.q[6]);
    let r = Vector3::new(1.0, 2.0, 3.0);
    let turned = UnitQuaternion::from_quaternion(q) * r;
    assert!((kit.turned(&state) - turned).norm() < 1e-15);

    // A velocity along the unit sphere, q̇ = ½ ω q.
    let omega = Vector3::new(0.4, -1.1, 0.6);
    let rate = Quaternion::from_imag(omega) * q * 0.5;
    [rate.w, rate.i, rate.j, rate.k].into_iter().enumerate().for_each(|(i, x)| state.v[3 + i] = x);
    assert!((kit.turning(&state) - omega).norm() < 1e-15);
    let body = UnitQuaternion::from_quaternion(q).inverse() * omega;
    assert!((kit.turning_body(&state) - body).norm() < 1e-15);
}

/// Pairs of bodies, each once: the inner sum is empty for the first.
#[derive(Lagrangian)]
#[coordinates(x: [4])]
#[lagrangian(sum(i in 0..4, m/2 * x_dot[i]^2 - sum(j in 0..i, k/2 * (x[i] - x[j])^2)))]
struct Pairs {
    m: f64,
    k: f64,
}

#[test]
fn the_inner_of_two_sums_may_be_empty() {
    let pairs = Pairs { m: 1.0, k: 2.0 };
    let forces = pairs.forcing(&State::at_rest([1.0, 2.0, 4.0, 8.0]));
    // k Σ_j (x_j − x_i)
    assert_eq!(forces.as_slice(), [22.0, 14.0, -2.0, -34.0]);
}
