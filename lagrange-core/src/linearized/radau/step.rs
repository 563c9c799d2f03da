//! One step of Radau IIA: stages, error estimate, projection, and the length of the next step.

use core::fmt;

use super::Radau;
use super::chart::Chart;
use super::iteration::{Converged, NODES, NoSolution, StageChanges, allowed, growth, is_too_large};
use super::memory::{KnownState, RadauMemory};
use crate::error::{Ending, Error, Pace};
use crate::linearized::StateDerivatives;
use crate::motion::method::clock::Clock;
use crate::motion::method::control::Tolerance;
use crate::motion::{Limits, Method, Step};
use crate::names::Entry;
use crate::number::{Real, Scalar, smaller};
use crate::solution::interpolant::Polynomial;
use crate::solution::solve::solve_near;
use crate::solution::vector_field::{LagrangianVectorField, StagePoint, VectorField};
use crate::statistics::Statistics;
use crate::system::{Lagrangian, StateOf};
use crate::vector::{Array, Length, PhaseVector, array, from_fn};

/// Weights of the stages in the error estimate: −(13 + 7√6)/3, (−13 + 7√6)/3 and −1/3.
const ERROR: [f64; 3] = [-10.048_809_399_827_416, 1.382_142_733_160_749, -1.0 / 3.0];

/// Reason to reject a step.
enum Rejection {
    Inaccurate(f64, Entry),
    TooSlow(f64),
    Unsolved(Error),
}

impl From<NoSolution> for Rejection {
    fn from(reason: NoSolution) -> Self {
        match reason {
            NoSolution::Unsolved(error) => Self::Unsolved(error),
            NoSolution::TooSlow(part) => Self::TooSlow(part),
        }
    }
}

impl From<Error> for Rejection {
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
        let at = KnownState::at(system, start, statistics)?;
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
        memory.at = KnownState::at(system, state, statistics)?;
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
            Err(Rejection::Inaccurate(error, entry)) => {
                let part =
                    if memory.accepted.is_none() { 0.1 } else { growth::<L::Scalar>(error, 1).min(0.9) };
                (part, Ending::StepTooSmall { time: now, entry })
            }
            Err(Rejection::TooSlow(_)) if memory.are_derivatives_old => {
                // The same step again, with the derivatives and the tangent plane of its start.
                (memory.derivatives, memory.factorizations) = (None, None);
                return Step::Rejected;
            }
            Err(Rejection::TooSlow(part)) => {
                let reason = "the iteration of a step does not converge, however short it is";
                (part, Ending::MethodFailed { time: now, reason })
            }
            Err(Rejection::Unsolved(error)) => (0.5, Ending::of(error, now)),
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
    pub(super) fn fit<T: Real>(&self, step: T, clock: &Clock<T>) -> T {
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
    ) -> Result<(), Rejection> {
        let tolerance = self.tolerance::<L::Scalar>();
        memory.prepare(system, h)?;
        let guess = memory.guess(h);
        let RadauMemory { at, derivatives, factorizations, contraction, .. } = memory;
        let (Some((chart, derivatives)), Some(factorizations)) = (derivatives, factorizations) else {
            return Err(Rejection::TooSlow(0.5));
        };
        let mut z = StageChanges(guess.0);
        for change in &mut z.0 {
            *change = chart.tangents(system, change, at.t)?;
        }
        let there = |k: usize, change: &PhaseVector<_, L::N>| {
            let moved = at.moved(h * L::Scalar::constant(NODES[k]), change);
            chart.onto(system, moved, (tolerance, &at.y))?.ok_or(NoSolution::TooSlow(0.5))
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
            return Err(Rejection::Inaccurate(error, worst::<L>(&off, &at.y, tolerance)));
        }
        let y = at.moved(h, &z.0[2]);
        let point = StagePoint { t: time, y: PhaseVector::of(y.q, y.v), velocity: array(y.v) };
        let end = <LagrangianVectorField as VectorField<L>>::project(system, &point)?;
        let next = KnownState::at(system, &end, statistics)?;
        let from = core::mem::replace(at, next);
        memory.accept(self, (from, h), &z, (error, iterations));
        Ok(())
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
