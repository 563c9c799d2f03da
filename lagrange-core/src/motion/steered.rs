//! [`Motion`]: stepwise integration, advanced by its caller.

use core::fmt::{self, Debug, Formatter};

use super::Method;
use super::advance::{FindCrossing, GoPast, LastStep};
use super::event::{AnyEvent, EventSearch};
use super::run::{Run, Watchdog, is_between, resume};
use crate::error::{Ending, Error};
use crate::number::Real;
use crate::solution::crossing::Crossing;
use crate::solution::interpolant::Interpolant;
use crate::solution::system_checks::SystemChecks;
use crate::solution::vector_field::VectorField;
use crate::statistics::Statistics;
use crate::system::{StateOf, System, check_contacts};
use crate::vector::Numbers;

/// A motion that its caller advances by a length of time or to a time, and can steer in between.
///
/// Between two advances the state and the parameters of the system can be read and set. A set value holds until it is
/// set again (zero-order hold). A change costs one evaluation of the equations, or none if all steps have one length;
/// the step length is kept. Every requested time is reached exactly, so inputs change there and nowhere else. The time
/// may lie in the past.
///
/// Nothing is stored and no step allocates: a motion takes as much memory after 10⁹ steps as after one. Its method
/// allocates its working memory when the motion begins, and the memory of the dense output when it is first evaluated.
/// Without the feature `alloc`, all methods but `Taylor` and `Radau` work, and hold all of that memory inline. The motion owns its
/// system, which may be a reference.
///
/// ```
/// use lagrange_core::prelude::*;
///
/// /// A pendulum with a motor at the pivot.
/// #[derive(Lagrangian)]
/// #[coordinates(theta)]
/// #[lagrangian(m*l^2/2 * theta_dot^2 + m*g*l*cos(theta))]
/// #[force(theta: torque)]
/// struct Pendulum { m: f64, l: f64, g: f64, torque: f64 }
///
/// let pendulum = Pendulum { m: 1.0, l: 1.0, g: 9.81, torque: 0.0 };
/// let mut motion = Motion::new(pendulum, State::at_rest([3.0]), Dopri5::with_tolerance(1e-6))?;
/// for tick in 1..=1000 {
///     // Held upright by a controller that looks every 10 ms.
///     let state = *motion.state();
///     motion.system_mut().torque = 30.0 * (core::f64::consts::PI - state.q[0]) - 8.0 * state.v[0];
///     motion.advance_to(0.01 * f64::from(tick))?;
/// }
/// assert!((motion.state().q[0] - core::f64::consts::PI).abs() < 1e-6);
/// # Ok::<(), Error>(())
/// ```
///
/// Limits on steps and on wall-clock time apply to each advance separately. A system with contacts or dry friction moves by a
/// [`ContactMotion`](crate::contact::ContactMotion).
pub struct Motion<L, P, F = <L as System>::Field>
where
    L: System<Scalar: Real>,
    F: VectorField<L>,
    P: Method<L, F>,
{
    system: L,
    method: P,
    run: Run<L, P, F>,
    /// State within the last step at which an event has stopped the motion.
    stop: Option<StateOf<L>>,
    last_step: LastStep<P::Interpolant>,
}

impl<L: System<Scalar: Real, Field: VectorField<L>>, P: Method<L>> Motion<L, P> {
    /// Starts a motion of this system from a state, by the given method.
    ///
    /// # Errors
    /// Those of [`Simulate::integrate`](crate::Simulate::integrate) before the first step.
    pub fn new(system: L, state: StateOf<L>, method: P) -> Result<Self, Error> {
        <L::Field as VectorField<L>>::Checks::check_entries(&system, &state)?;
        Self::begin(system, &state, method)
    }
}

impl<L, P, F> Motion<L, P, F>
where
    L: System<Scalar: Real>,
    F: VectorField<L>,
    P: Method<L, F>,
{
    pub(crate) fn begin(system: L, state: &StateOf<L>, method: P) -> Result<Self, Error> {
        const { check_contacts(F::Checks::HAS_CONTACTS) };
        let (run, _) = Run::begin(&system, state, &method)?;
        let last_step = LastStep::none();
        Ok(Self { system, method, run, stop: None, last_step })
    }

    /// Current state.
    pub fn state(&self) -> &StateOf<L> {
        self.stop.as_ref().unwrap_or(&self.run.state)
    }

    /// The system with its current parameters.
    pub fn system(&self) -> &L {
        &self.system
    }

    /// The system, to change its parameters from the current time on; coordinates and velocities stay as they are.
    /// Dense output of the last step by [`at`](Self::at) is then no longer available.
    pub fn system_mut(&mut self) -> &mut L {
        // Without a stop, no copy of the state onto itself: reading the state would wait for that store.
        if let Some(stop) = self.stop.take() {
            self.run.state = stop;
        }
        self.forget_step();
        &mut self.system
    }

    /// Continues from another state, without a step that leads there. A violation of the constraints of the order of
    /// round-off is projected away. If the number of coordinates has changed, the method begins anew.
    ///
    /// # Errors
    /// [`Error::StateNotFinite`]; [`Error::Inconsistent`], and [`Error::NotProjected`]. The motion then keeps its
    /// state.
    pub fn set_state(&mut self, state: StateOf<L>) -> Result<(), Error> {
        F::Checks::check_entries(&self.system, &state)?;
        F::Checks::check_constraints(&self.system, &state)?;
        let (state, _) = F::Checks::adjust(&self.system, &state)?;
        if state.q.entries().len() != self.run.state.q.entries().len() {
            let statistics = &mut self.run.statistics;
            self.run.memory = self.method.begin(&self.system, &state, statistics)?;
        }
        self.go_on_from(state);
        Ok(())
    }

    /// Sets the state, and invalidates the last step.
    fn go_on_from(&mut self, state: StateOf<L>) {
        self.run.state = state;
        self.forget_step();
    }

    fn forget_step(&mut self) {
        self.stop = None;
        self.last_step.forget();
    }

    /// Numbers of steps and evaluations since the start.
    pub fn statistics(&self) -> &Statistics {
        &self.run.statistics
    }

    /// Ends the motion, and returns its system with the current parameters.
    pub fn into_system(self) -> L {
        self.system
    }

    /// Advances to the time `end`, which is reached exactly; backwards if it lies in the past.
    ///
    /// # Errors
    /// The reason why the motion stops before `end`. The motion is then at the last state reached, and can continue
    /// from there. If a change of the system makes the state violate a constraint, the error is [`Ending::Unsolved`].
    #[inline]
    pub fn advance_to(&mut self, end: L::Scalar) -> Result<(), Ending> {
        let limits = Watchdog::new(self.method.limits(), &self.run.statistics);
        self.go_past(end, end, &limits)
    }

    /// Steps towards `end` until a step reaches or passes `t`.
    #[inline]
    fn go_past(&mut self, t: L::Scalar, end: L::Scalar, limits: &Watchdog) -> Result<(), Ending> {
        self.refresh(end)?;
        self.stop = None;
        let Self { system, method, run, last_step, .. } = self;
        run.drive(method, limits, &mut GoPast { system: &*system, last_step, t, end })
    }

    /// Advances to the first crossing of these events, or to the time `end` if there is none on the way.
    ///
    /// At a crossing, the state and the system may be changed, or the motion replaced by a motion of another system.
    /// Without a change, the motion continues within the same step: stopping costs nothing. [`Event`](crate::Event)
    /// describes which crossings are found. All of them stop the motion, whether [terminal](crate::Event::terminal) or
    /// not.
    ///
    /// # Errors
    /// The errors of [`advance_to`](Self::advance_to). [`Ending::EventNotFinite`], after which the motion is at the
    /// last state where the events were evaluated. [`Ending::EventsAccumulate`], after which it is at the last
    /// crossing.
    pub fn advance_to_event(
        &mut self,
        end: L::Scalar,
        events: &mut [&mut dyn AnyEvent<L>],
    ) -> Result<Option<Crossing<L::Scalar, L::Length>>, Ending> {
        self.refresh(end)?;
        let mut at = self.state().clone();
        let found = self.search(end, events, &mut at);
        self.stop = (at != self.run.state).then_some(at);
        found
    }

    /// Iterates over the crossings of these events until the time `end`, each found when the iterator is advanced: a
    /// Poincaré section, in constant memory. An error is the last item.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// #[derive(Lagrangian)]
    /// #[coordinates(x, y)]
    /// #[lagrangian((x_dot^2 + y_dot^2)/2 - (x^2 + y^2)/2 - x^2*y + y^3/3)]
    /// struct HenonHeiles;
    ///
    /// let mut section = HenonHeiles.event("section", |sample| sample.state().q[0]).rising();
    /// let start = State::new([0.0, 0.1], [0.35, 0.1]);
    /// let mut motion = Motion::new(HenonHeiles, start, Dop853::with_tolerance(1e-12))?;
    /// for crossing in motion.crossings(1e9, &mut [&mut section]).take(100) {
    ///     let state = crossing?.state;
    ///     assert!(state.q[0].abs() < 1e-16);
    ///     println!("{} {}", state.q[1], state.v[1]);
    /// }
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// For a stroboscopic section, call [`states_at`](Self::states_at) with its times.
    ///
    /// # Errors
    /// The errors of [`advance_to_event`](Self::advance_to_event).
    pub fn crossings<'e>(
        &mut self,
        end: L::Scalar,
        events: &'e mut [&'e mut dyn AnyEvent<L>],
    ) -> impl Iterator<Item = Result<Crossing<L::Scalar, L::Length>, Ending>> + use<'_, 'e, L, P, F> {
        let mut has_failed = false;
        core::iter::from_fn(move || {
            if has_failed {
                return None;
            }
            let found = self.advance_to_event(end, events);
            has_failed = found.is_err();
            found.transpose()
        })
    }

    /// Finds the first crossing after `at` and moves `at` there.
    fn search(
        &mut self,
        end: L::Scalar,
        events: &mut [&mut dyn AnyEvent<L>],
        at: &mut StateOf<L>,
    ) -> Result<Option<Crossing<L::Scalar, L::Length>>, Ending> {
        let Self { system, method, run, last_step, .. } = self;
        let limits = Watchdog::new(method.limits(), &run.statistics);
        let mut search = EventSearch::from(events, system, at, !last_step.is_there)
            .map_err(|error| Ending::of(error, at.t.to_f64()))?;
        let found = search.due(at)?;
        let mut search = FindCrossing { system: &*system, last_step, end, search, at, found };
        if search.found.is_none() {
            // Search the rest of the step within which the motion has stopped.
            search.look::<F>(&run.before, &run.state)?;
        }
        run.drive(method, &limits, &mut search)?;
        Ok(search.found)
    }

    /// Advances by this length of time; backwards if it is negative. Many equal lengths add up with the rounding error
    /// of each sum. To avoid that, give the times: [`advance_to`](Self::advance_to)`(0.01 * f64::from(k))`.
    ///
    /// # Errors
    /// The errors of [`advance_to`](Self::advance_to).
    pub fn advance_by(&mut self, length: L::Scalar) -> Result<(), Ending> {
        self.advance_to(self.state().t + length)
    }

    /// Returns the state at a time within the last step, by the dense output of the method, projected onto the
    /// constraints. The dense output is computed at the first call in a step.
    ///
    /// # Errors
    /// [`Error::OutsideTrajectory`] for a time outside the last step; after a change of the state or of the system only
    /// the current time is available. Errors of evaluating the equations, and [`Error::NotProjected`].
    pub fn at(&mut self, t: L::Scalar) -> Result<StateOf<L>, Error> {
        let (state, before) = (self.state(), &self.run.before);
        if t == state.t {
            return Ok(state.clone());
        }
        let start = if self.last_step.is_there { before.t } else { state.t };
        if !is_between(start, t, state.t) {
            let [time, start, end] = [t, start, state.t].map(Real::to_f64);
            return Err(Error::OutsideTrajectory { time, start, end });
        }
        if t == before.t {
            return Ok(before.clone());
        }
        let Self { system, method, run: Run { memory, state, before, statistics }, last_step, .. } = self;
        if last_step.interpolant().is_none() {
            let within = &mut last_step.within;
            method.push_interpolant(system, memory, [before, state], statistics, within)?;
        }
        match last_step.interpolant() {
            Some(interpolant) => F::project(system, &interpolant.at(t)),
            None => Ok(self.state().clone()),
        }
    }

    /// Iterates over the states at these times, each computed when the iterator is advanced; the motion is then at the
    /// last of them. The times do not shorten steps, and nothing is stored. An error is the last item.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// #[derive(Lagrangian)]
    /// #[coordinates(x)]
    /// #[lagrangian(x_dot^2/2 - x^2/2)]
    /// struct Spring;
    ///
    /// let mut motion = Motion::new(Spring, State::at_rest([1.0]), Dop853::default())?;
    /// for state in motion.states_at((0..=100).map(|k| 0.1 * f64::from(k))) {
    ///     let state = state?;
    ///     assert!((state.q[0] - state.t.cos()).abs() < 1e-8);
    /// }
    /// assert_eq!(motion.state().t, 10.0);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// The times must be monotonic, later or earlier from one to the next.
    ///
    /// # Errors
    /// An item is an error of [`advance_to`](Self::advance_to), or [`Ending::Unsolved`] with an
    /// [`Error::OutsideTrajectory`] for a time out of order.
    pub fn states_at<I: IntoIterator<Item = L::Scalar, IntoIter: DoubleEndedIterator>>(
        &mut self,
        times: I,
    ) -> impl Iterator<Item = Result<StateOf<L>, Ending>> + use<'_, I, L, P, F> {
        let mut times = times.into_iter();
        let last = times.next_back();
        let end = last.unwrap_or(self.state().t);
        let limits = Watchdog::new(self.method.limits(), &self.run.statistics);
        let mut has_failed = false;
        times.chain(last).map_while(move |t| {
            if has_failed {
                return None;
            }
            let state = self.state_on_the_way(t, end, &limits);
            has_failed = state.is_err();
            Some(state)
        })
    }

    /// Returns the state at `t`, between the current time and `end`.
    fn state_on_the_way(
        &mut self,
        t: L::Scalar,
        end: L::Scalar,
        limits: &Watchdog,
    ) -> Result<StateOf<L>, Ending> {
        let now = self.state().t.to_f64();
        self.go_past(t, end, limits)?;
        self.at(t).map_err(|error| Ending::of(error, now))
    }

    /// Resumes the method after a change, and checks `end`. If the motion has stopped within a step, and `end` lies
    /// within that step or behind, the rest of the step is discarded.
    #[inline]
    fn refresh(&mut self, end: L::Scalar) -> Result<(), Ending> {
        let time = self.state().t.to_f64();
        super::run::check_end(end).map_err(|error| Ending::of(error, time))?;
        let is_behind = |stop: &mut StateOf<L>| !is_between(stop.t, self.run.state.t, end);
        if let Some(stop) = self.stop.take_if(is_behind) {
            self.go_on_from(stop);
        }
        if !self.last_step.is_current {
            self.resume().map_err(|error| Ending::of(error, time))?;
            self.last_step.is_current = true;
        }
        Ok(())
    }

    #[inline]
    fn resume(&mut self) -> Result<(), Error> {
        let Run { memory, state, statistics, .. } = &mut self.run;
        resume::<_, F, _>(&self.system, &self.method, memory, state, statistics)
    }
}

impl<L, P, F> Debug for Motion<L, P, F>
where
    L: System<Scalar: Real>,
    F: VectorField<L>,
    P: Method<L, F>,
{
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Motion")
            .field("system", &F::Checks::name())
            .field("state", self.state())
            .field("statistics", self.statistics())
            .finish()
    }
}
