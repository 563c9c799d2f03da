//! The classical Runge–Kutta method of order 4, for any scalar.

use core::convert::Infallible;
use core::fmt;

use nalgebra::ComplexField;

use super::clock::Clock;
use super::contract::{Limits, Method, Step, check_settings, limit_setters};
use crate::error::{Ending, Error};
use crate::number::{Real, Scalar};
use crate::solution::consistent::{BOTH, project};
use crate::solution::interpolant::Polynomial;
use crate::solution::solve::{first_row, solve, solve_near};
use crate::statistics::Statistics;
use crate::system::{Lagrangian, Solution, State, StateOf};
use crate::vector::{Array, Element, Length, PhaseVector, Vector, array, from_fn, vector};

/// Returns the state a time `h` later, or earlier if `h` is negative, by one step of the classical Runge–Kutta method
/// of order 4 (Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, table II.1.2).
///
/// It is a plain function of the emitted accelerations, for every scalar: `f64` and `f32` in real time; SIMD
/// [lanes](crate::Lanes), each with its own step; dual numbers, which carry derivatives by the start or by parameters
/// through a motion. It always takes four evaluations, and estimates no error. The step must be short enough; compare
/// with a run at half the step. The state is NaN, lane by lane, if the elimination for the accelerations is not
/// reliable.
///
/// Only the accelerations satisfy the constraints: coordinates and velocities drift off as the errors of the steps
/// accumulate. [`RungeKutta4`] projects every step; [`make_consistent`](crate::Simulate::make_consistent) can project
/// from time to time.
///
/// ```
/// use lagrange_core::{prelude::*, runge_kutta_step};
///
/// /// A cart with a motor.
/// #[derive(Lagrangian)]
/// #[coordinates(x)]
/// #[lagrangian(m/2 * x_dot^2)]
/// #[force(x: u)]
/// struct Cart<T> { m: T, u: T }
///
/// let (mut cart, mut state) = (Cart { m: 2.0_f32, u: 0.0 }, State::at_rest([1.0]));
/// for _ in 0..1000 {
///     cart.u = -3.0 * state.q[0] - 4.0 * state.v[0];
///     state = runge_kutta_step(&cart, &state, 0.01);
/// }
/// assert!(state.q[0].abs() < 1e-4);
/// ```
#[inline]
#[must_use]
pub fn runge_kutta_step<L: Lagrangian>(system: &L, state: &StateOf<L>, h: L::Scalar) -> StateOf<L> {
    let stepped =
        step(state, h, |at| Ok::<_, Infallible>(system.accelerations_unchecked(at).accelerations.into()));
    match stepped {
        Ok(next) => next,
        Err(never) => match never {},
    }
}

/// One step, with any function for the accelerations.
#[inline(always)]
fn step<T: Scalar, E, N: Length>(
    state: &State<T, N>,
    h: T,
    mut accelerations: impl FnMut(&State<T, N>) -> Result<Array<T, N>, E>,
) -> Result<State<T, N>, E> {
    let (half, start) = (h * T::constant(0.5), [array(state.q), array(state.v)]);
    let moved = |by: T, slope: &[Array<T, N>; 2]| -> [Array<T, N>; 2] {
        from_fn(|half| from_fn(|i| start[half][i] + by * slope[half][i]))
    };
    let mut slope = |after: T, [q, v]: [Array<T, N>; 2]| -> Result<[Array<T, N>; 2], E> {
        Ok([v, accelerations(&State { t: state.t + after, q: vector(q), v: vector(v) })?])
    };
    let a = slope(T::constant(0.0), start)?;
    let b = slope(half, moved(half, &a))?;
    let c = slope(half, moved(half, &b))?;
    let d = slope(h, moved(h, &c))?;
    let two = T::constant(2.0);
    let sum = from_fn(|half| from_fn(|i| a[half][i] + two * (b[half][i] + c[half][i]) + d[half][i]));
    let [q, v] = moved(h / T::constant(6.0), &sum);
    Ok(State { t: state.t + h, q: vector(q), v: vector(v) })
}

/// The classical Runge–Kutta method of order 4 with fixed steps: [`runge_kutta_step`], with each step projected onto
/// the constraints.
///
/// For loops that must take the same time in every cycle; the error is not estimated. The dense output is the cubic
/// Hermite polynomial of the states and rates at both ends of a step. The last step before an end may be shorter.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct RungeKutta4 {
    step: f64,
    limits: Limits,
}

impl RungeKutta4 {
    /// Sets the step length, in units of time. The limit is 100 000 steps.
    pub fn with_step(step: f64) -> Self {
        Self { step, limits: Limits::default() }
    }

    limit_setters! {
        /// Sets the limit on the number of steps.
    }
}

/// State that the method carries from step to step.
#[derive(Clone, Debug)]
pub struct FixedStepState<T: Element, N: Length> {
    clock: Clock<T>,
    /// Length of the next step.
    planned: T,
    before: State<T, N>,
    state: State<T, N>,
}

impl<L: Lagrangian<Scalar: Real>> Method<L> for RungeKutta4 {
    type Memory = FixedStepState<L::Scalar, L::N>;
    type Interpolant = Polynomial<L::Scalar, [PhaseVector<L::Scalar, L::N>; 4]>;

    fn limits(&self) -> Limits {
        self.limits
    }

    fn identify(&self, to: &mut dyn fmt::Write) -> fmt::Result {
        write!(to, "RungeKutta4 {:?}", self.step)
    }

    fn check(&self) -> Result<(), Error> {
        check_settings([("fixed step", Some(self.step))])
    }

    fn begin(&self, _: &L, start: &StateOf<L>, _: &mut Statistics) -> Result<Self::Memory, Error> {
        let planned = L::Scalar::constant(self.step);
        Ok(FixedStepState {
            clock: Clock::new(start.t, Some(planned)),
            planned,
            before: *start,
            state: *start,
        })
    }

    #[inline]
    fn step(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        end: L::Scalar,
        statistics: &mut Statistics,
    ) -> Step<L::Scalar, L::N> {
        let FixedStepState { clock, planned, before, state } = memory;
        clock.aim(end);
        let (h, time) = clock.next(*planned);
        if !clock.is_ahead(time) {
            return Step::Failed(Ending::TimeTooCoarse { time: time.to_f64(), step: self.step });
        }
        statistics.evaluations += 4;
        let mut next = State { t: time, ..runge_kutta_step(system, state, h) };
        if (<L::M>::COUNT > 0 || !is_finite(&next))
            && let Err(error) = mend(system, state, h, &mut next, statistics)
        {
            return Step::Failed(Ending::of(error, state.t.to_f64()));
        }
        *planned = clock.tick((h, time), *planned, L::Scalar::constant(self.step));
        (*before, *state) = (*state, next);
        Step::Accepted(next)
    }

    #[inline]
    fn resume(
        &self,
        _: &L,
        memory: &mut Self::Memory,
        state: &StateOf<L>,
        _: &mut Statistics,
    ) -> Result<(), Error> {
        memory.clock.set(state.t);
        // Copy only if the states differ: the processor overlaps the comparison with the integration, but a copy
        // stalls on recent stores.
        if memory.state != *state {
            (memory.before, memory.state) = (*state, *state);
        }
        Ok(())
    }

    fn interpolant(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        statistics: &mut Statistics,
    ) -> Result<Self::Interpolant, Error> {
        let FixedStepState { before, state, .. } = memory;
        let mut node = |state: &StateOf<L>| -> Result<_, Error> {
            statistics.evaluations += 1;
            let rates = PhaseVector::of(state.v, solve(system, state)?.accelerations);
            Ok((PhaseVector::of(state.q, state.v), rates))
        };
        let (first, last) = (node(before)?, node(state)?);
        Ok(Polynomial::hermite(before.t, state.t - before.t, &first, &last))
    }
}

fn is_finite<T: Real, N: Length>(state: &State<T, N>) -> bool {
    // `&` instead of `&&` avoids a branch for each entry.
    let all_finite = |x: &Vector<T, N>| x.iter().fold(true, |all, x| all & x.is_finite());
    all_finite(&state.q) & all_finite(&state.v)
}

/// Completes a step of `h` from `start`: repeats it by the general solver if the elimination is not reliable, and
/// projects the end onto the constraints. An error rejects the step.
fn mend<L: Lagrangian<Scalar: Real>>(
    system: &L,
    start: &StateOf<L>,
    h: L::Scalar,
    end: &mut StateOf<L>,
    statistics: &mut Statistics,
) -> Result<(), Error> {
    if !is_finite(end) {
        // Later stages are off the constraints, so they use the constraints that are independent at the start.
        let mut at_start = None;
        let solved = step(start, h, |at| {
            let of = |solution: &Solution<_, L::N, L::M>, active: &_| (*solution, *active);
            let (solution, active) = solve_near(system, at, at_start.as_ref(), of)?;
            at_start.get_or_insert(active);
            statistics.multipliers_are_unique &= solution.multipliers_are_unique();
            Ok::<_, Error>(solution.accelerations.into())
        })?;
        *end = State { t: end.t, ..solved };
    }
    match first_row::<L>(|i| !(end.q[i].is_finite() && end.v[i].is_finite()), |_| false) {
        Some(row) => Err(Error::EquationsNotFinite { row, time: start.t.to_f64() }),
        None => project(system, &BOTH, end),
    }
}
