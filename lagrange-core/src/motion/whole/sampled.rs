//! Settings of a motion that keeps no steps: samples, quantities and a controller.

use alloc::boxed::Box;
use alloc::string::ToString;
use alloc::vec::Vec;
use core::fmt::{self, Debug, Display, Formatter};

use super::builder::{AllSteps, EventList, MotionBuilder, Start};
use super::progress::{OnProgress, report};
use super::record::{Arrival, Moving, Record, RecordPlan, Recorded, SampleTimes, Steering};
use crate::error::Error;
use crate::motion::event::{DynEvent, EventValue};
use crate::motion::method::Method;
use crate::motion::run::{Run, Watchdog, check_end};
use crate::number::Real;
use crate::solution::Sample;
use crate::solution::system_checks::SystemChecks;
use crate::solution::vector_field::VectorField;
use crate::system::{StateOf, System, check_contacts};

/// Marks a motion that keeps samples alone: `to` returns an [`Arrival`].
pub struct SamplesAlone<'w, L: System> {
    pub(crate) plan: RecordPlan<'w, L>,
    /// Controller, and the copy of the system that it changes.
    pub(crate) steered: Option<(Steering<'w, L>, L)>,
}

impl<L: System> Debug for SamplesAlone<'_, L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("SamplesAlone").field("is_steered", &self.steered.is_some()).finish_non_exhaustive()
    }
}

impl<'w, L: System<Scalar: Real>> SamplesAlone<'w, L> {
    /// Checks the sample times and the interval of the controller, as far as they do not depend on start and end.
    pub(crate) fn check(&self) -> Result<(), Error> {
        self.plan.check()?;
        self.steered.as_ref().map_or(Ok(()), |(steering, _)| steering.check())
    }

    /// Moves from the start of a run to the time `end`, or to a terminal event, and records the samples.
    pub(crate) fn record<F: VectorField<L>, P: Method<L, F>>(
        self,
        run: &mut Run<L, P, F>,
        method: &P,
        start: &Sample<&L>,
        (events, mut on_progress): (Vec<Box<DynEvent<'w, L>>>, Option<OnProgress<'w>>),
        end: L::Scalar,
    ) -> Result<Arrival<L::Scalar, L::Length>, Error> {
        let Self { plan, steered } = self;
        let (steering, mut own) = steered.unzip();
        let record = Record::begin(&plan, events, steering, start, end)?;
        let from = start.time();
        let accept = |state: &StateOf<L>, steps| report(&mut on_progress, [from, state.t, end], steps);
        let moving = own.as_mut().map_or(Moving::Fixed(*start.system()), Moving::Steered);
        let limits = Watchdog::new(method.limits(), &run.statistics);
        let mut recorded = Recorded::<_, _, _, true>::new(moving, record, accept);
        let driven = run.drive(method, &limits, &mut recorded);
        Ok(recorded.finish(driven, run.state.clone(), run.statistics))
    }
}

/// Selects what a motion keeps: all steps, or samples alone.
pub trait Kept<'w, L: System> {
    /// The same with samples alone.
    type Alone;

    /// Converts to settings with samples alone, and changes them; samples that were already chosen remain.
    #[doc(hidden)]
    fn samples_alone(self, change: impl FnOnce(&mut SamplesAlone<'w, L>)) -> Self::Alone;
}

impl<'w, L: System<Scalar: Real> + 'w> Kept<'w, L> for AllSteps {
    type Alone = SamplesAlone<'w, L>;

    fn samples_alone(self, change: impl FnOnce(&mut SamplesAlone<'w, L>)) -> SamplesAlone<'w, L> {
        let samples = SamplesAlone { plan: RecordPlan::of(SampleTimes::At(Vec::new())), steered: None };
        samples.samples_alone(change)
    }
}

impl<'w, L: System> Kept<'w, L> for SamplesAlone<'w, L> {
    type Alone = Self;

    fn samples_alone(mut self, change: impl FnOnce(&mut Self)) -> Self {
        change(&mut self);
        self
    }
}

/// Settings of a motion from the start `S` that keeps samples alone.
type Sampled<'a, 'w, L, S, P, E, K> = MotionBuilder<'a, 'w, L, S, P, E, <K as Kept<'w, L>>::Alone>;

impl<'a, 'w, L: System<Scalar: Real>, S, P, E, K: Kept<'w, L>> MotionBuilder<'a, 'w, L, S, P, E, K> {
    /// Keeps the states at these times, and no steps: [`to`](MotionBuilder::to) returns an [`Arrival`] that holds one
    /// state per time; for a motion with derivatives a
    /// [`SampledSensitivity`](crate::linearized::SampledSensitivity).
    ///
    /// The states lie on the dense output of the method, projected onto the constraints; samples do not shorten steps.
    /// The times must be in the order of the motion, between its start and its end. Without times, only the end and the
    /// crossings are kept.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// #[derive(Lagrangian)]
    /// #[coordinates(x)]
    /// #[lagrangian(x_dot^2/2 - x^2/2)]
    /// struct Spring;
    ///
    /// let spring = Spring;
    /// let arrival = spring.motion(State::at_rest([1.0])).samples_at([0.5, 1.5]).to(2.0)?;
    /// assert!((arrival.samples[1].q[0] - 1.5_f64.cos()).abs() < 1e-8);
    /// assert!((arrival.state.q[0] - 2.0_f64.cos()).abs() < 1e-8);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn samples_at(self, times: impl IntoIterator<Item = L::Scalar>) -> Sampled<'a, 'w, L, S, P, E, K> {
        let times = times.into_iter().collect();
        self.sampled(|samples| samples.plan.times = SampleTimes::At(times))
    }

    /// Keeps the state at the start and after every interval, and no steps; otherwise like
    /// [`samples_at`](Self::samples_at).
    ///
    /// Sample k is at the start plus k intervals. The last is exactly at the end if the end is a multiple to the
    /// round-off of the times.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// # #[derive(Lagrangian)]
    /// # #[coordinates(x)]
    /// # #[lagrangian(x_dot^2/2 - x^2/2)]
    /// # struct Spring;
    /// let arrival = Spring.motion(State::at_rest([1.0])).every(0.1).to(0.3)?;
    /// // In floating-point arithmetic, 3 · 0.1 is more than 0.3.
    /// assert!(arrival.samples.iter().map(|state| state.t).eq([0.0, 0.1, 0.2, 0.3]));
    /// # Ok::<(), Error>(())
    /// ```
    pub fn every(self, interval: L::Scalar) -> Sampled<'a, 'w, L, S, P, E, K> {
        self.sampled(|samples| samples.plan.times = SampleTimes::Every(interval))
    }

    fn sampled(self, set: impl FnOnce(&mut SamplesAlone<'w, L>)) -> Sampled<'a, 'w, L, S, P, E, K> {
        self.keeping(|kept| kept.samples_alone(set))
    }
}

impl<'a, 'w, L, F, P, E, K> MotionBuilder<'a, 'w, L, Start<L::Scalar, L::Length, F>, P, E, K>
where
    L: System<Scalar: Real>,
    K: Kept<'w, L>,
{
    /// Keeps this quantity of each sample in [`Arrival::values`]; with several quantities, all those of the first
    /// sample come first. The function returns a number, or the result of a query by name, `|sample|
    /// sample.observable("height")`.
    ///
    /// The function is also evaluated at the start, so that an error there is returned before the first step. An error
    /// at a later sample ends the motion.
    pub fn quantity<V: EventValue<L::Scalar>>(
        self,
        name: &'static str,
        function: impl Fn(&Sample<&L>) -> V + Send + Sync + 'w,
    ) -> Sampled<'a, 'w, L, Start<L::Scalar, L::Length, F>, P, E, K> {
        self.sampled(|samples| samples.plan.quantity(name, function))
    }

    /// Steers the motion by a controller, which is called at the start and then after every interval. It reads the
    /// state and sets parameters of the motion's own copy of the system. They hold until the next call (zero-order
    /// hold).
    ///
    /// The time of each call is reached exactly. Samples are taken before the call at their time. Events are searched
    /// anew from each call on, so a jump of their function there is no crossing. No steps are kept, because dense
    /// output can be evaluated only while the parameters of its step are known.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// /// A pendulum with a motor at the pivot.
    /// #[derive(Clone, Lagrangian)]
    /// #[coordinates(theta)]
    /// #[lagrangian(theta_dot^2/2 + g*cos(theta))]
    /// #[force(theta: torque)]
    /// struct Pendulum { g: f64, torque: f64 }
    ///
    /// let (pendulum, upright) = (Pendulum { g: 9.81, torque: 0.0 }, core::f64::consts::PI);
    /// let steered = pendulum.motion(State::at_rest([3.0])).by(Dopri5::with_tolerance(1e-6)).every(0.1);
    /// let steered = steered.quantity("torque", |sample| sample.system().torque);
    /// let arrival = steered
    ///     .controlled(0.01, |pendulum, state| {
    ///         pendulum.torque = 30.0 * (upright - state.q[0]) - 8.0 * state.v[0];
    ///         if pendulum.torque.abs() < 100.0 { Ok(()) } else { Err("the motor is too weak") }
    ///     })
    ///     .to(5.0)?;
    /// assert!((arrival.state.q[0] - upright).abs() < 1e-6);
    /// assert_eq!(arrival.samples.len(), arrival.values.len());
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// An error of the controller ends the motion, with [`Ending::ControllerFailed`](crate::Ending::ControllerFailed).
    /// [`to`](MotionBuilder::to) returns [`Error::Setting`] for an interval that is not positive and finite. An
    /// interval too short to advance the time ends the motion with
    /// [`Ending::TimeTooCoarse`](crate::Ending::TimeTooCoarse).
    pub fn controlled<X: Display>(
        self,
        interval: L::Scalar,
        mut controller: impl FnMut(&mut L, &StateOf<L>) -> Result<(), X> + 'w,
    ) -> Sampled<'a, 'w, L, Start<L::Scalar, L::Length, F>, P, E, K>
    where
        L: Clone,
    {
        let controller = Box::new(move |system: &mut L, state: &StateOf<L>| {
            controller(system, state).map_err(|error| error.to_string())
        });
        let steered = Some((Steering { interval, controller }, self.system.clone()));
        self.sampled(|samples| samples.steered = steered)
    }
}

impl<'w, L: System<Scalar: Real>, F, P, E>
    MotionBuilder<'_, 'w, L, Start<L::Scalar, L::Length, F>, P, E, SamplesAlone<'w, L>>
{
    /// Integrates to the time `end`, or to the first [terminal](crate::Event::terminal) event. If `end` is before the
    /// start, it integrates backwards.
    ///
    /// # Errors
    /// The errors of a motion that is [stored](crate::Simulate::motion); [`Error::SampleTime`],
    /// [`Error::OutsideTrajectory`] and [`Error::Setting`] for samples that cannot be taken; errors of the function of
    /// a quantity at the start.
    pub fn to(self, end: L::Scalar) -> Result<Arrival<L::Scalar, L::Length>, Error>
    where
        F: VectorField<L>,
        P: Method<L, F>,
        E: EventList<DynEvent<'w, L>>,
    {
        self.towards(end)?.finished()
    }

    /// Integrates towards the time `end`. If the motion fails on the way, the result holds the record up to there, and
    /// its ending the reason.
    ///
    /// # Errors
    /// The errors of [`to`](Self::to) that are found before the first step.
    pub fn towards(self, end: L::Scalar) -> Result<Arrival<L::Scalar, L::Length>, Error>
    where
        F: VectorField<L>,
        P: Method<L, F>,
        E: EventList<DynEvent<'w, L>>,
    {
        const { check_contacts(F::Checks::HAS_CONTACTS) };
        let Self { system, start, method, events, on_progress, kept } = self;
        let state = start.state.as_ref().as_ref().map_err(Error::clone)?;
        check_end(end)?;
        kept.check()?;
        let mut begun = Run::<L, P, F>::begin(system, state, &method);
        let (run, _) = begun.as_mut().map_err(|error| error.clone())?;
        let start = Sample::of(system, run.state.clone());
        kept.record(run, &method, &start, (events.list(), on_progress), end)
    }
}
