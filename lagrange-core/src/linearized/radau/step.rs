//! One step of Radau IIA: stages, error estimate, projection, and the length of the next step.

use core::fmt;

use nalgebra::Const;

use super::chart::Chart;
use super::collocation::Collocation;
use super::coupled::Coupled;
use super::equations::{Derivatives, Factorizations};
use super::estimate::StartSlopes;
use super::iteration::{
    Converged, Iteration, NoSolution, allowed, combination, product, reduction, within_limits, zip,
};
use super::limits::SHRINK;
use super::memory::{Age, KnownState, RadauMemory};
use super::tableau::{RadauStages, Transformation};
use super::{Radau, pose};
use crate::error::{Ending, Error, Pace};
use crate::linearized::StateDerivatives;
use crate::motion::method::clock::Clock;
use crate::motion::method::contract::check_settings;
use crate::motion::{Limits, Method, Step};
use crate::names::Entry;
use crate::number::{Real, Scalar, smaller};
use crate::numerics::lu::Lu;
use crate::solution::solve::solve_near;
use crate::solution::vector_field::{LagrangianVectorField, StagePoint, VectorField};
use crate::statistics::Statistics;
use crate::system::{Lagrangian, StateOf};
use crate::vector::{Array, PhaseVector, array, from_fn};

/// Reason to reject a step.
enum Rejection {
    Inaccurate(f64, Entry),
    TooSlow,
    Unsolved(Error),
    /// Multipliers have a pole within the step.
    AtPole(Error),
}

impl From<NoSolution> for Rejection {
    fn from(reason: NoSolution) -> Self {
        match reason {
            NoSolution::Unsolved(error) => Self::Unsolved(error),
            NoSolution::TooSlow => Self::TooSlow,
        }
    }
}

impl From<Error> for Rejection {
    fn from(error: Error) -> Self {
        Self::Unsolved(error)
    }
}

impl<L: StateDerivatives<Scalar: Real>, const S: usize> Method<L, LagrangianVectorField> for Radau<S>
where
    Const<S>: RadauStages,
{
    type Memory = RadauMemory<L, S>;
    type Interpolant = Collocation<L::Scalar, L::N, S>;

    fn limits(&self) -> Limits {
        self.limits
    }

    fn identify(&self, to: &mut dyn fmt::Write) -> fmt::Result {
        let Self { relative, absolute, max_step, first_step, .. } = self;
        write!(to, "Radau {} {relative:?} {absolute:?} {max_step:?} {first_step:?}", 2 * S - 1)
    }

    fn accuracy(&self) -> f64 {
        self.relative
    }

    fn check(&self) -> Result<(), Error> {
        check_settings([
            ("relative tolerance", Some(self.relative)),
            ("absolute tolerance", Some(self.absolute)),
            ("longest step", self.max_step),
            ("first step", self.first_step),
        ])
    }

    fn begin(
        &self,
        system: &L,
        start: &StateOf<L>,
        statistics: &mut Statistics,
    ) -> Result<Self::Memory, Error> {
        let at = KnownState::at(system, start, statistics)?;
        Ok(RadauMemory {
            clock: Clock::new(start.t, None),
            planned: L::Scalar::constant(0.0),
            at,
            transformation: Transformation::new(),
            chart: Chart::at(system, start),
            derivatives: Derivatives::new(),
            age: Age::Unknown,
            factorizations: Factorizations::new(),
            coupled: None,
            longest: f64::INFINITY,
            contraction: 1.0,
            orientation: Lu::new(),
            accepted: None,
            was_refused: false,
            obstacle: None,
            taken: None,
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
        (memory.age, memory.taken) = (Age::Unknown, None);
        Ok(())
    }

    fn step(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        end: L::Scalar,
        _: &StateOf<L>,
        to: &mut StateOf<L>,
        statistics: &mut Statistics,
    ) -> Step {
        memory.clock.aim(end);
        if memory.planned == L::Scalar::constant(0.0) {
            memory.planned = self.first(memory);
        }
        let (length, is_coupled) = memory.next();
        let (h, time) = memory.clock.next(length);
        let now = memory.clock.now.to_f64();
        if !memory.clock.is_ahead(time) {
            return Step::Failed(Ending::TimeTooCoarse { time: now, step: length.to_f64() });
        }
        let attempt = match memory.prepare(system, h, self.tolerance::<L::Scalar>()) {
            // Shorter steps would find the same equations at the start.
            Err(NoSolution::Unsolved(error)) => return Step::Failed(Ending::of(error, now)),
            Err(other) => Err(other.into()),
            Ok(()) => self.attempt(system, memory, (h, time, is_coupled), statistics),
        };
        let is_too_slow = matches!(attempt, Err(Rejection::TooSlow));
        let (part, ending) = match attempt {
            Ok(()) => {
                *to = memory.at.state();
                return Step::Accepted;
            }
            Err(Rejection::Inaccurate(error, entry)) => {
                let shorter = within_limits(reduction::<L::Scalar, S>(error));
                let part = if memory.accepted.is_none() { SHRINK } else { shorter };
                (part, Ending::StepTooSmall { time: now, entry })
            }
            Err(Rejection::TooSlow) if memory.age == Age::Old => {
                // The same step again, with the derivatives and the tangent plane of its start.
                memory.age = Age::Unknown;
                return Step::Rejected;
            }
            Err(Rejection::TooSlow) => {
                if L::HAS_PLANAR_FRICTION {
                    // A velocity that has just left zero is smaller than the tolerance, and not yet along its force: the polynomial
                    // of the last step turns it by any angle. The next guess is the state at the start of the step.
                    memory.taken = None;
                }
                let reason = "the iteration of a step does not converge, however short it is";
                let obstacle = memory.obstacle.clone().map(|error| Ending::of(error, now));
                (0.5, obstacle.unwrap_or(Ending::MethodFailed { time: now, reason }))
            }
            Err(Rejection::Unsolved(error)) => {
                memory.obstacle = Some(error.clone());
                (0.5, Ending::of(error, now))
            }
            Err(Rejection::AtPole(error)) => return Step::Failed(Ending::of(error, now)),
        };
        let shorter = Scalar::abs(h) * L::Scalar::constant(part);
        match is_too_slow && !is_coupled {
            true => memory.longest = shorter.to_f64(),
            false => (memory.planned, memory.was_refused) = (shorter, true),
        }
        if memory.clock.advances_by(shorter) { Step::Rejected } else { Step::Failed(ending) }
    }

    fn interpolant(
        &self,
        _: &L,
        memory: &mut Self::Memory,
        _: [&StateOf<L>; 2],
        _: &mut Statistics,
    ) -> Result<Self::Interpolant, Error> {
        let now = memory.clock.now.to_f64();
        let no_step = Error::OutsideTrajectory { time: now, start: now, end: now };
        memory.taken.as_ref().map(|(_, last)| *last).ok_or(no_step)
    }

    fn undo(&self, memory: &mut Self::Memory) -> bool {
        let Some((from, last)) = memory.taken.take() else { return false };
        (memory.clock.now, memory.at) = (from.t, from);
        (memory.age, memory.was_refused) = (Age::Unknown, true);
        memory.planned = Scalar::abs(last.length) * L::Scalar::constant(0.5);
        memory.clock.advances_by(memory.planned)
    }

    fn pace(&self, _: &L, memory: &Self::Memory, _: L::Scalar) -> Pace {
        Pace { step: Some(memory.next().0.to_f64()), ..Pace::default() }
    }
}

impl<const S: usize> Radau<S>
where
    Const<S>: RadauStages,
{
    /// Length of the first step.
    fn first<L: Lagrangian<Scalar: Real>>(&self, memory: &RadauMemory<L, S>) -> L::Scalar {
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
        memory: &mut RadauMemory<L, S>,
        (h, time, is_coupled): (L::Scalar, L::Scalar, bool),
        statistics: &mut Statistics,
    ) -> Result<(), Rejection> {
        let tolerance = self.tolerance::<L::Scalar>();
        let guess = memory.guess(h);
        let RadauMemory {
            at,
            transformation,
            chart,
            derivatives,
            age,
            factorizations,
            coupled,
            contraction,
            ..
        } = memory;
        let mut z = guess;
        for change in &mut z {
            *change = chart.tangents(system, change, at.t)?;
        }
        // Changes along the normals: those of the last evaluation leave few corrections to the next.
        let mut normal: [_; S] = from_fn(|k| zip(&guess[k], &z[k], |all, tangent| all - tangent));
        let mut there = |k: usize, change: &PhaseVector<_, L::N>| {
            let moved = zip(change, &normal[k], |tangent, normal| tangent + normal);
            let moved = at.moved(h * L::Scalar::constant(<Const<S>>::NODES[k]), &moved);
            let state = chart.onto(system, moved, (tolerance, &at.y))?;
            normal[k] = zip(&at.change_to(&state), change, |all, tangent| all - tangent);
            Ok::<_, NoSolution>(state)
        };
        let allowed = allowed::<L::Scalar, S>(tolerance.relative);
        let mut coupled =
            is_coupled.then(|| coupled.get_or_insert_with(|| Coupled::new(transformation.slopes)));
        if let Some(coupled) = &mut coupled {
            for (k, change) in z.iter().enumerate() {
                coupled.evaluate(system, (k, &there(k, change)?), (chart, &at.active))?;
            }
            statistics.evaluations += S;
            if !coupled.factorize(h) {
                return Err(Rejection::TooSlow);
            }
        }
        let corrections = |z: &_, rates: &_| match &coupled {
            Some(coupled) => coupled.corrections(z, rates),
            None => factorizations.corrections(transformation, derivatives, z, rates),
        };
        let left = |z: &_, rates: &[PhaseVector<_, _>; S]| {
            let slopes = product(&transformation.slopes, z);
            from_fn(|k| zip(&rates[k], &slopes[k], |rate, slope| rate * h - slope))
        };
        // Derivatives of an earlier state do not say how far round-off of this one goes: nothing is allowed for it.
        let floor = L::HAS_PLANAR_FRICTION.then(|| match age {
            Age::New => derivatives.round_off(&at.y, h),
            _ => PhaseVector::filled(L::Scalar::constant(0.0)),
        });
        let iteration = Iteration { tolerance, y: &at.y, allowed, is_coupled, floor };
        let Converged { iterations, contraction: found } =
            iteration.solve(&mut z, corrections, left, |k, change| {
                Ok(rates_at(system, chart, &there(k, change)?, &at.active, statistics)?)
            })?;
        *contraction = found;
        let tangent = combination(&transformation.start, &z);
        // Stages on the constraints, for dense output.
        for (k, change) in z.iter_mut().enumerate() {
            *change = at.change_to(&there(k, change)?);
        }
        let slopes = StartSlopes { tangent, all: combination(&transformation.start, &z) };
        let estimate = memory.estimate(system, &slopes, tolerance, statistics)?;
        let at = &mut memory.at;
        if estimate.is_too_large() {
            return Err(Rejection::Inaccurate(estimate.size, estimate.worst(&at.y, tolerance)));
        }
        let y = at.moved(h, &z[S - 1]);
        let point = StagePoint { t: time, y: PhaseVector::of(y.q, y.v), velocity: y.v };
        let end = <LagrangianVectorField as VectorField<L>>::project(system, &point)?;
        z[S - 1] = at.change_to(&end);
        let next = KnownState::at(system, &end, statistics)?;
        let step = Collocation { time: at.t, length: h, start: at.y, changes: z };
        pose::check(system, &mut memory.orientation, (at, &step, &end)).map_err(Rejection::AtPole)?;
        let from = core::mem::replace(at, next);
        memory.accept(self, (from, step), (estimate.size, iterations, is_coupled));
        Ok(())
    }
}

/// Rates at a stage in the tangent plane, by the constraints that are independent at the start of the step.
pub(super) fn rates_at<L: Lagrangian<Scalar: Real>>(
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
