//! The trait [`Method`]: interface of the integration methods.

use core::fmt;
use core::time::Duration;

use super::bounds::MultiplierBounds;
use crate::error::{Ending, Error, Pace};
use crate::number::Real;
use crate::room::Within;
use crate::solution::interpolant::Interpolant;
use crate::solution::vector_field::VectorField;
use crate::statistics::Statistics;
use crate::system::{SolutionOf, StateOf, System};

/// An integration method: a value with settings that proposes steps from one state to the next. Its bounds say to which
/// systems it applies, and `F` whether it integrates Lagrange's or Hamilton's equations.
///
/// [`integrate`](crate::Simulate::integrate) and [`Motion`](crate::Motion) check the start, run the loop, store the
/// steps and reach the end. A method works without an allocator if its `Memory` does.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a method that integrates `{L}`",
    note = "methods are `Dop853::default()`, `Taylor::default()`, `Dopri5::default()`, `Radau::default()`, and with steps of one length `RungeKutta4::with_step(…)`, `Verlet`, `Gauss::<2>`, `Lobatto::<2>` and `DAlembert`; the system must be over `f64` or `f32`",
    note = "motions in (q, p), `motion_in_momenta`, are integrated by `Dop853`, `Dopri5` and other pairs alone",
    note = "the order is `integrate(start, end, method)`; time steps across contacts are `motion(start).by_time_stepping(scheme)`"
)]
pub trait Method<L, F = <L as System>::Field>
where
    L: System<Scalar: Real>,
    F: VectorField<L>,
{
    /// State of the method that is carried from step to step, including its working arrays.
    type Memory;
    /// Dense output of one step.
    type Interpolant: Interpolant<L::Scalar, L::Length> + Send + Sync + 'static;

    /// Limits on steps and wall-clock time.
    fn limits(&self) -> Limits;

    /// Writes the name of the method and the settings that affect its results; the limits do not. Tables of ensembles
    /// distinguish runs by this text.
    ///
    /// # Errors
    /// Those of writing to `to`.
    fn identify(&self, to: &mut dyn fmt::Write) -> fmt::Result;

    /// Returns the part of an entry of the state by which a step may err; zero if the method does not estimate its errors.
    fn accuracy(&self) -> f64 {
        0.0
    }

    /// Checks the settings.
    ///
    /// # Errors
    /// [`Error::Setting`] for a setting that is not allowed.
    fn check(&self) -> Result<(), Error>;

    /// Prepares the first step from a consistent state. The settings have been checked.
    ///
    /// # Errors
    /// Those of evaluating the equations.
    fn begin(
        &self,
        system: &L,
        start: &StateOf<L>,
        statistics: &mut Statistics,
    ) -> Result<Self::Memory, Error>;

    /// Continues from another consistent state, or after a change of the system. The method may keep its step length.
    ///
    /// # Errors
    /// Those of evaluating the equations.
    fn resume(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        state: &StateOf<L>,
        statistics: &mut Statistics,
    ) -> Result<(), Error> {
        *memory = self.begin(system, state, statistics)?;
        Ok(())
    }

    /// Tries one step towards the time `end`, which may lie before the state. A step must not pass the end, and must be
    /// able to reach it exactly; the caller turns a step that does not lead towards the end into
    /// [`Ending::MethodFailed`].
    ///
    /// `from` is the state at the start of the step, and `to` is a copy of it. An accepted step writes the state at its end to
    /// `to`; this state satisfies the constraints. After any other step `to` may hold anything. The method must count its
    /// evaluations in `statistics`.
    fn step(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        end: L::Scalar,
        from: &StateOf<L>,
        to: &mut StateOf<L>,
        statistics: &mut Statistics,
    ) -> Step;

    /// Returns the dense output of the last accepted step, between the states `ends`. It is called only when needed, before the next
    /// step and before a change of the system.
    ///
    /// # Errors
    /// Those of evaluating the equations within the step.
    fn interpolant(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        ends: [&StateOf<L>; 2],
        statistics: &mut Statistics,
    ) -> Result<Self::Interpolant, Error>;

    /// Appends the dense output of the last accepted step to `to`, built in place so that a large one does not go
    /// through the stack. After an error, `to` has its former length.
    ///
    /// # Errors
    /// Those of [`interpolant`](Self::interpolant).
    fn push_interpolant(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        ends: [&StateOf<L>; 2],
        statistics: &mut Statistics,
        to: &mut Within<Self::Interpolant>,
    ) -> Result<(), Error> {
        to.push(self.interpolant(system, memory, ends, statistics)?);
        Ok(())
    }

    /// Returns bounds on the multipliers within the last accepted step, once its dense output has been computed; `None` if the
    /// method knows none. The method must count its evaluations in `statistics`.
    #[allow(unused_variables)]
    fn multiplier_bounds(
        &self,
        system: &L,
        memory: &Self::Memory,
        statistics: &mut Statistics,
    ) -> Option<MultiplierBounds<L::Scalar, L::M>> {
        None
    }

    /// Returns the mean accelerations and multipliers of the last accepted step, if samples have these in the place of those of the equations.
    #[doc(hidden)]
    #[allow(unused_variables)]
    fn means(&self, memory: &Self::Memory) -> Option<SolutionOf<L>> {
        None
    }

    /// Undoes the last step because its dense output is needed and cannot be computed; the next attempt is shorter.
    /// Returns false if this is impossible: the motion then ends before the step.
    #[allow(unused_variables)]
    fn undo(&self, memory: &mut Self::Memory) -> bool {
        false
    }

    /// Returns the current step length and what limits it. Called when the limit on steps is reached.
    #[allow(unused_variables)]
    fn pace(&self, system: &L, memory: &Self::Memory, end: L::Scalar) -> Pace {
        Pace::default()
    }
}

/// Checks that all given settings are positive and finite.
pub(crate) fn check_settings<const K: usize>(
    settings: [(&'static str, Option<f64>); K],
) -> Result<(), Error> {
    let is_wrong = |value: &f64| !(*value > 0.0 && value.is_finite());
    let wrong = settings.into_iter().find_map(|(name, value)| Some((name, value.filter(is_wrong)?)));
    match wrong {
        None => Ok(()),
        Some((name, value)) => Err(Error::Setting { name, value }),
    }
}

/// Result of an attempted step.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// The step reached a new state.
    Accepted,
    /// The step was too long; the next attempt is shorter.
    Rejected,
    /// No shorter step exists, or no step can succeed. Reasons specific to the method are [`Ending::MethodFailed`].
    Failed(Ending),
}

/// Limits at which an integration gives up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest number of attempted steps, rejected ones included.
    pub max_steps: usize,
    /// Largest wall-clock time. It asks for `std`: elsewhere there is no clock.
    pub wall_time: Option<Duration>,
}

/// Setters of a method with the field `limits`. The limit on steps is described in the words given.
macro_rules! limit_setters {
    ($(#[$words:meta])*) => {
        $(#[$words])*
        pub fn max_steps(mut self, steps: usize) -> Self {
            self.limits.max_steps = steps;
            self
        }

        /// Sets the limit on the wall-clock time of the integration.
        #[cfg(feature = "std")]
        pub fn wall_time(mut self, limit: std::time::Duration) -> Self {
            self.limits.wall_time = Some(limit);
            self
        }
    };
}

pub(crate) use limit_setters;

/// At most 100 000 steps, no limit on wall-clock time.
impl Default for Limits {
    fn default() -> Self {
        Self { max_steps: 100_000, wall_time: None }
    }
}
