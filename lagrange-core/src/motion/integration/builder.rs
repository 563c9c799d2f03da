//! Settings of one motion: start, method, events, progress callback, and the choice between all steps and samples
//! alone.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::fmt::{self, Debug, Formatter};
use core::marker::PhantomData;
use core::ops::ControlFlow;

use super::progress::{OnProgress, Progress};
use super::store::Stored;
use crate::error::{Ending, Error};
use crate::motion::event::{AnyEvent, DynEvent};
use crate::motion::method::{Dop853, Method};
use crate::motion::run::{Run, Watchdog, check_end};
use crate::number::Real;
use crate::solution::system_checks::SystemChecks;
use crate::solution::vector_field::VectorField;
use crate::system::{State, System, check_contacts};
use crate::trajectory::Trajectory;
use crate::vector::{Element, Length};

/// Settings of a motion before its integration: start, method, events, progress callback, samples and controller.
///
/// [`motion`](crate::Simulate::motion), [`motion_in_momenta`](crate::Hamiltonian::motion_in_momenta) and
/// [`motion_with_derivatives`](crate::MotionDerivatives::motion_with_derivatives) create a builder; [`to`](Self::to)
/// and [`towards`](Self::towards) integrate. The method is [`Dop853`] with a tolerance of 10⁻⁹ unless [`by`](Self::by)
/// sets another. The result is a [`Trajectory`] with all steps. After [`every`](Self::every) or
/// [`samples_at`](Self::samples_at) it keeps the chosen samples alone.
#[must_use = "a motion is integrated by `to` or `towards`"]
pub struct MotionBuilder<'a, 'w, L: System, S, P = Dop853, E = (), K = AllSteps> {
    pub(crate) system: &'a L,
    pub(crate) start: S,
    pub(crate) method: P,
    pub(crate) events: E,
    pub(crate) on_progress: Option<OnProgress<'w>>,
    /// Selects what the result keeps: all steps or samples alone.
    pub(crate) kept: K,
}

/// Marks a motion that keeps all steps and their dense output: `to` returns a [`Trajectory`].
#[derive(Clone, Copy, Debug)]
pub struct AllSteps;

/// State at which a motion starts. `F` marks the equations of motion, Lagrange's or Hamilton's.
#[derive(Clone, Debug)]
pub struct Start<T: Element, N: Length, F> {
    /// The start, or an error if it is not finite or no velocities belong to its momenta. It is on the heap because
    /// each call of the builder moves the settings, and a state of 1,000 coordinates would fill the stack.
    pub(super) state: Box<Result<State<T, N>, Error>>,
    field: PhantomData<F>,
}

impl<T: Element, N: Length, F> Start<T, N, F> {
    pub(crate) fn new(state: Result<State<T, N>, Error>) -> Self {
        Self { state: Box::new(state), field: PhantomData }
    }

    pub(crate) fn into_state(self) -> Result<State<T, N>, Error> {
        *self.state
    }
}

/// Settings of a motion without derivatives, with the equations of motion `F`.
pub(crate) type MotionFrom<'a, 'w, L, F> =
    MotionBuilder<'a, 'w, L, Start<<L as System>::Scalar, <L as System>::Length, F>>;

/// Events of a [`MotionBuilder`]; `()` for none.
pub trait EventList<W: ?Sized> {
    /// True if there are events.
    #[doc(hidden)]
    const HAS_EVENTS: bool;

    /// The events in the order in which they were given.
    #[doc(hidden)]
    fn list(self) -> Vec<Box<W>>;
}

impl<W: ?Sized> EventList<W> for () {
    const HAS_EVENTS: bool = false;

    fn list(self) -> Vec<Box<W>> {
        Vec::new()
    }
}

impl<W: ?Sized> EventList<W> for Vec<Box<W>> {
    const HAS_EVENTS: bool = true;

    fn list(self) -> Self {
        self
    }
}

impl<'a, 'w, L: System, S> MotionBuilder<'a, 'w, L, S> {
    pub(crate) fn new(system: &'a L, start: S) -> Self {
        Self { system, start, method: Dop853::default(), events: (), on_progress: None, kept: AllSteps }
    }
}

impl<'a, 'w, L: System, S, P, E, K> MotionBuilder<'a, 'w, L, S, P, E, K> {
    /// Sets the method.
    pub fn by<Q>(self, method: Q) -> MotionBuilder<'a, 'w, L, S, Q, E, K> {
        let Self { system, start, events, on_progress, kept, .. } = self;
        MotionBuilder { system, start, method, events, on_progress, kept }
    }

    /// Calls `look` with the progress after every step. If it returns `ControlFlow::Break`, the motion ends there with
    /// [`Ending::Cancelled`], which is no error.
    pub fn on_progress(mut self, look: impl FnMut(Progress) -> ControlFlow<()> + 'w) -> Self {
        self.on_progress = Some(Box::new(look));
        self
    }

    pub(crate) fn with_events<F>(self, events: impl FnOnce(E) -> F) -> MotionBuilder<'a, 'w, L, S, P, F, K> {
        let Self { system, start, method, on_progress, kept, .. } = self;
        MotionBuilder { system, start, method, events: events(self.events), on_progress, kept }
    }

    pub(crate) fn keeping<J>(self, kept: impl FnOnce(K) -> J) -> MotionBuilder<'a, 'w, L, S, P, E, J> {
        let Self { system, start, method, events, on_progress, .. } = self;
        MotionBuilder { system, start, method, events, on_progress, kept: kept(self.kept) }
    }
}

impl<'a, 'w, L, F, P, E, K> MotionBuilder<'a, 'w, L, Start<L::Scalar, L::Length, F>, P, E, K>
where
    L: System<Scalar: Real>,
    F: VectorField<L>,
    E: EventList<DynEvent<'w, L>>,
{
    /// Adds an event, by value or as `&mut event`. The result lists its crossings. A [terminal](crate::Event::terminal)
    /// event ends the motion. For several events, call this method once for each.
    #[allow(clippy::type_complexity, reason = "the type of the builder itself, with its list of events")]
    pub fn event(
        self,
        event: impl AnyEvent<L> + 'w,
    ) -> MotionBuilder<'a, 'w, L, Start<L::Scalar, L::Length, F>, P, Vec<Box<DynEvent<'w, L>>>, K> {
        self.events([event])
    }

    /// Adds several events of one type.
    #[allow(clippy::type_complexity, reason = "the type of the builder itself, with its list of events")]
    pub fn events<W: AnyEvent<L> + 'w>(
        self,
        events: impl IntoIterator<Item = W>,
    ) -> MotionBuilder<'a, 'w, L, Start<L::Scalar, L::Length, F>, P, Vec<Box<DynEvent<'w, L>>>, K> {
        let more = events.into_iter().map(|event| Box::new(event) as Box<DynEvent<'w, L>>);
        self.with_events(|events| {
            let mut events = events.list();
            events.extend(more);
            events
        })
    }
}

impl<'a, 'w, L: System<Scalar: Real>, S, P, E, K> MotionBuilder<'a, 'w, L, S, P, E, K> {
    /// Integrates to the time `end`, or to the first [terminal](crate::Event::terminal) event. If `end` is before the start, it
    /// integrates backwards, except across contacts.
    ///
    /// The result is a [`Trajectory`], after [`every`](Self::every) and [`samples_at`](Self::samples_at) with samples alone; with
    /// derivatives a [`TrajectorySensitivity`](crate::linearized::TrajectorySensitivity).
    ///
    /// # Errors
    /// The errors of [`integrate`](crate::Simulate::integrate), among them [`Error::Unfinished`] if the motion fails on the way.
    /// [`Error::EventNotFinite`] and [`Error::UnknownName`] if the function of an event or of a quantity fails at the start;
    /// [`Error::SampleTime`], [`Error::OutsideTrajectory`] and [`Error::Setting`] for samples that cannot be taken. In momenta,
    /// those of [`legendre`](crate::Hamiltonian::legendre). Across contacts, [`Error::Penetration`] if a gap is negative at the
    /// start, and [`Error::MotionBackwards`]; by time steps, those of [`stepper`](Self::stepper). With derivatives,
    /// [`Error::DerivativeNotFinite`].
    pub fn to<R: HasEnding>(self, end: L::Scalar) -> Result<R, Error>
    where
        K: Integrates<'a, 'w, L, S, P, E, Result = R>,
    {
        let result = K::run(self, end)?;
        if result.ending().is_failure() { Err(result.ending().clone().into()) } else { Ok(result) }
    }

    /// Integrates towards the time `end`. If the motion fails on the way, the result holds what was computed up to there, and its
    /// [`ending`](Trajectory::ending) the reason.
    ///
    /// # Errors
    /// The errors of [`to`](Self::to) that are found before the first step.
    pub fn towards<R>(self, end: L::Scalar) -> Result<R, Error>
    where
        K: Integrates<'a, 'w, L, S, P, E, Result = R>,
    {
        K::run(self, end)
    }
}

/// Choice of what a motion keeps and how it crosses contacts, which can be integrated from a start `S` by a method `P` with the
/// events `E`.
#[diagnostic::on_unimplemented(
    message = "a motion with these settings cannot be integrated",
    label = "these settings do not go together"
)]
pub trait Integrates<'a, 'w, L: System<Scalar: Real>, S, P, E>: Sized {
    /// Result of the integration.
    type Result: HasEnding;

    #[doc(hidden)]
    fn run(motion: MotionBuilder<'a, 'w, L, S, P, E, Self>, end: L::Scalar) -> Result<Self::Result, Error>;
}

/// Result of an integration, which knows why it ends.
pub trait HasEnding {
    #[doc(hidden)]
    fn ending(&self) -> &Ending;
}

impl<S: System, F, K> HasEnding for Trajectory<S, F, K> {
    fn ending(&self) -> &Ending {
        self.ending()
    }
}

impl<'a, 'w, L, F, P, E> Integrates<'a, 'w, L, Start<L::Scalar, L::Length, F>, P, E> for AllSteps
where
    L: System<Scalar: Real> + 'a,
    F: VectorField<L>,
    P: Method<L, F>,
    E: EventList<DynEvent<'w, L>>,
{
    type Result = Trajectory<&'a L, F>;

    fn run(
        motion: MotionBuilder<'a, 'w, L, Start<L::Scalar, L::Length, F>, P, E>,
        end: L::Scalar,
    ) -> Result<Trajectory<&'a L, F>, Error> {
        const { check_contacts(F::Checks::HAS_CONTACTS) };
        match const { E::HAS_EVENTS } {
            true => motion.store::<true>(end),
            false => motion.store::<false>(end),
        }
    }
}

impl<'a, 'w, L, F, P, E> MotionBuilder<'a, 'w, L, Start<L::Scalar, L::Length, F>, P, E>
where
    L: System<Scalar: Real>,
    F: VectorField<L>,
    P: Method<L, F>,
    E: EventList<DynEvent<'w, L>>,
{
    fn store<const HAS_EVENTS: bool>(self, end: L::Scalar) -> Result<Trajectory<&'a L, F>, Error> {
        let Self { system, start, method, events, on_progress, .. } = self;
        let (state, mut events) = (start.state.as_ref().as_ref().map_err(Error::clone)?, events.list());
        check_end(end)?;
        // Borrowed, not moved to its use: a move that is not optimized away would leave several copies on the stack.
        let mut begun = Run::<L, P, F>::begin(system, state, &method);
        let (run, adjustment) = begun.as_mut().map_err(|error| error.clone())?;
        let stored = Stored::<_, _, _, HAS_EVENTS>::begin;
        let mut stored = stored(system, &run.state, end, &mut events, on_progress)?;
        let limits = Watchdog::new(method.limits(), &run.statistics);
        let driven = run.drive(&method, &limits, &mut stored);
        Ok(stored.finish(driven, run.statistics, adjustment.clone()))
    }
}

impl<L, S, P, E, K> Debug for MotionBuilder<'_, '_, L, S, P, E, K>
where
    L: System,
    S: Debug,
    P: Debug,
{
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { start, method, .. } = self;
        let mut text = f.debug_struct("MotionBuilder");
        text.field("start", start).field("method", method).finish_non_exhaustive()
    }
}
