//! Newton's iteration for the stages of a step (Hairer and Wanner, *Solving Ordinary Differential Equations II*, IV.8).

use super::equations::{Derivatives, Factorizations};
use crate::error::Error;
use crate::motion::method::control::Tolerance;
use crate::number::{Real, Scalar, larger, smaller};
use crate::vector::{Array, Element, Length, PhaseVector, from_fn};

/// Times of the stages, in units of the step: (4 − √6)/10, (4 + √6)/10 and 1.
pub(super) const NODES: [f64; 3] = [0.155_051_025_721_682_2, 0.644_948_974_278_317_8, 1.0];
/// Columns are eigenvectors of the inverse of the matrix of the method.
const FROM_EIGENVECTORS: [[f64; 3]; 3] = [
    [0.091_232_394_870_892_94, -0.141_255_295_020_954_2, -0.030_029_194_105_147_424],
    [0.241_717_932_707_107, 0.204_129_352_293_799_94, 0.382_942_112_757_261_9],
    [0.966_048_182_615_093, 1.0, 0.0],
];
/// The inverse of that matrix.
const TO_EIGENVECTORS: [[f64; 3]; 3] = [
    [4.325_579_890_063_155, 0.339_199_251_815_809_84, 0.541_770_539_935_874_9],
    [-4.178_718_591_551_905, -0.327_682_820_761_062_4, 0.476_623_554_500_550_44],
    [-0.502_872_634_945_786_9, 2.571_926_949_855_605, -0.596_039_204_828_224_9],
];
/// Largest number of iterations. Near the solution each multiplies the error by less than 10⁻².
pub(super) const ITERATIONS: usize = 10;

/// Largest correction that may be round-off, in units of ε of the state.
const ROUND_OFF: f64 = 100.0;

/// Stages of a step, as differences from its start.
#[derive(Clone, Copy, Debug)]
pub(super) struct StageChanges<T: Element, N: Length>(pub(super) [PhaseVector<T, N>; 3]);

/// Result of an iteration that has converged.
pub(super) struct Converged {
    pub(super) iterations: usize,
    /// Factor by which an iteration reduces the error; zero if one iteration was enough.
    pub(super) contraction: f64,
}

/// Reason why an iteration ends without a solution.
pub(super) enum NoSolution {
    /// The equations have no solution at a stage.
    Unsolved(Error),
    /// It would take too many iterations; a step of this part of the length is likely to converge.
    TooSlow(f64),
}

impl From<Error> for NoSolution {
    fn from(error: Error) -> Self {
        Self::Unsolved(error)
    }
}

impl<T: Real, N: Length> StageChanges<T, N> {
    fn transformed(&self, matrix: &[[f64; 3]; 3]) -> Self {
        let entry = |row: &[f64; 3], half: usize, i: usize| {
            (0..3).fold(T::constant(0.0), |sum, j| sum + T::constant(row[j]) * self.0[j][half][i])
        };
        Self(from_fn(|k| PhaseVector::new(from_fn(|half| Array::from_fn(|i| entry(&matrix[k], half, i))))))
    }

    /// Iterates from this guess. `rates` evaluates the equations at a stage with these changes; an error counts in units of
    /// `tolerance` at the state `y`, and may be `allowed` of them.
    pub(super) fn solve(
        &mut self,
        (derivatives, factorizations): (&Derivatives<T, N>, &Factorizations<T, N>),
        (tolerance, y, allowed): (Tolerance, &PhaseVector<T, N>, f64),
        mut rates: impl FnMut(usize, &PhaseVector<T, N>) -> Result<PhaseVector<T, N>, NoSolution>,
    ) -> Result<Converged, NoSolution> {
        let (one, half) = (T::constant(1.0), T::constant(0.5));
        let round_off = T::constant(ROUND_OFF * T::EPSILON);
        let typical = T::constant(tolerance.absolute / tolerance.relative);
        let mut largest = [PhaseVector::<T, N>::filled(T::constant(0.0)); 3];
        let mut w = self.transformed(&TO_EIGENVECTORS);
        // Bound on the ratio of the remaining error to the last correction. A single correction tells nothing about the
        // contraction, so it must be small itself.
        let (mut contraction, mut remaining) = (0.0, 1.0);
        let (mut before, mut ratio_before) = (0.0, 0.0);
        for iteration in 1..=ITERATIONS {
            let mut f = *self;
            for (k, (rate, change)) in f.0.iter_mut().zip(&self.0).enumerate() {
                *rate = rates(k, change)?;
            }
            let correction =
                factorizations.corrections(derivatives, &w.0, &f.transformed(&TO_EIGENVECTORS).0);
            let parts = correction.map(|x| tolerance.part(one, &x, y));
            let size =
                Scalar::sqrt(parts.iter().fold(T::constant(0.0), |sum, x| sum + *x * *x) / T::constant(3.0));
            let size = size.to_f64();
            if !size.is_finite() {
                return Err(NoSolution::TooSlow(0.5));
            }
            if iteration > 1 {
                let ratio = size / before;
                contraction = if iteration == 2 { ratio } else { power::<T>(ratio * ratio_before, 0.5) };
                ratio_before = ratio;
                if contraction >= 0.99 {
                    return Err(NoSolution::TooSlow(0.5));
                }
                remaining = contraction / (1.0 - contraction);
                let left = ITERATIONS - iteration;
                let at_last = remaining * size * power::<T>(contraction, left as f64) / allowed;
                if at_last >= 1.0 {
                    let part = 0.8 * power::<T>(at_last.clamp(1e-4, 20.0), -1.0 / (4 + left) as f64);
                    return Err(NoSolution::TooSlow(part));
                }
            }
            before = size.max(f64::MIN_POSITIVE);
            for (w, x) in w.0.iter_mut().zip(&correction) {
                w.flat_mut().iter_mut().zip(x.flat()).for_each(|(w, x)| *w += *x);
            }
            *self = w.transformed(&FROM_EIGENVECTORS);
            // A correction may be small only because the derivatives are much too large: it then stays as large.
            let has_shrunk = (0..3).fold(true, |all, k| {
                let entries = correction[k].flat().iter().zip(largest[k].flat_mut()).zip(y.flat());
                entries.fold(all, |all, ((x, largest), y)| {
                    let (size, before) = (Scalar::abs(*x), *largest);
                    *largest = larger(before, size);
                    all & (size <= half * before || size <= round_off * (typical + Scalar::abs(*y)))
                })
            });
            if has_shrunk && remaining * size <= allowed {
                return Ok(Converged { iterations: iteration, contraction });
            }
        }
        Err(NoSolution::TooSlow(0.5))
    }
}

/// Largest ratio of the error of the iteration to the tolerance, for a relative tolerance.
pub(super) fn allowed<T: Real>(relative: f64) -> f64 {
    (10.0 * T::EPSILON / relative).max(power::<T>(relative, 0.5).min(0.03))
}

/// Ratio of the next step to this one, from the error in units of the tolerance and the number of iterations.
pub(super) fn growth<T: Real>(error: f64, iterations: usize) -> f64 {
    let safety = 0.9 * (1 + 2 * ITERATIONS) as f64 / (iterations + 2 * ITERATIONS) as f64;
    let safety = safety.min(0.9);
    smaller(larger(safety * power::<T>(error, -0.25), 0.2), 8.0)
}

/// x to a power, by the functions of the scalar: `f64` has none without the standard library.
pub(super) fn power<T: Real>(x: f64, exponent: f64) -> f64 {
    Scalar::powf(T::constant(x), T::constant(exponent)).to_f64()
}

/// True if an error, in units of the tolerance, rejects a step.
pub(super) fn is_too_large(error: f64) -> bool {
    error.is_nan() || error > 1.0
}
