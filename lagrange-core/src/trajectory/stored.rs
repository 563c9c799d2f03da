//! Trajectories: the result of a motion.

use alloc::vec::Vec;
use core::fmt::{self, Debug, Display, Formatter};
use core::marker::PhantomData;

use super::kept::{KeptStates, Legs};
use super::leg::{Leg, outside};
use super::transition::{Transition, write_counts};
use crate::error::{Ending, Error};
use crate::number::{Real, Scalar};
use crate::solution::crossing::Crossing;
use crate::solution::system_checks::SystemChecks;
use crate::solution::vector_field::VectorField;
use crate::solution::{Adjustment, Sample};
use crate::statistics::Statistics;
use crate::system::{State, System};

/// Motion of a system from its start to the end of the integration. It prints as a summary.
///
/// Between the steps the trajectory is the dense output of the method, projected onto the constraints like the
/// steps themselves. It is continuous and equals the computed states at their times.
///
/// Across [contacts](crate::contact) the motion consists of [legs](Self::legs) between its [transitions](Self::transitions), each with a
/// system whose contacts are open or closed as in the leg. At a transition, states are those after it; those before it end the
/// legs. Without contacts there is one leg, and no transition.
///
/// ```
/// use lagrange_core::contact::Contact;
/// use lagrange_core::prelude::*;
///
/// #[derive(Clone, Lagrangian)]
/// #[coordinates(y)]
/// #[lagrangian(y_dot^2/2 - g*y)]
/// #[observable(height = y)]
/// #[contact(floor: y >= 0)]
/// struct Stone { g: f64, floor: Contact }
///
/// let stone = Stone { g: 9.81, floor: Contact::Open };
/// let path = stone.motion(State::at_rest([1.0])).with_contacts().to(1.0)?;
/// assert_eq!(path.at(0.9)?.observable("height")?, 0.0);
/// assert_eq!(path.at(0.9)?.multiplier("floor")?, 9.81);
/// assert_eq!(path.csv(50).to_string().lines().next(), Some("t,y,y_dot,lambda(floor),force(y),height"));
/// let text = path.to_string();
/// assert!(text.contains("\n1 impact, 1 closing; closed at the end: `floor`\nreached the end at t = 1"), "{text}");
/// # Ok::<(), Error>(())
/// ```
///
/// By [time steps](crate::contact::MoreauJean) there is one leg. Between the ends of a step, states are linear in the time; accelerations and multipliers of a sample are the means over the step that leads there, at the start over the first, and
/// NaN without steps. The system of a sample has all contacts closed, so that their forces count; that of the leg has all open.
///
/// The call that integrates borrows the system `S`: `Trajectory<&Pendulum>`.
/// [`into_owned`](Self::into_owned) returns a trajectory with its own copy of the system,
/// `Trajectory<Pendulum>`; across contacts it has copies from the start. The vector field `F` tells which equations were integrated,
/// Lagrange's or Hamilton's; samples have both velocities and momenta. `K` tells what is kept: all steps, or after
/// [`every`](crate::MotionBuilder::every) and [`samples_at`](crate::MotionBuilder::samples_at) samples alone, a
/// [`SampledTrajectory`](super::SampledTrajectory). Its ends, crossings, transitions, ending and statistics are found in the same way.
pub struct Trajectory<S: System, F = <S as System>::Field, K = Legs<S, F>> {
    pub(crate) kept: K,
    pub(crate) transitions: Vec<Transition<S::Scalar>>,
    /// Contacts that are closed at the end.
    pub(crate) closed: Vec<&'static str>,
    pub(crate) crossings: Vec<Crossing<S::Scalar, S::Length>>,
    pub(crate) ending: Ending,
    pub(crate) statistics: Statistics,
    pub(crate) adjustment: Adjustment<S::Scalar, S::Length>,
    pub(crate) field: PhantomData<F>,
}

impl<L: System + Clone, F> Trajectory<&L, F> {
    /// Returns the trajectory with its own copy of the system; the original may then change or be dropped.
    ///
    /// ```
    /// use lagrange_core::prelude::*;
    ///
    /// #[derive(Clone, Lagrangian)]
    /// #[coordinates(theta)]
    /// #[lagrangian(l^2/2 * theta_dot^2 + g*l*cos(theta))]
    /// struct Pendulum { g: f64, l: f64 }
    ///
    /// fn swing(l: f64) -> Result<Trajectory<Pendulum>, Error> {
    ///     let pendulum = Pendulum { g: 9.81, l };
    ///     Ok(pendulum.integrate(State::at_rest([0.1]), 2.0, Dop853::default())?.into_owned())
    /// }
    ///
    /// assert!(swing(2.0)?.end().coordinate("theta")? < 0.1);
    /// # Ok::<(), Error>(())
    /// ```
    /// For a system in an `Arc` or an `Rc`, only the pointer is copied.
    pub fn into_owned(self) -> Trajectory<L, F> {
        self.map(|Legs(legs)| Legs(legs.into_iter().map(Leg::into_owned).collect()))
    }
}

impl<S: System, F, K> Trajectory<S, F, K> {
    /// A motion without transitions.
    pub(crate) fn of(
        kept: K,
        crossings: Vec<Crossing<S::Scalar, S::Length>>,
        ending: Ending,
        statistics: Statistics,
        adjustment: Adjustment<S::Scalar, S::Length>,
    ) -> Self {
        let (transitions, closed, field) = (Vec::new(), Vec::new(), PhantomData);
        Self { kept, transitions, closed, crossings, ending, statistics, adjustment, field }
    }

    /// The same trajectory, with what it keeps changed, of a system of the same kind.
    pub(super) fn map<O, J>(self, change: impl FnOnce(K) -> J) -> Trajectory<O, F, J>
    where
        O: System<Scalar = S::Scalar, Length = S::Length>,
    {
        let Self { kept, transitions, closed, crossings, ending, statistics, adjustment, field } = self;
        let kept = change(kept);
        Trajectory { kept, transitions, closed, crossings, ending, statistics, adjustment, field }
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

    /// Returns the transitions in the order in which they are decided. This is the order of time, except that the time of a
    /// [`Transition::Rests`] is when its last bounces end. At one time, impacts come before contacts that close and open.
    pub fn transitions(&self) -> &[Transition<S::Scalar>] {
        &self.transitions
    }

    /// Returns the reason why the trajectory ends: end time, terminal event, cancelled, or a failure, which
    /// [`towards`](crate::MotionBuilder::towards) does not return as an error.
    pub fn ending(&self) -> &Ending {
        &self.ending
    }

    /// Returns the crossings of the [events](crate::MotionBuilder::event), in the order of the motion; at a transition, the state
    /// is that before it. A function that jumps at a transition does not cross there. A terminal event ends the motion before
    /// the transition.
    pub fn crossings(&self) -> &[Crossing<S::Scalar, S::Length>] {
        &self.crossings
    }

    /// Returns the numbers of steps and evaluations.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// Returns the displacement of the initial state by its projection onto the constraints.
    pub fn adjustment(&self) -> &Adjustment<S::Scalar, S::Length> {
        &self.adjustment
    }

    /// True if the constraints were independent throughout. If not, the motion is still correct, and the
    /// multipliers are those of least norm in units in which masses are 1 and the rows of F have length 1. Time steps do not examine it: theirs are shared as if all contacts were equally stiff.
    pub fn multipliers_are_unique(&self) -> bool {
        self.statistics.multipliers_are_unique
    }
}

impl<S: System<Scalar: Real>, F: VectorField<S>, K: KeptStates<S>> Trajectory<S, F, K> {
    /// Returns the system, with its contacts as they are at the end.
    pub fn system(&self) -> &S {
        self.kept.system()
    }

    /// Returns the first state, made consistent; across contacts, that after what happens at the start.
    pub fn start(&self) -> Sample<S>
    where
        S: Clone,
    {
        self.kept.first().into_owned()
    }

    /// Returns the last state.
    pub fn end(&self) -> Sample<S>
    where
        S: Clone,
    {
        self.kept.last().into_owned()
    }
}

impl<S: System, F> Trajectory<S, F> {
    pub(crate) fn first_leg(&self) -> &Leg<S, F> {
        self.kept.leg_at_start()
    }

    /// Times of start and end.
    pub(super) fn times(&self) -> [S::Scalar; 2] {
        [self.first_leg().first().t, self.kept.leg_at_end().last().t]
    }

    /// Returns the legs between the transitions, one at least. A transition at the end of the motion is followed by a leg without steps.
    pub fn legs(&self) -> &[Leg<S, F>] {
        &self.kept.0
    }

    /// The transitions before each leg, after the one before it.
    pub(crate) fn transitions_before_legs(&self) -> impl Iterator<Item = &[Transition<S::Scalar>]> {
        let starts = core::iter::once(0).chain(self.legs().iter().map(|leg| leg.transitions));
        starts.zip(self.legs()).map(|(from, leg)| &self.transitions[from..leg.transitions])
    }
}

impl<S: System<Scalar: Real> + Clone, F: VectorField<S>> Trajectory<S, F> {
    /// Returns the sample at this time, with the system as it is then; at a transition, that after it.
    ///
    /// # Errors
    /// [`Error::OutsideTrajectory`]; [`Error::NotProjected`], or in (q, p) an error of the search for the
    /// velocity, if the interpolated state cannot be projected onto the constraints.
    pub fn at(&self, t: S::Scalar) -> Result<Sample<S>, Error> {
        self.leg_at(t).at(t).map_err(|error| self.outside(error, t))
    }

    /// Returns the states that the method computed, first and last included; at a transition, the state before it and the
    /// state after it.
    pub fn steps(&self) -> impl Iterator<Item = Sample<S>> + '_ {
        self.legs().iter().flat_map(Leg::steps)
    }

    /// Returns `count` states at evenly spaced times, first and last included. If [`at`](Self::at) fails,
    /// coordinates and velocities are NaN.
    pub fn samples(&self, count: usize) -> impl Iterator<Item = Sample<S>> + '_ {
        self.borrowed_samples(count).map(Sample::into_owned)
    }
}

impl<S: System<Scalar: Real>, F: VectorField<S>> Trajectory<S, F> {
    /// Samples at evenly spaced times.
    pub(super) fn borrowed_samples(&self, count: usize) -> impl Iterator<Item = Sample<&S>> {
        let [first, last] = self.times();
        let intervals = count.saturating_sub(1).max(1);
        let nowhere = self
            .first_leg()
            .first()
            .each_with(self.first_leg().first(), |_, _| S::Scalar::constant(f64::NAN));
        (0..count).map(move |i| {
            let t = between(first, last, i as f64 / intervals as f64);
            let leg = self.leg_at(t);
            leg.sample_at(t).unwrap_or_else(|_| Sample::of(leg.system(), State { t, ..nowhere.clone() }))
        })
    }

    /// The last leg that starts at this time or before.
    fn leg_at(&self, t: S::Scalar) -> &Leg<S, F> {
        let [start, end] = self.times();
        let has_begun = |leg: &Leg<S, F>| match end < start {
            true => leg.first().t >= t,
            false => leg.first().t <= t,
        };
        &self.legs()[self.legs().partition_point(has_begun).saturating_sub(1)]
    }

    /// Replaces the times of a leg in an error by those of the motion.
    fn outside(&self, error: Error, t: S::Scalar) -> Error {
        if let Error::OutsideTrajectory { .. } = error { outside(t, self.times()) } else { error }
    }
}

/// A summary: first and last time, numbers of steps, evaluations and crossings, across contacts the transitions by their kind and the
/// contacts that are closed at the end, and the ending.
impl<S: System<Scalar: Real>, F: VectorField<S>, K: KeptStates<S>> Display for Trajectory<S, F, K> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Statistics { accepted, rejected, evaluations, .. } = self.statistics;
        let [start, end] = [self.kept.first().time(), self.kept.last().time()];
        write!(f, "{} from t = {start} to t = {end}:", F::Checks::name())?;
        match self.kept.is_in_time_steps() {
            true => write!(f, " {accepted} time steps, {evaluations} evaluations")?,
            false => write!(f, " {accepted} steps, {rejected} rejected, {evaluations} evaluations")?,
        }
        match self.crossings.len() {
            0 => {}
            1 => write!(f, ", 1 crossing")?,
            count => write!(f, ", {count} crossings")?,
        }
        if F::Checks::HAS_CONTACTS && !self.kept.is_in_time_steps() {
            writeln!(f)?;
            write_counts(&self.transitions, f)?;
        }
        let mut before = "; closed at the end: ";
        for contact in &self.closed {
            write!(f, "{before}`{contact}`")?;
            before = ", ";
        }
        write!(f, "\n{}", self.ending)
    }
}

impl<S: System<Scalar: Real>, F: VectorField<S>, K: KeptStates<S>> Debug for Trajectory<S, F, K> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Trajectory")
            .field("system", &F::Checks::name())
            .field("start", self.kept.first().state())
            .field("end", self.kept.last().state())
            .field("ending", &self.ending)
            .field("statistics", &self.statistics)
            .field("transitions", &self.transitions.len())
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
