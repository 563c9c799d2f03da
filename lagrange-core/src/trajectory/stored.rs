//! The steps of a motion that were stored, and everything in between.

use core::fmt::{self, Debug, Formatter};
use core::iter::once;
use core::marker::PhantomData;

use super::path::Path;
use crate::error::{Ending, Error};
use crate::number::{Real, Scalar, vector};
use crate::solution::crossing::Crossing;
use crate::solution::vector_field::{LagrangianVectorField, VectorField};
use crate::solution::{Adjustment, Sample};
use crate::statistics::Statistics;
use crate::system::{Lagrangian, State};

/// The motion of a system from the start to where the integration stopped.
///
/// Between the steps it is the continuous extension of the method, projected onto the constraints like the steps
/// themselves: continuous, and equal to the states computed at their times.
///
/// The system `S` is borrowed by the call that integrates, `Trajectory<&Pendulum, 3, 1>`;
/// [`into_owned`](Self::into_owned) makes it one that borrows nothing, `Trajectory<Pendulum, 3, 1>`. The flow `F` says
/// which equations were integrated, Lagrange's or Hamilton's; a sample has both velocities and momenta.
pub struct Trajectory<S: Lagrangian<N, M>, const N: usize, const M: usize, F = LagrangianVectorField> {
    pub(super) system: S,
    pub(super) path: Path<S::Scalar, N>,
    ending: Ending,
    statistics: Statistics,
    adjustment: Adjustment<S::Scalar, N>,
    field: PhantomData<F>,
}

impl<L: Lagrangian<N, M> + Clone, F, const N: usize, const M: usize> Trajectory<&L, N, M, F> {
    /// The trajectory with a copy of the system, which may then change or go away.
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

fn swing(l: f64) -> Result<Trajectory<Pendulum, 1, 0>, Error> {
    let pendulum = Pendulum { g: 9.81, l };
    Ok(pendulum.integrate(State::at_rest([0.1]), 2.0, Dop853::default())?.into_owned())
}

assert!(swing(2.0)?.end().coordinate("theta")? < 0.1);
# Ok::<(), Error>(())
```
"#
    )]
    /// Of a system in an `Arc` or an `Rc` only the pointer is copied.
    pub fn into_owned(self) -> Trajectory<L, N, M, F> {
        let Self { system, path, ending, statistics, adjustment, field } = self;
        Trajectory { system: system.clone(), path, ending, statistics, adjustment, field }
    }
}

impl<S: Lagrangian<N, M>, F, const N: usize, const M: usize> Trajectory<S, N, M, F> {
    pub(crate) fn new(
        system: S,
        path: Path<S::Scalar, N>,
        ending: Ending,
        statistics: Statistics,
        adjustment: Adjustment<S::Scalar, N>,
    ) -> Self {
        Self { system, path, ending, statistics, adjustment, field: PhantomData }
    }

    /// The trajectory, if nothing but the caller or an event kept it from its end.
    ///
    /// # Errors
    /// [`Error::Unfinished`] with the [`ending`](Self::ending).
    pub fn finished(self) -> Result<Self, Error> {
        self.check_finished()?;
        Ok(self)
    }

    /// Whether it is [`finished`](Self::finished).
    pub(crate) fn check_finished(&self) -> Result<(), Error> {
        let is_failure = self.ending.is_failure();
        if is_failure { Err(self.ending.clone().into()) } else { Ok(()) }
    }

    /// The system that moves.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// Why the trajectory ends where it does: it reached its end or a terminal event, or was cancelled; or it failed, of which
    /// [`towards`](crate::MotionBuilder::towards) makes no error.
    pub fn ending(&self) -> &Ending {
        &self.ending
    }

    /// The crossings of the [events](crate::MotionBuilder::event), in the order of the motion.
    pub fn crossings(&self) -> &[Crossing<S::Scalar, N>] {
        &self.path.crossings
    }

    /// Steps and evaluations.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// How far the start was moved onto the constraints.
    pub fn adjustment(&self) -> &Adjustment<S::Scalar, N> {
        &self.adjustment
    }

    /// Whether the constraints were independent all along. Where not, the motion is right all the same, and the
    /// multipliers are the ones of least Euclidean norm.
    pub fn multipliers_are_unique(&self) -> bool {
        self.statistics.multipliers_are_unique
    }
}

impl<S, F, const N: usize, const M: usize> Trajectory<S, N, M, F>
where
    S: Lagrangian<N, M, Scalar: Real> + Clone,
    F: VectorField<S, N, M>,
{
    /// The state at this time.
    ///
    /// # Errors
    /// [`Error::OutsideTrajectory`]; [`Error::NotProjected`], or in (q, p) what finding the velocity gives, where no way
    /// leads from between the steps onto the constraints.
    pub fn at(&self, t: S::Scalar) -> Result<Sample<S, N, M>, Error> {
        self.state_at(t).map(|state| self.sample(state))
    }

    /// The first state, made consistent.
    pub fn start(&self) -> Sample<S, N, M> {
        self.sample(*self.path.start)
    }

    /// The last state.
    pub fn end(&self) -> Sample<S, N, M> {
        self.sample(*self.path.last)
    }

    /// The states that the method computed, first and last included.
    pub fn steps(&self) -> impl Iterator<Item = Sample<S, N, M>> + '_ {
        self.states_of_steps().map(|state| self.sample(state))
    }

    /// `count` states at evenly spaced times, first and last included. Where [`at`](Self::at) gives an error, all but the
    /// time is NaN.
    pub fn samples(&self, count: usize) -> impl Iterator<Item = Sample<S, N, M>> + '_ {
        self.states(count).map(|state| self.sample(state))
    }

    pub(super) fn sample(&self, state: State<S::Scalar, N>) -> Sample<S, N, M> {
        Sample { system: self.system.clone(), state }
    }
}

impl<S: Lagrangian<N, M, Scalar: Real>, F: VectorField<S, N, M>, const N: usize, const M: usize>
    Trajectory<S, N, M, F>
{
    pub(super) fn states_of_steps(&self) -> impl Iterator<Item = State<S::Scalar, N>> + '_ {
        let starts = (0..self.statistics.accepted).filter_map(|i| self.path.start_of(i));
        starts.map(|point| F::state(&self.system, &point)).chain(once(*self.path.last))
    }

    pub(super) fn states(&self, count: usize) -> impl Iterator<Item = State<S::Scalar, N>> + '_ {
        let (first, last) = (self.path.start.t, self.path.last.t);
        let intervals = count.saturating_sub(1).max(1);
        let nowhere = vector([S::Scalar::constant(f64::NAN); N]);
        (0..count).map(move |i| {
            let t = between(first, last, i as f64 / intervals as f64);
            self.state_at(t).unwrap_or(State { t, q: nowhere, v: nowhere })
        })
    }

    /// An interpolated state is off the constraints by about the tolerance: it is projected.
    pub(super) fn state_at(&self, t: S::Scalar) -> Result<State<S::Scalar, N>, Error> {
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

impl<S: Lagrangian<N, M>, F, const N: usize, const M: usize> Debug for Trajectory<S, N, M, F> {
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

/// Interpolates between two times; rounding leads neither past the last one nor to infinity.
pub(super) fn between<T: Real>(first: T, last: T, part: f64) -> T {
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
