//! Newton's iteration for the stages of a step (Hairer and Wanner, *Solving Ordinary Differential Equations II*, IV.8).

use super::limits::{FAST, GROWTH, NEGLIGIBLE, SHRINK};
use crate::error::Error;
use crate::motion::limits::SAFETY;
use crate::motion::method::control::Tolerance;
use crate::number::limits::CANCELLED;
use crate::number::{Real, Scalar, larger, smaller};
use crate::vector::{Element, PhaseVector, StaticLength};

/// Largest number of iterations for `s` stages. Near the solution each multiplies the error by less than 10⁻².
pub(super) const fn iterations(s: usize) -> usize {
    4 + 2 * s
}

/// Stages of a step, as differences from its start.
pub(super) type StageChanges<T, N, const S: usize> = [PhaseVector<T, N>; S];

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
    /// It would take too many iterations.
    TooSlow,
}

impl From<Error> for NoSolution {
    fn from(error: Error) -> Self {
        Self::Unsolved(error)
    }
}

/// The products Σⱼ aₖⱼ xⱼ of a matrix and stages.
pub(super) fn product<T: Real, N: StaticLength, const S: usize>(
    a: &[[f64; S]; S],
    x: &StageChanges<T, N, S>,
) -> StageChanges<T, N, S> {
    a.map(|row| combination(&row, x))
}

/// The sum Σⱼ aⱼ xⱼ.
pub(super) fn combination<T: Real, N: StaticLength, const S: usize>(
    a: &[f64; S],
    x: &StageChanges<T, N, S>,
) -> PhaseVector<T, N> {
    let mut sum = PhaseVector::filled(T::constant(0.0));
    for (a, x) in a.iter().zip(x) {
        let a = T::constant(*a);
        sum.flat_mut().iter_mut().zip(x.flat()).for_each(|(sum, x)| *sum += a * *x);
    }
    sum
}

/// Entries of x and y, combined.
pub(super) fn zip<T: Element, N: StaticLength>(
    x: &PhaseVector<T, N>,
    y: &PhaseVector<T, N>,
    of: impl Fn(T, T) -> T,
) -> PhaseVector<T, N> {
    let mut result = *x;
    result.flat_mut().iter_mut().zip(y.flat()).for_each(|(x, y)| *x = of(*x, *y));
    result
}

/// Accuracy of an iteration for the stages of a method.
pub(super) struct Iteration<'a, T: Real, N: StaticLength> {
    /// An error counts in units of this tolerance at the state `y`, and may be `allowed` of them.
    pub(super) tolerance: Tolerance,
    pub(super) y: &'a PhaseVector<T, N>,
    pub(super) allowed: f64,
    /// True with the derivatives at each stage: the iteration must converge fast, and a second correction must be small, too. On a
    /// stiff force that turns, an error δ along the force is small in itself, and leads to one of h² k θ δ across it.
    pub(super) is_coupled: bool,
    /// What round-off leaves of the equations, where corrections alone do not tell that the iteration has converged: friction along
    /// two velocities has derivatives μ g/|v|, which are too large without bound where it begins. Then what is left must be within
    /// the tolerance or 16 times this.
    pub(super) floor: Option<PhaseVector<T, N>>,
}

impl<T: Real, N: StaticLength> Iteration<'_, T, N> {
    /// Iterates from the guess `z`. `rates` evaluates the equations at a stage with these changes, `corrections` solves the
    /// linear equations for stages and their rates, and `left` is what the stages leave of the equations, as changes.
    pub(super) fn solve<const S: usize>(
        &self,
        z: &mut StageChanges<T, N, S>,
        corrections: impl Fn(&StageChanges<T, N, S>, &StageChanges<T, N, S>) -> StageChanges<T, N, S>,
        left: impl Fn(&StageChanges<T, N, S>, &StageChanges<T, N, S>) -> StageChanges<T, N, S>,
        mut rates: impl FnMut(usize, &PhaseVector<T, N>) -> Result<PhaseVector<T, N>, NoSolution>,
    ) -> Result<Converged, NoSolution> {
        let mut largest = [PhaseVector::<T, N>::filled(T::constant(0.0)); S];
        // Bound on the ratio of the remaining error to the last correction. A single correction tells nothing about the
        // contraction, so it must be small itself.
        let (mut contraction, mut remaining) = (0.0, 1.0);
        let (mut before, mut ratio_before, mut was_small) = (0.0, 0.0, false);
        for iteration in 1..=iterations(S) {
            let mut f = *z;
            for (k, (rate, change)) in f.iter_mut().zip(&*z).enumerate() {
                *rate = rates(k, change)?;
            }
            let correction = corrections(z, &f);
            let left_over = left(z, &f);
            let size = self.size(&correction);
            if !size.is_finite() {
                return Err(NoSolution::TooSlow);
            }
            let is_confirmed = was_small && size <= self.allowed;
            if iteration > 1 && !is_confirmed {
                let ratio = size / before;
                contraction = if iteration == 2 { ratio } else { power::<T>(ratio * ratio_before, 0.5) };
                ratio_before = ratio;
                if contraction >= 1.0 || self.is_coupled && ratio > FAST {
                    return Err(NoSolution::TooSlow);
                }
                remaining = contraction / (1.0 - contraction);
                let left = iterations(S) - iteration;
                let at_last = remaining * size * power::<T>(contraction, left as f64) / self.allowed;
                if at_last >= 1.0 {
                    return Err(NoSolution::TooSlow);
                }
            }
            before = size.max(f64::MIN_POSITIVE);
            for (z, x) in z.iter_mut().zip(&correction) {
                *z = zip(z, x, |z, x| z + x);
            }
            let has_shrunk = self.has_shrunk(&correction, &left_over, &mut largest);
            let is_small = has_shrunk && remaining * size <= self.allowed;
            if is_confirmed || is_small && !self.is_coupled {
                return Ok(Converged { iterations: iteration, contraction });
            }
            was_small = is_small;
        }
        Err(NoSolution::TooSlow)
    }

    /// Size of corrections in units of the tolerance.
    fn size<const S: usize>(&self, correction: &StageChanges<T, N, S>) -> f64 {
        let one = T::constant(1.0);
        let parts = correction.iter().map(|x| self.tolerance.part(one, x, self.y));
        let sum = parts.fold(T::constant(0.0), |sum, x| sum + x * x);
        Scalar::sqrt(sum / T::constant(S as f64)).to_f64()
    }

    /// True if each entry of a correction is less than half of the `largest` before, or round-off. A correction may be small
    /// only because the derivatives are much too large: it then stays as large, and as much is `left` of the equations.
    fn has_shrunk<const S: usize>(
        &self,
        correction: &StageChanges<T, N, S>,
        left: &StageChanges<T, N, S>,
        largest: &mut StageChanges<T, N, S>,
    ) -> bool {
        let half = T::constant(0.5);
        let round_off = T::constant(CANCELLED * T::EPSILON);
        let relative = T::constant(self.tolerance.relative);
        let typical = T::constant(self.tolerance.absolute / self.tolerance.relative);
        let mut all = true;
        for (k, (correction, largest)) in correction.iter().zip(largest).enumerate() {
            let entries = correction.flat().iter().zip(largest.flat_mut()).zip(self.y.flat());
            for (i, ((x, largest), y)) in entries.enumerate() {
                let (size, before, of) = (Scalar::abs(*x), *largest, typical + Scalar::abs(*y));
                *largest = larger(before, size);
                let left = Scalar::abs(left[k].flat()[i]);
                let is_little = left <= relative * of;
                all &= size <= half * before || size <= round_off * of && is_little;
                let floor = |floor: PhaseVector<T, N>| left <= T::constant(CANCELLED) * floor.flat()[i];
                all &= is_little || self.floor.is_none_or(floor);
            }
        }
        all
    }
}

/// Largest ratio of the error of the iteration to the tolerance, for a relative tolerance.
pub(super) fn allowed<T: Real, const S: usize>(relative: f64) -> f64 {
    let exponent = (S - 1) as f64 / (S + 1) as f64;
    (10.0 * T::EPSILON / relative).max(power::<T>(relative, exponent).min(NEGLIGIBLE))
}

/// Ratio of the next step to this one, from the error in units of the tolerance and the number of iterations.
pub(super) fn growth<T: Real, const S: usize>(error: f64, taken: usize) -> f64 {
    let most = iterations(S);
    within_limits((1 + 2 * most) as f64 / (taken + 2 * most) as f64 * reduction::<T, S>(error))
}

/// Ratio of step lengths that is taken for a predicted one, so that few steps are rejected; the least for NaN.
pub(super) fn within_limits(ratio: f64) -> f64 {
    smaller(larger(SHRINK, SAFETY * ratio), GROWTH)
}

/// Ratio of step lengths that divides an error of order s + 1 by `error`.
pub(super) fn reduction<T: Real, const S: usize>(error: f64) -> f64 {
    power::<T>(error, -1.0 / (S + 1) as f64)
}

/// x to a power, by the functions of the scalar: `f64` has none without the standard library.
pub(super) fn power<T: Real>(x: f64, exponent: f64) -> f64 {
    Scalar::powf(T::constant(x), T::constant(exponent)).to_f64()
}
