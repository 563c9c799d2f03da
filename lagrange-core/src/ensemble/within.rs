//! What is kept of members on their way.

use core::fmt::Display;

use super::settings::Ensemble;
use crate::motion::record::SampleTimes;
use crate::motion::{Event, EventFunction, EventValue};
use crate::number::Real;
use crate::solution::Sample;
use crate::system::{Lagrangian, State};

impl<'a, L, T: Real, const N: usize, const M: usize, const HAS_DENSE_OUTPUT: bool>
    Ensemble<'a, L, T, N, M, HAS_DENSE_OUTPUT>
where
    L: Lagrangian<N, M, Scalar = T>,
{
    /// Keeps the states of each member at these times, in [`Arrival::samples`](super::Arrival::samples).
    ///
    /// They lie on the continuous extension of the method, projected onto the constraints. Steps are as long as without, and
    /// the end has the same bits; but where the extension cannot be had a step is tried once more, shorter. On lanes the
    /// extension of a pair costs about half of a step in which one of the lanes has a sample; Taylor's method has it already. A member that ends early has the samples up to there.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// #[derive(Lagrangian)]
    /// #[coordinates(x)]
    /// #[lagrangian(x_dot^2/2 - k/2 * x^2)]
    /// struct Spring<T> { k: T }
    ///
    /// let springs = Ensemble::from_fn(100, |n| (Spring { k: n as f64 }, State::at_rest([1.0])));
    /// let outcome = springs
    ///     .samples_at((0..=20).map(|tick| 0.1 * f64::from(tick)))
    ///     .quantity("energy", |sample| sample.energy())
    ///     .integrate_on_lanes(2.0, Dop853::default())?;
    /// for state in &outcome.get(4).unwrap().arrival().unwrap().samples {
    ///     assert!((state.q[0] - (2.0 * state.t).cos()).abs() < 1e-8);
    /// }
    /// assert!(outcome.quantity(4, "energy")?.all(|energy| (energy - 2.0).abs() < 1e-7));
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// The times must be in the order of the motions, and lie between the start of each and the end. The member of
    /// [`Progress`](super::EnsembleProgress) has its samples, to be written down as soon as it is done: a table of
    /// [`csv`](super::Outcome::csv) does not hold them, and a member [taken over](Self::resume) from one has none.
    ///
    /// # Errors
    /// [`integrate`](Self::integrate) gives [`Error::SampleTime`](crate::Error::SampleTime) for a time that is not finite or out
    /// of order; a member that does not cover them, or moves the other way, is
    /// [`Error::OutsideTrajectory`](crate::Error::OutsideTrajectory) or `SampleTime`.
    pub fn samples_at(self, times: impl IntoIterator<Item = T>) -> Ensemble<'a, L, T, N, M, true> {
        let mut plan = self.plan;
        plan.member_plan.samples.times = SampleTimes::At(times.into_iter().collect());
        Ensemble { plan }
    }

    /// Keeps the state of each member at its start and whenever so much time has passed, as
    /// [`MotionBuilder::every`](crate::MotionBuilder::every) does; else as [`samples_at`](Self::samples_at), whose times it replaces.
    pub fn every(self, interval: T) -> Ensemble<'a, L, T, N, M, true> {
        let mut plan = self.plan;
        plan.member_plan.samples.times = SampleTimes::Every(interval);
        Ensemble { plan }
    }

    /// Watches each member for this event, [one](crate::Simulate::event) of any system of the kind: what a run
    /// [with events](crate::MotionBuilder::event) does, on lanes too. Its crossings are in
    /// [`Arrival::crossings`](super::Arrival::crossings); a [terminal](Event::terminal) one ends the member there, with
    /// [`Ending::Event`](crate::Ending::Event), and no other. Each member counts for itself.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// #[derive(Lagrangian)]
    /// #[coordinates(height)]
    /// #[lagrangian(height_dot^2/2 - g*height)]
    /// struct Ball<T> { g: T }
    ///
    /// let ball = |k: usize| Ball { g: 1.0 + k as f64 };
    /// let lands = ball(0).event("lands", |sample| sample.state().q[0]).falling().terminal();
    /// let balls = Ensemble::from_fn(10, |k| (ball(k), State::at_rest([1.0]))).event(lands);
    /// let outcome = balls.integrate_on_lanes(100.0, Dop853::default())?;
    /// for member in outcome.members() {
    ///     let arrival = member.arrival().unwrap();
    ///     assert!((arrival.ending.time() - (2.0 / ball(member.index).g).sqrt()).abs() < 1e-12);
    ///     assert_eq!(arrival.crossings[0].state, arrival.state);
    /// }
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// An event whose function cannot be had where a member starts is its error; later on it ends the member, which keeps what
    /// was found. Each step is looked into, which on lanes costs about half of it, by Taylor's method nothing, and the functions.
    pub fn event<G>(self, event: Event<L, G, N, M>) -> Ensemble<'a, L, T, N, M, true>
    where
        G: EventFunction<L, N, M> + Send + Sync + 'a,
    {
        let mut plan = self.plan;
        plan.member_plan.event(event);
        Ensemble { plan }
    }

    /// Steers each member: the controller is called where it starts, and then at every interval, reads the state and sets
    /// parameters. They hold until it is called again (zero-order hold). It is told the index of the member.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// /// A pendulum with a motor at the pivot.
    /// #[derive(Lagrangian)]
    /// #[coordinates(theta)]
    /// #[lagrangian(theta_dot^2/2 + g*cos(theta))]
    /// #[force(theta: torque)]
    /// struct Pendulum<T> { g: T, torque: T }
    ///
    /// let upright = core::f64::consts::PI;
    /// let starts = Ensemble::from_fn(50, |k| {
    ///     (Pendulum { g: 9.81, torque: 0.0 }, State::at_rest([3.0 + 0.01 * k as f64]))
    /// });
    /// let steered = starts.controlled(0.01, |_, pendulum, state| {
    ///     pendulum.torque = 30.0 * (upright - state.q[0]) - 8.0 * state.v[0];
    ///     if pendulum.torque.abs() < 100.0 { Ok(()) } else { Err("the motor is too weak") }
    /// });
    /// let outcome = steered.integrate_on_lanes(5.0, Dopri5::with_tolerance(1e-6))?;
    /// assert!(outcome.completed().all(|(_, state)| (state.q[0] - upright).abs() < 1e-6));
    /// assert_eq!(outcome.completed().count(), 50);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// A member that is steered moves as a [`Motion`](crate::Motion) that is advanced to the same times, the start plus so
    /// many intervals, each reached exactly. What a controller has to remember can be fields of the system; on lanes these must be
    /// numbers. [Samples](Self::samples_at) are taken before it is called; for [events](Self::event) the motion begins anew
    /// with each call, so that a function that jumps there does not cross.
    ///
    /// # Errors
    /// Where it fails the member ends, with [`Ending::ControllerFailed`](crate::Ending::ControllerFailed), and keeps all it has.
    /// [`integrate`](Self::integrate) gives [`Error::Setting`](crate::Error::Setting) for an interval that is not positive and
    /// finite; one too short to advance the time is [`Ending::TimeTooCoarse`](crate::Ending::TimeTooCoarse).
    pub fn controlled<E: Display>(
        self,
        interval: T,
        controller: impl Fn(usize, &mut L, &State<T, N>) -> Result<(), E> + Send + Sync + 'a,
    ) -> Ensemble<'a, L, T, N, M, true> {
        let mut plan = self.plan;
        plan.member_plan.controller(interval, controller);
        Ensemble { plan }
    }

    /// Keeps this quantity of each [sample](Self::samples_at), to be asked for by its name:
    /// [`Outcome::quantity`](super::Outcome::quantity). The function gives a number, or what gives one by name,
    /// `|sample| sample.observable("height")`.
    ///
    /// It is asked at the start too, so that what it cannot give there is told before the first step. Where it cannot be had
    /// later, the member ends.
    pub fn quantity<V: EventValue<T>>(
        mut self,
        name: &'static str,
        function: impl Fn(&Sample<&L, N, M>) -> V + Send + Sync + 'a,
    ) -> Self {
        self.plan.member_plan.samples.quantity(name, function);
        self
    }
}
