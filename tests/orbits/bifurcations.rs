//! Bifurcations of periodic orbits in closed form.

use lagrange_core::orbits::{BifurcationKind, OrbitError, OrbitSearch};
use lagrange_core::{Error, prelude::*};

use crate::messages::orbit_error;
use crate::systems::{CYCLE, Cycle};

pub(crate) fn around(system: &Cycle) -> OrbitSearch<Cycle> {
    let rho = system.b / 2.0 + (system.b * system.b / 4.0 - system.a).sqrt();
    system.periodic_orbit(&State::new([rho.sqrt(), 0.0], [0.0, 0.0])).period_near(6.3)
}

/// The oscillator's damping changes sign at c = 0.
#[test]
fn torus_in_closed_form() {
    let search = around(&CYCLE);
    let first = search.find().unwrap();
    let family = search.family(&first).in_parameter("c").backwards().step(0.3).longest_step(0.3);
    let family = family.until_first(BifurcationKind::Torus).follow().unwrap();
    let [torus] = family.bifurcations() else { panic!("{family}") };
    assert!(torus.kind == BifurcationKind::Torus && torus.value.abs() < 1e-12, "{torus:?}");
    let error = orbit_error(search.branch(torus).follow());
    assert!(matches!(error, OrbitError::NoBranch { .. }), "{error}");
}

/// The oscillator's rest y = 0 is left by y = ±√(−p) at p = 0.
#[test]
fn branches_in_closed_form() {
    let search = around(&Cycle { p: 0.3, ..CYCLE });
    let first = search.find().unwrap();
    let family = search.family(&first).in_parameter("p").backwards().step(0.3).longest_step(0.4);
    let family = family.until_first(BifurcationKind::BranchPoint).follow().unwrap();
    let [point] = family.bifurcations() else { panic!("{family}") };
    assert!(point.kind == BifurcationKind::BranchPoint && point.value.abs() < 1e-10, "{point:?}");
    let sides = [search.branch(point), search.branch(point).backwards()].map(|side| {
        let branch = side.orbits(3).step(0.05).follow().unwrap();
        let side = branch.orbits()[0].start.q[1].signum();
        for orbit in branch.orbits() {
            let (p, y) = (orbit.system.p, orbit.start.q[1]);
            assert!((y - side * (-p).sqrt()).abs() < 1e-9 && p < 0.0, "{p} {y}");
        }
        side
    });
    assert_eq!(sides[0], -sides[1]);
}

#[test]
fn what_cannot_be_followed_is_said() {
    let search = around(&CYCLE);
    let first = search.find().unwrap();
    // Without a parameter the orbit is isolated.
    assert_eq!(orbit_error(search.family(&first).follow()), OrbitError::NoFamily { freedom: 0 });
    let error = search.family(&first).in_parameter("omega_0").follow().unwrap_err();
    assert!(matches!(error, Error::UnknownName { .. }), "{error}");
    let error = search.family(&first).in_parameter("c").step(0.0).follow().unwrap_err();
    assert!(matches!(error, Error::Setting { .. }), "{error}");
}
