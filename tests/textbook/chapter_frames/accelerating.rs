//! A frame with a prescribed velocity V(t): Milton (8.32)–(8.42).
//!
//! L₀ = m/2 v₀² − U with v₀ = v + V(t). Without m/2 V², which is a function of time alone, it is (8.36); less the
//! total derivative of m r·V it is (8.40), with A = dV/dt.

use lagrange_core::nalgebra::Vector3;
use lagrange_core::prelude::*;

use crate::chapter_frames::functions::{Carried, Frame, Inertial, Velocity, Well};
use crate::chapter_frames::largest;
use lagrange_random::Random;
use lagrange_systems::random_state;

macro_rules! in_the_frame {
    ($name:ident, $($l:tt)*) => {
        #[derive(Lagrangian)]
        #[coordinates(r: [3])]
        #[function(U(r) = potential)]
        #[function(V(t): [3] = frame)]
        #[define(v = r_dot)]
        #[lagrangian($($l)*)]
        pub(crate) struct $name {
            m: f64,
            potential: Well,
            frame: Velocity,
        }

        impl $name {
            pub(crate) fn new(m: f64, potential: Well, frame: Frame) -> Self {
                Self { m, potential, frame: Velocity(frame) }
            }
        }
    };
}

in_the_frame!(Substituted, m / 2 * dot(v + V(t), v + V(t)) - U(r));
in_the_frame!(WithoutSquare, m / 2 * dot(v, v) + m * dot(v, V(t)) - U(r));
in_the_frame!(WithAcceleration, m / 2 * dot(v, v) - m * dot(r, der(V(t))) - U(r));

/// Neither in the axes nor in any potential does this frame turn.
fn sliding(random: &mut Random) -> Frame {
    Frame { turn: [0.0; 3], ..Frame::random(random) }
}

struct Setting {
    m: f64,
    well: Well,
    frame: Frame,
    state: State<f64, 3>,
}

fn settings(seed: u64) -> impl Iterator<Item = Setting> {
    let mut random = Random(seed);
    std::iter::repeat_with(move || {
        let [m, k] = random.array(Random::positive);
        Setting { m, well: Well { k }, frame: sliding(&mut random), state: random_state(&mut random) }
    })
    .take(1000)
}

#[test]
fn equation_of_motion_8_42() {
    for Setting { m, well, frame, state } in settings(1) {
        let push: Vector3<f64> = frame.acceleration(state.t).into();
        let exact = -well.gradient(state.q) / m - push;
        for found in [
            Substituted::new(m, well, frame).accelerations_unchecked(&state).accelerations,
            WithoutSquare::new(m, well, frame).accelerations_unchecked(&state).accelerations,
            WithAcceleration::new(m, well, frame).accelerations_unchecked(&state).accelerations,
        ] {
            let scale = well.gradient(state.q).norm() / m + push.norm();
            assert!((found - exact).norm() < 1e-12 * scale, "{found} {exact}");
        }
    }
}

/// p = m v₀ for the first two (8.37), p = m v for the third.
#[test]
fn canonical_momentum_8_37() {
    for Setting { m, well, frame, state } in settings(2) {
        let v: Vector3<f64> = frame.velocity(state.t).into();
        let inertial = Inertial { m, potential: Carried(well, frame) };
        let origin: Vector3<f64> = frame.origin(state.t).into();
        let p = inertial.momentum(&State::new(state.q + origin, state.v + v).at_time(state.t));
        assert!((p - m * (state.v + v)).norm() < 1e-12);
        assert!((Substituted::new(m, well, frame).momentum(&state) - p).norm() < 1e-12);
        assert!((WithoutSquare::new(m, well, frame).momentum(&state) - p).norm() < 1e-12);
        assert!((WithAcceleration::new(m, well, frame).momentum(&state) - m * state.v).norm() < 1e-12);
    }
}

/// L₀ − (8.36) = m/2 V² and (8.36) − (8.40) = d/dt(m r·V) = m v·V + m r·A; L₀ is that of the inertial frame.
#[test]
fn the_lagrangians_differ_by_total_derivatives() {
    for Setting { m, well, frame, state } in settings(3) {
        let [origin, v, a] =
            [frame.origin(state.t), frame.velocity(state.t), frame.acceleration(state.t)].map(Vector3::from);
        let substituted = Substituted::new(m, well, frame).lagrangian(&state);
        let without_square = WithoutSquare::new(m, well, frame).lagrangian(&state);
        let with_acceleration = WithAcceleration::new(m, well, frame).lagrangian(&state);
        let inertial = Inertial { m, potential: Carried(well, frame) };
        let seen = State::new(state.q + origin, state.v + v).at_time(state.t);
        let scale = 1.0 + substituted.abs() + without_square.abs() + with_acceleration.abs();
        assert!((substituted - inertial.lagrangian(&seen)).abs() < 1e-12 * scale);
        assert!((substituted - without_square - m / 2.0 * v.dot(&v)).abs() < 1e-12 * scale);
        let derivative = m * (state.v.dot(&v) + state.q.dot(&a));
        assert!((without_square - with_acceleration - derivative).abs() < 1e-12 * scale);
    }
}

const FRAME: Frame = Frame { swing: [0.8, -0.5, 0.3], rate: [0.7, 1.1, 0.4], turn: [0.0; 3] };

#[test]
fn one_motion_from_three_lagrangians_and_from_the_inertial_frame() {
    let (m, well) = (1.3, Well { k: 4.0 });
    let start = State::new([0.6, -0.4, 0.2], [0.1, 0.5, -0.3]);
    let method = Dop853::with_tolerance(1e-12);
    let systems = (
        Substituted::new(m, well, FRAME),
        WithoutSquare::new(m, well, FRAME),
        WithAcceleration::new(m, well, FRAME),
        Inertial { m, potential: Carried(well, FRAME) },
    );
    // At t = 0 the frame stands still at the origin.
    let first = systems.0.integrate(start, 50.0, method).unwrap();
    let second = systems.1.integrate(start, 50.0, method).unwrap();
    let third = systems.2.integrate(start, 50.0, method).unwrap();
    let inertial = systems.3.integrate(start, 50.0, method).unwrap();
    let apart = largest((0..=1000).map(|k| f64::from(k) * 0.05).flat_map(|t| {
        let q = *third.at(t).unwrap().state();
        let origin: Vector3<f64> = FRAME.origin(t).into();
        let velocity: Vector3<f64> = FRAME.velocity(t).into();
        let seen = *inertial.at(t).unwrap().state();
        [
            (first.at(t).unwrap().state().q - q.q).norm(),
            (second.at(t).unwrap().state().q - q.q).norm(),
            (seen.q - origin - q.q).norm(),
            (seen.v - velocity - q.v).norm(),
        ]
    }));
    assert!(apart < 1e-8, "{apart:e}");
}
