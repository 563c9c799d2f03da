//! Gaps that open at rest.

use alloc::vec::Vec;
use core::cell::Cell;

use super::states::{LegContact, LegStates};
use crate::number::Real;

/// The contacts that opened at the start of a leg, of two bodies at rest, and whose gaps have stayed zero to round-off at the end of
/// each step since.
///
/// A gap g whose force has come to zero slowly grows as τ³, slower than the errors of dense output of any order up to 3. Since
/// g = ∫∫ g̈, it cannot be negative where g̈ is positive and has not been negative before: there such an error is no gap that closes.
pub(super) struct Lifting<T>(Vec<Cell<Rise<T>>>);

/// How long the acceleration of a gap is known not to be negative, from the states at which it was evaluated.
#[derive(Clone, Copy)]
enum Rise<T> {
    /// The gap does not open at rest, or has risen.
    None,
    /// It was negative at no state so far.
    Always,
    /// Up to this time, the earliest at which it was negative.
    Until(T),
}

impl<T: Real> Lifting<T> {
    /// Those that are open and at rest at the start of a leg.
    pub(super) fn of(states: &LegStates) -> Self {
        let rise = |of: &LegContact| match of.is_resting && !of.is_closed {
            true => Rise::Always,
            false => Rise::None,
        };
        Self(states.contacts.iter().map(rise).map(Cell::new).collect())
    }

    /// Whether this contact opens at rest.
    pub(super) fn is_at_rest(&self, k: usize) -> bool {
        !matches!(self.0[k].get(), Rise::None)
    }

    /// Takes note of the acceleration of a gap at a time, and returns whether it is positive, and has not been negative before.
    pub(super) fn rises(&self, k: usize, t: T, (acceleration, noise): (T, T)) -> bool {
        let is_negative = acceleration < -noise;
        let rise = match self.0[k].get() {
            Rise::Always if is_negative => Rise::Until(t),
            Rise::Until(turn) if is_negative && t < turn => Rise::Until(t),
            rise => rise,
        };
        self.0[k].set(rise);
        acceleration > noise
            && match rise {
                Rise::None => false,
                Rise::Always => true,
                Rise::Until(turn) => t < turn,
            }
    }

    /// Ends the leg: a contact whose gap has risen is an ordinary open contact from then on.
    pub(super) fn end(&self, states: &mut LegStates) {
        for (of, rise) in states.contacts.iter_mut().zip(&self.0) {
            of.is_resting &= of.is_closed || !matches!(rise.get(), Rise::None);
        }
    }

    /// Takes note of the end of a step, at which gaps have risen.
    pub(super) fn pass(&self, has_risen: impl Fn(usize) -> bool) {
        for (k, rise) in self.0.iter().enumerate() {
            if self.is_at_rest(k) && has_risen(k) {
                rise.set(Rise::None);
            }
        }
    }
}
