//! What contacts and friction do between two instants.

use alloc::vec::Vec;

use super::{Contacts, Friction};

/// A contact between two instants.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LegContact {
    pub(super) is_closed: bool,
    /// It is open, but its gap remains zero because of what is closed.
    pub(super) is_implied: bool,
    /// Its gap is zero and does not change: it is closed, or nothing presses it together.
    pub(super) is_resting: bool,
}

/// A friction between two instants. That of an open contact has no meaning.
#[derive(Clone, Copy, Debug)]
pub(super) struct LegFriction {
    pub(super) friction: Friction,
    /// Its velocities were zero before.
    pub(super) from_rest: bool,
    /// It does not stick, but its velocities remain zero because of what is closed and sticks.
    pub(super) is_implied: bool,
}

impl LegFriction {
    /// Friction that does not act.
    pub(super) const OFF: Self =
        Self { friction: Friction::Slides([0.0; 2]), from_rest: false, is_implied: false };
}

/// All contacts and frictions between two instants. Before a motion starts, nothing is known of friction.
#[derive(Clone, Debug)]
pub(super) struct LegStates {
    pub(super) contacts: Vec<LegContact>,
    pub(super) frictions: Vec<LegFriction>,
}

impl LegStates {
    /// Some contacts closed, and no friction.
    pub(super) fn closed<L: Contacts>(is_closed: impl Fn(usize) -> bool) -> Self {
        let of = |k| LegContact { is_closed: is_closed(k), ..LegContact::default() };
        Self {
            contacts: (0..L::CONTACTS.len()).map(of).collect(),
            frictions: L::FRICTIONS.iter().map(|_| LegFriction::OFF).collect(),
        }
    }

    pub(super) fn is_closed(&self, k: usize) -> bool {
        self.contacts[k].is_closed
    }

    /// Whether something presses the bodies of a friction together, or its limit is its own.
    pub(super) fn is_pressed<L: Contacts>(&self, f: usize) -> bool {
        L::FRICTIONS[f].contact.is_none_or(|k| self.is_closed(k))
    }

    /// Whether a friction acts and keeps the bodies together.
    pub(super) fn is_at_rest<L: Contacts>(&self, f: usize) -> bool {
        self.is_pressed::<L>(f) && self.frictions.get(f).is_some_and(|of| of.friction.is_at_rest())
    }
}
