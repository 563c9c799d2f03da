//! What searches say of mistakes.

use lagrange_core::orbits::OrbitError;
use lagrange_core::{Error, prelude::*};

use lagrange_systems::HenonHeiles;

use crate::systems::{DRIVEN, PENDULUM};

/// Returns the error of a search that fails.
#[track_caller]
pub(crate) fn orbit_error<T>(found: Result<T, Error>) -> OrbitError {
    match found {
        Err(Error::Orbit(error)) => *error,
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("an orbit or a family is found"),
    }
}

/// At rest every motion closes, whatever its period and energy.
#[test]
fn start_at_an_equilibrium() {
    for (x, y) in [(0.0, 0.0), (0.0, 1.0)] {
        let search = || HenonHeiles.periodic_orbit(&State::at_rest([x, y])).period_near(6.3);
        for search in
            [search(), search().energy(0.1), search().mirrored(&["x", "y_dot"]), search().segments(2)]
        {
            assert_eq!(orbit_error(search.find()), OrbitError::StartsAtRest);
        }
    }
    // Small motions about it are orbits.
    let small = PENDULUM.periodic_orbit(&State::at_rest([1e-9])).period_near(6.3).mirrored(&["theta_dot"]);
    assert!((small.find().unwrap().period - std::f64::consts::TAU).abs() < 1e-9);
}

#[test]
fn energy_below_the_potential() {
    let near = PENDULUM.periodic_orbit(&State::at_rest([0.3])).period_near(6.3).energy(-1.5);
    for search in [near.clone(), near.mirrored(&["theta_dot"])] {
        let error = orbit_error(search.find());
        let OrbitError::TooLittleEnergy { energy, least } = error else { panic!("{error}") };
        assert!(energy == -1.5 && (least + 1.0).abs() < 1e-3, "{error}");
    }
    let guess = State::new([0.0, 0.0], [0.0, 0.45]);
    let error = orbit_error(HenonHeiles.periodic_orbit(&guess).period_near(6.6).energy(-0.1).find());
    assert!(matches!(error, OrbitError::TooLittleEnergy { .. }), "{error}");
}

#[test]
fn mirrors_that_are_none() {
    let search = |entries: &[&str]| {
        let guess = State::new([0.1, 0.2], [0.1, 0.45]);
        HenonHeiles.periodic_orbit(&guess).period_near(6.6).mirrored(entries).energy(0.1).find()
    };
    let error = orbit_error(search(&["x"]));
    assert!(matches!(error, OrbitError::NoMirror { are_named: false, .. }), "{error}");
    let error = orbit_error(
        PENDULUM
            .periodic_orbit(&State::at_rest([0.3]))
            .period_near(6.3)
            .mirrored(&["theta", "theta_dot"])
            .find(),
    );
    let text = "a mirror image in time changes the sign of one of `theta` and `theta_dot`: name one of them in `mirrored`, not both";
    assert_eq!(error.to_string(), text);
    let error = orbit_error(search(&["x_dot", "y_dot"]));
    let OrbitError::StartOffMirror { entry, value } = &error else { panic!("{error}") };
    assert_eq!((entry.to_string(), *value), ("x_dot".into(), 0.1));
}

#[test]
fn counts_of_nothing() {
    let none = PENDULUM.periodic_orbit(&State::at_rest([0.3])).period_near(6.3).segments(0).find();
    assert_eq!(
        none.unwrap_err().to_string(),
        "the number of segments of an orbit is 0: it must be positive and finite"
    );
    let none = DRIVEN.periodic_orbit(&State::at_rest([0.3])).driven_by("w", 0).find();
    assert!(none.unwrap_err().to_string().starts_with("the number of turns of the drive is 0"));
}

/// A mass on a spring, and one that falls.
#[derive(Clone, Lagrangian)]
#[coordinates(x, z)]
#[lagrangian((x_dot^2 + z_dot^2)/2 - x^2/2 - 10*z)]
struct Falling;

/// What falls does not come back, and is named with its gap: in a period its velocity changes by 10 · 2π.
#[test]
fn an_orbit_that_does_not_close_names_what_is_farthest_off() {
    let start = State::new([1.0, 0.0], [0.0, 0.0]);
    let error = orbit_error(Falling.periodic_orbit(&start).period(std::f64::consts::TAU).find());
    let OrbitError::NotClosed { entry, gap, .. } = &error else { panic!("{error}") };
    assert!(entry.to_string().starts_with('z') && gap.abs() > 1.0, "{error}");
}
