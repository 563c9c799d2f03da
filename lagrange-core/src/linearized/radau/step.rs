//! One step of Radau IIA: stages, error estimate, projection, and the length of the next step.

use core::fmt::{self, Debug, Formatter};

use super::Radau;
use super::chart::Chart;
use super::equations::{Derivatives, Factorizations};
use super::iteration::{Converged, NODES, NoSolution, StageChanges, allowed, growth, is_too_large, power};
use crate::error::{Ending, Error, Pace};
use crate::linearized::StateDerivatives;
use crate::motion::method::clock::Clock;
use crate::motion::method::control::Tolerance;
use crate::motion::{Limits, Method, Step};
use crate::names::Entry;
use crate::number::{Real, Scalar, larger, smaller};
use crate::solution::interpolant::{Polynomial, evaluate};
use crate::solution::solve::{solve, solve_near};
use crate::solution::vector_field::{LagrangianVectorField, StagePoint, VectorField};
use crate::statistics::Statistics;
use crate::system::{Lagrangian, State, StateOf};
use crate::vector::{Array, Element, Length, PhaseVector, array, from_fn, vector};

/// Weights of the stages in the error estimate: −(13 + 7√6)/3, (−13 + 7√6)/3 and −1/3.
const ERROR: [f64; 3] = [-10.048_809_399_827_416, 1.382_142_733_160_749, -1.0 / 3.0];
/// Contraction of the iteration below which derivatives are used again in the next step.
const REUSED: f64 = 1e-3;
/// Largest ratio of a step to the one before for which it keeps the length, and the factorizations with it.
const SAME: f64 = 1.2;

/// State that the method carries from step to step.
pub struct RadauMemory<L: Lagrangian<Scalar: Real>> {
    clock: Clock<L::Scalar>,
    /// Length of the next step; zero before the first is estimated.
    planned: L::Scalar,
    at: PlaceOf<L>,
    derivatives: Option<(Chart<L>, Derivatives<L::Scalar, L::N>)>,
    factorizations: Option<Factorizations<L::Scalar, L::N>>,
    /// True if the derivatives are those of an earlier state.
    are_derivatives_old: bool,
    contraction: f64,
    /// Length and error of the last accepted step, for the controller.
    accepted: Option<(f64, f64)>,
    was_refused: bool,
    /// The last accepted step, and its dense output.
    taken: Option<(PlaceOf<L>, L::Scalar)>,
    coefficients: [PhaseVector<L::Scalar, L::N>; 4],
}

impl<L: Lagrangian<Scalar: Real>> Debug for RadauMemory<L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { planned, at, contraction, .. } = self;
        let mut text = f.debug_struct("RadauMemory");
        text.field("planned", planned)
            .field("at", at)
            .field("contraction", contraction)
            .finish_non_exhaustive()
    }
}

/// A state with its rates, and the constraints that determine them.
#[derive(Clone, Copy, Debug)]
struct Place<T: Element, N: Length, M: Length> {
    y: PhaseVector<T, N>,
    rates: PhaseVector<T, N>,
    active: Array<bool, M>,
    t: T,
}

impl<T: Real, N: Length, M: Length> Place<T, N, M> {
    fn at<L: Lagrangian<N = N, M = M, Scalar = T>>(
        system: &L,
        state: &StateOf<L>,
        statistics: &mut Statistics,
    ) -> Result<Self, Error> {
        statistics.evaluations += 1;
        solve_near(system, state, None, |solution, active| {
            statistics.multipliers_are_unique &= solution.multipliers_are_unique();
            Self {
                y: PhaseVector::of(state.q, state.v),
                rates: PhaseVector::new([array(state.v), array(solution.accelerations)]),
                active: *active,
                t: state.t,
            }
        })
    }

    /// The state a time `h` later, with these changes.
    fn moved(&self, h: T, change: &PhaseVector<T, N>) -> State<T, N> {
        let [q, v] = from_fn(|half| Array::from_fn(|i| self.y[half][i] + change[half][i]));
        State { t: self.t + h, q: vector(q), v: vector(v) }
    }

    /// Changes that lead to the coordinates and velocities of a state.
    fn change_to(&self, state: &State<T, N>) -> PhaseVector<T, N> {
        let there = PhaseVector::<T, N>::of(state.q, state.v);
        PhaseVector::new(from_fn(|half| Array::from_fn(|i| there[half][i] - self.y[half][i])))
    }

    fn state(&self) -> State<T, N> {
        State { t: self.t, q: vector(self.y.half(0)), v: vector(self.y.half(1)) }
    }
}

type PlaceOf<L> = Place<<L as Lagrangian>::Scalar, <L as Lagrangian>::N, <L as Lagrangian>::M>;

/// Reason to reject a step.
enum Refusal {
    Inaccurate(f64, Entry),
    TooSlow(f64),
    Unsolved(Error),
}

impl From<NoSolution> for Refusal {
    fn from(reason: NoSolution) -> Self {
        match reason {
            NoSolution::Unsolved(error) => Self::Unsolved(error),
            NoSolution::TooSlow(part) => Self::TooSlow(part),
        }
    }
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        Self::Unsolved(error)
    }
}

impl<L: StateDerivatives<Scalar: Real>> Method<L> for Radau {
    type Memory = RadauMemory<L>;
    type Interpolant = Polynomial<L::Scalar, [PhaseVector<L::Scalar, L::N>; 4]>;

    fn limits(&self) -> Limits {
        self.limits
    }

    fn identify(&self, to: &mut dyn fmt::Write) -> fmt::Result {
        self.identify(to)
    }

    fn check(&self) -> Result<(), Error> {
        self.check()
    }

    fn begin(
        &self,
        system: &L,
        start: &StateOf<L>,
        statistics: &mut Statistics,
    ) -> Result<Self::Memory, Error> {
        let at = Place::at(system, start, statistics)?;
        let zero = L::Scalar::constant(0.0);
        Ok(RadauMemory {
            clock: Clock::new(start.t, None),
            planned: zero,
            at,
            derivatives: None,
            factorizations: None,
            are_derivatives_old: false,
            contraction: 1.0,
            accepted: None,
            was_refused: false,
            taken: None,
            coefficients: [PhaseVector::filled(zero); 4],
        })
    }

    fn resume(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        state: &StateOf<L>,
        statistics: &mut Statistics,
    ) -> Result<(), Error> {
        memory.clock.set(state.t);
        memory.at = Place::at(system, state, statistics)?;
        (memory.derivatives, memory.factorizations, memory.taken) = (None, None, None);
        Ok(())
    }

    fn step(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        end: L::Scalar,
        statistics: &mut Statistics,
    ) -> Step<L::Scalar, L::N> {
        memory.clock.aim(end);
        if memory.planned == L::Scalar::constant(0.0) {
            memory.planned = self.first(memory);
        }
        let (h, time) = memory.clock.next(memory.planned);
        let now = memory.clock.now.to_f64();
        if !memory.clock.is_ahead(time) {
            return Step::Failed(Ending::TimeTooCoarse { time: now, step: memory.planned.to_f64() });
        }
        let attempt = self.attempt(system, memory, (h, time), statistics);
        let (part, ending) = match attempt {
            Ok(()) => return Step::Accepted(memory.at.state()),
            Err(Refusal::Inaccurate(error, entry)) => {
                let part =
                    if memory.accepted.is_none() { 0.1 } else { growth::<L::Scalar>(error, 1).min(0.9) };
                (part, Ending::StepTooSmall { time: now, entry })
            }
            Err(Refusal::TooSlow(_)) if memory.are_derivatives_old => {
                // The same step again, with the derivatives and the tangent plane of its start.
                (memory.derivatives, memory.factorizations) = (None, None);
                return Step::Rejected;
            }
            Err(Refusal::TooSlow(part)) => {
                let reason = "the iteration of a step does not converge, however short it is";
                (part, Ending::MethodFailed { time: now, reason })
            }
            Err(Refusal::Unsolved(error)) => (0.5, Ending::of(error, now)),
        };
        memory.planned = Scalar::abs(h) * L::Scalar::constant(part);
        memory.was_refused = true;
        if memory.clock.advances_by(memory.planned) { Step::Rejected } else { Step::Failed(ending) }
    }

    fn interpolant(
        &self,
        _: &L,
        memory: &mut Self::Memory,
        _: &mut Statistics,
    ) -> Result<Self::Interpolant, Error> {
        let now = memory.clock.now.to_f64();
        let no_step = Error::OutsideTrajectory { time: now, start: now, end: now };
        let (from, h) = memory.taken.as_ref().ok_or(no_step)?;
        Ok(Polynomial::new(from.t, *h, memory.coefficients))
    }

    fn undo(&self, memory: &mut Self::Memory) -> bool {
        let Some((from, h)) = memory.taken.take() else { return false };
        (memory.clock.now, memory.at) = (from.t, from);
        (memory.derivatives, memory.factorizations, memory.was_refused) = (None, None, true);
        memory.planned = Scalar::abs(h) * L::Scalar::constant(0.5);
        memory.clock.advances_by(memory.planned)
    }

    fn pace(&self, _: &L, memory: &Self::Memory, _: L::Scalar) -> Pace {
        Pace { step: Some(memory.planned.to_f64()), ..Pace::default() }
    }
}

impl Radau {
    /// Length of the first step.
    fn first<L: Lagrangian<Scalar: Real>>(&self, memory: &RadauMemory<L>) -> L::Scalar {
        let left = memory.clock.left();
        let guess = match self.first_step {
            Some(step) => L::Scalar::constant(step),
            None => self.tolerance::<L::Scalar>().guess_step(&memory.at.y, &memory.at.rates, left),
        };
        self.fit(guess, &memory.clock)
    }

    /// Makes a step long enough to advance the time, and no longer than `max_step`.
    fn fit<T: Real>(&self, step: T, clock: &Clock<T>) -> T {
        let step = clock.at_least(step);
        let step = if step > T::constant(0.0) { step } else { clock.left() };
        self.max_step.map_or(step, |longest| smaller(step, T::constant(longest)))
    }

    /// Takes a step of length `h` to the time `time`, or refuses it.
    fn attempt<L: StateDerivatives<Scalar: Real>>(
        &self,
        system: &L,
        memory: &mut RadauMemory<L>,
        (h, time): (L::Scalar, L::Scalar),
        statistics: &mut Statistics,
    ) -> Result<(), Refusal> {
        let tolerance = self.tolerance::<L::Scalar>();
        memory.prepare(system, h)?;
        let guess = memory.guess(h);
        let RadauMemory { at, derivatives, factorizations, contraction, .. } = memory;
        let (Some((chart, derivatives)), Some(factorizations)) = (derivatives, factorizations) else {
            return Err(Refusal::TooSlow(0.5));
        };
        let mut z = StageChanges(guess.0);
        for change in &mut z.0 {
            *change = chart.tangents(system, change, at.t)?;
        }
        let there = |k: usize, change: &PhaseVector<_, L::N>| {
            let moved = at.moved(h * L::Scalar::constant(NODES[k]), change);
            chart.onto(system, moved, h)?.ok_or(NoSolution::TooSlow(0.5))
        };
        let mut rates = |state: &StateOf<L>| rates_at(system, chart, state, &at.active, statistics);
        let Converged { iterations, contraction: found } = z.solve(
            (derivatives, factorizations),
            (tolerance, &at.y, allowed::<L::Scalar>(tolerance.relative)),
            |k, change| Ok(rates(&there(k, change)?)?),
        )?;
        *contraction = found;
        // Stages on the constraints: for dense output, and because the error of the motion along the normals counts, too.
        for (k, change) in z.0.iter_mut().enumerate() {
            *change = at.change_to(&there(k, change)?);
        }
        let weighted = |half: usize, i: usize| {
            let sum = (0..3).map(|k| L::Scalar::constant(ERROR[k]) * z.0[k][half][i]);
            at.rates[half][i] + sum.fold(L::Scalar::constant(0.0), |sum, x| sum + x) / h
        };
        let right = PhaseVector::new(from_fn(|half| Array::from_fn(|i| weighted(half, i))));
        let off = factorizations.real(derivatives, &right);
        let error = tolerance.part(L::Scalar::constant(1.0), &off, &at.y).to_f64();
        if is_too_large(error) {
            return Err(Refusal::Inaccurate(error, worst::<L>(&off, &at.y, tolerance)));
        }
        let y = at.moved(h, &z.0[2]);
        let point = StagePoint { t: time, y: PhaseVector::of(y.q, y.v), velocity: array(y.v) };
        let end = <LagrangianVectorField as VectorField<L>>::project(system, &point)?;
        let next = Place::at(system, &end, statistics)?;
        let from = core::mem::replace(at, next);
        memory.accept(self, (from, h), &z, (error, iterations));
        Ok(())
    }
}

impl<L: StateDerivatives<Scalar: Real>> RadauMemory<L> {
    /// Stages on the polynomial of the last step, as changes from the state; zero if there is none.
    fn guess(&self, h: L::Scalar) -> StageChanges<L::Scalar, L::N> {
        let Some((_, length)) = &self.taken else {
            return StageChanges([PhaseVector::filled(L::Scalar::constant(0.0)); 3]);
        };
        StageChanges(NODES.map(|node| {
            let theta = L::Scalar::constant(1.0) + L::Scalar::constant(node) * h / *length;
            let (there, _) = evaluate(&self.coefficients, theta);
            PhaseVector::new(from_fn(|half| Array::from_fn(|i| there[half][i] - self.at.y[half][i])))
        }))
    }

    /// Makes a chart, evaluates derivatives in it and factorizes them, where those of the last step do not serve.
    fn prepare(&mut self, system: &L, h: L::Scalar) -> Result<(), Error> {
        if self.derivatives.is_none() {
            let state = self.at.state();
            let (solution, chart) = (solve(system, &state)?, Chart::at(system, &state));
            let derivatives = Derivatives::at(system, &state, solution, &chart)?;
            self.derivatives = Some((chart, derivatives));
            self.factorizations = None;
            self.are_derivatives_old = false;
        }
        if self.factorizations.as_ref().is_none_or(|found| found.h != h) {
            let derivatives = self.derivatives.as_ref();
            self.factorizations = derivatives.and_then(|(_, found)| Factorizations::of(found, h));
        }
        Ok(())
    }

    /// Moves the clock, keeps dense output, and chooses the next step.
    fn accept(
        &mut self,
        method: &Radau,
        (from, h): (PlaceOf<L>, L::Scalar),
        z: &StageChanges<L::Scalar, L::N>,
        (error, iterations): (f64, usize),
    ) {
        self.coefficients = collocation(&from.y, &self.at.y, &z.0);
        let length = Scalar::abs(h).to_f64();
        let error = error.max(1e-10);
        let mut ratio = growth::<L::Scalar>(error, iterations);
        if let Some((length_before, error_before)) = self.accepted {
            // The controller of Gustafsson, from two errors.
            let predicted =
                0.9 * length / length_before * power::<L::Scalar>(error * error / error_before, -0.25);
            ratio = ratio.min(predicted.clamp(0.2, 8.0));
        }
        if self.was_refused {
            ratio = ratio.min(1.0);
        }
        (self.accepted, self.was_refused) = (Some((length, error.max(1e-2))), false);
        let keeps_derivatives = self.contraction <= REUSED;
        let keeps_length = keeps_derivatives && (1.0..=SAME).contains(&ratio);
        if !keeps_derivatives {
            (self.derivatives, self.factorizations) = (None, None);
        }
        let planned = self.planned;
        let step = if keeps_length { Scalar::abs(h) } else { Scalar::abs(h) * L::Scalar::constant(ratio) };
        self.are_derivatives_old = true;
        self.taken = Some((from, h));
        self.clock.now = self.at.t;
        // If the end has shortened this step, the planned length serves a continued motion.
        let step = if self.clock.is_at_end() { larger(step, planned) } else { step };
        self.planned = method.fit(step, &self.clock);
    }
}

/// Rates at a stage in the tangent plane, by the constraints that are independent at the start of the step.
fn rates_at<L: Lagrangian<Scalar: Real>>(
    system: &L,
    chart: &Chart<L>,
    state: &StateOf<L>,
    active: &Array<bool, L::M>,
    statistics: &mut Statistics,
) -> Result<PhaseVector<L::Scalar, L::N>, Error> {
    statistics.evaluations += 1;
    let rates = solve_near(system, state, Some(active), |solution, _| {
        PhaseVector::new([array(state.v), array(solution.accelerations)])
    })?;
    chart.tangents(system, &rates, state.t)
}

/// Coefficients of the polynomial through both ends and the stages between.
fn collocation<T: Real, N: Length>(
    from: &PhaseVector<T, N>,
    to: &PhaseVector<T, N>,
    z: &[PhaseVector<T, N>; 3],
) -> [PhaseVector<T, N>; 4] {
    let mut coefficients = [*from; 4];
    for half in 0..2 {
        for i in 0..N::COUNT {
            let rise = to[half][i] - from[half][i];
            // P(c) = r₀ + c (r₁ + (1 − c)(r₂ + c r₃)) at the first two stages.
            let [first, second] = [0, 1].map(|k| {
                let c = T::constant(NODES[k]);
                (z[k][half][i] - c * rise) / (c * (T::constant(1.0) - c))
            });
            let slope = (second - first) / T::constant(NODES[1] - NODES[0]);
            coefficients[1][half][i] = rise;
            coefficients[2][half][i] = first - slope * T::constant(NODES[0]);
            coefficients[3][half][i] = slope;
        }
    }
    coefficients
}

/// The entry whose error is the largest part of its tolerance.
fn worst<L: Lagrangian<Scalar: Real>>(
    off: &PhaseVector<L::Scalar, L::N>,
    y: &PhaseVector<L::Scalar, L::N>,
    tolerance: Tolerance,
) -> Entry {
    let part = |k: usize| {
        let allowed = tolerance.absolute + tolerance.relative * Scalar::abs(y.flat()[k]).to_f64();
        Scalar::abs(off.flat()[k]).to_f64() / allowed
    };
    let k = (0..2 * <L::N>::COUNT).fold(0, |most, k| if part(k) > part(most) { k } else { most });
    match k.checked_sub(<L::N>::COUNT) {
        None => Entry::Coordinate(L::COORDINATES[k]),
        Some(i) => Entry::Velocity(L::COORDINATES[i]),
    }
}
