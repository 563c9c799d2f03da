//! At which velocities motions are steady.

use lagrange_core::error::Row;
use lagrange_core::prelude::*;

use crate::TOP;

/// A pendulum in polar angles.
#[derive(Clone, Lagrangian)]
#[coordinates(theta, phi)]
#[lagrangian(m*l^2/2*(theta_dot^2 + sin(theta)^2*phi_dot^2) + m*g*l*cos(theta))]
struct Conical {
    m: f64,
    l: f64,
    g: f64,
}

/// φ̇² = g/(l cos θ), either way round as the guess goes.
#[test]
fn a_conical_pendulum_goes_round_at_the_rate_of_its_angle() {
    for length in [1e-6, 0.5, 1e6] {
        let pendulum = Conical { m: 0.3, l: length, g: 9.81 };
        for theta in [0.01, 0.3, 1.0, 1.5] {
            let rate = (9.81 / (length * f64::cos(theta))).sqrt();
            for guess in [0.1 * rate, -3.0 * rate, 100.0 * rate] {
                let guess = State::new([theta, 0.7], [0.0, guess]).at_time(2.0);
                let found = pendulum.equilibrium(&guess, &["phi_dot"]).unwrap();
                assert!((found.state.v[1] / rate - guess.v[1].signum()).abs() < 1e-14, "{found:?}");
                assert_eq!((found.state.t, found.state.q, found.state.v[0]), (2.0, guess.q, 0.0));
                assert!(found.undetermined().is_empty());
                // It is what integration gives, too.
                let accelerations = pendulum.solve(&found.state).unwrap().accelerations;
                assert!(accelerations.amax() < 1e-13 * rate.powi(2), "{accelerations:?}");
            }
        }
    }
}

#[test]
fn a_rate_is_not_found_where_there_is_none_or_no_way_to_it() {
    let pendulum = Conical { m: 0.3, l: 0.5, g: 9.81 };
    // Above the pivot no rate holds it.
    let above = State::new([2.0, 0.0], [0.0, 1.0]);
    let error = pendulum.equilibrium(&above, &["phi_dot"]).unwrap_err();
    assert!(matches!(error, Error::NoEquilibrium { row: Row::Coordinate("theta"), .. }), "{error}");
    // From rest there is no telling which way.
    let error = pendulum.equilibrium(&State::at_rest([1.0, 0.0]), &["phi_dot"]).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("at phi_dot = 0.0; start closer, or let other coordinates, velocities"), "{text}");
    // A swing that gets faster is not steady, whatever accelerations are at the moment.
    let swinging = State::new([0.5, 0.0], [0.4, 1.0]);
    let error = pendulum.equilibrium(&swinging, &["phi_dot"]).unwrap_err();
    assert!(matches!(error, Error::NotSteady { .. } | Error::NoEquilibrium { .. }), "{error}");
}

#[test]
fn names_of_velocities_are_checked() {
    let pendulum = Conical { m: 0.3, l: 0.5, g: 9.81 };
    let seek = |names: &[&str]| pendulum.equilibrium(&State::new([0.5, 0.0], [0.0, 4.5]), names);
    assert_eq!(seek(&["phi_dot", "phi_dot"]).unwrap_err(), Error::RepeatedName { name: "phi_dot".into() });
    let text = seek(&["phi_ddot"]).unwrap_err().to_string();
    assert!(
        text.starts_with("there is no coordinate, velocity or parameter `phi_ddot`: it is the acc"),
        "{text}"
    );
    let text = seek(&["phi_dto"]).unwrap_err().to_string();
    assert!(text.ends_with("did you mean `phi_dot`?"), "{text}");
    // The angle and the rate are one more than determined: what is found is near the guess.
    let found = seek(&["theta", "phi_dot"]).unwrap();
    assert_eq!(found.undetermined(), ["theta", "phi_dot"]);
    let (theta, rate) = (found.state.q[0], found.state.v[1]);
    assert!((rate.powi(2) * 0.5 * theta.cos() / 9.81 - 1.0).abs() < 1e-14, "{found:?}");
}

/// (I₃ − I₁) cos θ φ̇² + I₃ ψ̇ φ̇ = m g l has a slow and a fast root (Goldstein, *Classical Mechanics*, 5.7).
#[test]
fn a_top_precesses_slowly_or_fast() {
    let top = &TOP;
    let (theta, spin) = (1.0_f64, 60.0);
    let (a, b, c) = ((0.1 - 0.3) * theta.cos(), 0.1 * spin, -1.2 * 9.81 * 0.25);
    let root = (b * b - 4.0 * a * c).sqrt();
    let (slow, fast) = (-2.0 * c / (b + root), -(b + root) / (2.0 * a));
    for (guess, expected) in [(0.0, slow), (10.0, slow), (40.0, fast), (300.0, fast)] {
        let guess = State::new([0.3, theta, 0.2], [guess, 0.0, spin]);
        let found = top.equilibrium(&guess, &["phi_dot"]).unwrap();
        let rate = found.state.v[0];
        assert!((rate / expected - 1.0).abs() < 1e-13, "{rate} for {expected}");
        assert_eq!((found.state.q, found.state.v[2]), (guess.q, spin));
    }
    // The spin that goes with a precession.
    let guess = State::new([0.3, theta, 0.2], [2.0, 0.0, 1.0]);
    let found = top.equilibrium(&guess, &["psi_dot"]).unwrap();
    let expected = -(c + a * 4.0) / (0.1 * 2.0);
    assert!((found.state.v[2] / expected - 1.0).abs() < 1e-14, "{found:?}");
}

/// Watt's governor: two balls on arms of length l, a sleeve below that they lift; an engine drives it against drag.
#[derive(Clone, Lagrangian)]
#[coordinates(theta, phi)]
#[lagrangian(m*l^2*(theta_dot^2 + sin(theta)^2*phi_dot^2) + 2*sleeve*l^2*sin(theta)^2*theta_dot^2
    + 2*(m + sleeve)*g*l*cos(theta))]
#[force(phi: engine - drag*phi_dot)]
struct Governor {
    m: f64,
    sleeve: f64,
    l: f64,
    g: f64,
    engine: f64,
    drag: f64,
}

/// φ̇² = (1 + sleeve/m) g/(l cos θ), and the engine gives what the drag takes.
#[test]
fn a_governor_stands_at_the_angle_of_its_rate() {
    let governor = Governor { m: 0.5, sleeve: 2.0, l: 0.2, g: 9.81, engine: 0.0, drag: 0.01 };
    let rate = (5.0 * 9.81 / (0.2 * 0.6_f64.cos())).sqrt();
    let found = governor.equilibrium(&State::new([0.6, 0.0], [0.0, 5.0]), &["phi_dot", "engine"]).unwrap();
    assert!((found.state.v[1] / rate - 1.0).abs() < 1e-14, "{found:?}");
    assert!((found.system.engine / (0.01 * rate) - 1.0).abs() < 1e-14, "{}", found.system.engine);
    // And back: the angle and the rate from the engine.
    let driven =
        found.system.equilibrium(&State::new([1.0, 0.0], [0.0, 10.0]), &["theta", "phi_dot"]).unwrap();
    assert!((driven.state.q[0] - 0.6).abs() < 1e-14 && (driven.state.v[1] / rate - 1.0).abs() < 1e-14);
}

/// Two wheels whose rims roll on one another, one driven, one braked.
#[derive(Clone, Lagrangian)]
#[coordinates(w: [2])]
#[lagrangian((w_dot[0]^2 + w_dot[1]^2)/2)]
#[constraint(rim: r*w_dot[0] - s*w_dot[1] = 0)]
#[force(w: [motor, -brake*w_dot[1]^3])]
struct Wheels {
    r: f64,
    s: f64,
    motor: f64,
    brake: f64,
}

/// The rim carries −motor/r = −brake ω³/s; all velocities of a vector are sought at once.
#[test]
fn velocities_are_sought_on_the_constraints() {
    let wheels = Wheels { r: 0.2, s: 0.5, motor: 3.0, brake: 0.7 };
    let found = wheels.equilibrium(&State::new([0.0; 2], [1.0, 2.0]), &["w_dot"]).unwrap();
    let second = (3.0 * 0.5 / (0.2 * 0.7_f64)).cbrt();
    assert!((found.state.v[1] / second - 1.0).abs() < 1e-14, "{found:?}");
    assert!((found.state.v[0] / (second * 2.5) - 1.0).abs() < 1e-14, "{found:?}");
    assert!((found.multipliers[0] / (-3.0 / 0.2) - 1.0).abs() < 1e-14, "{found:?}");
    wheels.check_consistent(&found.state).unwrap();
}
