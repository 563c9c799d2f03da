//! State that the method carries from step to step, and the choice of the next step.

use core::fmt::{self, Debug, Formatter};

use nalgebra::Const;

use super::Radau;
use super::chart::Chart;
use super::collocation::Collocation;
use super::coupled::Coupled;
use super::equations::{Derivatives, Factorizations};
use super::iteration::{NoSolution, StageChanges, growth, reduction, within_limits, zip};
use super::limits::{CONTRACTION, COUPLED, RETRIED, REUSED, SAME};
use super::tableau::{RadauStages, Transformation};
use crate::error::Error;
use crate::linearized::StateDerivatives;
use crate::motion::method::clock::Clock;
use crate::motion::method::control::Tolerance;
use crate::number::smaller;
use crate::number::{Real, Scalar, larger};
use crate::numerics::lu::Lu;
use crate::solution::solve::{solve, solve_near};
use crate::statistics::Statistics;
use crate::system::{Lagrangian, State, StateOf, System};
use crate::vector::{Array, Element, PhaseVector, StaticLength, array, from_fn, vector};

/// State at which the derivatives were evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Age {
    /// None: they must be evaluated.
    Unknown,
    /// An earlier state.
    Old,
    /// The start of the step.
    New,
}

/// State that the method carries from step to step.
pub struct RadauMemory<L: Lagrangian<Scalar: Real>, const S: usize = 3> {
    pub(super) clock: Clock<L::Scalar>,
    /// Length of the next step; zero before the first is estimated.
    pub(super) planned: L::Scalar,
    pub(super) at: KnownStateOf<L>,
    pub(super) transformation: Transformation<S>,
    pub(super) chart: Chart<L>,
    pub(super) derivatives: Derivatives<L::Scalar, L::N>,
    pub(super) age: Age,
    pub(super) factorizations: Factorizations<L::Scalar, L::N, S>,
    /// The linear equations with the derivatives at each stage, once they are needed.
    pub(super) coupled: Option<Coupled<L::Scalar, L::N, S>>,
    /// Longest step for which the iteration is expected to converge without them.
    pub(super) longest: f64,
    pub(super) contraction: f64,
    /// Memory to compare the constraints at both ends of a step.
    pub(super) orientation: Lu<L::Scalar, L::M>,
    /// Length and error of the last accepted step, for the controller.
    pub(super) accepted: Option<(f64, f64)>,
    pub(super) was_refused: bool,
    /// Reason why the equations had no solution at a stage of a longer step from the same state.
    pub(super) obstacle: Option<Error>,
    /// The state before the last accepted step, and its dense output.
    pub(super) taken: Option<(KnownStateOf<L>, Collocation<L::Scalar, L::N, S>)>,
}

impl<L: Lagrangian<Scalar: Real>, const S: usize> Debug for RadauMemory<L, S> {
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
pub(super) struct KnownState<T: Element, N: StaticLength, M: StaticLength> {
    pub(super) y: PhaseVector<T, N>,
    pub(super) rates: PhaseVector<T, N>,
    pub(super) active: Array<bool, M>,
    pub(super) t: T,
}

impl<T: Real, N: StaticLength, M: StaticLength> KnownState<T, N, M> {
    pub(super) fn at<L: Lagrangian<N = N, M = M, Scalar = T>>(
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
    pub(super) fn moved(&self, h: T, change: &PhaseVector<T, N>) -> State<T, N> {
        let [q, v] = zip(&self.y, change, |y, change| y + change).arrays().map(vector);
        State { t: self.t + h, q, v }
    }

    /// Changes that lead to the coordinates and velocities of a state.
    pub(super) fn change_to(&self, state: &State<T, N>) -> PhaseVector<T, N> {
        zip(&PhaseVector::of(state.q, state.v), &self.y, |there, y| there - y)
    }

    pub(super) fn state(&self) -> State<T, N> {
        State { t: self.t, q: vector(self.y.half(0)), v: vector(self.y.half(1)) }
    }
}

pub(super) type KnownStateOf<L> = KnownState<<L as System>::Scalar, <L as Lagrangian>::N, <L as System>::M>;

impl<L: StateDerivatives<Scalar: Real>, const S: usize> RadauMemory<L, S>
where
    Const<S>: RadauStages,
{
    /// Length of the next step, and whether it takes the derivatives at each stage.
    pub(super) fn next(&self) -> (L::Scalar, bool) {
        let (planned, longest) = (self.planned.to_f64(), self.longest);
        // Without a step before, the guess of the stages is the start, which knows no more than its derivatives.
        let is_coupled = self.taken.is_some() && planned > COUPLED * longest;
        (L::Scalar::constant(if is_coupled { planned } else { planned.min(longest) }), is_coupled)
    }

    /// Stages on the polynomial of the last step, as changes from the state; zero if there is none.
    pub(super) fn guess(&self, h: L::Scalar) -> StageChanges<L::Scalar, L::N, S> {
        from_fn(|k| match &self.taken {
            None => PhaseVector::filled(L::Scalar::constant(0.0)),
            Some((_, last)) => {
                let [there, _] = last.change(1.0 + <Const<S>>::NODES[k] * (h / last.length).to_f64());
                zip(&there, &last.changes[S - 1], |there, here| there - here)
            }
        })
    }

    /// Makes a chart, evaluates derivatives in it and factorizes them, where those of the last step do not serve.
    pub(super) fn prepare(
        &mut self,
        system: &L,
        h: L::Scalar,
        tolerance: Tolerance,
    ) -> Result<(), NoSolution> {
        let is_unknown = self.age == Age::Unknown;
        if is_unknown {
            let state = self.at.state();
            let solution = solve(system, &state)?;
            self.chart.set(system, &state);
            match self.derivatives.evaluate(system, &state, solution, &self.chart) {
                Err(Error::DerivativeNotFinite { .. }) => self.evaluate_nearby(system, tolerance)?,
                other => other?,
            }
            self.age = Age::New;
        }
        let Self { derivatives, factorizations, .. } = self;
        if (is_unknown || factorizations.h != h) && !factorizations.factorize(derivatives, h) {
            self.age = Age::Unknown;
            return Err(NoSolution::TooSlow);
        }
        Ok(())
    }

    /// Evaluates derivatives beside a kink: every entry moves on in its direction by an allowed error, each by another part
    /// of it, because a kink may depend on differences of entries. The iteration needs no more than nearby derivatives.
    fn evaluate_nearby(&mut self, system: &L, tolerance: Tolerance) -> Result<(), Error> {
        let mut moved = self.at;
        let entries = moved.y.flat_mut().iter_mut().zip(self.at.rates.flat()).enumerate();
        for (k, (y, rate)) in entries {
            let allowed = tolerance.absolute + tolerance.relative * Scalar::abs(*y).to_f64();
            let part = L::Scalar::constant(allowed * (1.0 - k as f64 / (4 * <L::N>::COUNT) as f64));
            *y += if *rate < L::Scalar::constant(0.0) { -part } else { part };
        }
        let state = moved.state();
        let solution = solve_near(system, &state, Some(&self.at.active), |solution, _| *solution)?;
        self.derivatives.evaluate(system, &state, solution, &self.chart)
    }

    /// Moves the clock, keeps dense output, and chooses the next step.
    pub(super) fn accept(
        &mut self,
        method: &Radau<S>,
        (from, step): (KnownStateOf<L>, Collocation<L::Scalar, L::N, S>),
        (error, iterations, is_coupled): (f64, usize, bool),
    ) {
        let h = step.length;
        let length = Scalar::abs(h).to_f64();
        let mut ratio = growth::<L::Scalar, S>(error, iterations);
        let converging = CONTRACTION / self.contraction;
        let is_exact = self.contraction <= REUSED;
        // Of bodies that begin to slide along two velocities, the velocity grows, and its direction turns ever less.
        self.longest *= if L::HAS_PLANAR_FRICTION && is_exact { 2.0 } else { RETRIED };
        match is_coupled {
            true => ratio = ratio.min(converging).min(COUPLED),
            false => self.longest = self.longest.min(length * converging),
        }
        if let Some((length_before, error_before)) = self.accepted {
            // The controller of Gustafsson, from two errors.
            let trend = reduction::<L::Scalar, S>(error * error / error_before);
            ratio = ratio.min(within_limits(length / length_before * trend));
        }
        if self.was_refused {
            ratio = ratio.min(1.0);
        }
        (self.accepted, self.was_refused, self.obstacle) =
            (Some((length, error.max(f64::MIN_POSITIVE))), false, None);
        let keeps_derivatives = !is_coupled && is_exact;
        let keeps_length = keeps_derivatives && (1.0..=SAME).contains(&ratio);
        self.age = if keeps_derivatives { Age::Old } else { Age::Unknown };
        let planned = self.planned;
        let next = if keeps_length { Scalar::abs(h) } else { Scalar::abs(h) * L::Scalar::constant(ratio) };
        self.taken = Some((from, step));
        self.clock.now = self.at.t;
        // If the end has shortened this step, the planned length serves a continued motion.
        let next = if self.clock.is_at_end() { larger(next, planned) } else { next };
        self.planned = method.fit(next, &self.clock);
    }

    /// Shortens the next step to what an error of the variations over the last allows, in units of their tolerance.
    pub(super) fn shorten(&mut self, method: &Radau<S>, error: f64) {
        let Some((_, step)) = self.taken.as_ref().filter(|_| !self.clock.is_at_end()) else { return };
        let ratio = within_limits(reduction::<L::Scalar, S>(error));
        let allowed = Scalar::abs(step.length) * L::Scalar::constant(ratio);
        self.planned = method.fit(smaller(self.planned, allowed), &self.clock);
    }
}
