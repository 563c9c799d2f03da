//! Damped Newton's iteration for zeros of a residual, to round-off.
//!
//! A [`Search`] defines the residual, the unknowns and the corrections. Among ever smaller parts of a
//! correction, the first that reduces the distance is taken (Deuflhard, *Newton Methods for Nonlinear
//! Problems*, 3.1).

use core::iter::successors;

use crate::number::limits::ITERATIONS;
use crate::number::{Real, Scalar, power_of_epsilon};

pub(crate) trait Search {
    type Scalar: Real;
    type Error;
    /// Trial point with its residual.
    type Trial;
    /// Linearization at a trial: data for the corrections, and the units in which nearby trials are compared.
    type Linear;

    /// Largest number of steps.
    fn limit(&self) -> usize {
        ITERATIONS
    }

    fn linearize(&mut self, trial: &Self::Trial) -> Result<Self::Linear, Self::Error>;

    fn left(&self, near: &Self::Linear, trial: &Self::Trial) -> Left<Self::Scalar>;

    /// Returns trials with ever smaller parts of a correction. If `converged`, only round-off may be left and
    /// smaller parts are useless.
    fn corrected(
        &self,
        linear: &Self::Linear,
        trial: &Self::Trial,
        converged: bool,
    ) -> Result<impl Iterator<Item = Self::Trial>, Self::Error>;

    fn not_found(&self, linear: &Self::Linear, trial: &Self::Trial, steps: usize) -> Self::Error;
}

/// Residual of a trial.
pub(crate) struct Left<T> {
    pub(crate) distance: T,
    /// True if only round-off is left.
    pub(crate) is_rounded: bool,
    /// True if the residual is small enough to be round-off of cancelling terms; further steps may reduce it.
    pub(crate) is_negligible: bool,
}

/// Returns the zero and the number of steps.
pub(crate) fn find<S: Search>(search: &mut S, start: S::Trial) -> Result<(S::Trial, usize), S::Error> {
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
            Ok(Some((next, after))) if steps < search.limit() => {
                (trial, steps) = (next, steps + 1);
                let stands = after.distance > S::Scalar::constant(0.5) * before.distance;
                if after.is_rounded || converged && stands {
                    return Ok((trial, steps));
                }
            }
            Err(error) if steps == 0 => return Err(error),
            // If the residual is round-off already, the trial is a solution even without a further
            // correction.
            _ if converged => return Ok((trial, steps)),
            // If a later trial has no correction, the iteration has failed: this is not an error of the
            // start.
            _ => return Err(search.not_found(&linear, &trial, steps)),
        }
    }
}

/// Returns the parts 1, 1/2, 1/4, … of a correction, down to √ε: smaller ones change less than round-off of the residual. If
/// `converged`, the whole correction alone.
pub(crate) fn halvings<T: Real>(converged: bool) -> impl Iterator<Item = T> {
    let least = if converged { T::constant(1.0) } else { power_of_epsilon(0.5) };
    successors(Some(T::constant(1.0)), |part| Some(*part * T::constant(0.5)))
        .take_while(move |part| *part >= least)
}

/// Returns the dampings of a step of Levenberg and Marquardt to try in turn, and with each the first one of the step after it. Each is
/// ten times the one before (Marquardt 1963). From `largest`/ε on a step is below round-off, where `largest` is the damping that is as
/// large as the derivatives.
pub(crate) fn dampings<T: Real>(first: T, largest: T) -> impl Iterator<Item = [T; 2]> {
    let last = largest / T::constant(T::EPSILON);
    let all = successors(Some(first), |damping| Some(*damping * T::constant(10.0)));
    all.take_while(move |damping| *damping <= last).map(|damping| [damping, damping * T::constant(0.1)])
}
