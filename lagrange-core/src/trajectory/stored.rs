//! Trajectories stored in memory.

use core::fmt::{self, Debug, Display, Formatter};
use core::iter::once;
use core::marker::PhantomData;

use super::path::Path;
use crate::error::{Ending, Error};
use crate::number::{Real, Scalar};
use crate::solution::crossing::Crossing;
use crate::solution::vector_field::{LagrangianVectorField, VectorField};
use crate::solution::{Adjustment, Sample};
use crate::statistics::Statistics;
use crate::system::{Lagrangian, State, StateOf};
use crate::vector::{Array, vector};

/// Motion of a system from its start to the end of the integration. It prints as a summary.
///
/// Between the steps the trajectory is the dense output of the method, projected onto the constraints like the
/// steps themselves. It is continuous and equals the computed states at their times.
///
/// The call that integrates borrows the system `S`: `Trajectory<&Pendulum>`.
/// [`into_owned`](Self::into_owned) returns a trajectory with its own copy of the system,
/// `Trajectory<Pendulum>`. The vector field `F` tells which equations were integrated,
/// Lagrange's or Hamilton's; samples have both velocities and momenta.
pub struct Trajectory<S: Lagrangian, F = LagrangianVectorField> {
    pub(crate) system: S,
    pub(super) path: Path<S::Scalar, S::N>,
    ending: Ending,
    statistics: Statistics,
    adjustment: Adjustment<S::Scalar, S::N>,
    field: PhantomData<F>,
}

impl<L: Lagrangian + Clone, F> Trajectory<&L, F> {
    /// Returns the trajectory with its own copy of the system; the original may then change or be dropped.
    ///
    #[cfg_attr(
        feature = "std",
        doc = r#"
```
use lagrange_core::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(theta)]
#[lagrangian(l^2/2 * theta_dot^2 + g*l*cos(theta))]
struct Pendulum { g: f64, l: f64 }

fn swing(l: f64) -> Result<Trajectory<Pendulum>, Error> {
    let pendulum = Pendulum { g: 9.81, l };
    Ok(pendulum.integrate(State::at_rest([0.1]), 2.0, Dop853::default())?.into_owned())
}

assert!(swing(2.0)?.end().coordinate("theta")? < 0.1);
# Ok::<(), Error>(())
```
"#
    )]
    /// For a system in an `Arc` or an `Rc`, only the pointer is copied.
    pub fn into_owned(self) -> Trajectory<L, F> {
        let Self { system, path, ending, statistics, adjustment, field } = self;
        Trajectory { system: system.clone(), path, ending, statistics, adjustment, field }
    }
}

impl<S: Lagrangian, F> Trajectory<S, F> {
    pub(crate) fn new(
        system: S,
        path: Path<S::Scalar, S::N>,
        ending: Ending,
        statistics: Statistics,
        adjustment: Adjustment<S::Scalar, S::N>,
    ) -> Self {
        Self { system, path, ending, statistics, adjustment, field: PhantomData }
    }

    /// Returns the trajectory, unless a failure kept it from its end. Terminal events and cancelled runs count
    /// as finished.
    ///
    /// # Errors
    /// [`Error::Unfinished`] with the [`ending`](Self::ending).
    pub fn finished(self) -> Result<Self, Error> {
        self.check_finished()?;
        Ok(self)
    }

    /// Checks that no failure kept the trajectory from its end.
    pub(crate) fn check_finished(&self) -> Result<(), Error> {
        let is_failure = self.ending.is_failure();
        if is_failure { Err(self.ending.clone().into()) } else { Ok(()) }
    }

    pub(crate) fn start_time(&self) -> S::Scalar {
        self.path.start.t
    }

    pub(crate) fn last_state(&self) -> &StateOf<S> {
        &self.path.last
    }

    /// Returns the system.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// Returns the reason why the trajectory ends: end time, terminal event, cancelled, or a failure, which
    /// [`towards`](crate::MotionBuilder::towards) does not return as an error.
    pub fn ending(&self) -> &Ending {
        &self.ending
    }

    /// Returns the crossings of the [events](crate::MotionBuilder::event), in the order of the motion.
    pub fn crossings(&self) -> &[Crossing<S::Scalar, S::N>] {
        &self.path.crossings
    }

    /// Returns the numbers of steps and evaluations.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// Returns the displacement of the initial state by its projection onto the constraints.
    pub fn adjustment(&self) -> &Adjustment<S::Scalar, S::N> {
        &self.adjustment
    }

    /// True if the constraints were independent throughout. If not, the motion is still correct, and the
    /// multipliers are those of least Euclidean norm.
    pub fn multipliers_are_unique(&self) -> bool {
        self.statistics.multipliers_are_unique
    }
}

impl<S: Lagrangian<Scalar: Real> + Clone, F: VectorField<S>> Trajectory<S, F> {
    /// Returns the sample at this time.
    ///
    /// # Errors
    /// [`Error::OutsideTrajectory`]; [`Error::NotProjected`], or in (q, p) an error of the search for the
    /// velocity, if the interpolated state cannot be projected onto the constraints.
    pub fn at(&self, t: S::Scalar) -> Result<Sample<S>, Error> {
        self.state_at(t).map(|state| self.sample(state))
    }

    /// Returns the first state, made consistent.
    pub fn start(&self) -> Sample<S> {
        self.sample(*self.path.start)
    }

    /// Returns the last state.
    pub fn end(&self) -> Sample<S> {
        self.sample(*self.path.last)
    }

    /// Returns the states that the method computed, first and last included.
    pub fn steps(&self) -> impl Iterator<Item = Sample<S>> + '_ {
        self.states_of_steps().map(|state| self.sample(state))
    }

    /// Returns `count` states at evenly spaced times, first and last included. If [`at`](Self::at) fails,
    /// coordinates and velocities are NaN.
    pub fn samples(&self, count: usize) -> impl Iterator<Item = Sample<S>> + '_ {
        self.states(count).map(|state| self.sample(state))
    }

    pub(super) fn sample(&self, state: StateOf<S>) -> Sample<S> {
        Sample { system: self.system.clone(), state }
    }
}

impl<S: Lagrangian<Scalar: Real>, F: VectorField<S>> Trajectory<S, F> {
    pub(crate) fn states_of_steps(&self) -> impl Iterator<Item = StateOf<S>> + '_ {
        let starts = (0..self.statistics.accepted).filter_map(|i| self.path.start_of(i));
        starts.map(|point| F::state(&self.system, &point)).chain(once(*self.path.last))
    }

    pub(super) fn states(&self, count: usize) -> impl Iterator<Item = StateOf<S>> + '_ {
        let (first, last) = (self.path.start.t, self.path.last.t);
        let intervals = count.saturating_sub(1).max(1);
        let nowhere = vector(Array::filled(S::Scalar::constant(f64::NAN)));
        (0..count).map(move |i| {
            let t = between(first, last, i as f64 / intervals as f64);
            self.state_at(t).unwrap_or(State { t, q: nowhere, v: nowhere })
        })
    }

    /// Returns the state at a time. An interpolated state violates the constraints by about the tolerance, so
    /// it is projected.
    pub(crate) fn state_at(&self, t: S::Scalar) -> Result<StateOf<S>, Error> {
        if t == self.path.last.t {
            return Ok(*self.path.last);
        }
        match self.path.at(t) {
            Some(point) => F::project(&self.system, &point),
            None => Err(Error::OutsideTrajectory {
                time: t.to_f64(),
                start: self.path.start.t.to_f64(),
                end: self.path.last.t.to_f64(),
            }),
        }
    }
}

/// A summary: first and last time, numbers of steps, evaluations and crossings, and the ending.
impl<S: Lagrangian<Scalar: Real>, F> Display for Trajectory<S, F> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Statistics { accepted, rejected, evaluations, .. } = self.statistics;
        write!(f, "{} from t = {} to t = {}:", S::NAME, self.path.start.t, self.path.last.t)?;
        write!(f, " {accepted} steps, {rejected} rejected, {evaluations} evaluations")?;
        match self.path.crossings.len() {
            0 => {}
            1 => write!(f, ", 1 crossing")?,
            count => write!(f, ", {count} crossings")?,
        }
        write!(f, "\n{}", self.ending)
    }
}

impl<S: Lagrangian, F> Debug for Trajectory<S, F> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Trajectory")
            .field("system", &S::NAME)
            .field("start", &*self.path.start)
            .field("end", &*self.path.last)
            .field("ending", &self.ending)
            .field("statistics", &self.statistics)
            .finish()
    }
}

/// Interpolates between two times. Rounding neither passes the last time nor overflows.
pub(crate) fn between<T: Real>(first: T, last: T, part: f64) -> T {
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
