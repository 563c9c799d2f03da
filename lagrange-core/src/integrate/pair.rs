//! One step of an embedded Runge–Kutta pair, projected onto the constraints.

use core::array::from_fn;

use nalgebra::ComplexField;

use super::{Adaptive, Limits, Method, Phase, Statistics, Step};
use crate::eliminate::vector;
use crate::integrate::Ending;
use crate::kkt::{larger, smaller};
use crate::names::{Entry, Row as EquationRow};
use crate::solve::{name, solve};
use crate::{Error, Lagrangian, Real, Scalar, State, consistent};

/// The coefficients of a sum of slopes: (index of the slope, coefficient).
pub type Row = &'static [(usize, f64)];

/// The coefficients of an explicit embedded pair with a continuous extension.
///
/// Slopes are numbered 0 at the start, then the stages, then `STAGES.len() + 1` at the end of the step, then the
/// stages of the interpolant.
pub trait Pair {
    /// The time of each slope as a fraction of the step.
    const NODES: &'static [f64];
    /// Each stage but the first as a sum of the slopes before it.
    const STAGES: &'static [Row];
    /// The new state.
    const WEIGHTS: Row;
    /// The error e that decides.
    const ERROR: Row;
    /// A second error e′ of lower order, or nothing: the estimate is then |e|²/√(|e|² + 0.01 |e′|²) instead of |e|.
    const LOWER_ERROR: Row;
    /// Stages that only the interpolant needs.
    const INTERPOLATION_STAGES: &'static [Row];
    /// Coefficients of the interpolant beyond the fourth.
    const INTERPOLATION: &'static [Row];
    /// The estimate behaves as this power of the step.
    const ORDER: f64;
    /// Weight of the previous error in the choice of the step (β of the PI controller).
    const DAMPING: f64;
    /// The new step is at least this times the old one …
    const SHRINK: f64;
    /// … and at most this times.
    const GROWTH: f64;
}

/// Room for the slopes of the longest method here, and for its interpolant.
const SLOPES: usize = 16;
const COEFFICIENTS: usize = 8;

/// What a pair carries from step to step.
#[derive(Clone, Debug)]
pub struct Memory<T, const N: usize> {
    state: State<T, N>,
    end: T,
    step: T,
    /// No step may become shorter.
    span: T,
    previous_error: T,
    was_rejected: bool,
    /// The first is that of `state`.
    slopes: [Phase<T, N>; SLOPES],
    interpolant: [Phase<T, N>; COEFFICIENTS],
}

/// Why a step is not accepted: the next is so much shorter, and where none is short enough that is the ending.
struct Refusal<T> {
    factor: T,
    ending: Ending,
}

impl<P, L, const N: usize, const M: usize> Method<L, N, M> for Adaptive<P>
where
    P: Pair,
    L: Lagrangian<N, M, Scalar: Real>,
{
    type Memory = Memory<L::Scalar, N>;

    fn limits(&self) -> Limits {
        self.limits()
    }

    fn begin(
        &self,
        system: &L,
        start: &State<L::Scalar, N>,
        end: L::Scalar,
        statistics: &mut Statistics,
    ) -> Result<Self::Memory, Error> {
        self.check()?;
        let zero = [[L::Scalar::constant(0.0); N]; 2];
        let mut slopes = [zero; SLOPES];
        slopes[0] = slope(system, start.t, &phase(start), statistics)?;
        let step = match self.fixed_step.or(self.first_step) {
            Some(step) => L::Scalar::constant(step),
            None => self.longest(self.estimate_step(system, start, end, &slopes[0], statistics)),
        };
        Ok(Memory {
            state: *start,
            end,
            step,
            span: end - start.t,
            previous_error: L::Scalar::constant(1e-4),
            was_rejected: false,
            slopes,
            interpolant: [zero; COEFFICIENTS],
        })
    }

    fn step<'m>(
        &self,
        system: &L,
        memory: &'m mut Self::Memory,
        statistics: &mut Statistics,
    ) -> Step<'m, L::Scalar, N> {
        let (h, time) = memory.next();
        match self.attempt(system, memory, h, time, statistics) {
            Ok((state, factor)) => {
                memory.state = state;
                memory.slopes[0] = memory.slopes[P::STAGES.len() + 1];
                self.choose_step(memory, h, factor);
                Step::Accepted { state, interpolant: &memory.interpolant[..4 + P::INTERPOLATION.len()] }
            }
            Err(refusal) => {
                memory.step = h * refusal.factor;
                memory.was_rejected = true;
                if self.fixed_step.is_some() || memory.is_step_too_small() {
                    Step::Failed(refusal.ending)
                } else {
                    Step::Rejected
                }
            }
        }
    }
}

impl<T: Real, const N: usize> Memory<T, N> {
    /// The next step and the time after it: exactly the end where that is near.
    fn next(&self) -> (T, T) {
        let time = self.state.t + self.step;
        if self.state.t + self.step * T::constant(1.01) >= self.end {
            (self.end - self.state.t, self.end)
        } else {
            (self.step, time)
        }
    }

    fn is_step_too_small(&self) -> bool {
        let epsilon = T::constant(T::EPSILON);
        let size = larger(Scalar::abs(self.state.t), epsilon * self.span);
        !(self.step > T::constant(10.0) * epsilon * size)
    }
}

impl<P: Pair> Adaptive<P> {
    /// The state after the step on the constraints, and by which factor the step may grow.
    fn attempt<L, const N: usize, const M: usize>(
        &self,
        system: &L,
        memory: &mut Memory<L::Scalar, N>,
        h: L::Scalar,
        time: L::Scalar,
        statistics: &mut Statistics,
    ) -> Result<(State<L::Scalar, N>, L::Scalar), Refusal<L::Scalar>>
    where
        L: Lagrangian<N, M, Scalar: Real>,
    {
        let last = P::STAGES.len() + 1;
        let start = phase(&memory.state);
        let now = memory.state.t;
        let refuse = |error| refusal(error, now);

        stages(system, memory, h, P::STAGES, 1, P::NODES, statistics).map_err(refuse)?;
        let mut next = advance(&start, h, &memory.slopes, P::WEIGHTS);
        check_finite::<L, N, M>(&next, now)?;
        if Self::error_needs_end() {
            memory.slopes[last] = slope(system, time, &next, statistics).map_err(refuse)?;
        }
        let factor = self.judge::<L, N, M>(memory, h, &next)?;
        if M > 0 {
            let mut state = state(time, &next);
            consistent::project(system, &mut state).map_err(refuse)?;
            next = phase(&state);
        }
        if M > 0 || !Self::error_needs_end() {
            memory.slopes[last] = slope(system, time, &next, statistics).map_err(refuse)?;
        }
        stages(system, memory, h, P::INTERPOLATION_STAGES, last + 1, P::NODES, statistics).map_err(refuse)?;
        memory.interpolate::<P>(h, &start, &next);
        Ok((state(time, &next), factor))
    }

    fn error_needs_end() -> bool {
        P::ERROR.iter().any(|(slope, _)| *slope > P::STAGES.len())
    }

    /// By which factor the step may grow, or the refusal of one with too large an error.
    fn judge<L, const N: usize, const M: usize>(
        &self,
        memory: &mut Memory<L::Scalar, N>,
        h: L::Scalar,
        next: &Phase<L::Scalar, N>,
    ) -> Result<L::Scalar, Refusal<L::Scalar>>
    where
        L: Lagrangian<N, M, Scalar: Real>,
    {
        let constant = L::Scalar::constant;
        if self.fixed_step.is_some() {
            return Ok(constant(1.0));
        }
        let scale = self.scale(&phase(&memory.state), next);
        let (error, worst) = estimate_error::<P, _, N>(&memory.slopes, h, &scale);
        let exponent = 1.0 / P::ORDER - 0.75 * P::DAMPING;
        let reduction = Scalar::powf(error, constant(exponent));
        if !(error <= constant(1.0)) {
            let entry = entry::<L, N, M>(worst);
            let ending = Ending::StepTooSmall { time: memory.state.t.to_f64(), entry };
            let factor = larger(constant(P::SHRINK), constant(0.9) / reduction);
            return Err(Refusal { factor, ending });
        }
        let memory_of_error = Scalar::powf(memory.previous_error, constant(P::DAMPING));
        memory.previous_error = larger(error, constant(1e-4));
        let factor = constant(0.9) * memory_of_error / larger(reduction, constant(1e-30));
        Ok(larger(constant(P::SHRINK), smaller(factor, constant(P::GROWTH))))
    }

    fn choose_step<T: Real, const N: usize>(&self, memory: &mut Memory<T, N>, h: T, factor: T) {
        if self.fixed_step.is_some() {
            return;
        }
        let most = if memory.was_rejected { T::constant(1.0) } else { T::constant(P::GROWTH) };
        memory.step = self.longest(h * smaller(factor, most));
        memory.was_rejected = false;
    }

    /// The step cut to the longest allowed.
    fn longest<T: Real>(&self, h: T) -> T {
        self.max_step.map_or(h, |longest| smaller(h, T::constant(longest)))
    }

    /// The error allowed in each entry.
    fn scale<T: Real, const N: usize>(&self, a: &Phase<T, N>, b: &Phase<T, N>) -> Phase<T, N> {
        let relative = T::constant(self.relative.max(16.0 * T::EPSILON));
        let absolute = T::constant(self.absolute);
        let size = |half: usize, i: usize| larger(Scalar::abs(a[half][i]), Scalar::abs(b[half][i]));
        from_fn(|half| from_fn(|i| absolute + relative * size(half, i)))
    }

    /// A first step from the size of the slope and of its change
    /// (Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, II.4).
    fn estimate_step<L, const N: usize, const M: usize>(
        &self,
        system: &L,
        start: &State<L::Scalar, N>,
        end: L::Scalar,
        first: &Phase<L::Scalar, N>,
        statistics: &mut Statistics,
    ) -> L::Scalar
    where
        L: Lagrangian<N, M, Scalar: Real>,
    {
        let constant = L::Scalar::constant;
        let y = phase(start);
        let scale = self.scale(&y, &y);
        let tiny = (end - start.t) * constant(1e-6);
        let (size, speed) = (norm(&y, &scale), norm(first, &scale));
        let usable = size > constant(1e-5) && speed > constant(1e-5);
        let trial = smaller(if usable { constant(0.01) * size / speed } else { tiny }, end - start.t);
        let euler = from_fn(|half| from_fn(|i| y[half][i] + trial * first[half][i]));
        let Ok(second) = slope(system, start.t + trial, &euler, statistics) else {
            return trial * constant(1e-3);
        };
        let change = from_fn(|half| from_fn(|i| second[half][i] - first[half][i]));
        let fastest = larger(norm(&change, &scale) / trial, speed);
        let step = if fastest > constant(1e-15) {
            Scalar::powf(constant(0.01) / fastest, constant(1.0 / P::ORDER))
        } else {
            larger(tiny, trial * constant(1e-3))
        };
        smaller(step, trial * constant(100.0))
    }
}

/// Evaluates the slopes of these stages, the first of which has the number `first`.
fn stages<L, const N: usize, const M: usize>(
    system: &L,
    memory: &mut Memory<L::Scalar, N>,
    h: L::Scalar,
    rows: &[Row],
    first: usize,
    nodes: &[f64],
    statistics: &mut Statistics,
) -> Result<(), Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    let start = phase(&memory.state);
    for (number, (row, node)) in rows.iter().zip(nodes.iter().skip(first)).enumerate() {
        let y = advance(&start, h, &memory.slopes, row);
        let t = memory.state.t + h * L::Scalar::constant(*node);
        memory.slopes[first + number] = slope(system, t, &y, statistics)?;
    }
    Ok(())
}

impl<T: Real, const N: usize> Memory<T, N> {
    /// The interpolant from `start` to `next`, with the slopes at both (II.6 and the code DOP853).
    fn interpolate<P: Pair>(&mut self, h: T, start: &Phase<T, N>, next: &Phase<T, N>) {
        let (first, last) = (&self.slopes[0], &self.slopes[P::STAGES.len() + 1]);
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

/// (q̇, q̈).
#[inline]
fn slope<L, const N: usize, const M: usize>(
    system: &L,
    t: L::Scalar,
    y: &Phase<L::Scalar, N>,
    statistics: &mut Statistics,
) -> Result<Phase<L::Scalar, N>, Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    statistics.evaluations += 1;
    let solution = solve(system, &state(t, y))?;
    statistics.multipliers_are_unique &= solution.multipliers_are_unique();
    Ok([y[1], solution.accelerations.into()])
}

/// start + h Σ cᵢ slopeᵢ.
#[inline]
fn advance<T: Real, const N: usize>(
    start: &Phase<T, N>,
    h: T,
    slopes: &[Phase<T, N>; SLOPES],
    row: &[(usize, f64)],
) -> Phase<T, N> {
    let sum = combine(slopes, row);
    from_fn(|half| from_fn(|i| start[half][i] + h * sum[half][i]))
}

#[inline]
fn combine<T: Real, const N: usize>(slopes: &[Phase<T, N>; SLOPES], row: &[(usize, f64)]) -> Phase<T, N> {
    let mut sum = [[T::constant(0.0); N]; 2];
    for (index, coefficient) in row {
        let coefficient = T::constant(*coefficient);
        for half in 0..2 {
            for i in 0..N {
                sum[half][i] += coefficient * slopes[*index][half][i];
            }
        }
    }
    sum
}

/// The error of a step in units of the tolerance, and the entry (half, index) where it is largest.
fn estimate_error<P: Pair, T: Real, const N: usize>(
    slopes: &[Phase<T, N>; SLOPES],
    h: T,
    scale: &Phase<T, N>,
) -> (T, (usize, usize)) {
    let error = combine(slopes, P::ERROR);
    let first = norm(&error, scale);
    let second = norm(&combine(slopes, P::LOWER_ERROR), scale);
    let both = Scalar::sqrt(first * first + T::constant(0.01) * second * second);
    let estimate = if both > T::constant(0.0) { h * first * first / both } else { first };
    let part = |(half, i): (usize, usize)| Scalar::abs(error[half][i]) / scale[half][i];
    let entries = (0..2).flat_map(|half| (0..N).map(move |i| (half, i)));
    (estimate, entries.fold((0, 0), |worst, e| if part(e) > part(worst) { e } else { worst }))
}

/// √(mean (x/scale)²).
fn norm<T: Real, const N: usize>(x: &Phase<T, N>, scale: &Phase<T, N>) -> T {
    let pairs = x.iter().flatten().zip(scale.iter().flatten());
    let sum = pairs.fold(T::constant(0.0), |sum, (x, s)| sum + (*x / *s) * (*x / *s));
    Scalar::sqrt(sum / T::constant((2 * N) as f64))
}

fn refusal<T: Real>(error: Error, now: T) -> Refusal<T> {
    Refusal { factor: T::constant(0.5), ending: Ending::of(error, now.to_f64()) }
}

fn check_finite<L, const N: usize, const M: usize>(
    y: &Phase<L::Scalar, N>,
    now: L::Scalar,
) -> Result<(), Refusal<L::Scalar>>
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    match (0..N).find(|&i| !(y[0][i].is_finite() && y[1][i].is_finite())) {
        None => Ok(()),
        Some(i) => {
            let row = EquationRow::Coordinate(name(&L::COORDINATES, i));
            Err(refusal(Error::EquationsNotFinite { row, time: now.to_f64() }, now))
        }
    }
}

fn entry<L, const N: usize, const M: usize>((half, index): (usize, usize)) -> Entry
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    let name = name(&L::COORDINATES, index);
    if half == 0 { Entry::Coordinate(name) } else { Entry::Velocity(name) }
}

fn phase<T: Real, const N: usize>(state: &State<T, N>) -> Phase<T, N> {
    [state.q.into(), state.v.into()]
}

fn state<T: Real, const N: usize>(t: T, [q, v]: &Phase<T, N>) -> State<T, N> {
    State { t, q: vector(*q), v: vector(*v) }
}
