//! End of an iteration at round-off.
//!
//! The rule of Hairer, McLachlan and Razakarivony (*BIT Numerical Mathematics* 48, 2008): an iteration ends when its
//! residuals no longer shrink. A fixed tolerance would leave an error of the same sign in every step, which makes the
//! energy drift.

use crate::motion::limits::{LONGEST_CYCLE, PATIENCE, REMAINING, TURN};
use crate::number::Parts;
use crate::number::limits::ITERATIONS;
use crate::vector::{Array, Matrix, StaticLength};

/// Largest residual that may remain where it no longer shrinks, as a part of its terms.
const fn largest<T: Parts>() -> f64 {
    let [double, single] = REMAINING;
    T::EPSILON * if T::EPSILON < 1e-10 { double } else { single }
}

/// Error of a step whose iteration does not converge: the step is too long.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotSettled;

/// Residuals of an iteration so far, one per equation.
pub(super) struct Residuals<T: Parts, K: StaticLength> {
    /// Least residuals of the sweeps so far; `None` before the first.
    least: Option<Array<T, K>>,
    sweeps: usize,
    /// Residuals of the last sweeps in which none shrank.
    recent: [Option<Array<T, K>>; LONGEST_CYCLE],
}

impl<T: Parts, K: StaticLength> Residuals<T, K> {
    pub(super) fn new() -> Self {
        Self { least: None, sweeps: 0, recent: [None; LONGEST_CYCLE] }
    }

    /// Takes the magnitudes of the residuals of another sweep, and those of their terms. True if this sweep is the
    /// last: each residual is round-off of its terms, or has stopped shrinking near it. Where terms cancel, as at rest,
    /// round-off is that of `wider`: with the terms of a motion over one step by as much as the coordinates.
    ///
    /// Terms may be hidden: `1 - exp(x)` near x = 0 is small, and its round-off is that of 1. Residuals that come back
    /// in the same bits are final as well, if `is_noise` tells that round-off moves them: a step that is too long may
    /// have a cycle, too. Where terms cancel in an equation by symmetry, as in a momentum of a symmetric body that turns
    /// steadily, `hidden` bounds them by those of the other equations; they count if the iteration does not end without.
    ///
    /// # Errors
    /// If a residual is not a finite number, or after too many sweeps.
    pub(super) fn settle(
        &mut self,
        sizes: &Array<T, K>,
        terms: &Array<T, K>,
        [hidden, wider]: [&dyn Fn() -> Array<T, K>; 2],
        is_noise: impl FnOnce() -> bool,
    ) -> Result<bool, NotSettled> {
        let hidden = (self.sweeps >= PATIENCE).then(hidden);
        let terms = &hidden.map_or(*terms, |hidden| Array::from_fn(|k| terms[k] + hidden[k]));
        // The first sweep makes progress by definition.
        let mut least = self.least.unwrap_or_else(|| sizes.map(|size| size + size));
        let (mut have_settled, mut are_finite) = (true, true);
        for k in 0..K::COUNT {
            have_settled &= sizes[k].has_settled(least[k], terms[k]);
            are_finite &= terms[k].is_finite();
            least[k] = least[k].least(sizes[k]);
        }
        (self.least, self.sweeps) = (Some(least), self.sweeps + 1);
        if have_settled
            && (are_within(largest::<T>(), sizes, terms) || self.is_last(sizes, wider(), is_noise))
        {
            return Ok(true);
        }
        if self.sweeps < ITERATIONS && are_finite { Ok(false) } else { Err(NotSettled) }
    }

    #[cold]
    fn is_last(&mut self, sizes: &Array<T, K>, wider: Array<T, K>, is_noise: impl FnOnce() -> bool) -> bool {
        let come_back = self
            .recent
            .iter()
            .flatten()
            .any(|before| are_within(1.0, sizes, before) && are_within(1.0, before, sizes));
        self.recent[self.sweeps % LONGEST_CYCLE] = Some(*sizes);
        are_within(largest::<T>(), sizes, &wider) || come_back && is_noise()
    }
}

/// True if each entry is at most `part` of its bound, and the slopes together are too: a single slope and its terms may
/// vanish by symmetry.
pub(super) fn are_within<T: Parts, K: StaticLength>(part: f64, x: &Array<T, K>, bound: &Array<T, K>) -> bool {
    let total = |x: &Array<T, K>| x.iter().fold(T::constant(0.0), |sum, x| sum + *x);
    (0..K::COUNT).all(|k| x[k].is_value_within(part, bound[k])) && total(x).is_within(part, total(bound))
}

/// True if the constraints in `jacobian` differ little from those factorized. `moves(a)` returns the displacement that changes
/// factorized constraint a by −1 and no other.
pub(super) fn have_hardly_turned<T: Parts, N: StaticLength, M: StaticLength>(
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
