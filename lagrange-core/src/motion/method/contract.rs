//! What is asked of a method.

#[cfg(feature = "alloc")]
use alloc::vec::Vec;
use core::fmt;

use crate::error::{Ending, Error, Pace};
use crate::number::Real;
use crate::solution::interpolant::Interpolant;
use crate::solution::vector_field::{LagrangianVectorField, VectorField};
use crate::statistics::Statistics;
use crate::system::{Lagrangian, State};

/// A way to step from one state to the next; a value, whose type says by its bounds where it applies, and
/// whether it integrates Lagrange's equations or Hamilton's, the flow `F`.
///
/// [`integrate`](crate::Simulate::integrate) and [`Motion`](crate::Motion) check the start, loop, store and end; a method
/// proposes steps. It works without an allocator where its memory does.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a method that integrates `{L}`",
    note = "methods are `Dop853::default()`, `Taylor::default()`, `Dopri5::default()` and `RungeKutta4::with_step(…)`; the system must be over `f64` or `f32`",
    note = "the order is `integrate(start, end, method)`"
)]
pub trait Method<L, const N: usize, const M: usize, F = LagrangianVectorField>
where
    L: Lagrangian<N, M, Scalar: Real>,
    F: VectorField<L, N, M>,
{
    /// What is carried from step to step, working arrays included.
    type Memory;
    /// What lies within a step.
    type Interpolant: Interpolant<L::Scalar, N> + Send + Sync + 'static;

    /// When to give up.
    fn limits(&self) -> Limits;

    /// Writes which method it is and the settings that its numbers depend on; the limits do not belong to them. Tables of
    /// ensembles tell runs apart by it.
    ///
    /// # Errors
    /// What writing gives.
    fn identify(&self, to: &mut dyn fmt::Write) -> fmt::Result;

    /// Checks the settings.
    ///
    /// # Errors
    /// [`Error::Setting`] for one that cannot work.
    fn check(&self) -> Result<(), Error>;

    /// Prepares the first step from a consistent state, with settings that have been checked.
    ///
    /// # Errors
    /// What evaluating the equations gives.
    fn begin(
        &self,
        system: &L,
        start: &State<L::Scalar, N>,
        statistics: &mut Statistics,
    ) -> Result<Self::Memory, Error>;

    /// Goes on from another consistent state, or after the system has changed. What has been learnt about the length
    /// of steps can be kept.
    ///
    /// # Errors
    /// What evaluating the equations gives.
    fn resume(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        state: &State<L::Scalar, N>,
        statistics: &mut Statistics,
    ) -> Result<(), Error> {
        *memory = self.begin(system, state, statistics)?;
        Ok(())
    }

    /// Tries one step towards the time `end`, which may lie before the state. It never passes the end, and reaches it
    /// exactly: a step that does not lead to a time between is [`Ending::MethodFailed`]. Evaluations are to be counted.
    fn step(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        end: L::Scalar,
        statistics: &mut Statistics,
    ) -> Step<L::Scalar, N>;

    /// What lies within the step accepted last; asked for where it is of interest, before the next step and before the
    /// system changes.
    ///
    /// # Errors
    /// What evaluating the equations within the step gives.
    fn interpolant(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        statistics: &mut Statistics,
    ) -> Result<Self::Interpolant, Error>;

    /// Puts what lies within the step accepted last behind others, where it is to stay: a large one need not be on the stack. Where
    /// that is an error there is no more of them than before.
    ///
    /// # Errors
    /// As [`interpolant`](Self::interpolant).
    #[cfg(feature = "alloc")]
    fn push_interpolant(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        statistics: &mut Statistics,
        to: &mut Vec<Self::Interpolant>,
    ) -> Result<(), Error> {
        to.push(self.interpolant(system, memory, statistics)?);
        Ok(())
    }

    /// Takes the last step back, because its interpolant is wanted and there is none; the next attempt is shorter. False
    /// where that cannot be: the motion then ends before the step.
    #[allow(unused_variables)]
    fn undo(&self, memory: &mut Self::Memory) -> bool {
        false
    }

    /// How long the next step is, and what keeps it short. Asked when the limit on steps is reached.
    #[allow(unused_variables)]
    fn pace(&self, system: &L, memory: &Self::Memory, end: L::Scalar) -> Pace {
        Pace::default()
    }
}

/// All settings that there are must be positive and finite.
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

/// What became of a step.
#[derive(Clone, Debug, PartialEq)]
pub enum Step<T, const N: usize> {
    /// A new state on the constraints.
    Accepted(State<T, N>),
    /// Too long; the next attempt is shorter.
    Rejected,
    /// No step is short enough, or none will do. What only the method knows is [`Ending::MethodFailed`].
    Failed(Ending),
}

/// When an integration gives up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Attempted steps, rejected ones included.
    pub max_steps: usize,
    /// Limit on wall-clock time.
    #[cfg(feature = "std")]
    pub wall_time: Option<std::time::Duration>,
}

/// At most 100 000 steps, no limit on wall time.
impl Default for Limits {
    fn default() -> Self {
        Self {
            max_steps: 100_000,
            #[cfg(feature = "std")]
            wall_time: None,
        }
    }
}
