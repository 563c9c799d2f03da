//! Gaps that open at rest.

use alloc::vec::Vec;
use core::cell::Cell;

use super::instant::Decided;
use crate::number::Real;

/// Contacts whose gaps have been zero, but for round-off, at the ends of all steps since the start of a leg.
///
/// A gap g whose force has come to zero slowly grows as τ³, slower than the errors of dense output of any order up to 3. Since
/// g = ∫∫ g̈, it cannot be negative as long as g̈ is positive: such an error is no gap that closes.
pub(super) struct Lifting(Vec<Cell<bool>>);

impl Lifting {
    /// Those that are open and at rest at the start of a leg.
    pub(super) fn of<T>(decided: &Decided<T>) -> Self {
        let rests = decided.is_resting.iter().zip(&decided.states.is_closed);
        Self(rests.map(|(is_resting, is_closed)| Cell::new(*is_resting && !is_closed)).collect())
    }

    /// Whether this gap of a contact may be an error of the dense output.
    pub(super) fn hides<T: Real>(&self, k: usize, gap: T) -> bool {
        gap < T::constant(0.0) && self.0[k].get()
    }

    /// Takes note of the end of a step, at which gaps have risen.
    pub(super) fn pass(&self, has_risen: impl Fn(usize) -> bool) {
        for (k, lifts) in self.0.iter().enumerate() {
            lifts.set(lifts.get() && !has_risen(k));
        }
    }
}
