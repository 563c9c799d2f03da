//! Newton's iteration, damped: from a start to where something vanishes, as far as round-off lets it be told.
//!
//! A search says what should vanish, what may move, and how corrections are found. Of ever smaller corrections the
//! first that leads nearer is taken (Deuflhard, *Newton Methods for Nonlinear Problems*, 3.1).

use core::iter::successors;

use crate::error::Error;
use crate::number::{Real, Scalar};

pub(crate) trait Search {
    type Scalar: Real;
    /// Trial point with its residual.
    type Trial;
    /// What corrections of a trial follow from, and the units in which the trials near it compare.
    type Linear;

    /// Steps before giving up.
    const STEPS: usize;

    fn linearize(&mut self, trial: &Self::Trial) -> Result<Self::Linear, Error>;

    fn left(&self, near: &Self::Linear, trial: &Self::Trial) -> Left<Self::Scalar>;

    /// Trials with ever smaller corrections. Where only round-off may be left, `converged`, that cannot help.
    fn corrected(
        &self,
        linear: &Self::Linear,
        trial: &Self::Trial,
        converged: bool,
    ) -> Result<impl Iterator<Item = Self::Trial>, Error>;

    fn not_found(&self, linear: &Self::Linear, trial: &Self::Trial, steps: usize) -> Error;
}

/// What is left of what should vanish.
pub(crate) struct Left<T> {
    pub(crate) distance: T,
    /// Nothing but round-off.
    pub(crate) is_rounded: bool,
    /// What may be round-off of terms that cancel: steps may still help.
    pub(crate) is_negligible: bool,
}

/// Where it vanishes, and how many steps that took.
pub(crate) fn find<S: Search>(search: &mut S, start: S::Trial) -> Result<(S::Trial, usize), Error> {
    let (mut trial, mut steps) = (start, 0);
    loop {
        let linear = search.linearize(&trial)?;
        let before = search.left(&linear, &trial);
        if before.is_rounded {
            return Ok((trial, steps));
        }
        let nearer = |next| {
            let after = search.left(&linear, &next);
            (after.distance < before.distance).then_some((next, after))
        };
        let converged = before.is_negligible;
        match search.corrected(&linear, &trial, converged).map(|mut trials| trials.find_map(nearer)) {
            Ok(Some((next, after))) if steps < S::STEPS => {
                (trial, steps) = (next, steps + 1);
                let stands = after.distance > S::Scalar::constant(0.5) * before.distance;
                if after.is_rounded || converged && stands {
                    return Ok((trial, steps));
                }
            }
            Err(error) if steps == 0 => return Err(error),
            // Round-off may have no correction, too.
            _ if converged => return Ok((trial, steps)),
            // It may have run to where there is no correction: that is not the fault of the start.
            _ => return Err(search.not_found(&linear, &trial, steps)),
        }
    }
}

/// 1, 1/2, 1/4, …: so many parts of a correction.
pub(crate) fn halvings<T: Real>(count: usize) -> impl Iterator<Item = T> {
    successors(Some(T::constant(1.0)), |part| Some(*part * T::constant(0.5))).take(count)
}
