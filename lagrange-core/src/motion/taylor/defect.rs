//! Whether a series is the motion: its accelerations are those of the equations where it leads.

use core::array::from_fn;

use super::Taylor;
use super::expansion::{Expansion, Solved};
use crate::error::Error;
use crate::number::{Filled, Real, Scalar, exceeds, larger, vector};
use crate::system::{State, TaylorSeries};

/// At the end of a step accelerations may differ by so many times the tolerance, and by this part of the velocities.
const DEFECT: [f64; 2] = [1e4, 1e-10];
/// Where a root is below zero in the series they may differ by so many times the tolerance alone: nothing is left to
/// what the step after makes good. So they may where the last coefficients are zero, and do not tell whether all beyond are.
const STRICT: f64 = 64.0;
/// A step with functions that the user supplies is looked at after each of so many parts.
const PARTS: usize = 4;
/// Rounding errors are estimated from two states that are so many units of it away, and may be so many times as large.
const ROUNDING: [f64; 2] = [4.0, 16.0];

/// A step to be looked at.
pub(super) struct Tried<'a, S, T, const N: usize, const M: usize> {
    pub(super) series: &'a Expansion<S, T, N>,
    pub(super) start: &'a State<T, N>,
    pub(super) end: &'a State<T, N>,
    pub(super) solved: &'a Solved<T, N, M>,
    pub(super) length: T,
    /// Those of the series at the end.
    pub(super) accelerations: [T; N],
}

impl<S: Filled<T>, T: Real, const N: usize, const M: usize> Tried<'_, S, T, N, M> {
    /// The velocity that is off the most, where one is by too much.
    pub(super) fn inaccurate<L>(&self, system: &L, method: &Taylor) -> Result<Option<usize>, Error>
    where
        L: TaylorSeries<N, M, Scalar = T, Sums = S>,
    {
        let tolerance = method.tolerance::<T>();
        let bound = if self.series.ends() { STRICT * tolerance } else { method.defect_allowed::<T>() };
        let mut found = self.off(system, method, (self.end, self.solved), &self.accelerations, bound);
        let at_roots =
            self.series.roots_below_zero::<L, M>(self.length).map(|length| (length, STRICT * tolerance));
        let within = parts::<L, N, M>().map(|part| (self.length * T::constant(part), bound));
        for (length, bound) in at_roots.chain(within) {
            let [dq, dv, accelerations] = self.series.change(length);
            let [q, v] = [(self.start.q, dq), (self.start.v, dv)]
                .map(|(x, change)| vector(from_fn(|i| x[i] + change[i])));
            let there = State { t: self.start.t + length, q, v };
            let solved = Solved::at(system, &there)?;
            found = found.or_else(|| self.off(system, method, (&there, &solved), &accelerations, bound));
        }
        Ok(found)
    }

    fn off<L>(
        &self,
        system: &L,
        method: &Taylor,
        (state, solved): (&State<T, N>, &Solved<T, N, M>),
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
        let (slack, bound) = (T::constant(self.slack::<T>()), T::constant(self.defect_allowed::<T>()));
        let is_moved = |(sum, projected): &(&[T; N], &[T; N]), i: usize| {
            exceeds(Scalar::abs(projected[i] - sum[i]), bound * (Scalar::abs(sum[i]) + slack))
        };
        (0..N).find(|&i| sums.iter().any(|pair| is_moved(pair, i)))
    }

    /// By so much accelerations may differ at the end of a step, as a part of the velocities.
    pub(super) fn defect_allowed<T: Real>(&self) -> f64 {
        let [times, part] = DEFECT;
        larger(times * self.tolerance::<T>(), part)
    }
}

/// After which parts of a step to look as well: inside of functions that the user supplies may be kinks that nobody tells of.
pub(super) fn parts<L: TaylorSeries<N, M>, const N: usize, const M: usize>() -> impl Iterator<Item = f64> {
    let inner = if L::ARGUMENTS.is_empty() { 1..1 } else { 1..PARTS };
    inner.map(|k| k as f64 / PARTS as f64)
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
    solved: &Solved<T, N, M>,
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
        Solved::at(system, &state)
    };
    [factors, [factors[1], factors[0]]].into_iter().any(|factors| {
        let change = |other: Solved<T, N, M>| {
            Scalar::abs(other.solution.accelerations[row] - solved.solution.accelerations[row])
        };
        moved(factors).is_ok_and(|other| off <= change(other) * T::constant(times))
    })
}
