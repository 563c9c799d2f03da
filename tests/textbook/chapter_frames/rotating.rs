//! A frame that turns and accelerates: Milton (8.43)–(8.51).

use lagrange_core::nalgebra::Vector3;
use lagrange_core::prelude::*;

use crate::chapter_frames::functions::{Acceleration, AngularVelocity, Carried, Frame, Inertial, Well};
use crate::chapter_frames::largest;
use lagrange_random::Random;
use lagrange_systems::random_state;

/// The Lagrangian (8.44); Ω and A are given by their components along the turning axes.
#[derive(Lagrangian, Clone)]
#[coordinates(r: [3])]
#[function(U(r) = potential)]
#[function(Omega(t): [3] = rotation)]
#[function(A(t): [3] = push)]
#[define(v = r_dot)]
#[define(W = Omega(t))]
#[lagrangian(
    m/2*dot(v, v) + m/2*dot(cross(W, r), cross(W, r)) + m*dot(v, cross(W, r)) - U(r) - m*dot(r, A(t))
)]
#[observable(euler = m*cross(r, der(W)))]
#[observable(coriolis = 2*m*cross(v, W))]
#[observable(centrifugal = m*cross(W, cross(r, W)))]
pub(crate) struct Rotating {
    m: f64,
    potential: Well,
    rotation: AngularVelocity,
    push: Acceleration,
}

impl Rotating {
    pub(crate) fn new(m: f64, potential: Well, frame: Frame) -> Self {
        Self { m, potential, rotation: AngularVelocity(frame), push: Acceleration(frame) }
    }

    fn random(random: &mut Random) -> Self {
        let [m, k] = random.array(Random::positive);
        Self::new(m, Well { k }, Frame::random(random))
    }

    fn force(&self, state: &State<f64, 3>) -> Vector3<f64> {
        self.m * self.accelerations_unchecked(state).accelerations
    }

    pub(crate) fn angular_velocity(&self, t: f64) -> Vector3<f64> {
        self.rotation.0.angular_velocity(t).into()
    }

    /// Ω̇ from Ω = β̇ e_x + α̇ (sin β e_y + cos β e_z), by hand.
    fn angular_acceleration(&self, t: f64) -> Vector3<f64> {
        let [a, b, c] = self.rotation.0.turn;
        let ((sine, cosine), (sin_beta, cos_beta)) = (t.sin_cos(), (c * t.sin()).sin_cos());
        let ([alpha_dot, beta_dot], alpha_ddot) = ([a + b * cosine, c * cosine], -b * sine);
        let along_y = alpha_ddot * sin_beta + alpha_dot * beta_dot * cos_beta;
        let along_z = alpha_ddot * cos_beta - alpha_dot * beta_dot * sin_beta;
        Vector3::new(-c * sine, along_y, along_z)
    }

    /// The state as seen from the inertial frame: R + Q r and Ṙ + Q (v + Ω×r).
    pub(crate) fn seen_from_outside(&self, state: &State<f64, 3>) -> State<f64, 3> {
        let (frame, t) = (self.rotation.0, state.t);
        let [origin, velocity] = [frame.origin(t), frame.velocity(t)].map(Vector3::from);
        let carried = state.v + self.angular_velocity(t).cross(&state.q);
        State::new(origin + frame.axes(t) * state.q, velocity + frame.axes(t) * carried).at_time(t)
    }
}

fn close(found: Vector3<f64>, exact: Vector3<f64>, tolerance: f64, scale: f64) {
    assert!((found - exact).norm() <= tolerance * scale, "{found} instead of {exact}");
}

/// p = m v + m Ω×r: along the turning axes, the momentum in an inertial frame that moves with the origin.
#[test]
fn canonical_momentum_8_45() {
    let mut random = Random(1);
    for _ in 0..1000 {
        let (system, state) = (Rotating::random(&mut random), random_state(&mut random));
        let p = system.momentum(&state);
        let exact = system.m * (state.v + system.angular_velocity(state.t).cross(&state.q));
        close(p, exact, 1e-12, 1.0 + exact.norm());
        let velocity: Vector3<f64> = system.rotation.0.velocity(state.t).into();
        let outside = system.m * (system.seen_from_outside(&state).v - velocity);
        close(system.rotation.0.axes(state.t) * p, outside, 1e-12, 1.0 + exact.norm());
    }
}

/// Random systems in random states.
fn at_random(seed: u64, check: impl Fn(&Rotating, &State<f64, 3>)) {
    let mut random = Random(seed);
    for _ in 0..1000 {
        let system = Rotating::random(&mut random);
        check(&system, &random_state(&mut random));
    }
}

/// A uniform rotation: about the z axis at the rate a, which is Ω at any time.
fn uniform(system: &Rotating) -> Rotating {
    let [a, ..] = system.rotation.0.turn;
    let rotation = AngularVelocity(Frame { turn: [a, 0.0, 0.0], ..system.rotation.0 });
    Rotating { rotation, ..system.clone() }
}

/// At rest, uniform rotation, without the rest: m Ω×(r×Ω), outwards.
#[test]
fn centrifugal_term_8_47() {
    at_random(2, |system, state| {
        let system = uniform(system);
        let still = Rotating {
            rotation: AngularVelocity(Frame { turn: [0.0; 3], ..system.rotation.0 }),
            ..system.clone()
        };
        let state = State { v: Vector3::zeros(), ..*state };
        let a = system.rotation.0.turn[0];
        let exact = Vector3::new(state.q[0], state.q[1], 0.0) * (system.m * a * a);
        let scale = system.force(&state).norm() + still.force(&state).norm();
        close(system.force(&state) - still.force(&state), exact, 1e-12, scale);
        close(system.centrifugal(&state), exact, 1e-12, scale);
    });
}

/// What the velocity adds to the force: 2 m v×Ω, whatever else there is.
#[test]
fn coriolis_term_8_47() {
    at_random(3, |system, state| {
        let still = State { v: Vector3::zeros(), ..*state };
        let exact = 2.0 * system.m * state.v.cross(&system.angular_velocity(state.t));
        let scale = system.force(state).norm() + system.force(&still).norm();
        close(system.force(state) - system.force(&still), exact, 1e-12, scale);
        close(system.coriolis(state), exact, 1e-12, scale);
    });
}

/// What a changing Ω adds to the force, beside a uniform rotation with the Ω of the moment: m r×Ω̇.
#[test]
fn euler_term_8_47() {
    at_random(4, |system, state| {
        // About z alone, α̇ = a + b cos t at this moment.
        let [a, b, _] = system.rotation.0.turn;
        let about_z = |turn| AngularVelocity(Frame { turn, ..system.rotation.0 });
        let changing = Rotating { rotation: about_z([a, b, 0.0]), ..system.clone() };
        let frozen = Rotating { rotation: about_z([a + b * state.t.cos(), 0.0, 0.0]), ..system.clone() };
        let exact = system.m * state.q.cross(&Vector3::new(0.0, 0.0, -b * state.t.sin()));
        let scale = changing.force(state).norm() + frozen.force(state).norm();
        close(changing.force(state) - frozen.force(state), exact, 1e-12, scale);
        close(changing.euler(state), exact, 1e-12, scale);
    });
}

/// What the frame's acceleration adds to the force: −m A.
#[test]
fn term_of_the_acceleration_8_47() {
    at_random(5, |system, state| {
        let uniform_velocity = Acceleration(Frame { swing: [0.0; 3], ..system.push.0 });
        let without = Rotating { push: uniform_velocity, ..system.clone() };
        let frame = system.push.0;
        let push: Vector3<f64> = frame.acceleration(state.t).into();
        let exact = -system.m * (frame.axes(state.t).transpose() * push);
        let scale = system.force(state).norm() + without.force(state).norm();
        close(system.force(state) - without.force(state), exact, 1e-12, scale);
    });
}

/// m v̇ = −∂U/∂r − m A + m r×Ω̇ + 2 m v×Ω + m Ω×(r×Ω), each term by hand.
#[test]
fn equation_of_motion_8_47() {
    at_random(6, |system, state| {
        let (frame, m, t) = (system.push.0, system.m, state.t);
        let w = system.angular_velocity(t);
        let push: Vector3<f64> = frame.along_axes(t, frame.acceleration(t)).into();
        let terms = [
            -system.potential.gradient(state.q),
            -m * push,
            m * state.q.cross(&system.angular_acceleration(t)),
            2.0 * m * state.v.cross(&w),
            m * w.cross(&state.q.cross(&w)),
        ];
        let scale: f64 = terms.iter().map(|term| term.norm()).sum();
        close(system.force(state), terms.iter().sum(), 1e-12, scale);
        let observed = [system.euler(state), system.coriolis(state), system.centrifugal(state)];
        for (found, exact) in observed.into_iter().zip(&terms[2..]) {
            close(found, *exact, 1e-12, scale);
        }
    });
}

const FRAME: Frame = Frame { swing: [0.4, -0.3, 0.5], rate: [0.9, 0.6, 1.2], turn: [0.7, 0.2, 0.3] };

/// The motion in the frame is the inertial one after the change of coordinates.
#[test]
fn same_motion_as_in_the_inertial_frame() {
    let system = Rotating::new(1.3, Well { k: 4.0 }, FRAME);
    let inertial = Inertial { m: 1.3, potential: Carried(system.potential, FRAME) };
    let start = State::new([0.5, -0.3, 0.2], [0.1, 0.4, -0.2]);
    let method = Dop853::with_tolerance(1e-12);
    let inside = system.integrate(start, 50.0, method).unwrap();
    let outside = inertial.integrate(system.seen_from_outside(&start), 50.0, method).unwrap();
    let apart = largest(inside.samples(1001).zip(outside.samples(1001)).flat_map(|(a, b)| {
        let seen = system.seen_from_outside(a.state());
        [(seen.q - b.state().q).norm(), (seen.v - b.state().v).norm()]
    }));
    assert!(apart < 1e-8, "{apart:e}");
}

/// E = E₀ − L·Ω where the rotation is uniform; with a potential that turns too, E is conserved and E₀ is not.
#[test]
fn energy_in_a_uniformly_rotating_frame_8_51() {
    let frame = Frame { swing: [0.0; 3], rate: [1.0; 3], turn: [0.7, 0.0, 0.0] };
    let system = Rotating::new(1.3, Well { k: 4.0 }, frame);
    let inertial = Inertial { m: 1.3, potential: Carried(system.potential, frame) };
    let start = State::new([0.5, -0.3, 0.2], [0.1, 0.4, -0.2]);
    let path = system.integrate(start, 50.0, Dop853::with_tolerance(1e-12)).unwrap();
    let energy = system.energy(&start);
    let mut outside = Vec::new();
    for sample in path.samples(501) {
        let state = sample.state();
        let seen = system.seen_from_outside(state);
        let angular_momentum = seen.q.cross(&inertial.momentum(&seen));
        let found = inertial.energy(&seen) - angular_momentum[2] * 0.7;
        assert!((system.energy(state) - found).abs() < 1e-12 * (1.0 + found.abs()));
        assert!((system.energy(state) - energy).abs() < 1e-10);
        outside.push(inertial.energy(&seen));
    }
    let spread = largest(outside.iter().map(|e| (e - outside[0]).abs()));
    assert!(spread > 0.01, "{spread}");
}
