//! A motion: its accepted steps, and everything in between.

#[cfg(test)]
mod tests;

use alloc::vec::Vec;
use core::array::from_fn;
use core::fmt::{self, Debug, Formatter};
use core::iter::once;
use core::marker::PhantomData;

use crate::integrate::{Flow, LagrangianFlow, Phase, Point};
use crate::{Adjustment, Csv, Drift, Ending, Error, Lagrangian, Real, Sample, Scalar, State, Statistics};

/// The motion of a system from the start to where the integration stopped, which [`ending`](Self::ending) explains.
///
/// Between the steps it is the continuous extension of the method, projected onto the constraints like the steps
/// themselves: continuous, and equal to the states computed at their times.
///
/// The flow `F` says which equations were integrated, Lagrange's or Hamilton's; a sample has both velocities and
/// momenta.
pub struct Trajectory<'a, L: Lagrangian<N, M>, const N: usize, const M: usize, F = LagrangianFlow> {
    system: &'a L,
    path: Path<L::Scalar, N>,
    ending: Ending,
    statistics: Statistics,
    adjustment: Adjustment<L::Scalar, N>,
    flow: PhantomData<F>,
}

impl<'a, L, F, const N: usize, const M: usize> Trajectory<'a, L, N, M, F>
where
    L: Lagrangian<N, M, Scalar: Real>,
    F: Flow<L, N, M>,
{
    pub(crate) fn new(
        system: &'a L,
        path: Path<L::Scalar, N>,
        ending: Ending,
        statistics: Statistics,
        adjustment: Adjustment<L::Scalar, N>,
    ) -> Self {
        Self { system, path, ending, statistics, adjustment, flow: PhantomData }
    }

    /// The state at this time.
    ///
    /// # Errors
    /// [`Error::OutsideTrajectory`].
    pub fn at(&self, t: L::Scalar) -> Result<Sample<'a, L, N, M>, Error> {
        match self.state_at(t) {
            Some(state) => Ok(self.sample(state)),
            None => Err(Error::OutsideTrajectory {
                time: t.to_f64(),
                start: self.path.first().t.to_f64(),
                end: self.path.last().t.to_f64(),
            }),
        }
    }

    /// The first state, made consistent.
    pub fn start(&self) -> Sample<'a, L, N, M> {
        self.sample(self.path.first())
    }

    /// The last state.
    pub fn end(&self) -> Sample<'a, L, N, M> {
        self.sample(self.path.last())
    }

    /// The states that the method computed, first and last included.
    pub fn steps(&self) -> impl Iterator<Item = Sample<'a, L, N, M>> + '_ {
        let starts = (0..self.statistics.accepted).filter_map(|i| self.path.start_of(i));
        let states = starts.map(|point| F::state(self.system, &point)).chain(once(self.path.last()));
        states.map(|state| self.sample(state))
    }

    /// `count` states at evenly spaced times, first and last included.
    pub fn samples(&self, count: usize) -> impl Iterator<Item = Sample<'a, L, N, M>> + '_ {
        let (first, last) = (self.path.first().t, self.path.last().t);
        let intervals = count.saturating_sub(1).max(1);
        (0..count).filter_map(move |i| {
            let part = L::Scalar::constant(i as f64 / intervals as f64);
            // Exactly the last time, whatever rounding does to the sum.
            let t = if i > 0 && i == intervals { last } else { first + (last - first) * part };
            self.state_at(t).map(|state| self.sample(state))
        })
    }

    /// A table of `count` states at evenly spaced times, as comma-separated values.
    ///
    /// Print it, or write `path.csv(200).to_string()` to a file.
    pub fn csv(&self, count: usize) -> Csv<'_, 'a, L, N, M, F> {
        Csv::new(self, count)
    }

    /// How far each conserved quantity strays from its value at the start.
    pub fn drift(&self) -> Drift<L::Scalar> {
        Drift::along(self)
    }

    /// Why the trajectory ends where it does.
    pub fn ending(&self) -> &Ending {
        &self.ending
    }

    /// Steps and evaluations.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// How far the start was moved onto the constraints.
    pub fn adjustment(&self) -> &Adjustment<L::Scalar, N> {
        &self.adjustment
    }

    /// Whether the constraints were independent all along. Where not, the motion is right all the same, and the
    /// multipliers are the ones of least Euclidean norm.
    pub fn multipliers_are_unique(&self) -> bool {
        self.statistics.multipliers_are_unique
    }

    /// An interpolated state is off the constraints by about the tolerance, and where no projection leads back it stays so.
    fn state_at(&self, t: L::Scalar) -> Option<State<L::Scalar, N>> {
        if t == self.path.last().t {
            return Some(self.path.last());
        }
        let point = self.path.at(t)?;
        Some(F::project(self.system, &point).unwrap_or_else(|_| F::state(self.system, &point)))
    }

    fn sample(&self, state: State<L::Scalar, N>) -> Sample<'a, L, N, M> {
        Sample::new(self.system, state)
    }
}

impl<L, F, const N: usize, const M: usize> Debug for Trajectory<'_, L, N, M, F>
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Trajectory")
            .field("system", &L::NAME)
            .field("start", &self.path.first())
            .field("end", &self.path.last())
            .field("ending", &self.ending)
            .field("statistics", &self.statistics)
            .finish()
    }
}

/// The states at the ends of the steps, and the interpolants between them.
pub(crate) struct Path<T, const N: usize> {
    start: State<T, N>,
    last: State<T, N>,
    /// The times at the starts of the steps.
    times: Vec<T>,
    coefficients: Vec<Phase<T, N>>,
    /// Coefficients a step.
    stride: usize,
}

impl<T: Real, const N: usize> Path<T, N> {
    pub(crate) fn from(start: State<T, N>) -> Self {
        Self { start, last: start, times: Vec::new(), coefficients: Vec::new(), stride: 0 }
    }

    pub(crate) fn push(&mut self, state: State<T, N>, interpolant: &[Phase<T, N>]) {
        self.times.push(self.last.t);
        self.coefficients.extend_from_slice(interpolant);
        self.stride = interpolant.len();
        self.last = state;
    }

    fn first(&self) -> State<T, N> {
        self.start
    }

    pub(crate) fn last(&self) -> State<T, N> {
        self.last
    }

    /// Where step `step` starts.
    fn start_of(&self, step: usize) -> Option<Point<T, N>> {
        Some(self.point(step, *self.times.get(step)?))
    }

    /// `None` before the start and from the last state on.
    fn at(&self, t: T) -> Option<Point<T, N>> {
        if !(t >= self.start.t && t < self.last.t) {
            return None;
        }
        let step = self.times.partition_point(|start| *start <= t).checked_sub(1)?;
        Some(self.point(step, t))
    }

    fn point(&self, step: usize, t: T) -> Point<T, N> {
        let time = |step: usize| self.times.get(step).copied().unwrap_or(self.last.t);
        let (begin, length) = (time(step), time(step + 1) - time(step));
        let (y, velocity) = evaluate(self.interpolant(step), (t - begin) / length);
        Point { t, y, velocity: velocity.map(|x| x / length) }
    }

    fn interpolant(&self, step: usize) -> &[Phase<T, N>] {
        let from = step * self.stride;
        self.coefficients.get(from..from + self.stride).unwrap_or(&[])
    }
}

/// r₀ + θ(r₁ + (1−θ)(r₂ + θ(r₃ + …))), and the derivative of its first half by θ.
fn evaluate<T: Real, const N: usize>(coefficients: &[Phase<T, N>], theta: T) -> (Phase<T, N>, [T; N]) {
    let (zero, one) = (T::constant(0.0), T::constant(1.0));
    let (mut sum, mut slope) = ([[zero; N]; 2], [zero; N]);
    for (k, r) in coefficients.iter().enumerate().rev() {
        let (factor, sign) = if k % 2 == 0 { (theta, one) } else { (one - theta, -one) };
        slope = from_fn(|i| sign * sum[0][i] + factor * slope[i]);
        sum = from_fn(|half| from_fn(|i| r[half][i] + factor * sum[half][i]));
    }
    (sum, slope)
}
