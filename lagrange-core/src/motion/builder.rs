//! A motion is asked for, piece by piece.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::fmt::{self, Debug, Formatter};
use core::marker::PhantomData;
use core::ops::ControlFlow;

use super::event::Watched;
use super::method::{Dop853, Method};
use super::run::{NoCompanion, OnProgress, Progress, drive};
use crate::error::Error;
use crate::number::Real;
use crate::solution::flow::Flow;
use crate::system::{Lagrangian, State};
use crate::trajectory::Trajectory;

/// A motion that is asked for: where it starts, by which method it goes, and what is to be looked at on the way.
///
/// Made by [`motion`](crate::Simulate::motion), [`motion_in_momenta`](crate::Hamiltonian::motion_in_momenta) and
/// [`motion_with_derivatives`](crate::AcrossEvents::motion_with_derivatives); [`to`](Self::to) and [`towards`](Self::towards) compute it.
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

/// The state that a motion starts at, and the equations that it goes by, `F`: those of Lagrange, or those of Hamilton.
#[derive(Clone, Debug)]
pub struct Start<T, const N: usize, F> {
    /// Or why there is none. On the heap: what is asked for is moved from call to call.
    state: Box<Result<State<T, N>, Error>>,
    flow: PhantomData<F>,
}

impl<T, const N: usize, F> Start<T, N, F> {
    pub(crate) fn new(state: Result<State<T, N>, Error>) -> Self {
        Self { state: Box::new(state), flow: PhantomData }
    }
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

impl<'a, 'w, L, F, const N: usize, const M: usize, P, E>
    MotionBuilder<'a, 'w, L, Start<L::Scalar, N, F>, N, M, P, E>
where
    L: Lagrangian<N, M, Scalar: Real>,
    F: Flow<L, N, M>,
    E: EventList<AnyEvent<'w, L, N, M>>,
{
    /// With this event, or a `&mut` to it: its crossings are kept, and the motion ends where it is
    /// [terminal](crate::Event::terminal). Several are given one after the other.
    #[allow(clippy::type_complexity, reason = "the type of the builder itself, with its list of events")]
    pub fn event(
        self,
        event: impl Watched<L, N, M> + 'w,
    ) -> MotionBuilder<'a, 'w, L, Start<L::Scalar, N, F>, N, M, P, Vec<Box<AnyEvent<'w, L, N, M>>>> {
        self.events([event])
    }

    /// With these events of one type, in their order.
    #[allow(clippy::type_complexity, reason = "the type of the builder itself, with its list of events")]
    pub fn events<W: Watched<L, N, M> + 'w>(
        self,
        events: impl IntoIterator<Item = W>,
    ) -> MotionBuilder<'a, 'w, L, Start<L::Scalar, N, F>, N, M, P, Vec<Box<AnyEvent<'w, L, N, M>>>> {
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
    pub fn to(self, end: L::Scalar) -> Result<Trajectory<&'a L, N, M, F>, Error>
    where
        P: Method<L, N, M, F>,
    {
        self.towards(end)?.finished()
    }

    /// The motion as far as it gets on the way to the time `end`: [`Trajectory::ending`] tells why it gets no farther.
    ///
    /// # Errors
    /// As [`to`](Self::to), of what is wrong before the first step.
    pub fn towards(self, end: L::Scalar) -> Result<Trajectory<&'a L, N, M, F>, Error>
    where
        P: Method<L, N, M, F>,
    {
        let Self { system, start, method, events, on_progress } = self;
        let (state, mut events) = (start.state.as_ref().as_ref().map_err(Error::clone)?, events.list());
        let (events, none) = (&mut events, &mut NoCompanion);
        match const { E::IS_WATCHED } {
            true => {
                drive::<_, _, _, _, _, N, M, true>(system, state, end, &method, events, on_progress, none)
            }
            false => {
                drive::<_, _, _, _, _, N, M, false>(system, state, end, &method, events, on_progress, none)
            }
        }
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
