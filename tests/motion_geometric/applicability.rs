//! Methods apply where the type of a system says so.

use lagrange_core::{StateOf, prelude::*, structure::HolonomicConstraints};

use crate::systems::*;

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
