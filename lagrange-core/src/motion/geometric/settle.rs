//! End of an iteration at round-off.
//!
//! The rule of Hairer, McLachlan and Razakarivony (*BIT Numerical Mathematics* 48, 2008): an iteration ends when its
//! residuals no longer shrink. A fixed tolerance would leave an error of the same sign in every step, which makes the
//! energy drift.

use crate::number::Parts;
use crate::vector::{Array, Length};

/// Largest number of sweeps. An iteration that contracts by a factor of ½ reaches round-off in 52.
const SWEEPS: usize = 60;
/// Largest residual that may remain where it no longer shrinks, in units of ε of all terms.
const LARGEST: f64 = 4096.0;

/// A step for which the iteration does not converge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotSettled;

/// Residuals of an iteration so far, one per equation.
pub(super) struct Residuals<T: Parts, K: Length> {
    /// Least residuals of the sweeps so far; `None` before the first.
    least: Option<Array<T, K>>,
    sweeps: usize,
}

impl<T: Parts, K: Length> Residuals<T, K> {
    pub(super) fn new() -> Self {
        Self { least: None, sweeps: 0 }
    }

    /// Takes the magnitudes of the residuals of another sweep, and those of their terms. True if this sweep is the
    /// last: each residual is round-off, or has stopped shrinking while all together are near round-off. Where terms
    /// cancel, as at rest, round-off is that of `displacements`: the terms of a motion over one step by as much as the
    /// coordinates.
    ///
    /// # Errors
    /// If a residual is not a finite number, or after too many sweeps.
    pub(super) fn settle(
        &mut self,
        sizes: &Array<T, K>,
        terms: &Array<T, K>,
        displacements: impl FnOnce() -> Array<T, K>,
    ) -> Result<bool, NotSettled> {
        // The first sweep makes progress by definition.
        let mut least = self.least.unwrap_or_else(|| sizes.map(|size| size + size));
        let (mut sum, mut of_terms, mut have_settled) = (T::constant(0.0), T::constant(0.0), true);
        for k in 0..K::COUNT {
            (sum, of_terms) = (sum + sizes[k], of_terms + terms[k]);
            have_settled &= sizes[k].has_settled(least[k], terms[k]);
            least[k] = least[k].least(sizes[k]);
        }
        (self.least, self.sweeps) = (Some(least), self.sweeps + 1);
        let is_round_off = || {
            sum.is_within(LARGEST * T::EPSILON, of_terms)
                || sum.is_within(
                    LARGEST * T::EPSILON,
                    displacements().into_iter().fold(of_terms, |sum, x| sum + x),
                )
        };
        match have_settled && is_round_off() {
            true => Ok(true),
            false if self.sweeps < SWEEPS && of_terms.is_finite() => Ok(false),
            false => Err(NotSettled),
        }
    }
}
