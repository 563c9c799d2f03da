//! One step of an embedded Runge–Kutta pair, projected onto the constraints.

use core::array::from_fn;

use nalgebra::ComplexField;

use super::clock::Clock;
use super::control::{Control, Place};
use super::pair::{Combination, Pair, SLOPES, Slopes, advance};
use super::{Adaptive, Limits, Method, Step};
use crate::error::Error;
use crate::names::{Entry, Row};
use crate::number::{Real, Scalar, vector};
use crate::solution::flow::{Flow, Phase, PhasePoint, Slope};
use crate::solution::solve::name;
use crate::system::{Lagrangian, State};
use crate::trajectory::{Ending, Statistics};

/// Room for the longest interpolant here.
const COEFFICIENTS: usize = 8;

/// What a pair carries from step to step.
#[derive(Clone, Debug)]
pub struct Memory<T, const N: usize, const M: usize> {
    pub(crate) clock: Clock<T>,
    pub(crate) y: Phase<T, N>,
    pub(crate) control: Control<T>,
    /// The first is that of `y`.
    pub(crate) slopes: Slopes<T, N>,
    /// Which constraints the first slope rests on: as many as are independent at `y`.
    pub(crate) active: [bool; M],
    interpolant: [Phase<T, N>; COEFFICIENTS],
}

impl<T: Real, const N: usize, const M: usize> Memory<T, N, M> {
    /// The length of the next step and the time after it.
    pub(crate) fn next(&self) -> (T, T) {
        self.clock.next(self.control.step)
    }

    /// A place in the step that starts here.
    fn point(&self, t: T, y: Phase<T, N>) -> PhasePoint<T, N> {
        PhasePoint { t, y, velocity: self.slopes[0][0] }
    }

    /// The interpolant from `start` to `next`, with the slopes at both (II.6 and the code DOP853).
    fn interpolate<P: Pair>(&mut self, h: T, start: &Phase<T, N>, next: &Phase<T, N>) {
        let (first, last) = (&self.slopes[0], &self.slopes[P::LAST]);
        for half in 0..2 {
            for i in 0..N {
                let rise = next[half][i] - start[half][i];
                let bend = h * first[half][i] - rise;
                self.interpolant[0][half][i] = start[half][i];
                self.interpolant[1][half][i] = rise;
                self.interpolant[2][half][i] = bend;
                self.interpolant[3][half][i] = rise - h * last[half][i] - bend;
            }
        }
        let zero = [[T::constant(0.0); N]; 2];
        for (coefficient, row) in self.interpolant.iter_mut().skip(4).zip(P::INTERPOLATION) {
            *coefficient = advance(&zero, h, &self.slopes, row);
        }
    }
}

/// Why a step is not accepted.
enum Refusal<T> {
    /// Its error is this many times the tolerance.
    Inaccurate(T, Place),
    /// Somewhere in it the equations or the constraints have no solution.
    Unsolved(Error),
}

impl<T> From<Error> for Refusal<T> {
    fn from(error: Error) -> Self {
        Self::Unsolved(error)
    }
}

/// Where a step ends, its error as a part of the tolerance, and which constraints its slope rests on.
struct Accepted<T, const N: usize, const M: usize> {
    y: Phase<T, N>,
    error: T,
    active: [bool; M],
}

impl<P, L, F, const N: usize, const M: usize> Method<L, N, M, F> for Adaptive<P>
where
    P: Pair,
    L: Lagrangian<N, M, Scalar: Real>,
    F: Flow<L, N, M>,
{
    type Memory = Memory<L::Scalar, N, M>;

    fn limits(&self) -> Limits {
        self.limits()
    }

    fn check(&self) -> Result<(), Error> {
        self.check()
    }

    fn sparse(mut self) -> Self {
        self.is_dense = false;
        self
    }

    fn begin(
        &self,
        system: &L,
        start: &State<L::Scalar, N>,
        end: L::Scalar,
        statistics: &mut Statistics,
    ) -> Result<Self::Memory, Error> {
        let zero = [[L::Scalar::constant(0.0); N]; 2];
        let mut slopes = [zero; SLOPES];
        let point = PhasePoint { t: start.t, y: F::phase(system, start), velocity: start.v.into() };
        let Slope { rates, active, .. } = slope::<L, F, N, M>(system, &point, None, statistics)?;
        slopes[0] = rates;
        let clock = Clock::new(start.t, end, self.fixed_step.map(L::Scalar::constant));
        let step = match self.fixed_step.or(self.first_step) {
            Some(step) => L::Scalar::constant(step),
            None => {
                let first = (&slopes[0], &active);
                self.estimate_step::<L, F, N, M>(system, &point, clock.left(), first, statistics)
            }
        };
        let control = Control::new(self.fit(step, &clock));
        let interpolant = [zero; COEFFICIENTS];
        Ok(Memory { clock, y: point.y, control, slopes, active, interpolant })
    }

    fn step<'m>(
        &self,
        system: &L,
        memory: &'m mut Self::Memory,
        statistics: &mut Statistics,
    ) -> Step<'m, L::Scalar, N> {
        let (h, time) = memory.next();
        let now = memory.clock.now.to_f64();
        if time <= memory.clock.now {
            return Step::Failed(Ending::TimeTooCoarse { time: now, step: memory.control.step.to_f64() });
        }
        let ending = match self.attempt::<L, F, N, M>(system, memory, h, time, statistics) {
            Ok(Accepted { y, error, active }) => {
                (memory.y, memory.active) = (y, active);
                memory.slopes[0] = memory.slopes[P::LAST];
                self.after_acceptance(&mut memory.control, &mut memory.clock, (h, time), error);
                let coefficients = if self.is_dense { 4 + P::INTERPOLATION.len() } else { 0 };
                return Step::Accepted {
                    state: State { t: time, q: vector(y[0]), v: vector(memory.slopes[0][0]) },
                    interpolant: &memory.interpolant[..coefficients],
                };
            }
            Err(Refusal::Inaccurate(error, place)) => {
                memory.control.refuse::<P>(h, error);
                Ending::StepTooSmall { time: now, entry: entry::<L, F, N, M>(place) }
            }
            Err(Refusal::Unsolved(error)) => {
                memory.control.halve(h);
                Ending::of(error, now)
            }
        };
        if self.fixed_step.is_some() || !memory.clock.advances_by(memory.control.step) {
            return Step::Failed(ending);
        }
        Step::Rejected
    }
}

impl<P: Pair> Adaptive<P> {
    /// Stages, error, projection, interpolant: whatever fails refuses the step.
    fn attempt<L: Lagrangian<N, M, Scalar: Real>, F: Flow<L, N, M>, const N: usize, const M: usize>(
        &self,
        system: &L,
        memory: &mut Memory<L::Scalar, N, M>,
        h: L::Scalar,
        time: L::Scalar,
        statistics: &mut Statistics,
    ) -> Result<Accepted<L::Scalar, N, M>, Refusal<L::Scalar>> {
        let start = memory.y;
        stages::<P, L, F, N, M>(system, memory, h, (1, P::STAGES), statistics)?;
        let mut next = memory.point(time, advance(&start, h, &memory.slopes, P::WEIGHTS));
        check_finite::<L, N, M>(time, &next.y)?;
        let mut active = memory.active;
        if P::error_needs_last() {
            active = last::<P, L, F, N, M>(system, memory, &next, Some(&active), statistics)?;
        }
        let error = self.check_error(&memory.slopes, h, &start, &next.y)?;
        if M > 0 {
            next.y = F::phase(system, &F::project(system, &next)?);
        }
        if M > 0 || !P::error_needs_last() {
            active = last::<P, L, F, N, M>(system, memory, &next, None, statistics)?;
        }
        if self.is_dense {
            stages::<P, L, F, N, M>(system, memory, h, (P::LAST + 1, P::INTERPOLATION_STAGES), statistics)?;
            memory.interpolate::<P>(h, &start, &next.y);
        }
        Ok(Accepted { y: next.y, error, active })
    }

    /// The error as a part of the tolerance, at most 1; nothing refuses a fixed step.
    fn check_error<T: Real, const N: usize>(
        &self,
        slopes: &Slopes<T, N>,
        h: T,
        before: &Phase<T, N>,
        after: &Phase<T, N>,
    ) -> Result<T, Refusal<T>> {
        let tolerance = self.tolerance::<T>();
        let error = tolerance.error::<P, T, N>(slopes, h, before, after);
        if !self.accepts(error) {
            return Err(Refusal::Inaccurate(error, tolerance.worst::<P, T, N>(slopes, before, after)));
        }
        Ok(error)
    }

    fn estimate_step<L: Lagrangian<N, M, Scalar: Real>, F: Flow<L, N, M>, const N: usize, const M: usize>(
        &self,
        system: &L,
        start: &PhasePoint<L::Scalar, N>,
        span: L::Scalar,
        (first, active): (&Phase<L::Scalar, N>, &[bool; M]),
        statistics: &mut Statistics,
    ) -> L::Scalar {
        let y = &start.y;
        let guess = self.guess_step(y, first, span);
        let euler = from_fn(|half| from_fn(|i| y[half][i] + guess * first[half][i]));
        let point = PhasePoint { t: start.t + guess, y: euler, ..*start };
        match slope::<L, F, N, M>(system, &point, Some(active), statistics) {
            Ok(second) => self.first_step_from(guess, y, first, &second.rates),
            Err(_) => guess,
        }
    }
}

/// Evaluates the slopes of these stages, the first of which has the number given.
fn stages<P, L, F, const N: usize, const M: usize>(
    system: &L,
    memory: &mut Memory<L::Scalar, N, M>,
    h: L::Scalar,
    (first, rows): (usize, &[Combination]),
    statistics: &mut Statistics,
) -> Result<(), Error>
where
    P: Pair,
    L: Lagrangian<N, M, Scalar: Real>,
    F: Flow<L, N, M>,
{
    let (t, start) = (memory.clock.now, memory.y);
    let mut point = memory.point(t, start);
    for (number, row) in rows.iter().enumerate().map(|(i, row)| (first + i, row)) {
        point.y = advance(&start, h, &memory.slopes, row);
        point.t = t + h * L::Scalar::constant(P::NODES[number]);
        let active = Some(&memory.active);
        memory.slopes[number] = slope::<L, F, N, M>(system, &point, active, statistics)?.rates;
    }
    Ok(())
}

/// Evaluates the slope at the end of the step; which constraints it rests on.
#[inline]
fn last<P, L, F, const N: usize, const M: usize>(
    system: &L,
    memory: &mut Memory<L::Scalar, N, M>,
    end: &PhasePoint<L::Scalar, N>,
    active: Option<&[bool; M]>,
    statistics: &mut Statistics,
) -> Result<[bool; M], Error>
where
    P: Pair,
    L: Lagrangian<N, M, Scalar: Real>,
    F: Flow<L, N, M>,
{
    let slope = slope::<L, F, N, M>(system, end, active, statistics)?;
    memory.slopes[P::LAST] = slope.rates;
    Ok(slope.active)
}

/// The rates of the phase, counted.
#[inline]
fn slope<L: Lagrangian<N, M, Scalar: Real>, F: Flow<L, N, M>, const N: usize, const M: usize>(
    system: &L,
    point: &PhasePoint<L::Scalar, N>,
    active: Option<&[bool; M]>,
    statistics: &mut Statistics,
) -> Result<Slope<L::Scalar, N, M>, Error> {
    statistics.evaluations += 1;
    let slope = F::slope(system, point, active)?;
    statistics.multipliers_are_unique &= slope.multipliers_are_unique;
    Ok(slope)
}

fn check_finite<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
    t: L::Scalar,
    [q, rest]: &Phase<L::Scalar, N>,
) -> Result<(), Error> {
    let row = |i: usize| Row::Coordinate(name(&L::COORDINATES, i));
    match (0..N).find(|&i| !(q[i].is_finite() && rest[i].is_finite())) {
        None => Ok(()),
        Some(i) => Err(Error::EquationsNotFinite { row: row(i), time: t.to_f64() }),
    }
}

fn entry<L: Lagrangian<N, M, Scalar: Real>, F: Flow<L, N, M>, const N: usize, const M: usize>(
    (half, index): Place,
) -> Entry {
    let name = name(&L::COORDINATES, index);
    if half == 0 { Entry::Coordinate(name) } else { F::entry(name) }
}
