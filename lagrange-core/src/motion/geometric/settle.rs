//! End of an iteration at round-off.
//!
//! The rule of Hairer, McLachlan and Razakarivony (*BIT Numerical Mathematics* 48, 2008): an iteration ends when its
//! residuals no longer shrink. A fixed tolerance would leave an error of the same sign in every step, which makes the
//! energy drift.

use crate::number::Parts;
use crate::vector::{Array, Length, Matrix};

/// Largest number of sweeps. An iteration that contracts by a factor of ½ reaches round-off in 52.
const SWEEPS: usize = 60;
/// Sweeps after which a residual of ε² of the `wider` terms is small enough. One that the round-off of other coordinates
/// moves would need more sweeps to be round-off of its own terms, as where a rotation has decayed to 10⁻³⁷. In ten million
/// steps such residuals move a coordinate by less than one unit of its round-off.
const PATIENCE: usize = 20;
/// Largest residual that may remain where it no longer shrinks, in units of ε of its terms.
const LARGEST: f64 = 4096.0;
/// Longest cycle of round-off. Most are of two sweeps: a rounded force pushes the coordinates across the boundary between
/// two of its values, and back.
const LONGEST: usize = 4;
/// Largest part by which constraints may have turned since their factorization: an iteration with it then converges.
const TURN: f64 = 0.25;

/// Error of a step whose iteration does not converge: the step is too long.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotSettled;

/// Residuals of an iteration so far, one per equation.
pub(super) struct Residuals<T: Parts, K: Length> {
    /// Least residuals of the sweeps so far; `None` before the first.
    least: Option<Array<T, K>>,
    sweeps: usize,
    /// Residuals of the last sweeps in which none shrank.
    recent: [Option<Array<T, K>>; LONGEST],
}

impl<T: Parts, K: Length> Residuals<T, K> {
    pub(super) fn new() -> Self {
        Self { least: None, sweeps: 0, recent: [None; LONGEST] }
    }

    /// Takes the magnitudes of the residuals of another sweep, and those of their terms. True if this sweep is the
    /// last: each residual is round-off of its terms, or has stopped shrinking near it. Where terms cancel, as at rest,
    /// round-off is that of `wider`: with the terms of a motion over one step by as much as the coordinates.
    ///
    /// Terms may be hidden: `1 - exp(x)` near x = 0 is small, and its round-off is that of 1. Residuals that come back
    /// in the same bits are final as well, if `is_noise` tells that round-off moves them: a step that is too long may
    /// have a cycle, too.
    ///
    /// # Errors
    /// If a residual is not a finite number, or after too many sweeps.
    pub(super) fn settle(
        &mut self,
        sizes: &Array<T, K>,
        terms: &Array<T, K>,
        wider: impl Fn() -> Array<T, K>,
        is_noise: impl FnOnce(&Array<T, K>) -> bool,
    ) -> Result<bool, NotSettled> {
        let late = (self.sweeps >= PATIENCE).then(&wider);
        let is_negligible = |k: usize| {
            late.as_ref().is_some_and(|wider| sizes[k].is_within(T::EPSILON * T::EPSILON, wider[k]))
        };
        // The first sweep makes progress by definition.
        let mut least = self.least.unwrap_or_else(|| sizes.map(|size| size + size));
        let (mut have_settled, mut are_finite) = (true, true);
        for k in 0..K::COUNT {
            have_settled &= sizes[k].has_settled(least[k], terms[k]) || is_negligible(k);
            are_finite &= terms[k].is_finite();
            least[k] = least[k].least(sizes[k]);
        }
        (self.least, self.sweeps) = (Some(least), self.sweeps + 1);
        if have_settled
            && (are_within(LARGEST * T::EPSILON, sizes, terms) || self.is_last(sizes, wider, is_noise))
        {
            return Ok(true);
        }
        if self.sweeps < SWEEPS && are_finite { Ok(false) } else { Err(NotSettled) }
    }

    #[cold]
    fn is_last(
        &mut self,
        sizes: &Array<T, K>,
        wider: impl FnOnce() -> Array<T, K>,
        is_noise: impl FnOnce(&Array<T, K>) -> bool,
    ) -> bool {
        let wider = wider();
        let come_back = self
            .recent
            .iter()
            .flatten()
            .any(|before| are_within(1.0, sizes, before) && are_within(1.0, before, sizes));
        self.recent[self.sweeps % LONGEST] = Some(*sizes);
        are_within(LARGEST * T::EPSILON, sizes, &wider) || come_back && is_noise(&wider)
    }
}

/// True if each entry is at most `part` of its bound, and the slopes together are too: a single slope and its terms may
/// vanish by symmetry.
pub(super) fn are_within<T: Parts, K: Length>(part: f64, x: &Array<T, K>, bound: &Array<T, K>) -> bool {
    let total = |x: &Array<T, K>| x.iter().fold(T::constant(0.0), |sum, x| sum + *x);
    (0..K::COUNT).all(|k| x[k].is_value_within(part, bound[k])) && total(x).is_within(part, total(bound))
}

/// True if the constraints in `jacobian` differ little from those factorized. `moves(a)` returns the displacement that changes
/// factorized constraint a by −1 and no other.
pub(super) fn have_hardly_turned<T: Parts, N: Length, M: Length>(
    jacobian: &Matrix<T, M, N>,
    moves: impl Fn(usize) -> Array<T, N>,
) -> bool {
    let moves: Array<Array<T, N>, M> = Array::from_fn(moves);
    let turned = |a: usize, b: usize| {
        let own = T::constant(if a == b { 1.0 } else { 0.0 });
        (0..N::COUNT).fold(own, |sum, i| sum + jacobian[(a, i)] * moves[b][i])
    };
    // Units of the constraints cancel.
    (0..M::COUNT).all(|a| {
        turned(a, a).magnitude().is_at_most(TURN)
            && (0..a).all(|b| (turned(a, b) * turned(b, a)).magnitude().is_at_most(TURN * TURN))
    })
}
