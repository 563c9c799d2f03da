//! Settings of a motion that keeps no steps: samples, quantities and a controller.

use alloc::boxed::Box;
use alloc::string::ToString;
use alloc::vec::Vec;
use core::fmt::{self, Debug, Display, Formatter};

use super::builder::{AllSteps, EventList, Integrates, MotionBuilder, Start};
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
use crate::trajectory::{SampledTrajectory, Samples};

/// Marks a motion that keeps samples alone: `to` returns a [`SampledTrajectory`]. `C` is [`Steered`] for a motion with a controller.
pub struct SamplesAlone<'w, L: System, C = ()> {
    plan: RecordPlan<'w, L>,
    control: C,
}

/// Marks a motion that a controller steers: the trajectory has the system as the controller leaves it.
pub struct Steered<'w, L: System> {
    steering: Steering<'w, L>,
    /// The copy of the system that the controller changes.
    own: L,
}

/// Selects what a motion keeps: all steps, or samples alone.
pub trait Kept<'w, L: System> {
    /// The same with samples alone.
    type Alone;
    /// The same with samples alone and a controller.
    type Steered;

    /// Converts to settings with samples alone, and changes them; samples that were already chosen remain.
    #[doc(hidden)]
    fn samples_alone(self, change: impl FnOnce(&mut RecordPlan<'w, L>)) -> Self::Alone;

    /// Adds the controller, in the place of one that was chosen before.
    #[doc(hidden)]
    fn steered(self, control: Steered<'w, L>) -> Self::Steered;
}

/// A controller and the copy of the system that it changes, or `()`.
pub trait Controls<'a, 'w, L: System> {
    /// The system of the trajectory: borrowed, or the copy that a controller has changed.
    type System: System<Scalar = L::Scalar, Length = L::Length, M = L::M> + Clone;

    #[doc(hidden)]
    fn parts(self) -> (Option<Steering<'w, L>>, Option<L>);

    #[doc(hidden)]
    fn at_end(system: &'a L, own: Option<L>) -> Self::System;
}

impl<'w, L: System<Scalar: Real> + 'w> Kept<'w, L> for AllSteps {
    type Alone = SamplesAlone<'w, L>;
    type Steered = SamplesAlone<'w, L, Steered<'w, L>>;

    fn samples_alone(self, change: impl FnOnce(&mut RecordPlan<'w, L>)) -> SamplesAlone<'w, L> {
        let samples = SamplesAlone { plan: RecordPlan::of(SampleTimes::At(Vec::new())), control: () };
        samples.samples_alone(change)
    }

    fn steered(self, steered: Steered<'w, L>) -> Self::Steered {
        self.samples_alone(|_| ()).steered(steered)
    }
}

impl<'w, L: System, C> Kept<'w, L> for SamplesAlone<'w, L, C> {
    type Alone = Self;
    type Steered = SamplesAlone<'w, L, Steered<'w, L>>;

    fn samples_alone(mut self, change: impl FnOnce(&mut RecordPlan<'w, L>)) -> Self {
        change(&mut self.plan);
        self
    }

    fn steered(self, control: Steered<'w, L>) -> Self::Steered {
        SamplesAlone { plan: self.plan, control }
    }
}

impl<'a, 'w, L: System + 'a> Controls<'a, 'w, L> for ()
where
    &'a L: System<Scalar = L::Scalar, Length = L::Length, M = L::M>,
{
    type System = &'a L;

    fn parts(self) -> (Option<Steering<'w, L>>, Option<L>) {
        (None, None)
    }

    fn at_end(system: &'a L, _: Option<L>) -> &'a L {
        system
    }
}

impl<'a, 'w, L: System + Clone> Controls<'a, 'w, L> for Steered<'w, L> {
    type System = L;

    fn parts(self) -> (Option<Steering<'w, L>>, Option<L>) {
        (Some(self.steering), Some(self.own))
    }

    fn at_end(system: &'a L, own: Option<L>) -> L {
        own.unwrap_or_else(|| system.clone())
    }
}

/// Samples of a motion, its controller, and the copy of the system that it changes.
type SampledSettings<'w, L> = (RecordPlan<'w, L>, Option<Steering<'w, L>>, Option<L>);

impl<'a, 'w, L: System<Scalar: Real>, C: Controls<'a, 'w, L>> SamplesAlone<'w, L, C> {
    /// Checks the sample times and the interval of the controller, as far as they do not depend on start and end.
    pub(crate) fn checked(self) -> Result<SampledSettings<'w, L>, Error> {
        let (steering, own) = self.control.parts();
        self.plan.check()?;
        steering.as_ref().map_or(Ok(()), Steering::check)?;
        Ok((self.plan, steering, own))
    }
}

impl<L: System, C: Debug> Debug for SamplesAlone<'_, L, C> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("SamplesAlone").field("plan", &self.plan).field("control", &self.control).finish()
    }
}

impl<L: System> Debug for Steered<'_, L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.steering.fmt(f)
    }
}

/// Moves from the start of a run to the time `end`, or to a terminal event, and records samples. A controller changes the system
/// `own`.
pub(crate) fn record<'w, L: System<Scalar: Real>, F: VectorField<L>, P: Method<L, F>>(
    run: &mut Run<L, P, F>,
    method: &P,
    (start, own): (&Sample<&L>, Option<&mut L>),
    (plan, steering): (&RecordPlan<'w, L>, Option<Steering<'w, L>>),
    (events, mut on_progress): (Vec<Box<DynEvent<'w, L>>>, Option<OnProgress<'w>>),
    end: L::Scalar,
) -> Result<Arrival<L::Scalar, L::Length>, Error> {
    let record = Record::begin(plan, events, steering, start, end)?;
    let from = start.time();
    let accept = |state: &StateOf<L>, steps| report(&mut on_progress, [from, state.t, end], steps);
    let moving = own.map_or(Moving::Fixed(*start.system()), Moving::Steered);
    let limits = Watchdog::new(method.limits(), &run.statistics);
    let mut recorded = Recorded::<_, _, _, true>::new(moving, record, accept);
    let driven = run.drive(method, &limits, &mut recorded);
    Ok(recorded.finish(driven, run.state.clone(), run.statistics))
}

/// Settings of a motion from the start `S` that keeps samples alone.
type Sampled<'a, 'w, L, S, P, E, K> = MotionBuilder<'a, 'w, L, S, P, E, <K as Kept<'w, L>>::Alone>;

/// Settings of a motion from a state that a controller steers.
type Controlled<'a, 'w, L, F, P, E, K> = MotionBuilder<
    'a,
    'w,
    L,
    Start<<L as System>::Scalar, <L as System>::Length, F>,
    P,
    E,
    <K as Kept<'w, L>>::Steered,
>;

impl<'a, 'w, L: System<Scalar: Real>, S, P, E, K: Kept<'w, L>> MotionBuilder<'a, 'w, L, S, P, E, K> {
    /// Keeps the states at these times, and no steps: [`to`](MotionBuilder::to) returns a [`SampledTrajectory`] that holds
    /// one state per time; for a motion with derivatives a
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
    /// let path = spring.motion(State::at_rest([1.0])).samples_at([0.5, 1.5]).to(2.0)?;
    /// assert!((path.samples()[1].q[0] - 1.5_f64.cos()).abs() < 1e-8);
    /// assert!((path.end().coordinate("x")? - 2.0_f64.cos()).abs() < 1e-8);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn samples_at(self, times: impl IntoIterator<Item = L::Scalar>) -> Sampled<'a, 'w, L, S, P, E, K> {
        let times = times.into_iter().collect();
        self.sampled(|plan| plan.times = SampleTimes::At(times))
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
    /// let path = Spring.motion(State::at_rest([1.0])).every(0.1).to(0.3)?;
    /// // In floating-point arithmetic, 3 · 0.1 is more than 0.3.
    /// assert!(path.samples().iter().map(|state| state.t).eq([0.0, 0.1, 0.2, 0.3]));
    /// # Ok::<(), Error>(())
    /// ```
    pub fn every(self, interval: L::Scalar) -> Sampled<'a, 'w, L, S, P, E, K> {
        self.sampled(|plan| plan.times = SampleTimes::Every(interval))
    }

    fn sampled(self, set: impl FnOnce(&mut RecordPlan<'w, L>)) -> Sampled<'a, 'w, L, S, P, E, K> {
        self.keeping(|kept| kept.samples_alone(set))
    }
}

impl<'a, 'w, L, F, P, E, K> MotionBuilder<'a, 'w, L, Start<L::Scalar, L::Length, F>, P, E, K>
where
    L: System<Scalar: Real>,
    K: Kept<'w, L>,
{
    /// Keeps this quantity of each sample: [`SampledTrajectory::quantity`] returns it. The function returns a number, or the result of a query by name, `|sample|
    /// sample.observable("height")`.
    ///
    /// The function is also evaluated at the start, so that an error there is returned before the first step. An error
    /// at a later sample ends the motion.
    pub fn quantity<V: EventValue<L::Scalar>>(
        self,
        name: &'static str,
        function: impl Fn(&Sample<&L>) -> V + Send + Sync + 'w,
    ) -> Sampled<'a, 'w, L, Start<L::Scalar, L::Length, F>, P, E, K> {
        self.sampled(|plan| plan.quantity(name, function))
    }

    /// Steers the motion by a controller, which is called at the start and then after every interval. It reads the
    /// state and sets parameters of the motion's own copy of the system. They hold until the next call (zero-order
    /// hold). A second controller takes the place of the first.
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
    /// let path = steered
    ///     .controlled(0.01, |pendulum, state| {
    ///         pendulum.torque = 30.0 * (upright - state.q[0]) - 8.0 * state.v[0];
    ///         if pendulum.torque.abs() < 100.0 { Ok(()) } else { Err("the motor is too weak") }
    ///     })
    ///     .to(5.0)?;
    /// assert!((path.end().coordinate("theta")? - upright).abs() < 1e-6);
    /// assert_eq!(path.samples().len(), path.quantity("torque")?.count());
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
    ) -> Controlled<'a, 'w, L, F, P, E, K>
    where
        L: Clone,
    {
        let controller = Box::new(move |system: &mut L, state: &StateOf<L>| {
            controller(system, state).map_err(|error| error.to_string())
        });
        let own = self.system.clone();
        self.keeping(|kept| kept.steered(Steered { steering: Steering { interval, controller }, own }))
    }
}

impl<'a, 'w, L, F, P, E, C> Integrates<'a, 'w, L, Start<L::Scalar, L::Length, F>, P, E>
    for SamplesAlone<'w, L, C>
where
    L: System<Scalar: Real>,
    F: VectorField<L>,
    P: Method<L, F>,
    E: EventList<DynEvent<'w, L>>,
    C: Controls<'a, 'w, L>,
{
    type Result = SampledTrajectory<C::System, F>;

    fn run(
        motion: MotionBuilder<'a, 'w, L, Start<L::Scalar, L::Length, F>, P, E, Self>,
        end: L::Scalar,
    ) -> Result<SampledTrajectory<C::System, F>, Error> {
        const { check_contacts(F::Checks::HAS_CONTACTS) };
        let MotionBuilder { system, start, method, events, on_progress, kept } = motion;
        let state = start.state.as_ref().as_ref().map_err(Error::clone)?;
        check_end(end)?;
        let (plan, steering, mut own) = kept.checked()?;
        let mut begun = Run::<L, P, F>::begin(system, state, &method);
        let (run, adjustment) = begun.as_mut().map_err(|error| error.clone())?;
        let start = Sample::of(system, run.state.clone());
        let (along, watched) = ((&plan, steering), (events.list(), on_progress));
        let arrival = record(run, &method, (&start, own.as_mut()), along, watched, end)?;
        let systems = [C::at_end(system, None), C::at_end(system, own)];
        let [first, last] = systems;
        let ends = [(first, start.state()), (last.clone(), &arrival.state)];
        let ends = ends.map(|(system, state)| Sample::of(system, state.clone()));
        let samples = Samples::of(last, ends, &plan);
        Ok(samples.trajectory(arrival, adjustment.clone()))
    }
}
