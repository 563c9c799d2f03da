//! Constraints: H on the constraint manifold, a singular mass matrix off it, constraints that depend on time.

use lagrange_core::nalgebra::{Const, Vector4};
use lagrange_core::prelude::*;

use lagrange_random::cases;
use lagrange_systems::SphericalPendulum;

use crate::{Random, agree, gradient};

/// A heavy top about a fixed point; the kinetic energy does not know of the length of the quaternion.
#[derive(Lagrangian)]
#[coordinates(q: [4])]
#[define(w = quat_rate_body(q, q_dot))]
#[lagrangian((i[0]*w[0]^2 + i[1]*w[1]^2 + i[2]*w[2]^2)/2 - mgl*quat_rotate(q, [0, 0, 1])[2])]
#[constraint(unit: dot(q, q) = 1)]
pub(crate) struct Top {
    pub(crate) i: [f64; 3],
    pub(crate) mgl: f64,
}

/// A bead on a ring that turns at a given rate: one of its constraints has an inhomogeneous part.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
#[constraint(ring: x^2 + y^2 + z^2 = a^2)]
#[constraint(plane: y*cos(omega*t) = x*sin(omega*t))]
pub(crate) struct Bead {
    pub(crate) m: f64,
    pub(crate) g: f64,
    pub(crate) a: f64,
    pub(crate) omega: f64,
}

/// At a consistent state and at momenta with a part along the constraints added, to which the motion is blind:
/// q̇ = ∂H/∂p everywhere, and ṗ = −∂H/∂q + Fᵀλ where the momenta are those of a velocity.
fn check<L: Hamiltonian<N = Const<N>, M = Const<M>, Scalar = f64>, const N: usize, const M: usize>(
    system: &L,
    rough: &State<f64, N>,
    random: &mut Random,
) {
    let (state, _) = system.make_consistent(rough).unwrap();
    let phase = system.phase_state(&state);
    agree(&[system.hamiltonian(&phase).unwrap()], &[system.energy(&state)], 1e-12);
    let rate = system.hamilton_equations(&phase).unwrap();
    agree(rate.q.as_slice(), state.v.as_slice(), 1e-12);
    let multipliers = system.solve(&state).unwrap().multipliers;
    agree(rate.multipliers.as_slice(), multipliers.as_slice(), 1e-10);
    let [by_q, by_p] = gradient(system, &phase);
    agree(rate.q.as_slice(), &by_p, 1e-9);
    let force = system.constraint_force(&state, &multipliers);
    let expected: [f64; N] = std::array::from_fn(|i| force[i] - by_q[i]);
    agree(rate.p.as_slice(), &expected, 1e-9);

    let along = system.constraint_force(&state, &random.vector().into());
    let other = PhaseState { p: phase.p + along, ..phase };
    agree(system.legendre(&other).unwrap().v.as_slice(), state.v.as_slice(), 1e-12);
    let [_, by_p] = gradient(system, &other);
    agree(rate.q.as_slice(), &by_p, 1e-9);
}

#[test]
fn pendulum_in_cartesian_coordinates() {
    let mut random = Random(4);
    let system = SphericalPendulum { m: 1.3, l: 0.8, g: 9.81 };
    for _ in 0..cases([30, 100, 10_000]) {
        check(&system, &State::new(random.vector(), random.vector()), &mut random);
    }
}

/// Here a term μ·b tells p·q̇ − L of the given momenta from the energy.
#[test]
fn bead_on_a_turning_ring() {
    let mut random = Random(5);
    let system = Bead { m: 0.4, g: 9.81, a: 0.5, omega: 4.0 };
    for _ in 0..cases([30, 100, 10_000]) {
        let (t, [x, y, z]) = (random.number(), random.vector());
        // Near the plane of the ring, which has turned by ω t.
        let (sine, cosine) = (4.0 * t).sin_cos();
        let q = [x * cosine - 0.1 * y * sine, x * sine + 0.1 * y * cosine, z];
        check(&system, &State::new(q, random.vector()).at_time(t), &mut random);
    }
}

/// With q̇ = ½ q ω the momenta give the body's angular momentum J_k = ½ p·(q e_k) for |q| = 1, so that
/// H = Σ J_k²/2I_k + U, whatever the part of p along q.
#[test]
fn top_with_a_unit_quaternion() {
    let mut random = Random(6);
    let system = Top { i: [0.5, 0.8, 0.3], mgl: 1.7 };
    for _ in 0..cases([30, 100, 10_000]) {
        let q = Vector4::from(random.vector()).normalize();
        let [w, x, y, z]: [f64; 4] = q.into();
        // q times i, j and k.
        let turned = [[-x, w, z, -y], [-y, -z, w, x], [-z, y, -x, w]].map(Vector4::from);
        let p = Vector4::from(random.vector());
        let kinetic: f64 =
            turned.iter().zip(system.i).map(|(e, i)| (0.5 * p.dot(e)).powi(2) / (2.0 * i)).sum();
        let height = w * w - x * x - y * y + z * z;
        let h = system.hamiltonian(&PhaseState::new(q, p)).unwrap();
        agree(&[h], &[kinetic + system.mgl * height], 1e-12);
        check(&system, &State::new(q, random.vector()), &mut random);
    }
}
