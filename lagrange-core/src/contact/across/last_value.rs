//! A quantity of a state that several events share.

use core::cell::Cell;

use crate::error::Error;
use crate::system::{Lagrangian, StateOf};

/// The last value of a quantity of the states of one system, with its state. Events are sampled in turn at each state.
pub(super) struct LastValue<L: Lagrangian, V>(Cell<Option<(StateOf<L>, V)>>);

impl<L: Lagrangian, V: Copy> LastValue<L, V> {
    pub(super) fn new() -> Self {
        Self(Cell::new(None))
    }

    /// Value at this state, computed unless it is the last one.
    pub(super) fn at(
        &self,
        state: &StateOf<L>,
        compute: impl FnOnce() -> Result<V, Error>,
    ) -> Result<V, Error> {
        if let Some((last, value)) = self.0.get()
            && last == *state
        {
            return Ok(value);
        }
        let value = compute()?;
        self.0.set(Some((*state, value)));
        Ok(value)
    }
}
