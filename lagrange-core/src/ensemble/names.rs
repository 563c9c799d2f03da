//! Names of the numbers that an ensemble keeps of its members.

use std::collections::BTreeSet;

use crate::error::{EnsembleError, Error};
use crate::names::Entry;

/// Names of coordinates and quantities, shared by all members of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ColumnNames {
    pub(super) coordinates: &'static [&'static str],
    /// Names of the quantities, in the order in which their values are stored.
    pub(super) quantities: Vec<String>,
}

impl ColumnNames {
    /// Names of the entries of a state: `t`, coordinates, velocities.
    pub(super) fn of_state(&self) -> impl Iterator<Item = String> {
        let velocities = self.coordinates.iter().map(|name| Entry::Velocity(name).to_string());
        core::iter::once("t".into())
            .chain(self.coordinates.iter().copied().map(String::from))
            .chain(velocities)
    }

    /// Names of the entries of a sample: those of its state, then the quantities.
    pub(super) fn of_sample(&self) -> impl Iterator<Item = String> {
        self.of_state().chain(self.quantities.iter().cloned())
    }

    /// Checks that no two entries of a sample have one name: they are columns of a table.
    pub(super) fn check(&self) -> Result<(), Error> {
        let mut known = BTreeSet::new();
        match self.of_sample().find(|name| !known.insert(name.clone())) {
            Some(name) => Err(Error::Ensemble(EnsembleError::QuantityName { name })),
            None => Ok(()),
        }
    }

    /// Values of the quantity `name` at each sample, out of the values of all quantities.
    pub(super) fn values<'v, T: Copy>(
        &self,
        name: &str,
        values: &'v [T],
    ) -> Result<impl Iterator<Item = T> + 'v, Error> {
        let place = self.quantities.iter().position(|known| known == name).ok_or_else(|| {
            let hint = self.quantities.is_empty().then(|| "ask for it by `Ensemble::quantity`".into());
            Error::UnknownName { name: name.into(), kind: "quantity", hint, known: self.quantities.clone() }
        })?;
        Ok(values.iter().skip(place).step_by(self.quantities.len()).copied())
    }
}
