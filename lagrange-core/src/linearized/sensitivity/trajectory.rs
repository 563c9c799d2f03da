//! A motion with its derivatives by initial values and parameters.

use alloc::{boxed::Box, string::String, string::ToString, vec::Vec};
use core::fmt::{self, Debug, Display, Formatter};
use core::ops::Deref;

use super::across::MotionDerivatives;
use super::along::Along;
use super::course::Course;
use super::events::DifferentiableEvent;
use super::state::StateSensitivity;
use crate::error::{Ending, Error};
use crate::linearized::Linearized;
use crate::linearized::variation::DifferentiableMethod;
use crate::motion::integration::builder::EventList;
use crate::motion::integration::progress::{OnProgress, report};
use crate::motion::integration::record::{Moving, Record, RecordPlan, Recorded};
use crate::motion::integration::store::Stored;
use crate::motion::run::{Run, check_end};
use crate::motion::{
    AllSteps, DynEvent, HasEnding, Integrates, LagrangianVectorField, MotionBuilder, SamplesAlone, Start,
};
use crate::names::Entry;
use crate::number::Real;
use crate::solution::Sample;
use crate::system::finite::check_finite;
use crate::system::{Lagrangian, StateOf, check_contacts, lookup};
use crate::trajectory::{KeptStates, Legs, Samples, Trajectory};

/// A motion with its derivatives by entries of the initial state and by parameters.
///
/// It is read like the motion alone, a [`Trajectory`]: `motion.end()`, `motion.at(t)`, `motion.crossings()`. The call that integrates names
/// the arguments. With constraints, derivatives lie in the tangent space at every time.
pub struct TrajectorySensitivity<'a, L: Linearized<Scalar: Real>, K = Legs<&'a L, LagrangianVectorField>> {
    trajectory: Trajectory<&'a L, LagrangianVectorField, K>,
    course: Course<L>,
    /// Derivatives of the samples, if these alone are kept.
    samples: Vec<StateSensitivity<L::Scalar, L::N>>,
    end: Result<StateSensitivity<L::Scalar, L::N>, Error>,
}

/// A [motion of which samples alone are kept](crate::trajectory::SampledTrajectory), with its derivatives by entries of the initial state
/// and by parameters. It is read like the motion alone.
///
/// ```
/// # use lagrange_core::prelude::*;
/// #[derive(Lagrangian)]
/// #[coordinates(x)]
/// #[lagrangian(x_dot^2/2 - k/2 * x^2)]
/// struct Spring { k: f64 }
///
/// let spring = Spring { k: 1.0 };
/// let motion = spring.motion(State::at_rest([1.0])).derivatives(&["x"])?.every(0.5).to(10.0)?;
/// for sample in motion.derivatives() {
///     // x = x₀ cos t
///     assert!((sample.q[(0, 0)] - sample.state.t.cos()).abs() < 1e-7);
/// }
/// # Ok::<(), Error>(())
/// ```
pub type SampledSensitivity<'a, L> = TrajectorySensitivity<'a, L, Samples<&'a L>>;

impl<'a, L: Linearized<Scalar: Real>, K> Deref for TrajectorySensitivity<'a, L, K> {
    type Target = Trajectory<&'a L, LagrangianVectorField, K>;

    fn deref(&self) -> &Self::Target {
        &self.trajectory
    }
}

impl<L: Linearized<Scalar: Real>, K> HasEnding for TrajectorySensitivity<'_, L, K> {
    fn ending(&self) -> &Ending {
        self.trajectory.ending()
    }
}

/// The summary of the motion.
impl<'a, L: Linearized<Scalar: Real>, K: KeptStates<&'a L>> Display for TrajectorySensitivity<'a, L, K> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        Display::fmt(&self.trajectory, f)
    }
}

impl<'a, L: Linearized<Scalar: Real>, K: KeptStates<&'a L>> Debug for TrajectorySensitivity<'a, L, K> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut text = f.debug_struct("TrajectorySensitivity");
        text.field("trajectory", &self.trajectory).field("arguments", &self.arguments()).finish()
    }
}

impl<'a, L: Linearized<Scalar: Real>, K> TrajectorySensitivity<'a, L, K> {
    /// Returns the motion if it reached its end or a terminal event.
    ///
    /// # Errors
    /// [`Error::Unfinished`] with the ending.
    pub fn finished(self) -> Result<Self, Error> {
        self.trajectory.check_finished()?;
        Ok(self)
    }

    /// Takes the motion without its derivatives, for a leg of a [`HybridTrajectory`](crate::HybridTrajectory) for
    /// example.
    pub fn into_trajectory(self) -> Trajectory<&'a L, LagrangianVectorField, K> {
        self.trajectory
    }

    /// The arguments, in the order of the columns.
    pub fn arguments(&self) -> &[Entry] {
        self.course.variations.arguments()
    }

    /// The last state with its derivatives. If an event ended the motion, they include the derivative of its time;
    /// otherwise they are those at the requested end.
    ///
    /// # Errors
    /// [`Error::Unfinished`] if the motion reached neither; [`Error::Grazing`], and [`Error::EventNotFinite`] if the
    /// function of the event has no derivative; the errors of [`Linearized::jacobian`].
    pub fn derivatives_at_end(&self) -> Result<&StateSensitivity<L::Scalar, L::N>, Error> {
        self.end.as_ref().map_err(Error::clone)
    }
}

impl<L: Linearized<Scalar: Real>> TrajectorySensitivity<'_, L> {
    /// The state at this time, with its derivatives.
    ///
    /// # Errors
    /// The errors of [`Trajectory::at`] and of [`Linearized::jacobian`].
    pub fn derivatives_at(&self, t: L::Scalar) -> Result<StateSensitivity<L::Scalar, L::N>, Error> {
        self.course.at(self.trajectory.system(), self.trajectory.at(t)?.state())
    }

    /// Derivative of coordinate `coordinate` by `argument` at this time.
    ///
    /// # Errors
    /// The errors of [`derivatives_at`](Self::derivatives_at); [`Error::UnknownName`].
    pub fn derivative(&self, t: L::Scalar, coordinate: &str, argument: &str) -> Result<L::Scalar, Error> {
        let row = lookup::index::<L>(L::COORDINATES, "coordinate", coordinate)?;
        let names: Vec<String> = self.arguments().iter().map(Entry::to_string).collect();
        let column = lookup::index::<L>(&names, "argument of these derivatives", argument)?;
        Ok(self.derivatives_at(t)?.q[(row, column)])
    }
}

impl<L: Linearized<Scalar: Real>> SampledSensitivity<'_, L> {
    /// The samples with their derivatives at fixed time.
    pub fn derivatives(&self) -> &[StateSensitivity<L::Scalar, L::N>] {
        &self.samples
    }
}

/// An event of a motion with derivatives.
pub(super) type DynDifferentiableEvent<'a, L> = dyn DifferentiableEvent<L> + 'a;

impl<'a, 'w, L, P, E, J> MotionBuilder<'a, 'w, L, StateSensitivity<L::Scalar, L::N>, P, E, J>
where
    L: Lagrangian<Scalar: Real>,
{
    /// Adds an event made by [`differentiable_event`](crate::MotionDerivatives::differentiable_event), by value or as `&mut event`.
    #[allow(clippy::type_complexity, reason = "the type of the builder itself, with its list of events")]
    pub fn event(
        self,
        event: impl DifferentiableEvent<L> + 'w,
    ) -> MotionBuilder<
        'a,
        'w,
        L,
        StateSensitivity<L::Scalar, L::N>,
        P,
        Vec<Box<DynDifferentiableEvent<'w, L>>>,
        J,
    >
    where
        L: Linearized,
        E: EventList<DynDifferentiableEvent<'w, L>>,
    {
        self.with_events(|events| {
            let mut events = events.list();
            events.push(Box::new(event));
            events
        })
    }
}

impl<'a, 'w, L, P, K> MotionBuilder<'a, 'w, L, Start<L::Scalar, L::N, LagrangianVectorField>, P, (), K>
where
    L: Linearized<Scalar: Real>,
{
    /// Integrates the derivatives of the motion too, by entries of the initial state and by parameters, named as in
    /// [`jacobian_by`](Linearized::jacobian_by). Events are added after this call.
    ///
    /// ```
    /// use lagrange_core::prelude::*;
    ///
    /// #[derive(Lagrangian)]
    /// #[coordinates(x)]
    /// #[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
    /// struct Spring { m: f64, k: f64 }
    ///
    /// let spring = Spring { m: 1.0, k: 4.0 };
    /// let motion = spring.motion(State::at_rest([0.5])).derivatives(&["k"])?.to(3.0)?;
    /// // x = ½ cos(√k t)
    /// assert!((motion.end().coordinate("x")? - 0.5 * 6.0_f64.cos()).abs() < 1e-7);
    /// assert!((motion.derivative(3.0, "x", "k")? + 0.5 * 3.0 / 4.0 * 6.0_f64.sin()).abs() < 1e-6);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::UnknownName`] and [`Error::RepeatedName`]; the error of the start, if it is none.
    #[allow(clippy::type_complexity, reason = "the type of the builder itself, with its start")]
    pub fn derivatives(
        self,
        arguments: &[&str],
    ) -> Result<MotionBuilder<'a, 'w, L, StateSensitivity<L::Scalar, L::N>, P, (), K>, Error> {
        const { check_contacts(L::HAS_CONTACTS) };
        let Self { system, start, method, events, on_progress, kept } = self;
        let start = system.sensitivity(&start.into_state()?, arguments)?;
        Ok(MotionBuilder { system, start, method, events, on_progress, kept })
    }
}

impl<'a, 'w, L, P, E> Integrates<'a, 'w, L, StateSensitivity<L::Scalar, L::N>, P, E> for AllSteps
where
    L: Linearized<Scalar: Real> + 'a,
    P: DifferentiableMethod<L>,
    E: EventList<DynDifferentiableEvent<'w, L>>,
{
    type Result = TrajectorySensitivity<'a, L>;

    fn run(
        motion: MotionBuilder<'a, 'w, L, StateSensitivity<L::Scalar, L::N>, P, E>,
        end: L::Scalar,
    ) -> Result<TrajectorySensitivity<'a, L>, Error> {
        let MotionBuilder { system, start, method, events, on_progress, .. } = motion;
        integrate(system, &start, end, &method, &mut events.list(), on_progress)
    }
}

impl<'a, 'w, L, P, E> Integrates<'a, 'w, L, StateSensitivity<L::Scalar, L::N>, P, E> for SamplesAlone<'w, L>
where
    L: Linearized<Scalar: Real> + 'a,
    P: DifferentiableMethod<L>,
    E: EventList<DynDifferentiableEvent<'w, L>>,
{
    type Result = SampledSensitivity<'a, L>;

    fn run(
        motion: MotionBuilder<'a, 'w, L, StateSensitivity<L::Scalar, L::N>, P, E, Self>,
        end: L::Scalar,
    ) -> Result<SampledSensitivity<'a, L>, Error> {
        let MotionBuilder { system, start, method, events, on_progress, kept } = motion;
        let (plan, ..) = kept.checked()?;
        sample(system, &start, end, &method, &mut events.list(), &plan, on_progress)
    }
}

/// Integrates a motion together with its derivatives.
pub(super) fn integrate<'a, L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>>(
    system: &'a L,
    start: &StateSensitivity<L::Scalar, L::N>,
    end: L::Scalar,
    method: &D,
    events: &mut [Box<DynDifferentiableEvent<'_, L>>],
    on_progress: Option<OnProgress<'_>>,
) -> Result<TrajectorySensitivity<'a, L>, Error> {
    check_finite(system, &start.state)?;
    check_end(end)?;
    let mut begun = Run::<L, D>::begin(system, &start.state, method);
    let (run, adjustment) = begun.as_mut().map_err(|error| error.clone())?;
    let stored = Stored::<_, _, _, true>::begin(system, &run.state, end, events, on_progress)?;
    let Along { observer, driven, course, before, samples, .. } =
        Along::drive(stored, system, run, start, method)?;
    let trajectory = observer.finish(driven, run.statistics, *adjustment);
    Ok(TrajectorySensitivity::of(trajectory, (course, before), samples, events))
}

/// Integrates a motion together with its derivatives, and samples both.
fn sample<'a, L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>>(
    system: &'a L,
    start: &StateSensitivity<L::Scalar, L::N>,
    end: L::Scalar,
    method: &D,
    events: &mut [Box<DynDifferentiableEvent<'_, L>>],
    plan: &RecordPlan<'_, L>,
    mut on_progress: Option<OnProgress<'_>>,
) -> Result<SampledSensitivity<'a, L>, Error> {
    check_finite(system, &start.state)?;
    check_end(end)?;
    let mut begun = Run::<L, D>::begin(system, &start.state, method);
    let (run, adjustment) = begun.as_mut().map_err(|error| error.clone())?;
    let first = run.state;
    let accept = |state: &StateOf<L>, steps: usize| report(&mut on_progress, [first.t, state.t, end], steps);
    let lent = events.iter_mut().map(|event| -> Box<DynEvent<'_, L>> { Box::new(event) });
    let record = Record::begin(plan, lent.collect(), None, &Sample::of(system, first), end)?;
    let recorded = Recorded::<_, _, _, true>::new(Moving::Fixed(system), record, accept);
    let Along { observer, driven, course, before, samples, .. } =
        Along::drive(recorded, system, run, start, method)?;
    let arrival = observer.finish(driven, run.state, run.statistics);
    let trajectory = Samples::of(system, [first, arrival.state].map(|state| Sample::of(system, state)), plan)
        .trajectory(arrival, *adjustment);
    Ok(TrajectorySensitivity::of(trajectory, (course, before), samples, events))
}

impl<'a, L: Linearized<Scalar: Real>, K: KeptStates<&'a L>> TrajectorySensitivity<'a, L, K> {
    /// The motion with the derivatives along it; `before` is an earlier state.
    fn of(
        trajectory: Trajectory<&'a L, LagrangianVectorField, K>,
        (course, before): (Course<L>, StateOf<L>),
        samples: Vec<StateSensitivity<L::Scalar, L::N>>,
        events: &[Box<DynDifferentiableEvent<'_, L>>],
    ) -> Self {
        let (system, ending, crossings) = (*trajectory.system(), trajectory.ending(), trajectory.crossings());
        let end = course.end(system, trajectory.end().state(), ending, crossings, events, &before);
        Self { trajectory, course, samples, end }
    }
}
