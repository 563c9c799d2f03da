//! A motion is asked for, piece by piece.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::fmt::{self, Debug, Formatter};
use core::ops::ControlFlow;

use super::event::Watched;
use super::method::{Dop853, Method};
use super::run::{Driven, NoCompanion, OnProgress, Progress, drive};
use crate::error::Error;
use crate::number::Real;
use crate::solution::flow::{Flow, LagrangianFlow};
use crate::system::finite::check_finite;
use crate::system::{Lagrangian, State};
use crate::trajectory::Trajectory;

/// A motion that is asked for: where it starts, by which method it goes, and what is to be looked at on the way. Made by
/// [`Simulate::motion`](crate::Simulate::motion); [`to`](Self::to) and [`towards`](Self::towards) compute it.
///
/// The method is [`Dop853`] with a tolerance of 10⁻⁹ unless [`by`](Self::by) names another.
#[must_use = "a motion is computed by `to` or `towards`"]
pub struct MotionBuilder<'a, 'w, L, S, const N: usize, const M: usize, P = Dop853, E = ()> {
    pub(crate) system: &'a L,
    pub(crate) start: S,
    pub(crate) method: P,
    pub(crate) events: E,
    pub(crate) on_progress: Option<OnProgress<'w>>,
}

/// Where a motion starts: a [`State`] for Lagrange's equations, a [`PhaseState`](crate::PhaseState) for Hamilton's, where the method
/// adds up and controls coordinates and momenta, or a [`Sensitivity`](crate::Sensitivity) for a motion with its derivatives.
#[diagnostic::on_unimplemented(
    message = "no motion of `{L}` starts at `{Self}`",
    note = "a motion starts at a `State` of as many coordinates, at a `PhaseState`, or at a `Sensitivity`, over the number type of the system"
)]
pub trait MotionStart<L, const N: usize, const M: usize>: sealed::Sealed {
    /// What is computed from there.
    #[doc(hidden)]
    type Asked;

    /// The same start.
    #[doc(hidden)]
    fn asked(self) -> Self::Asked;
}

/// The start of a motion that goes without its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Alone<S>(pub(crate) S);

/// A start to which equations of motion belong.
pub trait FlowStart<L, const N: usize, const M: usize>: sealed::Sealed
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    /// The equations that the motion goes by.
    type Flow: Flow<L, N, M>;

    /// The state there.
    ///
    /// # Errors
    /// Entries that are not finite, and momenta to which no velocities belong.
    #[doc(hidden)]
    fn state(&self, system: &L) -> Result<State<L::Scalar, N>, Error>;
}

/// The events of a [`MotionBuilder`]: none, or a list.
pub trait EventList<W: ?Sized> {
    /// Whether steps are looked into.
    #[doc(hidden)]
    const IS_WATCHED: bool;

    /// The list.
    #[doc(hidden)]
    fn list(self) -> Vec<Box<W>>;
}

/// The starts are those of this crate.
pub(crate) mod sealed {
    pub trait Sealed {}
}

impl<T, const N: usize> sealed::Sealed for State<T, N> {}

impl<L: Lagrangian<N, M>, const N: usize, const M: usize> MotionStart<L, N, M> for State<L::Scalar, N> {
    type Asked = Alone<Self>;

    fn asked(self) -> Alone<Self> {
        Alone(self)
    }
}

impl<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize> FlowStart<L, N, M>
    for State<L::Scalar, N>
{
    type Flow = LagrangianFlow;

    fn state(&self, system: &L) -> Result<Self, Error> {
        check_finite(system, self).map(|()| *self)
    }
}

impl<W: ?Sized> EventList<W> for () {
    const IS_WATCHED: bool = false;

    fn list(self) -> Vec<Box<W>> {
        Vec::new()
    }
}

impl<W: ?Sized> EventList<W> for Vec<Box<W>> {
    const IS_WATCHED: bool = true;

    fn list(self) -> Self {
        self
    }
}

impl<'a, 'w, L, S, const N: usize, const M: usize> MotionBuilder<'a, 'w, L, S, N, M> {
    pub(crate) fn new(system: &'a L, start: S) -> Self {
        Self { system, start, method: Dop853::default(), events: (), on_progress: None }
    }
}

impl<'a, 'w, L, S, const N: usize, const M: usize, P, E> MotionBuilder<'a, 'w, L, S, N, M, P, E> {
    /// By this method.
    pub fn by<Q>(self, method: Q) -> MotionBuilder<'a, 'w, L, S, N, M, Q, E> {
        let Self { system, start, events, on_progress, .. } = self;
        MotionBuilder { system, start, method, events, on_progress }
    }

    /// With a look at the progress after every step. `ControlFlow::Break` cancels, which is no error: what was computed until then
    /// is there, and its ending is [`Ending::Cancelled`](crate::Ending::Cancelled).
    pub fn on_progress(mut self, look: impl FnMut(Progress) -> ControlFlow<()> + 'w) -> Self {
        self.on_progress = Some(Box::new(look));
        self
    }

    pub(crate) fn with_events<F>(
        self,
        events: impl FnOnce(E) -> F,
    ) -> MotionBuilder<'a, 'w, L, S, N, M, P, F> {
        let Self { system, start, method, on_progress, .. } = self;
        MotionBuilder { system, start, method, events: events(self.events), on_progress }
    }
}

/// What an event is to a motion by itself.
type AnyEvent<'a, L, const N: usize, const M: usize> = dyn Watched<L, N, M> + 'a;

impl<'a, 'w, L, S, const N: usize, const M: usize, P, E> MotionBuilder<'a, 'w, L, Alone<S>, N, M, P, E>
where
    L: Lagrangian<N, M, Scalar: Real>,
    S: FlowStart<L, N, M>,
    E: EventList<AnyEvent<'w, L, N, M>>,
{
    /// With this event, or a `&mut` to it: its crossings are kept, and the motion ends where it is
    /// [terminal](crate::Event::terminal). Several are given one after the other.
    #[allow(clippy::type_complexity, reason = "the type of the builder itself, with its list of events")]
    pub fn event(
        self,
        event: impl Watched<L, N, M> + 'w,
    ) -> MotionBuilder<'a, 'w, L, Alone<S>, N, M, P, Vec<Box<AnyEvent<'w, L, N, M>>>> {
        self.events([event])
    }

    /// With these events of one type, in their order.
    #[allow(clippy::type_complexity, reason = "the type of the builder itself, with its list of events")]
    pub fn events<W: Watched<L, N, M> + 'w>(
        self,
        events: impl IntoIterator<Item = W>,
    ) -> MotionBuilder<'a, 'w, L, Alone<S>, N, M, P, Vec<Box<AnyEvent<'w, L, N, M>>>> {
        let more = events.into_iter().map(|event| Box::new(event) as Box<AnyEvent<'w, L, N, M>>);
        self.with_events(|events| {
            let mut events = events.list();
            events.extend(more);
            events
        })
    }

    /// The motion to the time `end`, backwards where that lies before the start; or to the first
    /// [terminal](crate::Event::terminal) event.
    ///
    /// # Errors
    /// As [`Simulate::integrate`](crate::Simulate::integrate); [`Error::EventNotFinite`] and [`Error::UnknownName`] of the functions of
    /// events at the start; as [`legendre`](crate::Hamiltonian::legendre) from a [`PhaseState`](crate::PhaseState).
    pub fn to(self, end: L::Scalar) -> Result<Trajectory<&'a L, N, M, S::Flow>, Error>
    where
        P: Method<L, N, M, S::Flow>,
    {
        self.towards(end)?.finished()
    }

    /// The motion as far as it gets on the way to the time `end`: [`Trajectory::ending`] tells why it gets no farther.
    ///
    /// # Errors
    /// As [`to`](Self::to), of what is wrong before the first step.
    pub fn towards(self, end: L::Scalar) -> Result<Trajectory<&'a L, N, M, S::Flow>, Error>
    where
        P: Method<L, N, M, S::Flow>,
    {
        let Self { system, start, method, events, on_progress } = self;
        let (state, mut events) = (start.0.state(system)?, events.list());
        let none = |_: &State<L::Scalar, N>| Ok(NoCompanion);
        let driven: Driven<'a, L, S::Flow, NoCompanion, N, M> = match const { E::IS_WATCHED } {
            true => drive::<_, _, _, _, _, N, M, true>(
                system,
                state,
                end,
                &method,
                &mut events,
                on_progress,
                none,
            )?,
            false => drive::<_, _, _, _, _, N, M, false>(
                system,
                state,
                end,
                &method,
                &mut events,
                on_progress,
                none,
            )?,
        };
        Ok(driven.trajectory)
    }
}

impl<L, S, const N: usize, const M: usize, P, E> Debug for MotionBuilder<'_, '_, L, S, N, M, P, E>
where
    L: Lagrangian<N, M>,
    S: Debug,
    P: Debug,
{
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { start, method, .. } = self;
        let mut text = f.debug_struct("MotionBuilder");
        text.field("system", &L::NAME).field("start", start).field("method", method).finish_non_exhaustive()
    }
}
