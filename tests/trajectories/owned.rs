//! Trajectories that own their system.

use std::rc::Rc;
use std::sync::Arc;
use std::thread;

use lagrange_core::prelude::*;
use lagrange_core::{Sample, hamiltonian::HamiltonianVectorField};

use crate::Spring;

/// A weight on a spring, pulled by a force: with ω² = 1 it swings about x = u.
type Plant = Spring<f64>;

const PLANT: Plant = Spring { k: 1.0, c: 0.0, u: 0.5, f: 0.0, s: 0.0 };

fn build(u: f64) -> Result<Trajectory<Plant>, Error> {
    let plant = Plant { u, ..PLANT };
    Ok(plant.integrate(State::at_rest([0.0]), 3.0, Dop853::with_tolerance(1e-12))?.into_owned())
}

fn exact(u: f64, t: f64) -> f64 {
    u * (1.0 - t.cos())
}

#[test]
fn a_function_builds_a_system_and_returns_its_path() -> Result<(), Error> {
    let path = build(0.5)?;
    assert_eq!(path.system().u, 0.5);
    for sample in path.samples(10) {
        assert!((sample.coordinate("x")? - exact(0.5, sample.time())).abs() < 1e-10);
        assert!((sample.acceleration("x")? - 0.5 * sample.time().cos()).abs() < 1e-10);
    }
    assert_eq!(path.csv(3).to_string().lines().count(), 4);
    Ok(())
}

/// Of a system in an `Arc` or `Rc` there is one, however many paths and samples have it.
#[test]
fn a_shared_system_is_not_copied() -> Result<(), Error> {
    let plant = Arc::new(PLANT);
    let path = plant.integrate(State::at_rest([0.0]), 3.0, Dop853::default())?.into_owned();
    assert!(Arc::ptr_eq(path.system(), &plant) && Arc::ptr_eq(path.end().system(), &plant));
    let end = thread::spawn(move || path.end().coordinate("x")).join().expect("no panic")?;
    assert!((end - exact(0.5, 3.0)).abs() < 1e-8 && Arc::strong_count(&plant) == 1);

    let plant = Rc::new(PLANT);
    let sample = plant.integrate(State::at_rest([0.0]), 3.0, Dop853::default())?.into_owned().end();
    assert!(Rc::ptr_eq(sample.system(), &plant));
    Ok(())
}

#[test]
fn a_sample_outlives_its_path_and_its_system() -> Result<(), Error> {
    let sample: Sample<Plant> = {
        let plant = PLANT;
        let borrowed: Sample<&Plant> = plant.integrate(State::at_rest([0.0]), 3.0, Dop853::default())?.end();
        borrowed.into_owned()
    };
    assert!((sample.coordinate("x")? - exact(0.5, 3.0)).abs() < 1e-8);
    Ok(())
}

#[test]
fn motions_in_momenta_are_owned_too() -> Result<(), Error> {
    let build = || -> Result<Trajectory<Plant, HamiltonianVectorField>, Error> {
        let plant = PLANT;
        let path = plant.motion_in_momenta(PhaseState::new([0.0], [0.0])).to(3.0)?;
        Ok(path.into_owned())
    };
    assert!((build()?.at(2.0)?.momentum("x")? - 0.5 * 2.0_f64.sin()).abs() < 1e-8);
    Ok(())
}
