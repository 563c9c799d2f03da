//! Errors of the variations over a step: the derivative of the error estimate of the motion.

use nalgebra::Const;

use super::super::estimate::StartSlopes;
use super::super::iteration::combination;
use super::super::memory::RadauMemory;
use super::super::tableau::RadauStages;
use super::super::{Radau, of_estimate};
use super::equations::StageVariations;
use crate::derivatives::tangent::{Tangent, WideOf};
use crate::error::Error;
use crate::linearized::Linearized;
use crate::linearized::variation::{Block, VariationalEquations, Variations};
use crate::motion::limits::SLACK;
use crate::motion::method::control::VariedEnds;
use crate::number::{Real, Wide};
use crate::solution::solve::solve_near;
use crate::vector::{Array, PhaseVector, from_fn};

impl<const S: usize> Radau<S>
where
    Const<S>: RadauStages,
{
    /// Largest error of a variation over the last step relative to its tolerance, and the index of that variation.
    pub(super) fn error_of<L: Linearized<Scalar: Real>>(
        &self,
        system: &L,
        memory: &RadauMemory<L, S>,
        variations: &Variations<L>,
        stages: &StageVariations<L::Scalar>,
    ) -> Result<(f64, usize), Error> {
        let Some((from, _)) = &memory.taken else { return Ok((0.0, 0)) };
        let state = from.state();
        let solution = solve_near(system, &state, Some(&from.active), |solution, _| *solution)?;
        let tangent = Tangent::of(system, &state, solution);
        let (equations, mut worst) = (variations.equations(&tangent), (0.0, 0));
        for (k, block) in variations.blocks.iter().enumerate() {
            let rates = equations.slope(block, &block.y)?;
            for lane in 0..block.lanes {
                let error = self.error_of_lane(memory, &equations, (k, block, lane), (stages, &rates))?;
                // NaN counts as infinite.
                let error = if error.is_nan() { f64::INFINITY } else { error };
                if error > worst.0 {
                    worst = (error, block.first + lane);
                }
            }
        }
        Ok(worst)
    }

    /// Error of the variation in a lane of block `k`, which has these rates at the start of the step.
    fn error_of_lane<L: Linearized<Scalar: Real>>(
        &self,
        memory: &RadauMemory<L, S>,
        equations: &VariationalEquations<'_, L>,
        (k, block, lane): (usize, &Block<WideOf<L>, L::N, L::P>, usize),
        (stages, rates): (&StageVariations<L::Scalar>, &PhaseVector<WideOf<L>, L::N>),
    ) -> Result<f64, Error> {
        let Tangent { system, state, .. } = equations.tangent;
        let in_plane = |y: &_| memory.chart.tangents(system, y, state.t);
        let [start, end, rates] = [&block.y, &stages.at(S - 1, k), rates].map(|y| lane_of::<L>(y, lane));
        let changes = from_fn(|stage| lane_of::<L>(&stages.change(stage, k, &block.y), lane));
        let all = combination(&memory.transformation.start, &changes);
        let slopes = StartSlopes { tangent: in_plane(&all)?, all };
        let places = [&PhaseVector::of(state.q, state.v), &memory.at.y];
        let step = VariedEnds { variations: [&start, &end], places, unit: block.unit.lane(lane) };
        let tolerance = self.tolerance::<L::Scalar>();
        let slack = of_estimate::<L::Scalar, S>(SLACK);
        let part = |errors: &_| tolerance.part_of_variations(slack, errors, &step).to_f64();
        let estimate = memory.estimate_of([&rates, &in_plane(&rates)?], &slopes, part, |errors| {
            let mut y = block.y;
            y.flat_mut().iter_mut().zip(errors.flat()).for_each(|(y, x)| y.put(lane, y.lane(lane) + *x));
            let y = equations.projected(block, y)?;
            in_plane(&lane_of::<L>(&equations.slope(block, &y)?, lane))
        });
        Ok(estimate?.size)
    }
}

/// One lane of the variations of a block.
fn lane_of<L: Linearized<Scalar: Real>>(
    y: &PhaseVector<WideOf<L>, L::N>,
    lane: usize,
) -> PhaseVector<L::Scalar, L::N> {
    from_fn(|half| Array::from_fn(|i| y[half][i].lane(lane)))
}
