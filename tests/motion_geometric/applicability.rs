//! Methods apply where the type of a system says so.

use lagrange_core::motion::{Gauss, Lobatto};
use lagrange_core::prelude::*;
use lagrange_core::structure::HolonomicConstraints;
use lagrange_core::{Method, StateOf};

use crate::systems::*;

fn applies<L: Lagrangian<Scalar = f64>, P: Method<L>>() {}

#[test]
fn methods_apply_to_systems_of_their_kind() {
    applies::<Kepler<f64>, Verlet>();
    applies::<Spherical<f64>, Verlet>();
    applies::<&Shaken<f64>, Verlet>();
    applies::<DoublePendulum<f64>, Gauss<1>>();
    applies::<&Bead<f64>, Gauss<4>>();
    applies::<Bowl<f64>, Lobatto<2>>();
    applies::<Kepler<f64>, Lobatto<4>>();
    applies::<Wheel<f64>, DAlembert>();
    applies::<Kepler<f64>, DAlembert>();
}

/// A function for every system with holonomic constraints needs no bound beyond that.
fn energy_after<L>(system: &L, start: StateOf<L>) -> Result<f64, Error>
where
    L: HolonomicConstraints + Lagrangian<Scalar = f64>,
{
    let path = system.integrate(start, 1.0, Lobatto::<3>::with_step(0.01))?;
    Ok(system.energy(path.end().state()) - system.energy(&start))
}

#[test]
fn functions_are_generic_over_systems() {
    let ((bowl, on_bowl), (kepler, in_orbit)) = (bowl(), kepler());
    assert!(energy_after(&bowl, on_bowl).unwrap().abs() < 1e-7);
    assert!(energy_after(&kepler, in_orbit).unwrap().abs() < 1e-7);
}
