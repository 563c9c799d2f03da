//! Steps of one length across contacts, for many of them.

mod cones;
mod newton;
mod step;
mod trajectory;

use alloc::vec::Vec;

use super::bodies::Bodies;
use super::builder::{CrossesContacts, check_times};
use super::{Contact, Contacts};
use crate::error::{Ending, Error, Pace};
use crate::motion::Simulate;
use crate::motion::method::contract::check_settings;
use crate::motion::progress::report;
use crate::motion::{AllSteps, LagrangianVectorField, MotionBuilder, Start};
use crate::number::{Real, Scalar};
use crate::solution::solve::solve;
use crate::system::{Lagrangian, StateOf};
pub use trajectory::{SteppedTrajectory, TimeStep};

/// Largest number of steps unless [`max_steps`](MoreauJean::max_steps) sets another.
const STEPS: usize = 100_000;

/// Part of a step by which the last one may be longer than the others, instead of one more.
const LONGER: f64 = 1e-6;

/// Largest number of states for which memory is reserved before the first step.
const RESERVED: usize = 1 << 16;

/// Time stepping of contacts by the scheme of Moreau and Jean: [`by_time_stepping`](MotionBuilder::by_time_stepping).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct MoreauJean {
    step: f64,
    theta: f64,
    tolerance: f64,
    max_iterations: usize,
    max_steps: usize,
}

impl MoreauJean {
    /// Sets the step length, in units of time. θ is ½, the tolerance 10⁻¹⁰, and the limits are 10,000 sweeps in a step and
    /// 100,000 steps.
    pub fn with_step(step: f64) -> Self {
        Self { step, theta: 0.5, tolerance: 1e-10, max_iterations: 10_000, max_steps: STEPS }
    }

    /// Sets the part θ of a step for which the bodies move with the velocities after it, from ½ to 1. Vibrations keep their energy
    /// with ½, to the second order, and with 1 to the first.
    pub fn theta(self, theta: f64) -> Self {
        Self { theta, ..self }
    }

    /// Sets the tolerance of the [residual](TimeStep::residual) of the impulses of a step.
    pub fn tolerance(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// Sets the largest number of sweeps in a step.
    pub fn max_iterations(self, max_iterations: usize) -> Self {
        Self { max_iterations, ..self }
    }

    /// Sets the largest number of steps.
    pub fn max_steps(self, max_steps: usize) -> Self {
        Self { max_steps, ..self }
    }

    fn check(&self) -> Result<(), Error> {
        let sweeps = self.max_iterations as f64;
        check_settings([
            ("step", Some(self.step)),
            ("tolerance", Some(self.tolerance)),
            ("largest number of sweeps", Some(sweeps)),
        ])?;
        let is_right = self.theta >= 0.5 && self.theta <= 1.0;
        if is_right { Ok(()) } else { Err(Error::Theta { value: self.theta }) }
    }
}

/// Marks a motion in steps of one length across contacts: `to` returns a [`SteppedTrajectory`].
#[derive(Clone, Copy, Debug)]
pub struct TimeStepping {
    scheme: MoreauJean,
}

impl<'a, 'w, L: Contacts + Clone, S, P> MotionBuilder<'a, 'w, L, S, P, (), AllSteps> {
    /// Moves across the [contacts](crate::contact) of the system in steps of one length, without events, by the
    /// [scheme of Moreau and Jean](MoreauJean).
    pub fn by_time_stepping(self, scheme: MoreauJean) -> MotionBuilder<'a, 'w, L, S, P, (), TimeStepping>
    where
        S: CrossesContacts,
    {
        self.keeping(|_| TimeStepping { scheme })
    }
}

/// Settings of a motion from a state.
type Builder<'a, 'w, L, P> = MotionBuilder<
    'a,
    'w,
    L,
    Start<<L as Lagrangian>::Scalar, <L as Lagrangian>::N, LagrangianVectorField>,
    P,
    (),
    TimeStepping,
>;

impl<L: Contacts<Scalar: Real> + Clone, P> Builder<'_, '_, L, P> {
    /// Moves to the time `end`.
    ///
    /// # Errors
    /// Those of [`towards`](Self::towards), and [`Error::Unfinished`] if the motion stops before.
    pub fn to(self, end: L::Scalar) -> Result<SteppedTrajectory<L>, Error> {
        self.towards(end)?.finished()
    }

    /// Moves towards the time `end`. If the motion fails on the way, the result holds what was computed until then, and its
    /// [`ending`](SteppedTrajectory::ending) the reason: [`Error::ImpulsesNotFound`] if the sweeps of a step leave a residual
    /// above the tolerance.
    ///
    /// # Errors
    /// [`Error::Setting`] and [`Error::Theta`] for settings that are not allowed; those of
    /// [`integrate`](crate::Simulate::integrate) before the first step; [`Error::Penetration`] if a gap is negative at the
    /// start; [`Error::MotionBackwards`] if `end` lies before the start.
    pub fn towards(self, end: L::Scalar) -> Result<SteppedTrajectory<L>, Error> {
        let Self { system, start, mut on_progress, kept: TimeStepping { scheme }, .. } = self;
        let state = start.into_state()?;
        scheme.check()?;
        check_times(state.t, end)?;
        let bodies = begin(system, &state, end)?;
        let (open, from) = (bodies.open.clone(), state.t);
        let mut stepper = step::Stepper::new(bodies, scheme, &state);
        let count = count(&scheme, (end - from).to_f64());
        let mut steps = Vec::with_capacity(count.min(scheme.max_steps).min(RESERVED) + 1);
        steps.push(TimeStep::start(state));
        let ending = loop {
            let (done, last): (usize, StateOf<L>) = (steps.len() - 1, steps[steps.len() - 1].state);
            let time = last.t.to_f64();
            if done == count {
                break Ending::Complete { time };
            }
            if done >= scheme.max_steps {
                break Ending::StepLimit { time, steps: done, pace: Pace::default() };
            }
            let planned = from + L::Scalar::constant(scheme.step * (done + 1) as f64);
            let next = if done + 1 == count { end } else { planned };
            if next <= last.t {
                break Ending::TimeTooCoarse { time, step: scheme.step };
            }
            match stepper.step(&last, next) {
                Ok(step) => steps.push(step),
                Err(error) => break Ending::of(error, time),
            }
            if let Err(ending) = report(&mut on_progress, [from, next, end], done + 1) {
                break ending;
            }
        };
        Ok(SteppedTrajectory { system: open, steps, ending })
    }
}

/// Checks the start.
fn begin<L: Contacts<Scalar: Real> + Clone>(
    system: &L,
    state: &StateOf<L>,
    end: L::Scalar,
) -> Result<Bodies<L>, Error> {
    let mut bodies = Bodies::new(system);
    solve(&bodies.open, state)?;
    bodies.passes(state);
    bodies.reaches(state, end - state.t)?;
    let is_closed: Vec<bool> =
        (0..L::CONTACTS.len()).map(|k| system.contact(k) != Some(Contact::Open)).collect();
    bodies.without_friction(&is_closed).check_consistent(state)?;
    bodies.crossed(&is_closed, state).map_or(Ok(()), Err)?;
    Ok(bodies)
}

/// Number of steps over a span of time, the last of which may be shorter.
fn count(scheme: &MoreauJean, span: f64) -> usize {
    Scalar::max(span / scheme.step - LONGER, 0.0).ceil() as usize
}
