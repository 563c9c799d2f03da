//! Names of the numbers that an ensemble keeps of its members.

use std::collections::BTreeSet;

use crate::error::{EnsembleError, Entry, Error};
use crate::motion::integration::record::quantity;

/// Names of the numbers of a sample, shared by all members of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ColumnNames {
    /// Names of the entries of a state: `t`, coordinates, velocities.
    pub(super) state: Vec<String>,
    /// Names of the quantities, in the order in which their values are stored.
    pub(super) quantities: Vec<String>,
}

impl ColumnNames {
    pub(super) fn new(coordinates: &'static [&'static str], quantities: Vec<String>) -> Self {
        let velocities = coordinates.iter().map(|name| Entry::Velocity(name).to_string());
        let positions = coordinates.iter().copied().map(String::from);
        Self { state: core::iter::once("t".into()).chain(positions).chain(velocities).collect(), quantities }
    }

    /// Checks that no two entries of a sample have one name: they are columns of a table.
    pub(super) fn check(&self) -> Result<(), Error> {
        let mut known = BTreeSet::new();
        match self.state.iter().chain(&self.quantities).find(|name| !known.insert(*name)) {
            Some(name) => Err(Error::Ensemble(EnsembleError::QuantityName { name: name.clone() })),
            None => Ok(()),
        }
    }

    /// Values of the quantity `name` at each sample, out of the values of all quantities.
    pub(super) fn values<'v, T: Copy>(
        &self,
        name: &str,
        values: &'v [T],
    ) -> Result<impl Iterator<Item = T> + use<'v, T>, Error> {
        quantity(name, &self.quantities, values, "ask for it by `Ensemble::quantity`")
    }
}
