//! Systems with a singular M that the constraints complete: the emitted elimination solves them, at every state, and
//! its solutions are those of the equations as they are written.

use approx::assert_relative_eq;
use lagrange_core::nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3, Vector4};
use lagrange_core::{Lanes, prelude::*};
use lagrange_random::{Random, cases};

/// A body about a fixed point, of any inertia.
#[derive(Lagrangian)]
#[coordinates(q: [4])]
#[define(w = quat_rate_body(q, q_dot))]
#[lagrangian(dot(w, inertia*w)/2 - m*g*dot(quat_rotate(q, arm), [0, 0, 1]))]
#[constraint(unit: s*(dot(q, q) - 1)/2 = 0)]
struct Body<T: Scalar> {
    inertia: Matrix3<T>,
    m: T,
    g: T,
    arm: Vector3<T>,
    /// The unit of the constraint.
    s: T,
}

impl<T: Scalar> Body<T> {
    /// The same body over another number type.
    fn map<S: Scalar>(&self, of: impl Fn(T) -> S + Copy) -> Body<S> {
        let Self { inertia, m, g, arm, s } = self;
        Body { inertia: inertia.map(of), m: of(*m), g: of(*g), arm: arm.map(of), s: of(*s) }
    }
}

fn trusted() -> f64 {
    f64::EPSILON.cbrt()
}

/// A unit quaternion, and the rate at which it turns at this angular velocity in the body: q̇ = ½ q ω.
fn turning(q: [f64; 4], w: Vector3<f64>) -> State<f64, 4> {
    let q = Quaternion::new(q[0], q[1], q[2], q[3]).normalize();
    let rate = q * Quaternion::from_imag(w) * 0.5;
    State::new([q.w, q.i, q.j, q.k], [rate.w, rate.i, rate.j, rate.k])
}

fn quaternion(v: &Vector4<f64>) -> Quaternion<f64> {
    Quaternion::new(v[0], v[1], v[2], v[3])
}

/// Random orientations, 1 and the half turns about the axes.
fn orientations() -> Vec<[f64; 4]> {
    let random = &mut Random(7);
    let units = (0..4).map(|i| std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 }));
    let halves = (0..4).map(|i| std::array::from_fn(|j| if j % 3 == i % 3 { 1.0 } else { 0.0 }));
    units.chain(halves).chain((0..cases([10, 50, 1_000])).map(|_| random.vector())).collect()
}

fn any_inertia(random: &mut Random, scale: f64) -> Matrix3<f64> {
    let [w, x, y, z] = random.quaternion();
    let turn = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)).to_rotation_matrix().into_inner();
    let moments = Vector3::from_fn(|_, _| random.between(0.1, 2.1)) * scale;
    turn * Matrix3::from_diagonal(&moments) * turn.transpose()
}

/// Euler's equations in the body's frame, J ω̇ + ω × J ω = τ, and the multiplier by virtual work along q.
#[test]
fn a_rigid_body_obeys_eulers_equations_in_every_orientation() {
    let random = &mut Random(1);
    for q in orientations() {
        for (scale, s) in [(1.0, 1.0), (1e-9, 1.0), (1e9, 1e6), (1.0, 1e-6), (1.0, 1e6), (1e-12, 1e-6)] {
            let inertia = any_inertia(random, scale);
            let arm = Vector3::from(random.vector());
            let body = Body { inertia, m: scale, g: 9.81, arm, s };
            let w = 3.0 * Vector3::from(random.vector());
            let state = turning(q, w);
            let fused = body.accelerations_unchecked(&state);
            assert!(fused.pivot > trusted(), "{q:?}: {}", fused.pivot);
            let solution = body.solve(&state).unwrap();
            assert_eq!(
                (solution.accelerations, solution.multipliers),
                (fused.accelerations, fused.multipliers)
            );

            let [q, rate, second] = [&state.q, &state.v, &solution.accelerations].map(quaternion);
            let change = (q.conjugate() * second * 2.0).imag();
            let weight = UnitQuaternion::new_normalize(q).inverse() * Vector3::new(0.0, 0.0, -scale * 9.81);
            let torque = arm.cross(&weight);
            let expected = inertia.try_inverse().unwrap() * (torque - w.cross(&(inertia * w)));
            assert_relative_eq!(change, expected, max_relative = 1e-11, epsilon = 1e-11 * expected.norm());
            // |q| stays 1.
            assert_relative_eq!(q.dot(&second), -rate.dot(&rate), max_relative = 1e-11);
            // d/dt (q·p) = q·ṗ + q̇·p, where q·p = 0 and q̇·p = 2T, and q·∂L/∂q = 2T − 2U: λ s = 2U − 4T.
            let (energy, potential) = (w.dot(&(inertia * w)) / 2.0, -arm.dot(&weight));
            let expected = 2.0 * potential - 4.0 * energy;
            let size = 2.0 * potential.abs() + 4.0 * energy;
            assert_relative_eq!(solution.multipliers[0] * s, expected, epsilon = 1e-11 * size);
        }
    }
}

/// In single precision and on lanes: the same function.
#[test]
fn every_scalar_solves_it() {
    let random = &mut Random(4);
    for q in orientations() {
        let (inertia, arm) = (any_inertia(random, 1.0), Vector3::from(random.vector()));
        let (body, state) =
            (Body { inertia, m: 1.0, g: 9.81, arm, s: 1.0 }, turning(q, [0.3, -1.0, 2.0].into()));
        let expected = body.solve(&state).unwrap().accelerations;
        let [position, velocity] = [&state.q, &state.v].map(|x| x.map(|x| x as f32));
        let found = body.map(|x| x as f32).accelerations_unchecked(&State::new(position, velocity));
        assert!(found.pivot > f32::EPSILON.cbrt(), "{q:?}: {}", found.pivot);
        let size = 1.0 + expected.amax();
        assert_relative_eq!(found.accelerations.map(f64::from), expected, epsilon = 1e-4 * size);
        let [position, velocity] = [&state.q, &state.v].map(|x| x.map(Lanes::constant));
        let found = body.map(Lanes::constant).accelerations_unchecked(&State::new(position, velocity));
        for lane in 0..Lanes::COUNT {
            let acceleration = found.accelerations.map(|x| x.to_array()[lane]);
            assert_relative_eq!(acceleration, expected, epsilon = 1e-12 * size);
            assert!(found.pivot.to_array()[lane] > trusted());
        }
    }
}

/// A bead on a parabola whose height has no mass of its own, in units of every size.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m*x_dot^2/2 - w*y)]
#[constraint(curve: s*(y - x^2/l) = 0)]
struct Bead {
    m: f64,
    w: f64,
    l: f64,
    s: f64,
}

#[test]
fn a_coordinate_without_a_mass_takes_what_the_constraint_gives_it() {
    for m in [1e-9, 1.0, 1e9] {
        for s in [1e-6, 1.0, 1e6] {
            for w in [1e-3, 1.0, 1e3] {
                let bead = Bead { m, w, l: 2.0, s };
                let state = State::new([0.7, 0.245], [0.4, 0.28]);
                assert!(bead.accelerations_unchecked(&state).pivot > trusted(), "m = {m}, s = {s}");
                let solution = bead.solve(&state).unwrap();
                let slope = -2.0 * w * 0.7 / (2.0 * m);
                // To the rounding of what the curve alone makes of the velocity, ÿ = 0.16, and of m times that.
                assert_relative_eq!(solution.accelerations[0], slope, epsilon = 1e-15 * (0.16 + slope.abs()));
                assert_relative_eq!(solution.accelerations[1], 0.7 * slope + 0.16, max_relative = 1e-14);
                assert_relative_eq!(solution.multipliers[0] * s, w, epsilon = 1e-14 * (0.16 * m + w));
            }
        }
    }
}

/// A door: its hinge is said by more equations than are independent.
#[derive(Lagrangian)]
#[coordinates(q: [4])]
#[define(w = quat_rate_body(q, q_dot))]
#[define(pin = quat_rotate(q, [0, 0, 1]))]
#[lagrangian((moments[0]*w[0]^2 + moments[1]*w[1]^2 + moments[2]*w[2]^2)/2 - k*quat_rotate(q, [1, 0, 0])[0])]
#[constraint(unit: (dot(q, q) - 1)/2 = 0)]
#[constraint(hinge: pin = [0, 0, 1])]
struct Door {
    moments: [f64; 3],
    k: f64,
}

/// Dependent constraints are no matter of M: the pivot tells, and the general solve finds the least multipliers.
#[test]
fn dependent_constraints_still_show_in_the_pivot() {
    let door = Door { moments: [1.0, 2.0, 3.0], k: 0.8 };
    for angle in [0.1_f64, 1.0, 2.5] {
        let (sine, cosine) = (angle / 2.0).sin_cos();
        let state = turning([cosine, 0.0, 0.0, sine], Vector3::new(0.0, 0.0, 1.3));
        let pivot = door.accelerations_unchecked(&state).pivot;
        assert!(pivot.is_nan() || pivot <= trusted(), "{pivot}");
        let solution = door.solve(&state).unwrap();
        assert_eq!(solution.rank, 3);
        let change = (quaternion(&state.q).conjugate() * quaternion(&solution.accelerations) * 2.0).imag();
        let expected = Vector3::new(0.0, 0.0, 0.8 * angle.sin() / 3.0);
        assert_relative_eq!(change, expected, epsilon = 1e-9);
        let force = door.constraint_jacobian(&state).tr_mul(&solution.multipliers);
        let missing = door.mass_matrix(&state) * solution.accelerations - door.forcing(&state);
        assert_relative_eq!(force, missing, epsilon = 1e-9);
        // The rows of the length and of the pin's height are one the double of the other, and carry equal forces.
        assert_relative_eq!(2.0 * solution.multipliers[3], solution.multipliers[0], max_relative = 1e-9);
    }
}

/// Two bodies, one hung to the other by spherical joints.
#[derive(Lagrangian)]
#[coordinates(r: [3], q: [4], s: [3], p: [4])]
#[define(w = quat_rate_body(q, q_dot))]
#[define(v = quat_rate_body(p, p_dot))]
#[define(turn = (moments[0]*(w[0]^2 + v[0]^2) + moments[1]*(w[1]^2 + v[1]^2) + moments[2]*(w[2]^2 + v[2]^2))/2)]
#[lagrangian(m/2*(dot(r_dot, r_dot) + dot(s_dot, s_dot)) + turn - m*g*(r[2] + s[2]))]
#[constraint(first: dot(q, q) = 1)]
#[constraint(second: dot(p, p) = 1)]
#[constraint(hook: r + quat_rotate(q, arm) = 0)]
#[constraint(joint: s + quat_rotate(p, arm) = r - quat_rotate(q, arm))]
struct Hanging {
    m: f64,
    moments: [f64; 3],
    g: f64,
    arm: [f64; 3],
}

/// M x − Fᵀλ = h with the M that was not completed, and F x + γ = 0: of the equations of motion, and of any others by
/// their factor.
#[test]
fn joints_leave_no_residual() {
    let (random, arm) = (&mut Random(5), Vector3::new(0.1, -0.05, 0.4));
    let bodies = Hanging { m: 2.0, moments: [0.1, 0.11, 0.02], g: 9.81, arm: arm.into() };
    for q in orientations() {
        let (first, second) =
            (turning(q, Vector3::new(1.0, 2.0, 0.5)), turning(q.map(|x| x + random.number()), arm));
        let mut guess = State::<f64, 14>::at_rest([0.0; 14]);
        for (start, body) in [(0, &first), (7, &second)] {
            guess.q.fixed_rows_mut::<4>(start + 3).copy_from(&body.q);
            guess.v.fixed_rows_mut::<4>(start + 3).copy_from(&body.v);
        }
        let state = bodies.make_consistent(&guess).unwrap().0;
        let (forcing, bias) = (bodies.forcing(&state), bodies.constraint_bias(&state));
        let blow = (crate::vector(random), crate::vector(random));
        let after = bodies.solve_with(&bodies.factor(&state), &blow.0, &blow.1);
        for (solution, (forcing, bias)) in
            [(bodies.accelerations_unchecked(&state), (forcing, bias)), (after, blow)]
        {
            assert!(solution.pivot > trusted(), "{}", solution.pivot);
            let left = crate::residual(&bodies, &state, (&forcing, &bias), &solution);
            assert!(left < 1e-12, "{left:e}");
        }
    }
}
