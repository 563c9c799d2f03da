//! Whether a series is the motion: its accelerations are those of the equations where it leads.

use core::array::from_fn;

use super::expansion::{Expansion, SolvedState};
use super::sampling::parts;
use super::settings::Taylor;
use crate::error::Error;
use crate::number::{FixedArray, Real, Scalar, exceeds, larger, vector};
use crate::statistics::Statistics;
use crate::system::{State, TaylorSeries};

/// Within a step and at its end accelerations may differ by the tolerance, as a part of the velocities, and by so many units of
/// round-off. The terms that are left out make a sixteenth of the tolerance at most, rounding 100 units of it (pendulums of one to
/// ten links, on a rod and in space, Kepler's ellipses, Hénon and Heiles, from 10⁻³ to round-off): more is a force that the series
/// does not know. A pulse whose standard deviation is an eighth of a step shows at the nearer end by a 500th of its peak at least.
const DEFECT: f64 = 4096.0;
/// Beside kinks of functions that the user supplies, and poses where constraints become dependent, they may differ by so many times the tolerance, and by this part of the
/// velocities, so that a step leads across.
const DEFECT_AT_KINKS: [f64; 2] = [1e4, 1e-10];
/// Where a root is below zero in the series they may differ by so many times the tolerance alone: nothing is left to
/// what the step after makes good. So they may where the last coefficients are zero, and do not tell whether all beyond are.
const STRICT: f64 = 64.0;
/// Rounding errors are estimated from two states that are so many units of it away, and may be so many times as large.
const ROUNDING: [f64; 2] = [4.0, 16.0];

/// A step to be looked at.
pub(super) struct CandidateStep<'a, S, T, const N: usize, const M: usize> {
    pub(super) series: &'a Expansion<S, T, N>,
    pub(super) start: &'a State<T, N>,
    pub(super) end: &'a State<T, N>,
    pub(super) solved: &'a SolvedState<T, N, M>,
    pub(super) length: T,
    /// Those of the series at the end.
    pub(super) accelerations: &'a [T; N],
    /// Number of samples within.
    pub(super) count: usize,
    /// Whether at its start or its end accelerations have the rounding errors of constraints that are hardly independent.
    pub(super) is_near_dependence: bool,
}

impl<S: FixedArray<T>, T: Real, const N: usize, const M: usize> CandidateStep<'_, S, T, N, M> {
    /// The velocity that is off the most, where one is by too much.
    pub(super) fn inaccurate<L>(
        &self,
        system: &L,
        method: &Taylor,
        statistics: &mut Statistics,
    ) -> Result<Option<usize>, Error>
    where
        L: TaylorSeries<N, M, Scalar = T, Sums = S>,
    {
        let tolerance = method.tolerance::<T>();
        let allowed = match self.is_near_dependence {
            true => method.jump_allowed::<T>(),
            false => method.defect_allowed::<L, N, M>(),
        };
        let bound = if self.series.ends() { STRICT * tolerance } else { allowed };
        if let Some(found) = self.off(system, method, (self.end, self.solved), self.accelerations, bound) {
            return Ok(Some(found));
        }
        let at_roots =
            self.series.roots_below_zero::<L, M>(self.length).map(|length| (length, STRICT * tolerance));
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

    fn off<L>(
        &self,
        system: &L,
        method: &Taylor,
        (state, solved): (&State<T, N>, &SolvedState<T, N, M>),
        accelerations: &[T; N],
        bound: f64,
    ) -> Option<usize>
    where
        L: TaylorSeries<N, M, Scalar = T, Sums = S>,
    {
        let slack = T::constant(method.slack::<T>());
        let off = |i: usize| Scalar::abs(accelerations[i] - solved.solution.accelerations[i]);
        let defect = |i: usize| part([self.start.v[i], self.end.v[i]], off(i), self.length, slack);
        let worst = (0..N).fold(0, |worst, i| if defect(i) > defect(worst) { i } else { worst });
        let is_too_much = exceeds(defect(worst), T::constant(bound));
        (is_too_much && !is_rounding(system, state, solved, worst, off(worst))).then_some(worst)
    }
}

impl Taylor {
    /// The coordinate whose value or velocity is moved the most, where that is by too much: near a pose where constraints become
    /// dependent a projection leads onto another branch of the motion.
    pub(super) fn moved<T: Real, const N: usize>(&self, sums: [(&[T; N], &[T; N]); 2]) -> Option<usize> {
        let (slack, bound) = (T::constant(self.slack::<T>()), T::constant(self.jump_allowed::<T>()));
        let is_moved = |(sum, projected): &(&[T; N], &[T; N]), i: usize| {
            exceeds(Scalar::abs(projected[i] - sum[i]), bound * (Scalar::abs(sum[i]) + slack))
        };
        (0..N).find(|&i| sums.iter().any(|pair| is_moved(pair, i)))
    }

    /// By so much accelerations may differ, as a part of the velocities.
    pub(super) fn defect_allowed<L, const N: usize, const M: usize>(&self) -> f64
    where
        L: TaylorSeries<N, M, Scalar: Real>,
    {
        let tolerance = self.tolerance::<L::Scalar>();
        match L::ARGUMENTS.is_empty() {
            true => larger(tolerance, DEFECT * L::Scalar::EPSILON),
            false => self.jump_allowed::<L::Scalar>(),
        }
    }

    /// By so much the equations may jump, or a projection move a state, without another step.
    pub(crate) fn jump_allowed<T: Real>(&self) -> f64 {
        let [times, part] = DEFECT_AT_KINKS;
        larger(times * self.tolerance::<T>(), part)
    }
}

/// What so much of acceleration makes in a step, as a part of the velocity at its start and its end.
pub(super) fn part<T: Scalar>([start, end]: [T; 2], off: T, length: T, slack: T) -> T {
    off * length.abs() / (start.abs() + end.abs() + slack)
}

/// Whether rounding errors of the state alone change this acceleration about as much.
#[cold]
fn is_rounding<L, T: Real, const N: usize, const M: usize>(
    system: &L,
    state: &State<T, N>,
    solved: &SolvedState<T, N, M>,
    row: usize,
    off: T,
) -> bool
where
    L: TaylorSeries<N, M, Scalar = T>,
{
    let [units, times] = ROUNDING;
    let factors = [1.0, -1.0].map(|sign| T::constant(1.0 + sign * units * T::EPSILON));
    let moved = |[even, odd]: [T; 2]| {
        let moved = |x: &[T; N]| vector(from_fn(|i| x[i] * if i % 2 == 0 { even } else { odd }));
        let state = State { t: state.t * even, q: moved(&state.q.into()), v: moved(&state.v.into()) };
        SolvedState::at(system, &state)
    };
    [factors, [factors[1], factors[0]]].into_iter().any(|factors| {
        let change = |other: SolvedState<T, N, M>| {
            Scalar::abs(other.solution.accelerations[row] - solved.solution.accelerations[row])
        };
        moved(factors).is_ok_and(|other| off <= change(other) * T::constant(times))
    })
}
