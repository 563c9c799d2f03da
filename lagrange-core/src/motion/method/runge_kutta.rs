//! The classical Runge–Kutta method of order 4, for any scalar.

use core::convert::Infallible;
use core::fmt;

use nalgebra::ComplexField;

use super::clock::Clock;
use super::contract::{Limits, Method, Step, check_settings, limit_setters};
use crate::error::{Ending, Error};
use crate::number::{Real, Scalar, are_finite};
use crate::solution::interpolant::Polynomial;
use crate::solution::named_field::NamedField;
use crate::solution::vector_field::{StagePoint, VectorField, VelocityField};
use crate::statistics::Statistics;
use crate::system::{State, StateOf, System};
use crate::vector::{Element, Length, Numbers, PhaseVector, SpareVectors, each};

/// Returns the state a time `h` later, or earlier if `h` is negative, by one step of the classical Runge–Kutta method
/// of order 4 (Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, table II.1.2).
///
/// It is a plain function of the emitted accelerations, for every scalar: `f64` and `f32` in real time; SIMD
/// [lanes](crate::Lanes), each with its own step; dual numbers, which carry derivatives by the start or by parameters
/// through a motion. It always takes four evaluations, and estimates no error. The step must be short enough; compare
/// with a run at half the step. The state is NaN, lane by lane, if the elimination for the accelerations is not
/// reliable.
///
/// The state must have as many coordinates and velocities as the system has coordinates: this function does not check it.
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
pub fn runge_kutta_step<L: System>(system: &L, state: &StateOf<L>, h: L::Scalar) -> StateOf<L> {
    let mut next = state.clone();
    unchecked(system, h, &mut next, &mut SpareVectors::default());
    next
}

/// Moves a state by one step, with the accelerations as the system states them.
#[inline(always)]
fn unchecked<L: System>(
    system: &L,
    h: L::Scalar,
    state: &mut StateOf<L>,
    spare: &mut SpareVectors<L::Scalar, L::Length>,
) {
    let moved = step(h, state, spare, |t, y, rates| {
        rates[0].copy_from_slice(&y[1]);
        system.accelerations(t, y.view(0), y.view(1), rates.view_mut(1));
        Ok::<_, Infallible>(())
    });
    match moved {
        Ok(()) => {}
        Err(never) => match never {},
    }
}

/// Moves a state by one step, with any function for the rates.
#[inline(always)]
fn step<T: Scalar, E, N: Length>(
    h: T,
    state: &mut State<T, N>,
    spare: &mut SpareVectors<T, N>,
    mut evaluate: impl FnMut(T, &PhaseVector<T, N>, &mut PhaseVector<T, N>) -> Result<(), E>,
) -> Result<(), E> {
    let start = spare.join(&state.q, &state.v);
    let [zero, half, two] = [0.0, 0.5, 2.0].map(T::constant);
    let moved = |by: T, slope: &PhaseVector<T, N>, mut to: PhaseVector<T, N>| {
        each::<T, N, 2>([start.flat(), slope.flat()], to.flat_mut(), |_, [x, slope]| x + by * slope);
        to
    };
    let mut slope = |after: T, y: &PhaseVector<T, N>, mut rates: PhaseVector<T, N>| {
        evaluate(state.t + after, y, &mut rates).map(|()| rates)
    };
    let point = spare.lend(&start);
    let mut a = slope(zero, &start, spare.lend(&start))?;
    let point = moved(h * half, &a, point);
    let b = slope(h * half, &point, spare.lend(&start))?;
    let point = moved(h * half, &b, point);
    let c = slope(h * half, &point, spare.lend(&start))?;
    let point = moved(h, &c, point);
    let d = slope(h, &point, spare.lend(&start))?;
    each::<T, N, 3>([b.flat(), c.flat(), d.flat()], a.flat_mut(), |a, [b, c, d]| a + two * (b + c) + d);
    let end = moved(h / T::constant(6.0), &a, point);
    state.t = state.t + h;
    state.q.entries_mut().copy_from_slice(&end[0]);
    state.v.entries_mut().copy_from_slice(&end[1]);
    for lent in [start, a, b, c, d, end] {
        spare.give_back(lent);
    }
    Ok(())
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
    /// Current state. The method has its own: a step would wait for the copies that the loop makes of its states.
    state: State<T, N>,
    spare: SpareVectors<T, N>,
}

impl<L: System<Scalar: Real>, F: VelocityField<L>> Method<L, F> for RungeKutta4 {
    type Memory = FixedStepState<L::Scalar, L::Length>;
    type Interpolant = Polynomial<L::Scalar, [PhaseVector<L::Scalar, L::Length>; 4]>;

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
            state: start.clone(),
            spare: SpareVectors::default(),
        })
    }

    #[inline]
    fn step(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        end: L::Scalar,
        from: &StateOf<L>,
        to: &mut StateOf<L>,
        statistics: &mut Statistics,
    ) -> Step {
        let FixedStepState { clock, planned, state, spare } = memory;
        clock.aim(end);
        let (h, time) = clock.next(*planned);
        if !clock.is_ahead(time) {
            return Step::Failed(Ending::TimeTooCoarse { time: time.to_f64(), step: self.step });
        }
        statistics.evaluations += 4;
        unchecked(system, h, state, spare);
        state.t = time;
        if (const { F::HAS_CONSTRAINTS } || !is_finite(state))
            && let Err(error) = mend::<L, F>(system, from, h, state, statistics)
        {
            state.clone_from(from);
            return Step::Failed(Ending::of(error, from.t.to_f64()));
        }
        *planned = clock.tick((h, time), *planned, L::Scalar::constant(self.step));
        to.clone_from(state);
        Step::Accepted
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
            memory.state.clone_from(state);
        }
        Ok(())
    }

    fn interpolant(
        &self,
        system: &L,
        _: &mut Self::Memory,
        [from, to]: [&StateOf<L>; 2],
        statistics: &mut Statistics,
    ) -> Result<Self::Interpolant, Error> {
        let mut node = |state: &StateOf<L>| -> Result<_, Error> {
            statistics.evaluations += 1;
            let point = StagePoint::of(state);
            let mut rates = point.y.clone();
            F::evaluate(system, &point, None, &mut rates)?;
            Ok((point.y, rates))
        };
        let (first, last) = (node(from)?, node(to)?);
        Ok(Polynomial::hermite(from.t, to.t - from.t, &first, &last))
    }
}

fn is_finite<T: Real, N: Length>(state: &State<T, N>) -> bool {
    are_finite(state.q.entries()) & are_finite(state.v.entries())
}

/// Completes a step of `h` from `start`: repeats it by the general solver if the elimination is not reliable, and
/// projects the end onto the constraints. An error rejects the step.
fn mend<L: System<Scalar: Real>, F: VectorField<L>>(
    system: &L,
    start: &StateOf<L>,
    h: L::Scalar,
    end: &mut StateOf<L>,
    statistics: &mut Statistics,
) -> Result<(), Error> {
    let time = end.t;
    if !is_finite(end) {
        // Later stages are off the constraints, so they use the constraints that are independent at the start.
        let mut at_start = None;
        end.clone_from(start);
        step(h, end, &mut SpareVectors::default(), |t, y, rates| {
            let point = StagePoint::at(t, y.clone());
            let found = F::evaluate(system, &point, at_start.as_ref(), rates)?;
            at_start.get_or_insert(found.active);
            statistics.multipliers_are_unique &= found.multipliers_are_unique;
            Ok::<_, Error>(())
        })?;
        end.t = time;
    }
    let halves = [end.q.entries(), end.v.entries()];
    if let Some(i) = (0..halves[0].len()).find(|&i| !(halves[0][i].is_finite() && halves[1][i].is_finite())) {
        return Err(Error::EquationsNotFinite { row: F::Checks::row(system, i), time: start.t.to_f64() });
    }
    let point = StagePoint::of(end);
    *end = F::project(system, &point)?;
    Ok(())
}
