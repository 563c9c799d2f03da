//! A motion: its accepted steps, and everything in between.

mod csv;
mod drift;
mod path;
mod sample;
#[cfg(test)]
mod tests;

use core::fmt::{self, Debug, Formatter};
use core::iter::once;
use core::marker::PhantomData;

pub use csv::Csv;
pub use drift::{Deviation, Drift};
pub(crate) use path::Path;
pub use sample::Sample;

use crate::ending::Ending;
use crate::error::Error;
use crate::number::Real;
use crate::solution::Adjustment;
use crate::solution::flow::{Flow, LagrangianFlow};
use crate::statistics::Statistics;
use crate::system::{Lagrangian, State};

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

impl<'a, L: Lagrangian<N, M, Scalar: Real>, F: Flow<L, N, M>, const N: usize, const M: usize>
    Trajectory<'a, L, N, M, F>
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
                start: self.path.start.t.to_f64(),
                end: self.path.last.t.to_f64(),
            }),
        }
    }

    /// The first state, made consistent.
    pub fn start(&self) -> Sample<'a, L, N, M> {
        self.sample(self.path.start)
    }

    /// The last state.
    pub fn end(&self) -> Sample<'a, L, N, M> {
        self.sample(self.path.last)
    }

    /// The states that the method computed, first and last included.
    pub fn steps(&self) -> impl Iterator<Item = Sample<'a, L, N, M>> + '_ {
        let starts = (0..self.statistics.accepted).filter_map(|i| self.path.start_of(i));
        let states = starts.map(|point| F::state(self.system, &point)).chain(once(self.path.last));
        states.map(|state| self.sample(state))
    }

    /// `count` states at evenly spaced times, first and last included.
    pub fn samples(&self, count: usize) -> impl Iterator<Item = Sample<'a, L, N, M>> + '_ {
        let (first, last) = (self.path.start.t, self.path.last.t);
        let intervals = count.saturating_sub(1).max(1);
        (0..count).filter_map(move |i| {
            self.state_at(between(first, last, i as f64 / intervals as f64)).map(|state| self.sample(state))
        })
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
        if t == self.path.last.t {
            return Some(self.path.last);
        }
        let point = self.path.at(t)?;
        Some(F::project(self.system, &point).unwrap_or_else(|_| F::state(self.system, &point)))
    }

    fn sample(&self, state: State<L::Scalar, N>) -> Sample<'a, L, N, M> {
        Sample { system: self.system, state }
    }
}

impl<L, F, const N: usize, const M: usize> Debug for Trajectory<'_, L, N, M, F>
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Trajectory")
            .field("system", &L::NAME)
            .field("start", &self.path.start)
            .field("end", &self.path.last)
            .field("ending", &self.ending)
            .field("statistics", &self.statistics)
            .finish()
    }
}

/// The time after this part of the way, which rounding carries neither past the last nor past all numbers.
fn between<T: Real>(first: T, last: T, part: f64) -> T {
    let (span, done) = (last - first, T::constant(part));
    if part == 1.0 {
        last
    } else if span.is_finite() {
        let time = first + span * done;
        if (last - time) * span > T::constant(0.0) { time } else { last }
    } else {
        first * (T::constant(1.0) - done) + last * done
    }
}
