//! Checks that a state is finite and that parameters have their declared properties.

use nalgebra::ComplexField;

use super::defect::Defect;
use super::lagrangian::{Lagrangian, check_names};
use crate::error::Error;
use crate::names::Entry;
use crate::number::{Real, exceeds, power_of_epsilon};
use crate::system::StateOf;
use crate::vector::Vector;

/// Checks that the state is finite and that every parameter has its declared properties.
pub(crate) fn check_finite<L: Lagrangian<Scalar: Real>>(system: &L, state: &StateOf<L>) -> Result<(), Error> {
    check_entries(system, state.t, [&state.q, &state.v], Entry::Velocity)
}

/// Checks that the time, the coordinates and `others` (velocities or momenta, named by `other`) are finite, and
/// that every parameter has its declared properties.
pub(crate) fn check_entries<L: Lagrangian<Scalar: Real>>(
    system: &L,
    t: L::Scalar,
    [q, others]: [&Vector<L::Scalar, L::N>; 2],
    other: fn(&'static str) -> Entry,
) -> Result<(), Error> {
    const { check_names::<L>() };
    check_parameters(system)?;
    let named = |entry: fn(&'static str) -> Entry| L::COORDINATES.iter().copied().map(entry);
    let vectors = named(Entry::Coordinate).zip(q).chain(named(other).zip(others));
    let mut entries = [(Entry::Time, &t)].into_iter().chain(vectors);
    match entries.find(|(_, x)| !x.is_finite()) {
        None => Ok(()),
        Some((entry, x)) => Err(Error::StateNotFinite { entry, value: x.to_f64() }),
    }
}

/// Checks the declared properties of the parameters. The tolerance is ε^(2/3) of the size of the matrix, above
/// the round-off of many matrix products. A matrix with an entry that is not finite fails, even if the
/// equations do not use the entry.
fn check_parameters<L: Lagrangian<Scalar: Real>>(system: &L) -> Result<(), Error> {
    let mut result = Ok(());
    system.visit_defects(&mut |name, Defect { wanted, defect, size }| {
        if result.is_ok() && exceeds(defect, size * power_of_epsilon(2.0 / 3.0)) {
            let defect = (defect / size).to_f64();
            result = Err(Error::ParameterNotAsSaid { name, wanted, defect });
        }
    });
    result
}
