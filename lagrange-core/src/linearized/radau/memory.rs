//! State that the method carries from step to step, and the choice of the next step.

use core::fmt::{self, Debug, Formatter};

use super::Radau;
use super::chart::Chart;
use super::equations::{Derivatives, Factorizations};
use super::iteration::{NODES, StageChanges, growth, power};
use crate::error::Error;
use crate::linearized::StateDerivatives;
use crate::motion::method::clock::Clock;
use crate::number::{Real, Scalar, larger};
use crate::solution::interpolant::evaluate;
use crate::solution::solve::{solve, solve_near};
use crate::statistics::Statistics;
use crate::system::{Lagrangian, State, StateOf};
use crate::vector::{Array, Element, Length, PhaseVector, array, from_fn, vector};

/// Contraction of the iteration below which derivatives are used again in the next step.
const REUSED: f64 = 1e-3;
/// Largest ratio of a step to the one before for which it keeps the length, and the factorizations with it.
const SAME: f64 = 1.2;

/// State that the method carries from step to step.
pub struct RadauMemory<L: Lagrangian<Scalar: Real>> {
    pub(super) clock: Clock<L::Scalar>,
    /// Length of the next step; zero before the first is estimated.
    pub(super) planned: L::Scalar,
    pub(super) at: KnownStateOf<L>,
    pub(super) derivatives: Option<(Chart<L>, Derivatives<L::Scalar, L::N>)>,
    pub(super) factorizations: Option<Factorizations<L::Scalar, L::N>>,
    /// True if the derivatives are those of an earlier state.
    pub(super) are_derivatives_old: bool,
    pub(super) contraction: f64,
    /// Length and error of the last accepted step, for the controller.
    pub(super) accepted: Option<(f64, f64)>,
    pub(super) was_refused: bool,
    /// The last accepted step, and its dense output.
    pub(super) taken: Option<(KnownStateOf<L>, L::Scalar)>,
    pub(super) coefficients: [PhaseVector<L::Scalar, L::N>; 4],
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
pub(super) struct KnownState<T: Element, N: Length, M: Length> {
    pub(super) y: PhaseVector<T, N>,
    pub(super) rates: PhaseVector<T, N>,
    pub(super) active: Array<bool, M>,
    pub(super) t: T,
}

impl<T: Real, N: Length, M: Length> KnownState<T, N, M> {
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
        let [q, v] = from_fn(|half| Array::from_fn(|i| self.y[half][i] + change[half][i]));
        State { t: self.t + h, q: vector(q), v: vector(v) }
    }

    /// Changes that lead to the coordinates and velocities of a state.
    pub(super) fn change_to(&self, state: &State<T, N>) -> PhaseVector<T, N> {
        let there = PhaseVector::<T, N>::of(state.q, state.v);
        PhaseVector::new(from_fn(|half| Array::from_fn(|i| there[half][i] - self.y[half][i])))
    }

    pub(super) fn state(&self) -> State<T, N> {
        State { t: self.t, q: vector(self.y.half(0)), v: vector(self.y.half(1)) }
    }
}

pub(super) type KnownStateOf<L> =
    KnownState<<L as Lagrangian>::Scalar, <L as Lagrangian>::N, <L as Lagrangian>::M>;

impl<L: StateDerivatives<Scalar: Real>> RadauMemory<L> {
    /// Stages on the polynomial of the last step, as changes from the state; zero if there is none.
    pub(super) fn guess(&self, h: L::Scalar) -> StageChanges<L::Scalar, L::N> {
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
    pub(super) fn prepare(&mut self, system: &L, h: L::Scalar) -> Result<(), Error> {
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
    pub(super) fn accept(
        &mut self,
        method: &Radau,
        (from, h): (KnownStateOf<L>, L::Scalar),
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
