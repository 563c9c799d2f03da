//! Data kept along the motions of members: samples, quantities, event crossings; and their controllers.

use core::fmt::Display;

use super::settings::Ensemble;
use crate::motion::integration::record::SampleTimes;
use crate::motion::{Event, EventFunction, EventValue, Simulate};
use crate::{Sample, StateOf};

impl<'a, L: Simulate, const HAS_DENSE_OUTPUT: bool> Ensemble<'a, L, HAS_DENSE_OUTPUT> {
    /// Stores the states of each member at these times, in [`Arrival::samples`](super::Arrival::samples).
    ///
    /// Samples lie on the dense output of the method, projected onto the constraints. Steps have the same lengths as
    /// without samples, and the end has the same bits. The exception: where dense output fails, the step is repeated
    /// with a shorter length. On lanes, dense output of a Runge–Kutta pair costs about half of a step in which one of
    /// the lanes has a sample; Taylor's method has it at no cost. A member that ends early has the samples up to its
    /// end.
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
    /// The times must be in the order of the motion, and lie between the start of each member and the end. The row
    /// of a member in a [table](super::Outcome::json_lines) has its samples, and a member [taken over](Self::resume) has them too.
    ///
    /// # Errors
    /// [`integrate`](Self::integrate) returns [`Error::SampleTime`](crate::Error::SampleTime) for times that are not
    /// finite or out of order. A member whose motion does not cover the times, or runs in the other direction, has the
    /// error [`Error::OutsideTrajectory`](crate::Error::OutsideTrajectory) or `SampleTime`.
    pub fn samples_at(self, times: impl IntoIterator<Item = L::Scalar>) -> Ensemble<'a, L, true> {
        let mut plan = self.plan;
        plan.member_plan.samples.times = SampleTimes::At(times.into_iter().collect());
        Ensemble { plan }
    }

    /// Stores the state of each member at its start and after every `interval` of time, like
    /// [`MotionBuilder::every`](crate::MotionBuilder::every). Replaces the times of [`samples_at`](Self::samples_at),
    /// whose rules hold otherwise.
    pub fn every(self, interval: L::Scalar) -> Ensemble<'a, L, true> {
        let mut plan = self.plan;
        plan.member_plan.samples.times = SampleTimes::Every(interval);
        Ensemble { plan }
    }

    /// Watches each member for this event, like a run [with events](crate::MotionBuilder::event), on lanes too. The
    /// [event](crate::Simulate::event) may be made by any system of this type. Crossings are stored in
    /// [`Arrival::crossings`](super::Arrival::crossings). A [terminal](Event::terminal) event ends only the member that
    /// meets it, with [`Ending::Event`](crate::Ending::Event). Each member counts its own crossings.
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
    /// If the event's function fails at the start of a member, the member has that error. If it fails later, the member
    /// ends and keeps the crossings found so far. Every step is searched for crossings. On lanes this costs about half
    /// of a step, by Taylor's method nothing, and the evaluations of the function.
    pub fn event<G: EventFunction<L> + Send + Sync + 'a>(self, event: Event<L, G>) -> Ensemble<'a, L, true> {
        let mut plan = self.plan;
        plan.member_plan.event(event);
        Ensemble { plan }
    }

    /// Controls each member: the controller is called at the start and after every `interval`, reads the state and sets
    /// parameters. These hold until the next call (zero-order hold). The first argument is the index of the member.
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
    /// A controlled member moves exactly like a [`Motion`](crate::Motion) that is advanced to the same times, the start
    /// plus multiples of the interval. Fields of the system can store the controller's memory; on lanes these must be
    /// numbers. [Samples](Self::samples_at) are taken before the controller is called. For [events](Self::event) the
    /// motion restarts at each call, so that a function that jumps there does not count as a crossing.
    ///
    /// # Errors
    /// A member whose controller fails ends with [`Ending::ControllerFailed`](crate::Ending::ControllerFailed), and
    /// keeps all data so far. [`integrate`](Self::integrate) returns [`Error::Setting`](crate::Error::Setting) for an
    /// interval that is not positive and finite. An interval too short to advance the time ends the member with
    /// [`Ending::TimeTooCoarse`](crate::Ending::TimeTooCoarse).
    pub fn controlled<E: Display>(
        self,
        interval: L::Scalar,
        controller: impl Fn(usize, &mut L, &StateOf<L>) -> Result<(), E> + Send + Sync + 'a,
    ) -> Ensemble<'a, L, true> {
        let mut plan = self.plan;
        plan.member_plan.controller(interval, controller);
        Ensemble { plan }
    }

    /// Stores this quantity at each [sample](Self::samples_at); [`Outcome::quantity`](super::Outcome::quantity) returns
    /// the values by name. The function returns a number, or a result that looks one up by name: `|sample|
    /// sample.observable("height")`.
    ///
    /// The function is also evaluated at the start, so that an error there is reported before the first step. If it
    /// fails later, the member ends. The name is the name of a column in tables; [`integrate`](Self::integrate) returns
    /// [`EnsembleError::QuantityName`](super::EnsembleError::QuantityName) if it is that of another quantity, `t`, or the
    /// name of a coordinate or velocity.
    pub fn quantity<V: EventValue<L::Scalar>>(
        mut self,
        name: &'static str,
        function: impl Fn(&Sample<&L>) -> V + Send + Sync + 'a,
    ) -> Self {
        self.plan.member_plan.samples.quantity(name, function);
        self
    }
}
