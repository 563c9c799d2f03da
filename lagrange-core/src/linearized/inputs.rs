//! From names of coordinates and parameters to indices.

use alloc::{format, vec::Vec};

use crate::Error;
use crate::system::lookup;

/// The indices of the entries of these names; `r` names all elements `r[0]`, `r[1]`, … of a vector.
pub(super) fn indices(
    known: &[&'static str],
    kind: &'static str,
    names: &[&str],
) -> Result<Vec<usize>, Error> {
    let mut found = Vec::new();
    for name in names {
        let element = format!("{name}[");
        let before = found.len();
        found.extend((0..known.len()).filter(|&i| known[i] == *name || known[i].starts_with(&element)));
        if found.len() == before {
            return Err(lookup::unknown(known, kind, name));
        }
        if let Some(again) = found[before..].iter().find(|index| found[..before].contains(index)) {
            return Err(Error::RepeatedName { name: known[*again].into() });
        }
    }
    Ok(found)
}
