//! At which velocities motions are steady.

use lagrange_core::error::Row;
use lagrange_core::prelude::*;
use lagrange_systems::PolarPendulum;

use crate::TOP;

/// φ̇² = g/(l cos θ), either way round as the guess goes.
#[test]
fn a_conical_pendulum_goes_round_at_the_rate_of_its_angle() {
    for length in [1e-6, 0.5, 1e6] {
        let pendulum = PolarPendulum { m: 0.3, l: length, g: 9.81 };
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
    let pendulum = PolarPendulum { m: 0.3, l: 0.5, g: 9.81_f64 };
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
    let pendulum = PolarPendulum { m: 0.3, l: 0.5, g: 9.81_f64 };
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
