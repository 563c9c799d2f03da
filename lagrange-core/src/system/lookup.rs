//! From names to indices.

use alloc::{format, string::ToString, vec::Vec};

use crate::Error;
use crate::names::Entry;

/// The index of `name` among `names`.
pub(crate) fn index(names: &[&'static str], kind: &'static str, name: &str) -> Result<usize, Error> {
    names.iter().position(|known| *known == name).ok_or_else(|| unknown(names, kind, name))
}

pub(crate) fn unknown(names: &[&'static str], kind: &'static str, name: &str) -> Error {
    Error::UnknownName { name: name.into(), kind, known: names.iter().map(ToString::to_string).collect() }
}

/// The coordinate (0) or velocity (1) called `name`, and its index.
pub(crate) fn entry(coordinates: &[&'static str], name: &str) -> Result<(usize, usize), Error> {
    let velocity = |coordinate: &&'static str| format!("{}", Entry::Velocity(coordinate));
    if let Some(index) = coordinates.iter().position(|known| *known == name) {
        return Ok((0, index));
    }
    if let Some(index) = coordinates.iter().position(|known| velocity(known) == name) {
        return Ok((1, index));
    }
    let known: Vec<_> =
        coordinates.iter().map(ToString::to_string).chain(coordinates.iter().map(velocity)).collect();
    Err(Error::UnknownName { name: name.into(), kind: "coordinate or velocity", known })
}
