//! The loop from the first step to the ending, the same for every method.

mod adaptive;
#[cfg(feature = "std")]
mod batch;
mod control;
mod dop853;
mod dopri5;
mod ending;
mod flow;
mod pair;
#[cfg(feature = "std")]
mod seat;
mod step;
#[cfg(test)]
mod tests;

use core::ops::ControlFlow;

pub use adaptive::Adaptive;
#[cfg(feature = "std")]
pub(crate) use batch::Batch;
pub use dop853::{Dop853, DormandPrince853};
pub use dopri5::{Dopri5, DormandPrince54};
pub use ending::Ending;
pub use flow::{Flow, LagrangianFlow, Point, Slope};
pub use pair::{Pair, Row};
#[cfg(feature = "std")]
pub(crate) use seat::Seat;

use crate::consistent::Consistent;
use crate::solve::solve;
use crate::trajectory::Path;
use crate::{Error, Lagrangian, Real, State, Trajectory, consistent};

/// Coordinates and velocities, or coordinates and momenta, as arrays: what a one-step method adds up.
pub type Phase<T, const N: usize> = [[T; N]; 2];

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

/// What an integration took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Statistics {
    /// Steps taken.
    pub accepted: usize,
    /// Steps tried and repeated shorter.
    pub rejected: usize,
    /// Evaluations of the equations of motion.
    pub evaluations: usize,
    /// Whether the constraints were independent in every evaluation.
    pub multipliers_are_unique: bool,
}

/// Of nothing done yet.
impl Default for Statistics {
    fn default() -> Self {
        Self { accepted: 0, rejected: 0, evaluations: 0, multipliers_are_unique: true }
    }
}

/// How far an integration has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The time of the start.
    pub start: f64,
    /// The time reached.
    pub time: f64,
    /// The time of the end.
    pub end: f64,
    /// Steps taken.
    pub steps: usize,
}

/// See [`Simulate::integrate_with`](crate::Simulate::integrate_with).
pub(crate) fn drive<'a, L, F, P, const N: usize, const M: usize>(
    system: &'a L,
    state: State<L::Scalar, N>,
    end: L::Scalar,
    method: &P,
    mut watch: impl FnMut(Progress) -> ControlFlow<()>,
) -> Result<Trajectory<'a, L, N, M, F>, Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
    F: Flow<L, N, M>,
    P: Method<L, N, M, F>,
{
    let mut statistics = Statistics::default();
    let ((start, adjustment), mut memory) = begin(system, &state, end, method, &mut statistics)?;
    let mut path = Path::from(start);
    let ending =
        run(system, start, end, method, &mut memory, &mut statistics, |state, interpolant, steps| {
            path.push(state, interpolant);
            watch(Progress { start: start.t.to_f64(), time: state.t.to_f64(), end: end.to_f64(), steps })
        });
    Ok(Trajectory::new(system, path, ending, statistics, adjustment))
}

/// Settings and start checked, the start made consistent, and what the method prepares there.
pub(crate) fn begin<L, F, P, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    end: L::Scalar,
    method: &P,
    statistics: &mut Statistics,
) -> Result<(Consistent<L::Scalar, N>, P::Memory), Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
    F: Flow<L, N, M>,
    P: Method<L, N, M, F>,
{
    method.check()?;
    let consistent = check_start(system, state, end)?;
    let memory = method.begin(system, &consistent.0, end, statistics)?;
    Ok((consistent, memory))
}

/// Steps from the start to the ending; `accept` is told each new state with its interpolant and how many there are.
pub(crate) fn run<L, F, P, const N: usize, const M: usize>(
    system: &L,
    mut state: State<L::Scalar, N>,
    end: L::Scalar,
    method: &P,
    memory: &mut P::Memory,
    statistics: &mut Statistics,
    mut accept: impl FnMut(State<L::Scalar, N>, &[Phase<L::Scalar, N>], usize) -> ControlFlow<()>,
) -> Ending
where
    L: Lagrangian<N, M, Scalar: Real>,
    F: Flow<L, N, M>,
    P: Method<L, N, M, F>,
{
    let limits = Watchdog::new(method.limits());
    loop {
        let time = state.t.to_f64();
        if state.t >= end {
            return Ending::Complete { time };
        }
        if let Some(ending) = limits.exceeded(statistics, time) {
            return ending;
        }
        match method.step(system, memory, statistics) {
            Step::Accepted { state: next, interpolant } => {
                statistics.accepted += 1;
                state = next;
                if accept(state, interpolant, statistics.accepted).is_break() {
                    return Ending::Cancelled { time: state.t.to_f64() };
                }
            }
            Step::Rejected => statistics.rejected += 1,
            Step::Failed(ending) => return ending,
        }
    }
}

/// The start made consistent to round-off, where that is all it lacks.
fn check_start<L, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    end: L::Scalar,
) -> Result<Consistent<L::Scalar, N>, Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    check_end(end)?;
    if end < state.t {
        return Err(Error::EndTime { start: state.t.to_f64(), end: end.to_f64() });
    }
    solve(system, state)?;
    consistent::check(system, state)?;
    consistent::make_consistent(system, state)
}

/// An end that can be reached.
pub(crate) fn check_end<T: Real>(end: T) -> Result<(), Error> {
    if end.is_finite() { Ok(()) } else { Err(Error::EndNotFinite { end: end.to_f64() }) }
}

struct Watchdog {
    limits: Limits,
    #[cfg(feature = "std")]
    started: std::time::Instant,
}

impl Watchdog {
    fn new(limits: Limits) -> Self {
        Self {
            limits,
            #[cfg(feature = "std")]
            started: std::time::Instant::now(),
        }
    }

    #[cfg(feature = "std")]
    fn restart(&mut self) {
        self.started = std::time::Instant::now();
    }

    fn exceeded(&self, statistics: &Statistics, time: f64) -> Option<Ending> {
        let steps = statistics.accepted + statistics.rejected;
        if steps >= self.limits.max_steps {
            return Some(Ending::StepLimit { time, steps });
        }
        #[cfg(feature = "std")]
        if self.limits.wall_time.is_some_and(|limit| self.started.elapsed() >= limit) {
            return Some(Ending::WallTimeLimit { time });
        }
        None
    }
}
