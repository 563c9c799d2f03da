//! State that an embedded pair carries from step to step.

use super::clock::Clock;
use super::control::Control;
use super::pair::{Slopes, StageMultipliers};
use super::slope::slope;
use crate::error::Error;
use crate::number::Real;
use crate::room::Room;
use crate::solution::vector_field::{StagePoint, VectorField};
use crate::statistics::Statistics;
use crate::system::Lagrangian;
use crate::vector::{Array, Element, Length, PhaseVector};

/// State that an embedded pair carries from step to step.
#[derive(Clone, Debug)]
pub struct PairMemory<T: Element, N: Length, M: Length> {
    pub(crate) clock: Clock<T>,
    pub(crate) control: Control<T>,
    /// True once the first step length has been chosen, which requires the end.
    pub(super) is_planned: bool,
    /// Current coordinates and velocities, or coordinates and momenta.
    pub(crate) y: PhaseVector<T, N>,
    /// True if `slope` holds the rates at `y`.
    pub(crate) has_slope: bool,
    /// Rates at `y`.
    pub(crate) slope: PhaseVector<T, N>,
    /// Constraints that determine the rates: a largest independent set at `y`.
    pub(crate) active: Array<bool, M>,
    /// Multipliers at `y`, with `slope`; NaN where lanes led there.
    pub(crate) multipliers: Array<T, M>,
    /// Slopes of the last step tried; the first is the slope at its start.
    pub(super) slopes: Room<Slopes<T, N>>,
    /// Multipliers with each of these slopes.
    pub(super) stage_multipliers: Room<StageMultipliers<T, M>>,
    /// The step that led to `y`.
    pub(super) taken: Option<Taken<T, N, M>>,
}

/// An accepted step, for its dense output or to undo it.
#[derive(Clone, Debug)]
pub(super) struct Taken<T: Element, N: Length, M: Length> {
    pub(super) from: StepStart<T, N, M>,
    pub(super) h: T,
    pub(super) control: Control<T>,
}

/// Start of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepStart<T: Element, N: Length, M: Length> {
    pub(super) t: T,
    pub(super) y: PhaseVector<T, N>,
    pub(super) active: Array<bool, M>,
}

impl<T: Real, N: Length, M: Length> PairMemory<T, N, M> {
    /// Returns the next step, signed, and the time after it.
    pub(crate) fn next(&self) -> (T, T) {
        self.clock.next(self.control.step)
    }

    /// Start, length and slopes of the last accepted step.
    #[cfg(feature = "alloc")]
    pub(crate) fn last_step(&self) -> Option<(StagePoint<T, N>, T, &Slopes<T, N>)> {
        let Taken { from: StepStart { t, y, .. }, h, .. } = self.taken.as_ref()?;
        Some((StagePoint { t: *t, y: *y, velocity: self.slopes[0].half(0) }, *h, &self.slopes))
    }

    /// Evaluates the rates at the current state, unless they are known.
    #[inline]
    pub(crate) fn ensure_slope<L: Lagrangian<N = N, M = M, Scalar = T>, F: VectorField<L>>(
        &mut self,
        system: &L,
        statistics: &mut Statistics,
    ) -> Result<(), Error> {
        if !self.has_slope {
            let point = StagePoint { t: self.clock.now, y: self.y, velocity: self.slope.half(0) };
            let found = slope::<L, F>(system, &point, None, &mut self.slope, statistics)?;
            (self.active, self.multipliers) = (found.active, found.multipliers);
            self.has_slope = true;
        }
        Ok(())
    }

    pub(super) fn origin(&self) -> StepStart<T, N, M> {
        StepStart { t: self.clock.now, y: self.y, active: self.active }
    }
}
