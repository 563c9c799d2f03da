//! Motions, equilibria and frequencies in units in which numbers are huge or tiny.

use lagrange_core::{linearized::Stability, prelude::*};
use lagrange_systems::{Pendulum, SphericalPendulum};

use crate::scales::{Bead, DOUBLE};

#[test]
fn it_moves_as_far_in_any_unit() {
    for s in DOUBLE {
        let bead = Bead { m: 1.0, g: 10.0, s };
        let path = bead.integrate(State::at_rest([0.0; 2]), 1.0, Dop853::default()).expect("a path");
        let [x, y]: [f64; 2] = path.end().state().q.into();
        assert!(path.ending().is_complete() && path.multipliers_are_unique());
        assert!((x - 2.4).abs() < 1e-12 && (y + 1.8).abs() < 1e-12, "({x}, {y}) for {s}");
        let phase = bead.phase_state(&State::at_rest([0.0; 2]));
        let path = bead.motion_in_momenta(phase).to(1.0).expect("a path");
        let [x, y]: [f64; 2] = path.end().state().q.into();
        assert!((x - 2.4).abs() < 1e-12 && (y + 1.8).abs() < 1e-12, "({x}, {y}) for {s} in (q, p)");
    }
}

#[test]
fn on_lanes_too() {
    let beads = Ensemble::from_fn(DOUBLE.len(), |k| {
        (Bead { m: 1.0, g: 10.0, s: DOUBLE[k] }, State::at_rest([0.0; 2]))
    });
    let outcome = beads.integrate_on_lanes(1.0, Dop853::default()).expect("an outcome");
    assert_eq!(outcome.completed().count(), DOUBLE.len());
    for (k, state) in outcome.completed() {
        let [x, y]: [f64; 2] = state.q.into();
        assert!((x - 2.4).abs() < 1e-12 && (y + 1.8).abs() < 1e-12, "({x}, {y}) for {}", DOUBLE[k]);
    }
}

#[test]
fn a_pendulum_swings_alike_in_any_unit_or_is_refused() {
    let along = |state: &State<f64, 3>, unit: f64| state.q[0] / unit;
    let reference = SphericalPendulum { m: 1.0, g: 10.0, l: 1.0 };
    let path = reference.integrate(State::at_rest([0.6, 0.0, -0.8]), 1.0, Dop853::default()).expect("a path");
    let expected = along(path.end().state(), 1.0);
    let (mut refused, mut swung) = (0, 0);
    for unit in [1e-150, 1e-100, 1e-8, 1e8, 1e100, 1e150, 1e165, 1e200] {
        for m in [1e-200, 1.0, 1e200] {
            // What the Lagrangian itself loses nobody can see.
            if m * unit * unit < f64::MIN_POSITIVE {
                continue;
            }
            let rod = SphericalPendulum { m, g: 10.0 * unit, l: unit };
            let start = State::at_rest([0.6 * unit, 0.0, -0.8 * unit]);
            let Ok(path) = rod.integrate(start, 1.0, Dop853::default().absolute_tolerance(1e-9 * unit))
            else {
                refused += 1;
                continue;
            };
            assert!(path.ending().is_complete(), "{}", path.ending());
            let arrived = along(path.end().state(), unit);
            assert!((arrived - expected).abs() < 1e-7, "{arrived}, not {expected}, for {unit}, m = {m}");
            swung += 1;
        }
    }
    // l² is no number for the two largest, nor m g for the next and the largest mass.
    assert_eq!((refused, swung), (7, 15));
}

/// A weight on a spring of which the length without it is far away.
#[derive(Lagrangian, Clone)]
#[coordinates(x)]
#[lagrangian(m/2*x_dot^2 - k/2*(x - far)^2 + m*g*x)]
struct Spring {
    m: f64,
    g: f64,
    k: f64,
    far: f64,
}

/// At 10¹⁶ an angle is known to ±1: whatever stands there is no equilibrium. A length may be as large.
#[test]
fn an_equilibrium_is_where_the_forces_vanish() {
    let swing = Pendulum { m: 1.0, g: 9.81, l: 1.0 };
    for guess in [0.1, 3.0, 1e3, 1e6, 1e9, 1e12, 1e14, 1e16, 1e200] {
        match swing.equilibrium(&State::at_rest([guess]), &[]) {
            Ok(found) => {
                assert!(guess < 1e10, "{found:?}");
                let acceleration = swing.solve(&found.state).expect("a solution").accelerations[0];
                assert!(acceleration.abs() < 1e-15 * guess.max(1.0), "{acceleration} at {found:?}");
            }
            Err(error) => {
                assert!(guess > 1e7 && matches!(error, Error::NoEquilibrium { .. }), "{error}");
            }
        }
    }
    for far in [0.0, 1.0, 1e9, 1e16, 1e100] {
        for guess in [0.0, far, 1.1 * far] {
            let spring = Spring { m: 1.0, g: 9.81, k: 0.3, far };
            let found = spring.equilibrium(&State::at_rest([guess]), &[]).expect("an equilibrium");
            let expected = far + 9.81 / 0.3;
            assert!((found.state.q[0] / expected - 1.0).abs() < 1e-14, "{found:?}, not {expected}");
        }
    }
}

/// Two oscillators, coupled, the second in a unit of length of its own.
#[derive(Lagrangian, Clone)]
#[coordinates(x, y)]
#[lagrangian(x_dot^2/2 + u^2*y_dot^2/2 - w^2*(3*x^2 + 3*(u*y)^2 - 2*x*u*y)/2)]
#[dissipation(c*(x_dot^2 + u^2*y_dot^2)/2)]
struct Pair {
    w: f64,
    u: f64,
    c: f64,
}

/// The frequencies are w √2 and 2 w: slow, fast, and in any unit of length.
#[test]
fn frequencies_and_stability_do_not_depend_on_units() {
    let mut tried = 0;
    for w in [1e-140, 1e-120, 1e-80, 1e-3, 1.0, 1e5, 1e80, 1e120, 1e140] {
        for u in [1e-140, 1e-20, 1e-5, 1.0, 1e5, 1e20, 1e140] {
            // What an entry of the matrices themselves loses nobody can see.
            let entries = [u * u, w * w, w * w * u * u, w * w * u, w * w / u];
            if !entries.iter().all(|entry| (1e-290..1e290).contains(entry)) {
                continue;
            }
            tried += 1;
            let near = |c| Pair { w, u, c }.linearize(&State::at_rest([0.0; 2]), &[]).expect("linear");
            let still = near(0.0);
            let found = still.natural_frequencies().expect("frequencies");
            assert!(found.len() == 2, "{found:?} for {w:e} {u:e}");
            for (frequency, expected) in found.iter().zip([2.0_f64.sqrt(), 2.0]) {
                assert!((frequency / w / expected - 1.0).abs() < 1e-12, "{found:?} for {w:e} {u:e}");
            }
            assert_eq!(still.stability().expect("decided"), Stability::Undecided, "{w:e} {u:e}");
            let damped = near(0.1 * w).stability().expect("decided");
            assert_eq!(damped, Stability::AsymptoticallyStable, "{w:e} {u:e}");
        }
    }
    assert!(tried >= 25, "{tried}");
    // Growth so fast that its square is no number.
    for c in [-1e150, -1e160, -1e200, -1e300] {
        let near = Pair { w: 1.0, u: 1.0, c }.linearize(&State::at_rest([0.0; 2]), &[]).expect("linear");
        assert_eq!(near.stability().expect("decided"), Stability::Unstable, "{c:e}");
        let [first, second, ..] = near.eigenvalues().expect("eigenvalues")[..] else { panic!("four") };
        assert!(
            (first.re / -c - 1.0).abs() < 1e-14 && (second.re / -c - 1.0).abs() < 1e-14,
            "{first} {second}"
        );
    }
}
