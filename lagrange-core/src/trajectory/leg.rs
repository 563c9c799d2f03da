//! Legs of a motion: its parts between transitions.

use alloc::vec::Vec;
use core::fmt::{self, Debug, Formatter};
use core::iter::once;
use core::marker::PhantomData;

use super::path::Path;
use crate::error::Error;
use crate::number::Real;
use crate::solution::Sample;
use crate::solution::system_checks::SystemChecks;
use crate::solution::vector_field::VectorField;
use crate::system::{Solution, SolutionOf, StateOf, System};

/// A part of a [`Trajectory`](super::Trajectory) between two transitions, with the system as it is there: a motion without contacts has
/// one leg.
pub struct Leg<S: System, F = <S as System>::Field> {
    pub(super) system: S,
    pub(super) path: Path<S::Scalar, S::Length>,
    /// Number of transitions of the motion before the leg.
    pub(super) transitions: usize,
    /// Event at its end, of the user or of a contact.
    boundary: Option<&'static str>,
    means: Option<Means<S>>,
    field: PhantomData<F>,
}

/// Mean accelerations and multipliers in a motion by time steps, with the system to which they belong.
struct Means<S: System> {
    /// The system with all contacts closed and all friction sticking: each multiplier has its constraint.
    closed: S,
    /// Mean accelerations and multipliers of each step.
    of_steps: Vec<SolutionOf<S>>,
}

impl<S: System, F> Leg<S, F> {
    pub(crate) fn new(system: S, path: Path<S::Scalar, S::Length>, boundary: Option<&'static str>) -> Self {
        Self { system, path, transitions: 0, boundary, means: None, field: PhantomData }
    }

    /// A motion by time steps with these mean accelerations and multipliers, which belong to its system, whose contacts are all closed.
    pub(crate) fn in_time_steps(self, open: S, mut of_steps: Vec<SolutionOf<S>>) -> Self {
        // An event may cut off the last step at its start.
        of_steps.truncate(self.path.len());
        Self { system: open, means: Some(Means { closed: self.system, of_steps }), ..self }
    }

    /// True if it is a motion by time steps.
    pub(crate) fn is_in_time_steps(&self) -> bool {
        self.means.is_some()
    }

    /// The same leg, with this number of transitions of the motion before it.
    pub(crate) fn after(self, transitions: usize) -> Self {
        Self { transitions, ..self }
    }

    /// True if this number of transitions, all those of the motion so far, are before the leg.
    pub(crate) fn is_after(&self, transitions: usize) -> bool {
        self.transitions == transitions
    }

    /// Name of the event, of the user or of a contact, at its end.
    pub(crate) fn boundary(&self) -> Option<&'static str> {
        self.boundary
    }

    /// Returns the system, with the contacts of the leg.
    pub fn system(&self) -> &S {
        &self.system
    }

    pub(crate) fn first(&self) -> &StateOf<S> {
        &self.path.start
    }

    pub(crate) fn last(&self) -> &StateOf<S> {
        &self.path.last
    }
}

impl<L: System + Clone, F> Leg<&L, F> {
    pub(crate) fn into_owned(self) -> Leg<L, F> {
        let Self { system, path, transitions, boundary, means, field } = self;
        let means = means.map(|Means { closed, of_steps }| Means { closed: closed.clone(), of_steps });
        Leg { system: system.clone(), path, transitions, boundary, means, field }
    }
}

impl<S: System<Scalar: Real> + Clone, F: VectorField<S>> Leg<S, F> {
    /// Returns its first state.
    pub fn start(&self) -> Sample<S> {
        self.first_sample().into_owned()
    }

    /// Returns its last state, which is that before the next transition.
    pub fn end(&self) -> Sample<S> {
        self.last_sample().into_owned()
    }

    /// Returns the sample at this time.
    ///
    /// # Errors
    /// Those of [`Trajectory::at`](super::Trajectory::at).
    pub fn at(&self, t: S::Scalar) -> Result<Sample<S>, Error> {
        self.sample_at(t).map(Sample::into_owned)
    }

    /// Returns the states that the method computed, first and last included.
    pub fn steps(&self) -> impl Iterator<Item = Sample<S>> + '_ {
        self.samples_of_steps().map(Sample::into_owned)
    }
}

impl<S: System<Scalar: Real>, F: VectorField<S>> Leg<S, F> {
    /// A state of the leg, in a motion by time steps with the means of the step that leads there; at the start with those of the first.
    fn sample(&self, state: StateOf<S>) -> Sample<&S> {
        let Some(Means { closed, of_steps }) = &self.means else { return Sample::of(&self.system, state) };
        let of_step = of_steps.get(self.path.step_until(state.t)).copied();
        Sample::of(closed, state).with(of_step.or_else(|| Some(Solution::unknown())))
    }

    pub(super) fn first_sample(&self) -> Sample<&S> {
        self.sample((*self.path.start).clone())
    }

    pub(super) fn last_sample(&self) -> Sample<&S> {
        self.sample((*self.path.last).clone())
    }

    pub(crate) fn samples_of_steps(&self) -> impl Iterator<Item = Sample<&S>> + '_ {
        let starts = (0..self.path.len()).filter_map(|i| self.path.start_of(i));
        let states =
            starts.map(|point| F::state(&self.system, &point)).chain(once((*self.path.last).clone()));
        states.map(|state| self.sample(state))
    }

    /// Returns the state at the start of the last step; `None` without steps.
    pub(crate) fn before_last(&self) -> Option<StateOf<S>> {
        let point = self.path.start_of(self.path.len().checked_sub(1)?)?;
        Some(F::state(&self.system, &point))
    }

    /// Returns the sample at a time. An interpolated state violates the constraints by about the tolerance, so
    /// it is projected, unless it is between time steps, which violate them themselves.
    pub(super) fn sample_at(&self, t: S::Scalar) -> Result<Sample<&S>, Error> {
        if t == self.path.last.t {
            return Ok(self.last_sample());
        }
        let Some(point) = self.path.at(t) else {
            return Err(outside(t, [self.path.start.t, self.path.last.t]));
        };
        let state = match self.is_in_time_steps() {
            true => F::state(&self.system, &point),
            false => F::project(&self.system, &point)?,
        };
        Ok(self.sample(state))
    }
}

impl<S: System<Scalar: Real>, F: VectorField<S>> Debug for Leg<S, F> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut text = f.debug_struct("Leg");
        text.field("system", &F::Checks::name())
            .field("start", &*self.path.start)
            .field("end", &*self.path.last)
            .finish()
    }
}

/// The time is not between start and end.
pub(super) fn outside<T: Real>(time: T, [start, end]: [T; 2]) -> Error {
    let [time, start, end] = [time, start, end].map(Real::to_f64);
    Error::OutsideTrajectory { time, start, end }
}
