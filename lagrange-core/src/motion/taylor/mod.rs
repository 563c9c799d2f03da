//! Taylor's method: the motion expanded in a power series about each state, to round-off.

pub(crate) mod control;
mod crossing;
mod defect;
pub(crate) mod expansion;
#[cfg(feature = "std")]
mod lanes;
mod polynomial;
mod roots;
mod sampling;
mod step;
mod sums;

use alloc::vec::Vec;
use core::fmt;

use super::method::clock::Clock;
use super::method::{Limits, Method, Step, check_settings};
use crate::error::{Ending, Error, Pace};
use crate::names::Entry;
use crate::number::{Real, Scalar, vector};
use crate::solution::solve::name;
use crate::statistics::Statistics;
use crate::system::{State, TaylorSeries};
use crossing::SingularStep;
use expansion::{Expansion, SolvedState};
pub use polynomial::TaylorPolynomial;
use sampling::Sampling;
use step::Attempt;

/// Taylor's method: each step is a power series of the motion about its start, whose coefficients come from recurrences
/// that the derive has found (Jorba and Zou, *Experimental Mathematics* 14 (2005) 99–117).
///
/// For smooth motions with errors below about 10⁻⁹, down to round-off, which is the default. The coefficients of accelerations
/// and multipliers of all orders are solved for with the one matrix that the equations have at the start of the step, so that
/// constraints cost nothing extra, and a chain as much as its length. Constraints of second degree take the fewest sums: state a rod by
/// the square of its length.
///
/// The order follows from the tolerance, 18 for 10⁻⁹ and 29 for round-off; the length of a step from the last five
/// coefficients, zeros passed over: from a symmetric start every fourth alone may be there. It is at most ten times that of the step
/// before; the first step moves the state by its size at most. A step is refused where the accelerations of the series at its end are
/// not those of the equations, to the tolerance. Rounding errors of the
/// states are carried along (compensated sums); each state is projected onto the constraints, its velocities along the
/// Hamiltonian vector fields of the constraints, so that what rounding does to the distance of a body leaves its angular momentum
/// and energy. On constraints, without magnetic fields and damping, energy changes as a random walk, of 9·10⁻¹⁶ of the kinetic energy in a step of 2½ rad, and
/// drifts by some 10⁻¹⁸ a step. Between its ends a step is the series itself.
///
/// A force may vanish to round-off where a step begins and be strong within: a wall by `tanh`, a pulse in time by `exp`, a high power
/// of a sine. The series does not know such a force. So the equations are also sampled within a step, at up to 128 times, wherever the
/// argument of `exp`, `tanh`, `sinh` or `cosh` or the base of a power of 16 or more, or one that a field says, goes far, and wherever a step gets more than
/// twice as long while its series has few terms. Guaranteed is that a force wider than the distance between two samples is seen, and a
/// Gaussian pulse whose standard deviation is a tenth of that distance. All other steps are compared with the equations at
/// their ends, where a pulse of an eighth of a step shows. Narrower forces can be missed, as by every method that evaluates at
/// points, and so can those inside of a [`Function`](crate::Function), of which only its values are known:
/// [`max_step`](Self::max_step) says how wide the narrowest is.
///
/// Where constraints become dependent at one pose alone, a step leads across it by a series that is cut off before the orders that
/// consist of rounding errors, to about 10⁻¹² as a rule; where none does, the motion ends before the pose.
///
/// A root that comes down to zero has a kink there, as √x² has, which its series does not know. Steps shrink towards it, about
/// thirty on each side, until a step across it changes nothing. Where a force jumps there, no step is short enough, and the motion
/// ends at that time. A power whose exponent is a parameter cannot be expanded where its base is zero.
///
/// A system with `abs`, `min`, `max` or `clamp` in its equations has no [`TaylorSeries`], nor one with a function that is not known over
/// every scalar or whose third derivatives the equations take, and the compiler says so. A [`Function`](crate::Function) is evaluated on a [`PowerSeries`](crate::PowerSeries) at every order; of
/// kinks inside of it each step is aware at its end and three times within, to 10⁻¹⁰ of the velocities or 10⁴ tolerances, whichever is
/// more. Parameters may change between steps. Nothing is allocated in a step.
/// In an ensemble four members, or eight with AVX-512, are expanded at once on SIMD lanes, each with its own step: `Ensemble::integrate_on_lanes`.
/// Derivatives of a motion come from the recurrences over dual numbers, to ten times the tolerance:
/// [`integrate_sensitivities`](crate::Linearized::integrate_sensitivities).
///
/// ```
/// use lagrange_core::prelude::*;
///
/// #[derive(Lagrangian)]
/// #[coordinates(x, y)]
/// #[lagrangian((x_dot^2 + y_dot^2)/2 + 1/sqrt(x^2 + y^2))]
/// struct Kepler;
///
/// // An ellipse of eccentricity 0.5, ten times around.
/// let start = State::new([0.5, 0.0], [0.0, 3.0_f64.sqrt()]);
/// let end = 20.0 * std::f64::consts::PI;
/// let path = Kepler.integrate(start, end, Taylor::default())?;
/// assert!((path.end().coordinate("x")? - 0.5).abs() < 1e-12);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Taylor {
    relative: f64,
    absolute: f64,
    max_step: Option<f64>,
    limits: Limits,
}

/// Tolerances at round-off, at most 100 000 steps, no limit on wall time.
impl Default for Taylor {
    fn default() -> Self {
        Self::with_tolerance(f64::EPSILON)
    }
}

impl Taylor {
    /// This relative and absolute tolerance.
    pub fn with_tolerance(tolerance: f64) -> Self {
        Self { relative: tolerance, absolute: tolerance, max_step: None, limits: Limits::default() }
    }

    /// The error allowed as a fraction of each entry. Below the round-off unit of the scalar it counts as that.
    pub fn relative_tolerance(self, tolerance: f64) -> Self {
        Self { relative: tolerance, ..self }
    }

    /// The error allowed in the unit of each entry, which matters where the entry is about zero.
    pub fn absolute_tolerance(self, tolerance: f64) -> Self {
        Self { absolute: tolerance, ..self }
    }

    /// The longest step allowed.
    pub fn max_step(self, step: f64) -> Self {
        Self { max_step: Some(step), ..self }
    }

    /// Sets the limit on the number of attempted steps.
    pub fn max_steps(mut self, steps: usize) -> Self {
        self.limits.max_steps = steps;
        self
    }

    /// How long the integration may take by the clock on the wall.
    #[cfg(feature = "std")]
    pub fn wall_time(mut self, limit: std::time::Duration) -> Self {
        self.limits.wall_time = Some(limit);
        self
    }
}

/// What Taylor's method carries from step to step.
#[derive(Clone, Debug)]
pub struct TaylorMemory<S, T, const N: usize, const M: usize> {
    pub(crate) clock: Clock<T>,
    pub(crate) state: State<T, N>,
    pub(crate) solved: SolvedState<T, N, M>,
    /// What rounding has left of the state: coordinates and velocities.
    rest: [[T; N]; 2],
    /// About the state, or about where the last step started.
    pub(crate) series: Expansion<S, T, N>,
    is_expanded: bool,
    /// The length of the next step; zero before the motion begins.
    pub(crate) planned: T,
    sampling: Sampling<T>,
    /// Where the step is summed by fewer orders.
    crossing: Option<SingularStep<T>>,
    /// What was known where the step taken last starts.
    before: Option<Before<T, N, M>>,
}

/// What is known of a state beside its series.
#[derive(Clone, Debug)]
struct Before<T, const N: usize, const M: usize> {
    solved: SolvedState<T, N, M>,
    rest: [[T; N]; 2],
    sampling: Sampling<T>,
}

impl<L, const N: usize, const M: usize> Method<L, N, M> for Taylor
where
    L: TaylorSeries<N, M, Scalar: Real>,
{
    type Memory = TaylorMemory<L::Sums, L::Scalar, N, M>;
    type Interpolant = TaylorPolynomial<L::Scalar, N>;

    fn limits(&self) -> Limits {
        self.limits
    }

    fn identify(&self, to: &mut dyn fmt::Write) -> fmt::Result {
        let Self { relative, absolute, max_step, .. } = self;
        write!(to, "Taylor {relative:?} {absolute:?} {max_step:?}")
    }

    fn check(&self) -> Result<(), Error> {
        check_settings([
            ("relative tolerance", Some(self.relative)),
            ("absolute tolerance", Some(self.absolute)),
            ("longest step", self.max_step),
        ])
    }

    fn begin(
        &self,
        system: &L,
        start: &State<L::Scalar, N>,
        statistics: &mut Statistics,
    ) -> Result<Self::Memory, Error> {
        statistics.evaluations += 1;
        let (zero, solved) = (L::Scalar::constant(0.0), SolvedState::at(system, start)?);
        statistics.multipliers_are_unique &= solved.solution.multipliers_are_unique();
        Ok(TaylorMemory {
            clock: Clock::new(start.t, None),
            state: *start,
            solved,
            rest: [[zero; N]; 2],
            series: Expansion::new::<L, M>(self.order::<L::Scalar>()),
            is_expanded: false,
            planned: zero,
            sampling: Sampling { step: zero, distance: zero },
            crossing: None,
            before: None,
        })
    }

    fn resume(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        state: &State<L::Scalar, N>,
        statistics: &mut Statistics,
    ) -> Result<(), Error> {
        statistics.evaluations += 1;
        memory.clock.set(state.t);
        (memory.state, memory.solved) = (*state, SolvedState::at(system, state)?);
        statistics.multipliers_are_unique &= memory.solved.solution.multipliers_are_unique();
        (memory.is_expanded, memory.before) = (false, None);
        memory.rest = [[L::Scalar::constant(0.0); N]; 2];
        Ok(())
    }

    fn step(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        end: L::Scalar,
        statistics: &mut Statistics,
    ) -> Step<L::Scalar, N> {
        self.aim(memory, end);
        let now = memory.clock.now.to_f64();
        if let Err(error) = self.expand(system, memory, statistics) {
            return Step::Failed(Ending::of(error, now));
        }
        let (h, time) = memory.clock.next(memory.planned);
        if !memory.clock.is_ahead(time) {
            return Step::Failed(Ending::TimeTooCoarse { time: now, step: memory.planned.to_f64() });
        }
        statistics.evaluations += 1;
        let ending = match self.attempt(system, memory, (h, time), statistics) {
            Ok(Attempt::Reached(next)) => {
                statistics.multipliers_are_unique &= memory.solved.solution.multipliers_are_unique();
                return Step::Accepted(next);
            }
            Ok(Attempt::Inaccurate(i)) => {
                Ending::StepTooSmall { time: now, entry: Entry::Velocity(name(&L::COORDINATES, i)) }
            }
            Err(error) => Ending::of(error, now),
        };
        if self.can_be_shorter(memory, h) { Step::Rejected } else { Step::Failed(ending) }
    }

    fn interpolant(
        &self,
        _: &L,
        memory: &mut Self::Memory,
        _: &mut Statistics,
    ) -> Result<Self::Interpolant, Error> {
        let Expansion { start, unit, q, summed, .. } = &memory.series;
        Ok(TaylorPolynomial::new(*start, *unit, q[..summed + 2].iter().copied()))
    }

    fn push_interpolant(
        &self,
        _: &L,
        memory: &mut Self::Memory,
        _: &mut Statistics,
        to: &mut Vec<Self::Interpolant>,
    ) -> Result<(), Error> {
        let Expansion { start, unit, q, summed, .. } = &memory.series;
        to.push(TaylorPolynomial::empty(*start, *unit));
        if let Some(last) = to.last_mut() {
            last.set(q[..summed + 2].iter().copied());
        }
        Ok(())
    }

    fn undo(&self, memory: &mut Self::Memory) -> bool {
        let Some(Before { solved, rest, sampling }) = memory.before.take() else { return false };
        let (start, h) = (memory.series.start, memory.clock.now - memory.series.start);
        memory.clock.now = start;
        memory.state = State { t: start, q: vector(memory.series.q[0]), v: vector(memory.series.v[0]) };
        (memory.solved, memory.rest, memory.sampling, memory.is_expanded) = (solved, rest, sampling, true);
        self.can_be_shorter(memory, h)
    }

    fn pace(&self, _: &L, memory: &Self::Memory, _: L::Scalar) -> Pace {
        Pace { step: Some(memory.planned.to_f64()), ..Pace::default() }
    }
}
