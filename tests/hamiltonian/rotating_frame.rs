//! Rotating frames: the energy, Milton (8.48)–(8.53), and the Hamiltonian, Milton (8.54)–(8.57).

use lagrange_core::nalgebra::Vector3;
use lagrange_core::prelude::*;

use crate::{Potential, Random, agree};

/// An angular velocity that turns and changes its size.
struct Turning;

impl Function<1, 3> for Turning {
    fn eval<S: Scalar>(&self, [t]: [S; 1]) -> [S; 3] {
        let c = S::constant;
        [c(0.3) * t.sin(), c(0.2) * (c(0.7) * t).cos(), c(0.5) + c(0.1) * t.sin()]
    }
}

/// The Lagrangian (8.44) in a frame that does not accelerate.
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[function(U(r) = potential)]
#[function(Omega(t): [3] = omega)]
#[define(v = r_dot)]
#[define(W = Omega(t))]
#[lagrangian(m/2*dot(v, v) + m/2*dot(cross(W, r), cross(W, r)) + m*dot(v, cross(W, r)) - U(r))]
struct Rotating {
    m: f64,
    potential: Potential,
    omega: Turning,
}

/// The equation of motion (8.47) as it is printed, its terms as forces: m v̇ = −∂U/∂r + m r×Ω̇ + 2m v×Ω + m Ω×(r×Ω).
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[function(U(r) = potential)]
#[function(Omega(t): [3] = omega)]
#[define(W = Omega(t))]
#[lagrangian(m/2*dot(r_dot, r_dot) - U(r))]
#[force(r: m*cross(r, der(W)))]
#[force(r: 2*m*cross(r_dot, W))]
#[force(r: m*cross(W, cross(r, W)))]
struct Newton {
    m: f64,
    potential: Potential,
    omega: Turning,
}

fn rotating() -> Rotating {
    Rotating { m: 1.3, potential: Potential, omega: Turning }
}

fn potential(r: Vector3<f64>) -> f64 {
    Function::eval(&Potential, r.into())[0]
}

/// H = p²/2m − Ω·(r×p) + U, (8.54)–(8.55), at any phase point and time.
#[test]
fn hamiltonian_8_55() {
    let (system, mut random) = (rotating(), Random(11));
    for _ in 0..1000 {
        let (t, r, p) = (3.0 * random.number(), random.vector(), random.vector());
        let phase = PhaseState::new(r, p).at_time(t);
        let (r, p, omega) = (Vector3::from(r), Vector3::from(p), Vector3::from(Turning.eval([t])));
        let h = p.dot(&p) / (2.0 * system.m) - omega.dot(&r.cross(&p)) + potential(r);
        agree(&[system.hamiltonian(&phase).unwrap()], &[h], 1e-12);
    }
}

/// ṙ = p/m − Ω×r and ṗ = −Ω×p − ∂U/∂r, (8.56)–(8.57).
#[test]
fn hamiltons_equations_8_57() {
    let (system, mut random) = (rotating(), Random(12));
    for _ in 0..1000 {
        let (t, r, p) = (3.0 * random.number(), random.vector(), random.vector());
        let rate = system.hamilton_equations(&PhaseState::new(r, p).at_time(t)).unwrap();
        let force = -gradient(r);
        let (r, p, omega) = (Vector3::from(r), Vector3::from(p), Vector3::from(Turning.eval([t])));
        agree(rate.q.as_slice(), (p / system.m - omega.cross(&r)).as_slice(), 1e-12);
        agree(rate.p.as_slice(), (force - omega.cross(&p)).as_slice(), 1e-12);
    }
}

/// ∂U/∂r by hand.
fn gradient([x, y, z]: [f64; 3]) -> Vector3<f64> {
    let (slope, twist) = (0.2 * (x + 0.5 * z).cos(), -0.1 * (y * z).sin());
    Vector3::new(1.4 * x + 0.3 * y + slope, 1.8 * y + 0.3 * x + twist * z, 2.4 * z + 0.5 * slope + twist * y)
}

/// Hamilton's equations and (8.47) give the same motion.
#[test]
fn the_motion_is_that_of_8_47() {
    let (system, newton) = (rotating(), Newton { m: 1.3, potential: Potential, omega: Turning });
    let start = State::new([0.7, -0.4, 0.5], [0.3, 0.8, -0.2]);
    let method = Dop853::with_tolerance(1e-12);
    let hamilton = system.motion_in_momenta(system.phase_state(&start)).by(method).to(50.0).unwrap();
    let forces = newton.integrate(start, 50.0, method).unwrap();
    assert!(hamilton.ending().is_complete() && forces.ending().is_complete());
    for (one, other) in hamilton.samples(1001).zip(forces.samples(1001)) {
        agree(one.state().q.as_slice(), other.state().q.as_slice(), 1e-8);
        agree(one.state().v.as_slice(), other.state().v.as_slice(), 1e-8);
    }
}

/// A frame that rotates uniformly.
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[function(U(r) = potential)]
#[define(v = r_dot)]
#[define(W = omega)]
#[lagrangian(m/2*dot(v, v) + m/2*dot(cross(W, r), cross(W, r)) + m*dot(v, cross(W, r)) - U(r))]
struct Uniform {
    m: f64,
    omega: [f64; 3],
    potential: Potential,
}

/// E = m/2 v² − m/2 (Ω×r)² + U, without the term linear in v (8.48); p and L are those of the inertial frame (8.49),
/// where the velocity is v₀ = v + Ω×r; and E = E₀ − L·Ω (8.51).
#[test]
fn energy_8_48_to_8_51() {
    let mut random = Random(13);
    for _ in 0..1000 {
        let system = Uniform { m: 1.5 + random.number(), omega: random.vector(), potential: Potential };
        let (m, omega) = (system.m, Vector3::from(system.omega));
        let state = State::new(random.vector(), random.vector());
        let (r, v) = (state.q, state.v);
        let turning = omega.cross(&r);
        let energy = m / 2.0 * v.dot(&v) - m / 2.0 * turning.dot(&turning) + potential(r);
        agree(&[system.energy(&state)], &[energy], 1e-12);
        let inertial = v + turning;
        let p = system.momentum(&state);
        agree(p.as_slice(), (inertial * m).as_slice(), 1e-12);
        let (l, l_0) = (r.cross(&p), r.cross(&inertial) * m);
        agree(l.as_slice(), l_0.as_slice(), 1e-12);
        let e_0 = m / 2.0 * inertial.dot(&inertial) + potential(r);
        agree(&[system.energy(&state)], &[e_0 - l_0.dot(&omega)], 1e-12);
        agree(&[system.hamiltonian(&system.phase_state(&state)).unwrap()], &[e_0 - l_0.dot(&omega)], 1e-12);
    }
}

/// The potential energy of two particles at this distance from one another.
struct Interaction;

impl Function<3, 1> for Interaction {
    fn eval<S: Scalar>(&self, [x, y, z]: [S; 3]) -> [S; 1] {
        [S::constant(-0.6) / (S::constant(0.1) + x * x + y * y + z * z).sqrt()]
    }
}

/// Three particles that interact, in the rotating frame: (8.52).
#[derive(Lagrangian)]
#[coordinates(a: [3], b: [3], c: [3])]
#[function(V(s: [3]) = interaction)]
#[define(W = omega)]
#[define(motion(m, r, v) = m/2*dot(v, v) + m/2*dot(cross(W, r), cross(W, r)) + m*dot(v, cross(W, r)))]
#[lagrangian(motion(m[0], a, a_dot) + motion(m[1], b, b_dot) + motion(m[2], c, c_dot) - V(a - b) - V(b - c) - V(c - a))]
struct Particles {
    m: [f64; 3],
    omega: [f64; 3],
    interaction: Interaction,
}

/// E = E₀ − Σ L_a·Ω (8.53).
#[test]
fn energy_of_many_particles_8_53() {
    let mut random = Random(14);
    for _ in 0..1000 {
        let m = random.vector().map(|x: f64| 1.5 + x);
        let system = Particles { m, omega: random.vector(), interaction: Interaction };
        let omega = Vector3::from(system.omega);
        let state = State::new(random.vector::<9>(), random.vector::<9>());
        let p = system.momentum(&state);
        let mut inertial_energy = 0.0;
        let mut angular = Vector3::zeros();
        let part = |x: &[f64], k: usize| Vector3::from_column_slice(&x[3 * k..3 * k + 3]);
        for (k, m) in m.into_iter().enumerate() {
            let r = part(state.q.as_slice(), k);
            let v = part(state.v.as_slice(), k) + omega.cross(&r);
            agree(part(p.as_slice(), k).as_slice(), (v * m).as_slice(), 1e-12);
            inertial_energy += m / 2.0 * v.dot(&v);
            angular += r.cross(&v) * m;
            let distance = r - part(state.q.as_slice(), (k + 1) % 3);
            inertial_energy += Function::eval(&Interaction, distance.into())[0];
        }
        let expected = inertial_energy - angular.dot(&omega);
        agree(&[system.energy(&state)], &[expected], 1e-12);
        agree(&[system.hamiltonian(&system.phase_state(&state)).unwrap()], &[expected], 1e-12);
    }
}
