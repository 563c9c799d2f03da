//! Whether the entries of a state are numbers.

use super::lagrangian::Lagrangian;
use super::state::State;
use crate::error::Error;
use crate::names::Entry;
use crate::number::Real;

/// Every entry of a state must be a number.
pub(crate) fn check_finite<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
    _: &L,
    state: &State<L::Scalar, N>,
) -> Result<(), Error> {
    let q = L::COORDINATES.iter().zip(&state.q).map(|(name, x)| (Entry::Coordinate(name), *x));
    let v = L::COORDINATES.iter().zip(&state.v).map(|(name, x)| (Entry::Velocity(name), *x));
    all_finite(core::iter::once((Entry::Time, state.t)).chain(q).chain(v))
}

/// Every one of these entries must be a number.
pub(crate) fn all_finite<T: Real>(mut entries: impl Iterator<Item = (Entry, T)>) -> Result<(), Error> {
    match entries.find(|(_, x)| !x.is_finite()) {
        None => Ok(()),
        Some((entry, x)) => Err(Error::StateNotFinite { entry, value: x.to_f64() }),
    }
}
