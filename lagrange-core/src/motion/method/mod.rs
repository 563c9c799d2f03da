//! The methods: one step of each, and how a step is chosen.

mod adaptive;
pub(super) mod clock;
pub(super) mod control;
mod dop853;
mod dopri5;
pub(super) mod pair;
pub(super) mod step;

pub use adaptive::Adaptive;
pub use dop853::{Dop853, DormandPrince853};
pub use dopri5::{Dopri5, DormandPrince54};
pub use pair::{Combination, Pair};

use crate::error::Error;
use crate::number::Real;
use crate::solution::flow::{Flow, LagrangianFlow, Phase};
use crate::system::{Lagrangian, State};
use crate::trajectory::{Ending, Statistics};

/// A way to step from one state to the next; a value, whose type says by its bounds where it applies, and
/// whether it integrates Lagrange's equations or Hamilton's, the flow `F`.
///
/// [`drive`](crate::Simulate::integrate) checks the start, loops, stores and ends; a method proposes steps.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a method that integrates `{L}`",
    note = "use `Dop853::default()` or `Dopri5::default()`; the system must be over `f64` or `f32`"
)]
pub trait Method<L, const N: usize, const M: usize, F = LagrangianFlow>
where
    L: Lagrangian<N, M, Scalar: Real>,
    F: Flow<L, N, M>,
{
    /// What is carried from step to step, working arrays included.
    type Memory;

    /// When to give up.
    fn limits(&self) -> Limits;

    /// Checks the settings.
    ///
    /// # Errors
    /// [`Error::Setting`] for one that cannot work.
    fn check(&self) -> Result<(), Error>;

    /// The same method where only the states after the steps are of interest: it need not compute interpolants.
    #[must_use]
    fn sparse(self) -> Self
    where
        Self: Sized,
    {
        self
    }

    /// Prepares the first step from a consistent state, with settings that have been checked.
    ///
    /// # Errors
    /// What evaluating the equations gives.
    fn begin(
        &self,
        system: &L,
        start: &State<L::Scalar, N>,
        end: L::Scalar,
        statistics: &mut Statistics,
    ) -> Result<Self::Memory, Error>;

    /// Tries one step. It never passes the end, and reaches it exactly.
    fn step<'m>(
        &self,
        system: &L,
        memory: &'m mut Self::Memory,
        statistics: &mut Statistics,
    ) -> Step<'m, L::Scalar, N>;
}

/// What became of a step.
#[derive(Debug)]
pub enum Step<'m, T, const N: usize> {
    /// A new state on the constraints.
    Accepted {
        /// The state.
        state: State<T, N>,
        /// Coefficients r₀, r₁, … (as many in every step, none from a [`sparse`](Method::sparse) method) of the interpolant
        /// r₀ + θ(r₁ + (1−θ)(r₂ + θ(r₃ + (1−θ)(…)))), θ from 0 to 1 over the step
        /// (Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, II.6).
        interpolant: &'m [Phase<T, N>],
    },
    /// Too long; the next attempt is shorter.
    Rejected,
    /// No step is short enough, or none will do.
    Failed(Ending),
}

/// When an integration gives up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Attempted steps, rejected ones included.
    pub max_steps: usize,
    /// Time by the clock on the wall.
    #[cfg(feature = "std")]
    pub wall_time: Option<std::time::Duration>,
}
