//! Periodic orbits by single and multiple shooting.

use std::f64::consts::{PI, TAU};

use lagrange_core::nalgebra::Complex;
use lagrange_core::orbits::{OrbitError, OrbitSearch};
use lagrange_core::{Error, prelude::*};
use lagrange_systems::DrivenSpring;

use crate::messages::orbit_error;
use crate::systems::{CYCLE, Cycle, DRIVEN, PENDULUM};

/// Complete elliptic integral of the first kind by the arithmetic-geometric mean.
fn complete(modulus: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - modulus * modulus).sqrt());
    for _ in 0..6 {
        (a, b) = ((a + b) / 2.0, (a * b).sqrt());
    }
    PI / 2.0 / a
}

#[test]
fn pendulum_of_known_energy_period_or_symmetry() {
    let period = 4.0 * complete(0.5_f64.sin());
    let near = || PENDULUM.periodic_orbit(&State::new([0.9], [0.2])).period_near(6.5);
    let by_energy = near().energy(-(1.0_f64.cos())).find().unwrap();
    assert!((by_energy.period - period).abs() < 1e-11);
    let by_period = PENDULUM.periodic_orbit(&State::at_rest([0.95])).period(period).find().unwrap();
    assert!((by_period.energy() + 1.0_f64.cos()).abs() < 1e-10);
    let mirrored = PENDULUM.periodic_orbit(&State::at_rest([0.9])).period_near(6.5).mirrored(&["theta_dot"]);
    let mirrored = mirrored.energy(-(1.0_f64.cos())).segments(3).find().unwrap();
    assert!((mirrored.period - period).abs() < 1e-11 && (mirrored.start.q[0] - 1.0).abs() < 1e-11);
    assert_eq!(mirrored.nodes.len(), 6);
    // dT/dE fills the one entry of the Jordan block.
    for orbit in [by_energy, by_period, mirrored] {
        assert!(orbit.multipliers().unwrap().iter().all(|x| (x - Complex::new(1.0, 0.0)).norm() < 1e-12));
        assert_eq!(orbit.monodromy.trivial(), 2);
    }
}

/// Over the top: the angle advances by 2π in 2 k K(k) with k² = 2/(E + 1).
#[test]
fn pendulum_that_turns_over() {
    let energy = 1.7;
    let modulus = (2.0_f64 / (energy + 1.0)).sqrt();
    let search = PENDULUM.periodic_orbit(&State::new([0.0], [2.3])).period_near(3.3).advancing("theta", TAU);
    let orbit = search.clone().energy(energy).segments(2).find().unwrap();
    assert!((orbit.period - 2.0 * modulus * complete(modulus)).abs() < 1e-11, "{}", orbit.period);
    let mirrored = search.mirrored(&["theta"]).energy(energy).find().unwrap();
    assert!((mirrored.period - orbit.period).abs() < 1e-11);
}

/// Amplitude and phase of the forced oscillation; multipliers exp(s T).
#[test]
fn forced_oscillation() {
    let (c, omega) = (DRIVEN.c, 1.3);
    let system = DrivenSpring { w: omega, ..DRIVEN };
    let orbit = system.periodic_orbit(&State::at_rest([0.0])).driven_by("w", 1).find().unwrap();
    let response = Complex::new(1.0 - omega * omega, c * omega).inv();
    assert!((orbit.start.q[0] - response.re).abs() < 1e-11);
    assert!((orbit.start.v[0] + omega * response.im).abs() < 1e-11);
    let modulus = (-c * orbit.period / 2.0).exp();
    assert!(orbit.multipliers().unwrap().iter().all(|x| (x.norm() - modulus).abs() < 1e-11));
    assert_eq!(orbit.monodromy.trivial(), 0);
}

fn near_cycle() -> OrbitSearch<Cycle> {
    CYCLE.periodic_orbit(&State::new([0.9, 0.0], [0.0, 0.0]))
}

#[test]
fn what_cannot_be_found_is_said() {
    let start = State::at_rest([0.9]);
    let search = || PENDULUM.periodic_orbit(&start);
    assert_eq!(orbit_error(search().find()), OrbitError::NoPeriod);
    // No swing is that fast.
    let error = orbit_error(search().period(5.0).find());
    assert!(matches!(error, OrbitError::Equilibrium { .. }), "{error}");
    let error = orbit_error(DRIVEN.periodic_orbit(&start).period_near(6.0).find());
    assert!(matches!(error, OrbitError::Clock { .. }), "{error}");
    let error = orbit_error(near_cycle().period_near(6.3).mirrored(&["x_dot", "y"]).find());
    assert!(matches!(error, OrbitError::NotMirrored { .. } | OrbitError::NotClosed { .. }), "{error}");
    for error in [
        search().period_near(6.0).mirrored(&["phi"]).find().unwrap_err(),
        DRIVEN.periodic_orbit(&start).driven_by("frequency", 1).find().unwrap_err(),
    ] {
        assert!(matches!(error, Error::UnknownName { .. }), "{error}");
    }
    for error in [search().period(-1.0).find().unwrap_err(), search().period(f64::NAN).find().unwrap_err()] {
        assert!(matches!(error, Error::Setting { name: "period of an orbit", .. }), "{error}");
    }
}

/// A period that is not the drive's, and a drive that is none.
#[test]
fn periods_that_drive_nothing() {
    let guess = State::new([0.0], [1.0]);
    for search in [DRIVEN.periodic_orbit(&guess).period(3.0), DRIVEN.periodic_orbit(&guess).driven_by("a", 1)]
    {
        let error = orbit_error(search.find());
        assert!(matches!(error, OrbitError::NotItsClock { .. } | OrbitError::NotClosed { .. }), "{error}");
    }
    let error = orbit_error(near_cycle().driven_by("a", 1).find());
    assert_eq!(error, OrbitError::NoClock);
}

#[test]
fn energy_that_changes_cannot_be_fixed() {
    let driven = DRIVEN.periodic_orbit(&State::at_rest([0.0])).driven_by("w", 1).energy(5.0).find();
    let cycle = near_cycle().period_near(6.3).energy(1.0).find();
    for (found, is_driven) in [(driven.map(drop), true), (cycle.map(drop), false)] {
        let error = orbit_error(found);
        assert_eq!(error, OrbitError::EnergyChanges { is_driven });
        assert!(error.to_string().contains("leave out `energy`"), "{error}");
    }
}
