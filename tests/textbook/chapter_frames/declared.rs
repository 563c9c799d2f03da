//! The frames of (8.32)–(8.53) declared as such: what the macro makes of `#[frame(…)]` against the Lagrangians of the book.

use lagrange_core::nalgebra::Vector3;
use lagrange_core::prelude::*;

use crate::chapter_frames::accelerating::{Substituted, WithAcceleration, WithoutSquare};
use crate::chapter_frames::functions::{Angles, Carried, Frame, Inertial, Origin, Well};
use crate::chapter_frames::rotating::Rotating;
use lagrange_random::Random;
use lagrange_systems::random_state;

/// A frame that moves and turns, as it is: no velocity, acceleration or angular velocity of it is given.
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[function(U(r) = potential)]
#[function(R(t): [3] = origin)]
#[function(turn(t): [2] = angles)]
#[frame(moving: translate(R(t)), rotate_z(turn(t)[0]), rotate_x(turn(t)[1]))]
#[lagrangian(kinetic(moving, m, r) - U(r))]
#[observable(place = position(moving, r))]
#[observable(velocity_outside = express(velocity(moving, r), fixed))]
#[observable(rate_outside = der(vector(moving, r)))]
#[observable(spin = angular_velocity(moving))]
#[observable(acceleration = der(velocity(moving, r)))]
struct Declared {
    m: f64,
    potential: Well,
    origin: Origin,
    angles: Angles,
}

impl Declared {
    fn new(m: f64, potential: Well, frame: Frame) -> Self {
        Self { m, potential, origin: Origin(frame), angles: Angles(frame) }
    }
}

struct Setting {
    m: f64,
    well: Well,
    frame: Frame,
    state: State<f64, 3>,
}

impl Setting {
    fn declared(&self) -> Declared {
        Declared::new(self.m, self.well, self.frame)
    }

    fn rotating(&self) -> Rotating {
        Rotating::new(self.m, self.well, self.frame)
    }
}

/// Whose origins or whose axes, or both, move.
fn settings(seed: u64, of: impl Fn(Frame) -> Frame) -> impl Iterator<Item = Setting> {
    let mut random = Random(seed);
    std::iter::repeat_with(move || {
        let [m, k] = random.array(Random::positive);
        Setting {
            m,
            well: Well { k },
            frame: of(Frame::random(&mut random)),
            state: random_state(&mut random),
        }
    })
    .take(1000)
}

fn sliding(frame: Frame) -> Frame {
    Frame { turn: [0.0; 3], ..frame }
}

/// Its origin rests.
fn turning(frame: Frame) -> Frame {
    Frame { swing: [0.0; 3], ..frame }
}

fn assert_close(found: Vector3<f64>, exact: Vector3<f64>, scale: f64) {
    assert!((found - exact).norm() <= 1e-13 * scale, "{found} instead of {exact}");
}

#[test]
fn equations_of_the_accelerating_frame_8_42() {
    for setting in settings(1, sliding) {
        let Setting { m, well, frame, ref state } = setting;
        let found = setting.declared().solve(state).unwrap().accelerations;
        let scale = well.gradient(state.q).norm() / m + Vector3::from(frame.acceleration(state.t)).norm();
        for of_the_book in [
            Substituted::new(m, well, frame).solve(state).unwrap(),
            WithoutSquare::new(m, well, frame).solve(state).unwrap(),
            WithAcceleration::new(m, well, frame).solve(state).unwrap(),
        ] {
            assert_close(found, of_the_book.accelerations, scale);
        }
    }
}

/// It is the first of the three Lagrangians, before any total derivative is left out.
#[test]
fn lagrangian_and_momentum_of_the_accelerating_frame_8_36_8_37() {
    for setting in settings(2, sliding) {
        let Setting { m, well, frame, ref state } = setting;
        let (declared, substituted) = (setting.declared(), Substituted::new(m, well, frame));
        let scale =
            declared.lagrangian(state).abs() + 2.0 * well.k * (1.0 + state.q.norm_squared() * 3.0).sqrt();
        assert!((declared.lagrangian(state) - substituted.lagrangian(state)).abs() < 1e-13 * scale);
        let p = substituted.momentum(state);
        assert_close(declared.momentum(state), p, p.norm());
        assert!((declared.energy(state) - substituted.energy(state)).abs() < 1e-13 * scale);
    }
}

#[test]
fn equations_of_the_rotating_and_accelerating_frame_8_47() {
    for setting in settings(3, |frame| frame) {
        let (declared, rotating, state) = (setting.declared(), setting.rotating(), &setting.state);
        let by_terms = rotating.solve(state).unwrap().accelerations;
        let terms = [rotating.euler(state), rotating.coriolis(state), rotating.centrifugal(state)];
        let push = Vector3::from(setting.frame.acceleration(state.t)).norm();
        let forces: f64 =
            setting.well.gradient(state.q).norm() + terms.iter().map(|term| term.norm()).sum::<f64>();
        let found = declared.solve(state).unwrap();
        assert_close(found.accelerations, by_terms, push + forces / setting.m);
        // As seen from outside, no force acts but that of the potential.
        let exact = -setting.well.gradient(state.q) / setting.m;
        assert_close(declared.acceleration(state, &found), exact, push + forces / setting.m);
    }
}

/// (8.43): the rate of a vector from outside, dr/dt + Ω×r along the turning axes, and what the frame knows of its motion.
#[test]
fn rates_of_vectors_8_43() {
    for setting in settings(4, |frame| frame) {
        let (declared, rotating, state) = (setting.declared(), setting.rotating(), &setting.state);
        let seen = rotating.seen_from_outside(state);
        assert_close(declared.place(state), seen.q, 1.0 + seen.q.norm());
        assert_close(declared.velocity_outside(state), seen.v, 1.0 + seen.v.norm());
        let spin = rotating.angular_velocity(state.t);
        assert_close(declared.spin(state), spin, 1.0 + spin.norm());
        let rate = state.v + spin.cross(&state.q);
        assert_close(declared.rate_outside(state), rate, 1.0 + rate.norm());
    }
}

/// (8.45) and (8.48): where only the axes turn, L, p and E are those of (8.44).
#[test]
fn momentum_and_energy_of_the_rotating_frame_8_45_8_48() {
    for setting in settings(5, turning) {
        let (declared, rotating, state) = (setting.declared(), setting.rotating(), &setting.state);
        let p = rotating.momentum(state);
        assert_close(declared.momentum(state), p, p.norm() + setting.m * state.v.norm());
        let kinetic = p.norm_squared() / setting.m;
        let scale = 1.0 + kinetic + setting.m * state.v.norm_squared() + rotating.energy(state).abs();
        assert!((declared.lagrangian(state) - rotating.lagrangian(state)).abs() < 1e-13 * scale);
        assert!((declared.energy(state) - rotating.energy(state)).abs() < 1e-13 * scale);
    }
}

/// E = E₀ − p·(Ṙ + Ω×r), which is (8.51) where the origin rests.
#[test]
fn energy_outside_8_51() {
    for setting in settings(6, |frame| frame) {
        let (declared, state) = (setting.declared(), &setting.state);
        let seen = setting.rotating().seen_from_outside(state);
        let inertial = Inertial { m: setting.m, potential: Carried(setting.well, setting.frame) };
        let carried = seen.v - setting.frame.axes(state.t) * state.v;
        let exact = inertial.energy(&seen) - inertial.momentum(&seen).dot(&carried);
        let scale = 1.0 + setting.m * (seen.v.norm_squared() + carried.norm_squared()) + exact.abs();
        assert!((declared.energy(state) - exact).abs() < 1e-13 * scale);
    }
}
