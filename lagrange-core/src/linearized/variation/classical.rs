//! Variations along the classical Runge–Kutta method: each stage is differentiated, with its own factorization.

use alloc::vec;
use alloc::vec::Vec;

use super::{DifferentiableMethod, Linearized, Variations, VariedRun};
use crate::derivatives::tangent::{Tangent, WideOf};
use crate::error::{Ending, Error};
use crate::motion::{PhaseVector, RungeKutta4};
use crate::number::{Broadcast, Real, Scalar};
use crate::solution::interpolant::hermite;
use crate::solution::solve::solve_near;
use crate::system::{State, StateOf};
use crate::vector::{Array, Element, StaticLength, from_fn, vector};

/// A block of variations at the start of the last step, and their slopes at its stages.
#[derive(Clone, Debug)]
pub struct ClassicalStages<W: Element, N: StaticLength> {
    start: PhaseVector<W, N>,
    slopes: [PhaseVector<W, N>; 4],
}

impl<L: Linearized<Scalar: Real>> DifferentiableMethod<L> for RungeKutta4 {
    type VariationMemory = Vec<ClassicalStages<WideOf<L>, L::N>>;

    fn companion(
        &self,
        _: &L,
        _: &StateOf<L>,
        variations: &Variations<L>,
    ) -> Result<Self::VariationMemory, Error> {
        let zero = PhaseVector::filled(WideOf::<L>::constant(0.0));
        Ok(vec![ClassicalStages { start: zero, slopes: [zero; 4] }; variations.blocks.len()])
    }

    fn restart(&self, _: VariedRun<'_, L, Self>) -> Result<(), Error> {
        Ok(())
    }

    fn follow(&self, at: VariedRun<'_, L, Self>) -> Result<(), Ending> {
        let VariedRun { system, run, variations, memory: all } = at;
        let blocks = variations.blocks.iter().zip(&mut *all);
        blocks.for_each(|(block, stages)| stages.start = block.y);
        go(system, [&run.before, &run.state], variations, all).map_err(|error| {
            step_back(variations, all);
            Ending::of(error, run.before.t.to_f64())
        })
    }

    fn interpolate(
        &self,
        VariedRun { system, run, variations, memory: all }: VariedRun<'_, L, Self>,
        within: &mut Vec<Self::Interpolant>,
        coefficients: &mut Vec<PhaseVector<WideOf<L>, L::N>>,
    ) -> Result<(), Ending> {
        let (known, first) = (within.len(), coefficients.len());
        let h = WideOf::<L>::of(run.state.t - run.before.t);
        let zero = PhaseVector::filled(WideOf::<L>::constant(0.0));
        let found = run.look_within(system, self, within).and_then(|()| {
            let at_end = Tangent::at(system, &run.state).and_then(|tangent| {
                let equations = variations.equations(&tangent);
                for (block, ClassicalStages { start, slopes }) in variations.blocks.iter().zip(&*all) {
                    let (at, slope) = (coefficients.len(), equations.slope(block, &block.y)?);
                    coefficients.extend([zero; 4]);
                    hermite(h, (start, &slopes[0]), (&block.y, &slope), &mut coefficients[at..]);
                }
                Ok(())
            });
            at_end.map_err(|error| Ending::of(error, run.before.t.to_f64()))
        });
        found.inspect_err(|_| {
            within.truncate(known);
            coefficients.truncate(first);
            step_back(variations, all);
        })
    }
}

/// Restores the variations to the start of the last step.
fn step_back<L: Linearized<Scalar: Real>>(
    variations: &mut Variations<L>,
    all: &[ClassicalStages<WideOf<L>, L::N>],
) {
    variations.blocks.iter_mut().zip(all).for_each(|(block, stages)| block.y = stages.start);
}

/// Advances the variations over the step between these states.
fn go<L: Linearized<Scalar: Real>>(
    system: &L,
    [before, after]: [&StateOf<L>; 2],
    variations: &mut Variations<L>,
    all: &mut [ClassicalStages<WideOf<L>, L::N>],
) -> Result<(), Error> {
    let (h, start) = (after.t - before.t, PhaseVector::of(before.q, before.v));
    let (mut newest, mut independent) = (start, None);
    for (number, node) in [0.0, 0.5, 0.5, 1.0].into_iter().enumerate() {
        let length = h * L::Scalar::constant(node);
        let place = along(&start, length, &newest);
        let state = State { t: before.t + length, q: vector(place.half(0)), v: vector(place.half(1)) };
        // Later stages are off the constraints: they use those that are independent at the start.
        let (solution, active) =
            solve_near(system, &state, independent.as_ref(), |solution, active| (*solution, *active))?;
        independent.get_or_insert(active);
        newest = PhaseVector::of(state.v, solution.accelerations);
        let tangent = Tangent::of(system, &state, solution);
        let length = WideOf::<L>::of(length);
        for (block, ClassicalStages { start, slopes }) in variations.blocks.iter_mut().zip(&*all) {
            let before = number.checked_sub(1).map(|before| &slopes[before]);
            block.at_stage = before.map_or(*start, |slope| along(start, length, slope));
        }
        let equations = variations.equations(&tangent);
        for (block, stages) in variations.blocks.iter().zip(&mut *all) {
            stages.slopes[number] = equations.slope(block, &block.at_stage)?;
        }
    }
    let sixth = WideOf::<L>::of(h / L::Scalar::constant(6.0));
    for (block, ClassicalStages { start, slopes }) in variations.blocks.iter_mut().zip(&*all) {
        block.y = along(start, sixth, &weighted(slopes));
    }
    match const { <L::M>::COUNT == 0 } {
        true => Ok(()),
        false => variations.arrive(&Tangent::at(system, after)?),
    }
}

/// Sum of the slopes of a step by their weights, in sixths.
fn weighted<T: Scalar, N: StaticLength>([a, b, c, d]: &[PhaseVector<T, N>; 4]) -> PhaseVector<T, N> {
    let two = T::constant(2.0);
    let sum = |half: usize, i: usize| a[half][i] + two * (b[half][i] + c[half][i]) + d[half][i];
    from_fn(|half| Array::from_fn(|i| sum(half, i)))
}

/// start + length · slope
fn along<T: Scalar, N: StaticLength>(
    start: &PhaseVector<T, N>,
    length: T,
    slope: &PhaseVector<T, N>,
) -> PhaseVector<T, N> {
    from_fn(|half| Array::from_fn(|i| length.multiply_add(slope[half][i], start[half][i])))
}
