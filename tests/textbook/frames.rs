//! Noninertial frames, Milton (8.32)–(8.51): the Lagrangians of the book, and `#[frame(…)]`, against Newton's law in the inertial frame.

use lagrange_core::nalgebra::Vector3;
use lagrange_core::prelude::*;
use lagrange_random::{Random, cases};
use lagrange_systems::random_state;

use crate::functions::{
    Acceleration, Angles, AngularVelocity, Carried, Frame, Inertial, Origin, Velocity, Well,
};

macro_rules! in_the_frame {
    ($name:ident, $($l:tt)*) => {
        #[derive(Lagrangian)]
        #[coordinates(r: [3])]
        #[function(U(r) = potential)]
        #[function(V(t): [3] = frame)]
        #[define(v = r_dot)]
        #[lagrangian($($l)*)]
        struct $name {
            m: f64,
            potential: Well,
            frame: Velocity,
        }
    };
}

in_the_frame!(Substituted, m / 2 * dot(v + V(t), v + V(t)) - U(r));
in_the_frame!(WithoutSquare, m / 2 * dot(v, v) + m * dot(v, V(t)) - U(r));
in_the_frame!(WithAcceleration, m / 2 * dot(v, v) - m * dot(r, der(V(t))) - U(r));

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
struct Rotating {
    m: f64,
    potential: Well,
    rotation: AngularVelocity,
    push: Acceleration,
}

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

struct Setting {
    m: f64,
    well: Well,
    frame: Frame,
    state: State<f64, 3>,
}

impl Setting {
    fn rotating(&self) -> Rotating {
        let &Self { m, well: potential, frame, .. } = self;
        Rotating { m, potential, rotation: AngularVelocity(frame), push: Acceleration(frame) }
    }

    fn declared(&self) -> Declared {
        let &Self { m, well: potential, frame, .. } = self;
        Declared { m, potential, origin: Origin(frame), angles: Angles(frame) }
    }

    fn inertial(&self) -> Inertial {
        Inertial { m: self.m, potential: Carried(self.well, self.frame) }
    }

    fn spin(&self) -> Vector3<f64> {
        self.frame.angular_velocity(self.state.t).into()
    }
}

/// Checks random systems in random states.
fn at_random(seed: u64, check: impl Fn(Setting)) {
    let mut random = Random(seed);
    for _ in 0..cases([200, 1000, 10_000]) {
        let [m, k] = random.array(Random::positive);
        let (frame, state) = (Frame::random(&mut random), random_state(&mut random));
        check(Setting { m, well: Well { k }, frame, state });
    }
}

#[track_caller]
fn close(found: Vector3<f64>, exact: Vector3<f64>, tolerance: f64, scale: f64) {
    assert!((found - exact).norm() <= tolerance * scale, "{found} instead of {exact}");
}

/// A frame with a velocity V(t) that does not turn. L₀ = m/2 v₀² − U with v₀ = v + V(t). Without m/2 V², which is a function of time alone,
/// it is (8.36); less the total derivative of m r·V, m v·V + m r·A, it is (8.40), with A = dV/dt. p = m v₀ for the first two (8.37), p = m v
/// for the third.
#[test]
fn three_lagrangians_of_the_accelerating_frame_8_36_to_8_42() {
    at_random(1, |setting| {
        let Setting { m, well, frame, ref state } = setting;
        let frame = Frame { turn: [0.0; 3], ..frame };
        let [velocity, push] = [frame.velocity(state.t), frame.acceleration(state.t)].map(Vector3::from);
        let substituted = Substituted { m, potential: well, frame: Velocity(frame) };
        let without_square = WithoutSquare { m, potential: well, frame: Velocity(frame) };
        let with_acceleration = WithAcceleration { m, potential: well, frame: Velocity(frame) };
        let (exact, scale) =
            (-well.gradient(state.q) / m - push, well.gradient(state.q).norm() / m + push.norm());
        close(substituted.accelerations_unchecked(state).accelerations, exact, 1e-12, scale);
        close(without_square.accelerations_unchecked(state).accelerations, exact, 1e-12, scale);
        close(with_acceleration.accelerations_unchecked(state).accelerations, exact, 1e-12, scale);

        let inertial = Inertial { m, potential: Carried(well, frame) };
        let seen = frame.seen_from_outside(state);
        let p = m * (state.v + velocity);
        for found in [inertial.momentum(&seen), substituted.momentum(state), without_square.momentum(state)] {
            close(found, p, 1e-12, 1.0);
        }
        close(with_acceleration.momentum(state), m * state.v, 1e-12, 1.0);

        let [first, second, third] = [
            substituted.lagrangian(state),
            without_square.lagrangian(state),
            with_acceleration.lagrangian(state),
        ];
        let scale = 1.0 + first.abs() + second.abs() + third.abs();
        let derivative = m * (state.v.dot(&velocity) + state.q.dot(&push));
        for off in [
            first - inertial.lagrangian(&seen),
            first - second - m / 2.0 * velocity.norm_squared(),
            second - third - derivative,
        ] {
            assert!(off.abs() < 1e-12 * scale, "{off:e} of {scale}");
        }
    });
}

/// p = m v + m Ω×r: along the turning axes, the momentum in an inertial frame that moves with the origin. E = p·v − L (8.48).
#[test]
fn momentum_and_energy_of_the_rotating_frame_8_45_8_48() {
    at_random(2, |setting| {
        let (m, spin, state) = (setting.m, setting.spin(), &setting.state);
        let rotating = setting.rotating();
        let exact = m * (state.v + spin.cross(&state.q));
        close(rotating.momentum(state), exact, 1e-12, 1.0 + exact.norm());
        let [square, carried] = [state.v.norm_squared(), spin.cross(&state.q).norm_squared()];
        let push = Vector3::from(setting.frame.along_axes(state.t, setting.frame.acceleration(state.t)));
        let [potential] = setting.well.eval(state.q.into());
        let energy = m / 2.0 * (square - carried) + potential + m * state.q.dot(&push);
        let scale = 1.0 + m * (square + carried) + potential + m * push.norm() * state.q.norm();
        assert!((rotating.energy(state) - energy).abs() < 1e-12 * scale, "{energy}");
    });
}

/// m v̇ = −∂U/∂r − m A + m r×Ω̇ + 2 m v×Ω + m Ω×(r×Ω), each term by hand. Ω̇ follows from Ω = β̇ e_x + α̇ (sin β e_y + cos β e_z).
#[test]
fn equation_of_motion_8_47() {
    at_random(3, |setting| {
        let Setting { m, well, frame, ref state } = setting;
        let (w, t) = (setting.spin(), state.t);
        let [a, b, c] = frame.turn;
        let ((sine, cosine), (sin_beta, cos_beta)) = (t.sin_cos(), (c * t.sin()).sin_cos());
        let ([alpha_dot, beta_dot], alpha_ddot) = ([a + b * cosine, c * cosine], -b * sine);
        let along_y = alpha_ddot * sin_beta + alpha_dot * beta_dot * cos_beta;
        let along_z = alpha_ddot * cos_beta - alpha_dot * beta_dot * sin_beta;
        let terms = [
            -well.gradient(state.q),
            -m * Vector3::from(frame.along_axes(t, frame.acceleration(t))),
            m * state.q.cross(&Vector3::new(-c * sine, along_y, along_z)),
            2.0 * m * state.v.cross(&w),
            m * w.cross(&state.q.cross(&w)),
        ];
        let scale: f64 = terms.iter().map(|term| term.norm()).sum();
        let rotating = setting.rotating();
        close(m * rotating.solve(state).unwrap().accelerations, terms.iter().sum(), 1e-12, scale);
        let observed = [rotating.euler(state), rotating.coriolis(state), rotating.centrifugal(state)];
        for (found, exact) in observed.into_iter().zip(&terms[2..]) {
            close(found, *exact, 1e-12, scale);
        }
        let declared = setting.declared();
        let found = declared.solve(state).unwrap();
        close(m * found.accelerations, terms.iter().sum(), 1e-13, scale);
        // As seen from outside, no force acts but that of the potential.
        close(m * declared.acceleration(state, &found), terms[0], 1e-13, scale);
    });
}

/// (8.43): the rate of a vector from outside, dr/dt + Ω×r along the turning axes, and what the frame knows of its motion.
#[test]
fn rates_of_vectors_8_43() {
    at_random(4, |setting| {
        let (declared, spin, state) = (setting.declared(), setting.spin(), &setting.state);
        let seen = setting.frame.seen_from_outside(state);
        let rate = state.v + spin.cross(&state.q);
        for (found, exact) in [
            (declared.place(state), seen.q),
            (declared.velocity_outside(state), seen.v),
            (declared.spin(state), spin),
            (declared.rate_outside(state), rate),
        ] {
            close(found, exact, 1e-13, 1.0 + exact.norm());
        }
    });
}

/// L and p of a declared frame are those of the inertial frame, and E = E₀ − p·(Ṙ + Ω×r), which is (8.51) where the origin rests.
#[test]
fn declared_frames_have_the_inertial_lagrangian_8_51() {
    at_random(5, |setting| {
        let (declared, inertial, state) = (setting.declared(), setting.inertial(), &setting.state);
        let seen = setting.frame.seen_from_outside(state);
        let axes = setting.frame.axes(state.t);
        let (p, carried) = (inertial.momentum(&seen), seen.v - axes * state.v);
        close(axes * declared.momentum(state), p, 1e-13, 1.0 + p.norm());
        let energy = inertial.energy(&seen) - p.dot(&carried);
        let scale = 1.0 + setting.m * (seen.v.norm_squared() + carried.norm_squared()) + energy.abs();
        let lagrangian = inertial.lagrangian(&seen);
        assert!((declared.lagrangian(state) - lagrangian).abs() < 1e-13 * scale, "{lagrangian}");
        assert!((declared.energy(state) - energy).abs() < 1e-13 * scale, "{energy}");
    });
}
