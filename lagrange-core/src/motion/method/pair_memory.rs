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
use crate::system::System;
use crate::vector::{Array, Element, Length, PhaseVector, SpareVectors, StaticLength};

/// State that an embedded pair carries from step to step.
#[derive(Clone, Debug)]
pub struct PairMemory<T: Element, N: Length, M: StaticLength> {
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
    pub(super) spare: SpareVectors<T, N>,
}

/// An accepted step, for its dense output or to undo it.
#[derive(Clone, Debug)]
pub(super) struct Taken<T: Element, N: Length, M: StaticLength> {
    pub(super) from: StepStart<T, N, M>,
    pub(super) h: T,
    pub(super) control: Control<T>,
}

/// Start of a step.
#[derive(Clone, Debug)]
pub(super) struct StepStart<T: Element, N: Length, M: StaticLength> {
    pub(super) t: T,
    pub(super) y: PhaseVector<T, N>,
    pub(super) active: Array<bool, M>,
}

impl<T: Real, N: Length, M: StaticLength> PairMemory<T, N, M> {
    /// Returns the next step, signed, and the time after it.
    pub(crate) fn next(&self) -> (T, T) {
        self.clock.next(self.control.step)
    }

    /// Start, length and slopes of the last accepted step.
    pub(crate) fn last_step(&self) -> Option<(StagePoint<T, N>, T, &Slopes<T, N>)> {
        let Taken { from: StepStart { t, y, .. }, h, .. } = self.taken.as_ref()?;
        let velocity = self.slopes[0].half_if_constant(0);
        Some((StagePoint { t: *t, y: y.clone(), velocity }, *h, &self.slopes))
    }

    /// Evaluates the rates at the current state, unless they are known.
    #[inline]
    pub(crate) fn ensure_slope<L: System<Length = N, M = M, Scalar = T>, F: VectorField<L>>(
        &mut self,
        system: &L,
        statistics: &mut Statistics,
    ) -> Result<(), Error> {
        if !self.has_slope {
            let velocity = self.slope.half_if_constant(0);
            let point = StagePoint { t: self.clock.now, y: self.lend_state(), velocity };
            let found = slope::<L, F>(system, &point, None, &mut self.slope, statistics);
            self.spare.give_back(point.y);
            let found = found?;
            (self.active, self.multipliers) = (found.active, found.multipliers);
            self.has_slope = true;
        }
        Ok(())
    }

    /// Returns a copy of the current phase.
    #[inline(always)]
    fn lend_state(&mut self) -> PhaseVector<T, N> {
        let mut y = self.spare.lend(&self.y);
        y.copy_from(&self.y);
        y
    }

    /// Returns the start of a step from the current state.
    #[inline(always)]
    pub(super) fn origin(&mut self) -> StepStart<T, N, M> {
        StepStart { t: self.clock.now, y: self.lend_state(), active: self.active }
    }
}
