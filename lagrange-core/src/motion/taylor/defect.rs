//! Defect of a series: the difference between its accelerations and those of the equations along a step.

use super::expansion::{Expansion, SolvedState};
use super::limits::{JUMP, ROUND_OFF};
use super::sampling::parts;
use super::settings::Taylor;
use crate::error::Error;
use crate::number::{Real, Scalar, exceeds, larger};
use crate::solution::limits::MARGIN;
use crate::solution::pivot::least_pivot;
use crate::solution::round_off::neighbours;
use crate::statistics::Statistics;
use crate::system::{State, TaylorSeries};
use crate::vector::{Array, Element, FixedArray, StaticLength, from_fn, vector};

/// A step to check before it is accepted.
pub(super) struct CandidateStep<'a, S, T: Element, N: StaticLength, M: StaticLength> {
    pub(super) series: &'a Expansion<S, T, N>,
    pub(super) start: &'a State<T, N>,
    pub(super) end: &'a State<T, N>,
    pub(super) solved: &'a SolvedState<T, N, M>,
    pub(super) length: T,
    /// Accelerations of the series at the end.
    pub(super) accelerations: &'a Array<T, N>,
    /// Number of samples within the step.
    pub(super) count: usize,
}

impl<S: FixedArray<T>, T: Real, N: StaticLength, M: StaticLength> CandidateStep<'_, S, T, N, M> {
    /// Index of the coordinate with the largest defect, if that is too large; `None` if the step is accurate.
    pub(super) fn inaccurate<L: TaylorSeries<N = N, M = M, Scalar = T, Sums = S>>(
        &self,
        system: &L,
        method: &Taylor,
        statistics: &mut Statistics,
    ) -> Result<Option<usize>, Error> {
        let tolerance = method.tolerance::<T>();
        let allowed = match self.series.is_truncated() {
            true => method.jump_allowed::<T>(),
            false => method.defect_allowed::<L>(),
        };
        // If the last coefficients are zero, the omitted ones may not be.
        let bound = if self.series.ends() { tolerance } else { allowed };
        if let Some(found) = self.off(system, method, (self.end, self.solved), self.accelerations, bound) {
            return Ok(Some(found));
        }
        // A root never is negative, and no later step would correct the error of a series that says it is.
        let at_roots = self.series.roots_below_zero::<L>(self.length).map(|length| (length, tolerance));
        let within = parts(self.count).map(|part| (self.length * T::constant(part), allowed));
        for (length, bound) in at_roots.chain(within) {
            let [dq, dv, accelerations] = self.series.change(length);
            let [q, v] = [(self.start.q, dq), (self.start.v, dv)]
                .map(|(x, change)| vector(from_fn(|i| x[i] + change[i])));
            let there = State { t: self.start.t + length, q, v };
            statistics.evaluations += 1;
            let solved = SolvedState::at(system, &there)?;
            let found = self.off(system, method, (&there, &solved), &accelerations, bound);
            if found.is_some() {
                return Ok(found);
            }
        }
        Ok(None)
    }

    fn off<L: TaylorSeries<N = N, M = M, Scalar = T, Sums = S>>(
        &self,
        system: &L,
        method: &Taylor,
        (state, solved): (&State<T, N>, &SolvedState<T, N, M>),
        accelerations: &Array<T, N>,
        bound: f64,
    ) -> Option<usize> {
        let slack = T::constant(method.slack::<T>());
        let off = |i: usize| Scalar::abs(accelerations[i] - solved.solution.accelerations[i]);
        let defect = |i: usize| part([self.start.v[i], self.end.v[i]], off(i), self.length, slack);
        let worst = (0..N::COUNT).fold(0, |worst, i| if defect(i) > defect(worst) { i } else { worst });
        let bound = larger(T::constant(bound), round_off(solved.solution.pivot));
        let is_too_much = exceeds(defect(worst), bound);
        (is_too_much && !is_rounding(system, state, solved, worst, off(worst))).then_some(worst)
    }
}

impl Taylor {
    /// Index of a coordinate whose value or velocity is changed too much by the projection, if there is one. Near a
    /// pose where constraints become dependent, a projection may lead onto another branch of the motion.
    pub(super) fn moved<T: Real, N: StaticLength>(
        &self,
        sums: [(&Array<T, N>, &Array<T, N>); 2],
    ) -> Option<usize> {
        let (slack, bound) = (T::constant(self.slack::<T>()), T::constant(self.jump_allowed::<T>()));
        let is_moved = |(sum, projected): &(&Array<T, N>, &Array<T, N>), i: usize| {
            exceeds(Scalar::abs(projected[i] - sum[i]), bound * (Scalar::abs(sum[i]) + slack))
        };
        (0..N::COUNT).find(|&i| sums.iter().any(|pair| is_moved(pair, i)))
    }

    /// Largest defect of accelerations, relative to the velocities.
    pub(super) fn defect_allowed<L: TaylorSeries<Scalar: Real>>(&self) -> f64 {
        match L::ARGUMENTS.is_empty() {
            true => self.tolerance::<L::Scalar>(),
            false => self.jump_allowed::<L::Scalar>(),
        }
    }

    /// Largest jump of the accelerations, or change of a state by a projection, that does not reject a step.
    pub(crate) fn jump_allowed<T: Real>(&self) -> f64 {
        let [times, part] = JUMP;
        larger(times * self.tolerance::<T>(), part)
    }
}

/// Defect: change of velocity that a difference `off` of accelerations makes over a step, relative to the velocities at
/// its start and end.
pub(super) fn part<T: Scalar>([start, end]: [T; 2], off: T, length: T, slack: T) -> T {
    off * length.abs() / (start.abs() + end.abs() + slack)
}

/// Largest defect that may be a rounding error: the elimination loses as many digits as its smallest pivot has zeros.
/// Below the least pivot, orthogonal factors solve the equations.
///
/// A larger defect is a force that the series does not contain. A pulse with a standard deviation of an eighth of a
/// step shows at the nearer end, at most four of these away, by at least e⁻⁸ = 1/3000 of its peak.
pub(super) fn round_off<T: Real>(pivot: T) -> T {
    T::constant(ROUND_OFF * T::EPSILON) / larger(pivot, least_pivot())
}

/// True if rounding errors of the state change this acceleration by about as much as `off`.
#[cold]
fn is_rounding<L: TaylorSeries<Scalar = T>, T: Real>(
    system: &L,
    state: &State<T, L::N>,
    solved: &SolvedState<T, L::N, L::M>,
    row: usize,
    off: T,
) -> bool {
    neighbours(state, state, 4.0 * T::EPSILON).any(|nearby| {
        let change = |other: SolvedState<T, L::N, L::M>| {
            Scalar::abs(other.solution.accelerations[row] - solved.solution.accelerations[row])
        };
        SolvedState::at(system, &nearby).is_ok_and(|other| off <= change(other) * T::constant(MARGIN))
    })
}
