//! Checks that a state is finite and that parameters have their declared properties.

use nalgebra::{ComplexField, SVector};

use super::defect::Defect;
use super::lagrangian::Lagrangian;
use super::state::State;
use crate::error::Error;
use crate::names::Entry;
use crate::number::{Real, exceeds, power_of_epsilon};

/// Every entry of a state must be a number, every parameter what is said of it.
pub(crate) fn check_finite<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
) -> Result<(), Error> {
    check_entries(system, state.t, [&state.q, &state.v], Entry::Velocity)
}

/// Time, coordinates and what belongs to them, velocities or momenta, must be numbers; `other` names the latter. The
/// parameters must be what is said of them.
pub(crate) fn check_entries<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
    system: &L,
    t: L::Scalar,
    [q, others]: [&SVector<L::Scalar, N>; 2],
    other: fn(&'static str) -> Entry,
) -> Result<(), Error> {
    check_parameters(system)?;
    let named = |entry: fn(&'static str) -> Entry| L::COORDINATES.into_iter().map(entry);
    let vectors = named(Entry::Coordinate).zip(q).chain(named(other).zip(others));
    let mut entries = [(Entry::Time, &t)].into_iter().chain(vectors);
    match entries.find(|(_, x)| !x.is_finite()) {
        None => Ok(()),
        Some((entry, x)) => Err(Error::StateNotFinite { entry, value: x.to_f64() }),
    }
}

/// Beyond what many products leave, ε^(2/3) of the size, a matrix is not what it is said to be; nor is it
/// where an entry is not finite, also one that the equations do not use.
fn check_parameters<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
    system: &L,
) -> Result<(), Error> {
    let mut result = Ok(());
    system.visit_defects(&mut |name, Defect { wanted, defect, size }| {
        if result.is_ok() && exceeds(defect, size * power_of_epsilon(2.0 / 3.0)) {
            let defect = (defect / size).to_f64();
            result = Err(Error::ParameterNotAsSaid { name, wanted, defect });
        }
    });
    result
}
