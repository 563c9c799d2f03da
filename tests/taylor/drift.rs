//! Energy over many turns on constraints: rounding errors add up as a random walk does, nearly to no side that they prefer.

use lagrange_core::{TaylorSeries, prelude::*};

#[derive(Lagrangian, Clone)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2)]
#[constraint(rod: x^2 + y^2 = l^2)]
struct Rotor<T> {
    l: T,
}

const ROTOR: Rotor<f64> = Rotor { l: 1.0 };

#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 - g*z)]
#[constraint(rod: (x^2 + y^2 + z^2 - 1)/2 = 0)]
struct Pendulum {
    g: f64,
}

/// So many; `LAGRANGE_DRIFT` says how many otherwise.
fn turns(few: f64) -> f64 {
    std::env::var("LAGRANGE_DRIFT").ok().and_then(|n| n.parse().ok()).unwrap_or(few)
}

/// Steps of 2½ rad: the most that energy may change by, as a part of itself.
fn by_long_steps(steps: f64) -> f64 {
    4e-15 * steps.sqrt() + 1e-16 * steps
}

/// Steps of ½ rad, as a part of the most kinetic energy.
fn by_short_steps(steps: f64) -> f64 {
    1.5e-15 * steps.sqrt() + 1.2e-17 * steps
}

/// Until `end`; the kinetic energy is at most `kinetic`.
fn check<L, const N: usize, const M: usize>(
    system: &L,
    start: State<f64, N>,
    end: f64,
    kinetic: f64,
    allowed: fn(f64) -> f64,
) where
    L: TaylorSeries<N, M, Scalar = f64>,
{
    let (start, _) = system.make_consistent(&start).expect("near the constraints");
    let mut motion =
        Motion::new(system, start, Taylor::default().max_steps(usize::MAX)).expect("a consistent start");
    motion.advance_to(end).expect("a regular motion");
    let change = (system.energy(motion.state()) - system.energy(&start)) / kinetic;
    let (steps, allowed) = (motion.statistics().accepted, allowed(motion.statistics().accepted as f64));
    println!("{} from {:?}: {change:+.1e} in {steps} steps", L::NAME, start.q.as_slice());
    assert!(change.abs() < allowed, "{change:e} of {allowed:e}");
}

const TURN: f64 = 2.0 * core::f64::consts::PI;

fn turning(angle: f64, rate: f64) -> State<f64, 2> {
    let (sin, cos) = angle.sin_cos();
    State::new([cos, sin], [-rate * sin, rate * cos])
}

#[test]
fn a_rotor_keeps_its_energy() {
    for (angle, rate) in [(0.75 * TURN, 1.0), (5.05, 0.64), (2.78, 0.759)] {
        let end = turns(2000.0) * TURN / rate;
        check(&ROTOR, turning(angle, rate), end, rate * rate / 2.0, by_long_steps);
    }
}

#[test]
fn rotors_on_lanes_keep_their_energy() {
    let start = |k: usize| turning(0.7 * k as f64, 1.0);
    let rotors = Ensemble::from_fn(8, |k| (ROTOR, start(k)));
    let method = Taylor::default().max_steps(usize::MAX);
    let outcome = rotors.integrate_on_lanes(turns(2000.0) * TURN, method).expect("an outcome");
    assert_eq!(outcome.completed().count(), 8);
    for (k, state) in outcome.completed() {
        let change = 2.0 * (ROTOR.energy(state) - ROTOR.energy(&start(k)));
        println!("member {k}: {change:+.1e}");
        assert!(change.abs() < by_long_steps(2.52 * turns(2000.0)), "{k}: {change:e}");
    }
}

/// Along great circles.
#[test]
fn a_particle_on_a_sphere_keeps_its_energy() {
    for (angle, tilt, rate) in [(2.85, 0.3_f64, 1.403), (4.55, 2.0, 0.696)] {
        let State { q, v, .. } = turning(angle, rate);
        let (up, along) = tilt.sin_cos();
        let start = State::new([q[0], q[1] * along, q[1] * up], [v[0], v[1] * along, v[1] * up]);
        let end = turns(2000.0) * TURN / rate;
        check(&Pendulum { g: 0.0 }, start, end, rate * rate / 2.0, by_long_steps);
    }
}

/// By the angle from below, the horizontal speed there, and the most kinetic energy: from nearly in a plane to nearly on a
/// cone, and from above the suspension.
#[test]
fn spherical_pendulums_keep_their_energy() {
    let pendulum = Pendulum { g: 9.81 };
    let starts = [
        (0.3_f64, 0.095, 0.43),
        (0.9, 1.55, 3.6),
        (1.3, 5.28, 17.0),
        (0.643_501_108_793_284, 1.68, 1.9),
        (2.2, 1.33, 16.0),
        (0.25 * TURN, 4.43, 13.0),
    ];
    for (k, (angle, speed, kinetic)) in (0..).zip(starts) {
        let State { q, v, .. } = turning(1.1 * f64::from(k), 1.0);
        let (across, height) = (angle.sin(), -angle.cos());
        let start = State::new([across * q[0], across * q[1], height], [speed * v[0], speed * v[1], 0.0]);
        check(&pendulum, start, turns(200.0) * TURN / pendulum.g.sqrt(), kinetic, by_short_steps);
    }
}
