//! Derivatives along the steps of a motion.

use alloc::{boxed::Box, vec::Vec};

use super::state::{StateSensitivity, at_event};
use super::trajectory::DynDifferentiableEvent;
use crate::derivatives::tangent::{Tangent, WideOf};
use crate::error::{Ending, Error};
use crate::linearized::Linearized;
use crate::linearized::variation::{DifferentiableMethod, Variations};
use crate::number::{Broadcast, Real, Scalar, Wide};
use crate::solution::crossing::Crossing;
use crate::system::{Direction, StateOf};
use crate::vector::{Entrywise, PhaseVector, StaticLength};

/// Derivatives along a motion.
pub(super) struct Course<L: Linearized<Scalar: Real>> {
    /// Variations at the end of the last step.
    pub(super) variations: Variations<L>,
    /// Time at the end of the last step; the motion may have ended within this step.
    end: L::Scalar,
    /// Start and length of each step.
    steps: Vec<[L::Scalar; 2]>,
    /// Coefficients of the interpolants of the variations, step by step and block by block, the same number for each.
    pub(super) coefficients: Vec<PhaseVector<WideOf<L>, L::N>>,
    /// Evaluates an interpolant from its coefficients.
    between: Between<WideOf<L>, L::N>,
}

/// Variations of a block at a fraction of a step, from the coefficients of the interpolant.
type Between<W, N> = fn(&[PhaseVector<W, N>], W) -> PhaseVector<W, N>;

impl<L: Linearized<Scalar: Real>> Course<L> {
    /// Derivatives at the start of a motion, and the method's memory for them.
    pub(super) fn from<D: DifferentiableMethod<L>>(
        system: &L,
        state: &StateOf<L>,
        start: &StateSensitivity<L::Scalar, L::N>,
        method: &D,
    ) -> Result<(Self, D::VariationMemory), Error> {
        let tangent = Tangent::at(system, state)?;
        // Convert to derivatives at fixed time: if the start is an event, subtract the change of its time.
        let column = |j| {
            let Direction { t, q, v } = start.direction(j);
            let back = |x: L::Scalar, rate| x - rate * t;
            [q.each_with(&state.v, back), v.each_with(&tangent.solution.accelerations, back)]
        };
        let variations = Variations::begin(&tangent, start.arguments().to_vec(), column)?;
        let memory = method.companion(system, state, &variations)?;
        let (steps, coefficients) = (Vec::new(), Vec::new());
        Ok((Self { variations, end: state.t, steps, coefficients, between: D::between }, memory))
    }

    /// Records a step that the variations have followed.
    pub(super) fn push(&mut self, start: L::Scalar, end: L::Scalar) {
        self.steps.push([start, end - start]);
        self.end = end;
    }

    /// Derivatives of a state of the motion.
    pub(super) fn at(
        &self,
        system: &L,
        state: &StateOf<L>,
    ) -> Result<StateSensitivity<L::Scalar, L::N>, Error> {
        let blocks = &self.variations.blocks;
        let mut at = StateSensitivity::of(*state, self.variations.arguments().to_vec());
        let found = if state.t == self.end { None } else { self.step(state.t) };
        let tangent = if const { <L::M>::COUNT > 0 } { Some(Tangent::at(system, state)?) } else { None };
        let equations = tangent.as_ref().map(|tangent| self.variations.equations(tangent));
        for (k, block) in blocks.iter().enumerate() {
            let mut y = match found {
                None => block.y,
                Some((step, part)) => {
                    let each = self.coefficients.len() / (self.steps.len() * blocks.len());
                    let first = each * (step * blocks.len() + k);
                    (self.between)(&self.coefficients[first..first + each], WideOf::<L>::of(part))
                }
            };
            if let Some(equations) = &equations {
                y = equations.projected(block, y)?;
            }
            for lane in 0..block.lanes {
                let [q, v] = y.arrays().map(|half| half.map(|x| x.lane(lane)));
                at.set(block.first + lane, [&q, &v]);
            }
        }
        Ok(at)
    }

    /// Returns the derivatives at the end of the motion; at an event they include those of its time. `before` is an earlier state.
    pub(super) fn end(
        &self,
        system: &L,
        state: &StateOf<L>,
        ending: &Ending,
        crossings: &[Crossing<L::Scalar, L::N>],
        events: &[Box<DynDifferentiableEvent<'_, L>>],
        before: &StateOf<L>,
    ) -> Result<StateSensitivity<L::Scalar, L::N>, Error> {
        if ending.is_failure() {
            return Err(ending.clone().into());
        }
        let at = self.at(system, state)?;
        let last = crossings.last().filter(|_| matches!(ending, Ending::Event { .. }));
        match last.and_then(|crossing| events.get(crossing.index)) {
            None => Ok(at),
            Some(event) => at_event(system, at, (event.called(), &|at: &_| event.change(system, at)), before),
        }
    }

    /// Discards the steps, and keeps the derivatives at the end of the last.
    pub(super) fn forget_steps(&mut self) {
        self.steps.clear();
        self.coefficients.clear();
    }

    /// Index of the step that contains this time, and the fraction of it that has passed.
    fn step(&self, t: L::Scalar) -> Option<(usize, L::Scalar)> {
        let is_past = |[start, length]: &[L::Scalar; 2]| (t - *start) / *length >= L::Scalar::constant(0.0);
        let step = self.steps.partition_point(is_past).checked_sub(1)?;
        let [start, length] = self.steps[step];
        Some((step, (t - start) / length))
    }
}
