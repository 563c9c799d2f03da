//! A motion in steps of one length: its states, impulses, and residuals.

use alloc::vec::Vec;
use core::fmt::{self, Debug, Display, Formatter};

use crate::contact::Contacts;
use crate::error::{Ending, Error};
use crate::number::{Real, Scalar, larger};
use crate::system::{Lagrangian, StateOf, lookup};
use crate::vector::{Entrywise, Vector, zeros};

/// A step of a motion: what is known at its end.
pub struct TimeStep<L: Lagrangian> {
    /// State at the end of the step. Coordinates satisfy gaps and constraints there; velocities satisfy them where the
    /// impulses act, within the step.
    pub state: StateOf<L>,
    /// Impulses Λ of all constraints, contacts and friction in the step: momenta change by WᵀΛ.
    pub impulses: Vector<L::Scalar, L::M>,
    /// How often the impulses were found, as forces change with the velocities.
    pub iterations: usize,
    /// What the balance of momentum is off by, as a part of its largest term, both in units of the root of an energy.
    pub residual: L::Scalar,
}

impl<L: Lagrangian<Scalar: Real>> TimeStep<L> {
    /// The start of a motion.
    pub(super) fn start(state: StateOf<L>) -> Self {
        let zero = L::Scalar::constant(0.0);
        Self { state, impulses: zeros(), iterations: 0, residual: zero }
    }
}

impl<L: Lagrangian> TimeStep<L> {
    /// Returns the impulse of a contact, a friction or a constraint in the step. The friction of a contact `floor` is
    /// `floor_friction`.
    ///
    /// # Errors
    /// [`Error::UnknownName`] if there is none of this name.
    pub fn impulse(&self, name: &str) -> Result<L::Scalar, Error> {
        lookup::index::<L>(L::CONSTRAINTS, "constraint", name).map(|row| self.impulses[row])
    }
}

impl<L: Lagrangian> Clone for TimeStep<L> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: Lagrangian> Copy for TimeStep<L> {}

impl<L: Lagrangian> Debug for TimeStep<L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { state, impulses, iterations, residual } = self;
        let mut text = f.debug_struct("TimeStep");
        text.field("state", state).field("impulses", impulses);
        text.field("iterations", iterations).field("residual", residual).finish()
    }
}

/// A motion in steps of one length: [`by_time_stepping`](crate::MotionBuilder::by_time_stepping).
pub struct SteppedTrajectory<L: Lagrangian> {
    pub(super) system: L,
    /// The first is the start.
    pub(super) steps: Vec<TimeStep<L>>,
    pub(super) ending: Ending,
}

impl<L: Lagrangian> SteppedTrajectory<L> {
    /// Returns the steps. The first is the start, without impulses.
    pub fn steps(&self) -> &[TimeStep<L>] {
        &self.steps
    }

    /// Returns the last state.
    pub fn end(&self) -> &StateOf<L> {
        &self.steps[self.steps.len() - 1].state
    }

    /// Returns the system, with all contacts open.
    pub fn system(&self) -> &L {
        &self.system
    }

    /// Returns why the motion ends.
    pub fn ending(&self) -> &Ending {
        &self.ending
    }

    /// Returns the motion, unless a failure kept it from its end.
    ///
    /// # Errors
    /// [`Error::Unfinished`] with the [`ending`](Self::ending).
    pub fn finished(self) -> Result<Self, Error> {
        if self.ending.is_failure() { Err(self.ending.into()) } else { Ok(self) }
    }

    /// Returns the energy at the end of each step. Impacts and friction take of it, and so may the projection of velocities onto
    /// constraints.
    pub fn energies(&self) -> impl Iterator<Item = L::Scalar> + '_ {
        self.steps.iter().map(|step| self.system.energy(&step.state))
    }
}

impl<L: Lagrangian<Scalar: Real>> SteppedTrajectory<L> {
    /// Returns the state at this time, linear between the ends of steps in coordinates and velocities. Within a step that has an
    /// impact, velocities are means of those before and after it.
    ///
    /// # Errors
    /// [`Error::OutsideTrajectory`] for a time before the start or after the end.
    pub fn at(&self, t: L::Scalar) -> Result<StateOf<L>, Error> {
        let [start, end] = [self.steps[0].state.t, self.end().t];
        if !(start <= t && t <= end) {
            let [time, start, end] = [t, start, end].map(Real::to_f64);
            return Err(Error::OutsideTrajectory { time, start, end });
        }
        let next = self.steps.partition_point(|step| step.state.t < t);
        let after = &self.steps[next].state;
        if next == 0 || after.t == t {
            return Ok(*after);
        }
        let before = &self.steps[next - 1].state;
        let part = (t - before.t) / (after.t - before.t);
        let between = |x, y| x + part * (y - x);
        let (q, v) = (before.q.each_with(&after.q, between), before.v.each_with(&after.v, between));
        Ok(StateOf::<L> { t, q, v })
    }

    /// The largest number of iterations and the largest residual of a step.
    fn worst(&self) -> (usize, L::Scalar) {
        self.steps.iter().fold((0, L::Scalar::constant(0.0)), |(iterations, residual), step| {
            (iterations.max(step.iterations), larger(residual, step.residual))
        })
    }
}

/// A summary: steps, the largest number of iterations and the largest residual, and the ending.
impl<L: Contacts<Scalar: Real>> Display for SteppedTrajectory<L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [start, end] = [self.steps[0].state.t, self.end().t];
        let ((iterations, residual), steps) = (self.worst(), self.steps.len() - 1);
        let [of_steps, of_iterations] = [steps, iterations].map(|count| if count == 1 { "" } else { "s" });
        writeln!(f, "{} from t = {start} to t = {end}: {steps} step{of_steps}", L::NAME)?;
        let residual = residual.to_f64();
        writeln!(
            f,
            "at most {iterations} iteration{of_iterations} and a residual of {residual:.1e} in a step"
        )?;
        write!(f, "{}", self.ending)
    }
}

impl<L: Lagrangian> Debug for SteppedTrajectory<L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut text = f.debug_struct("SteppedTrajectory");
        text.field("system", &L::NAME)
            .field("end", self.end())
            .field("ending", &self.ending)
            .finish_non_exhaustive()
    }
}
