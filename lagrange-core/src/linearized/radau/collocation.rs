//! Dense output: the polynomial through the start of a step and its stages.

use nalgebra::Const;

use super::iteration::{StageChanges, combination, zip};
use super::tableau::{RadauStages, basis};
use crate::number::Real;
use crate::solution::interpolant::Interpolant;
use crate::solution::vector_field::StagePoint;
use crate::vector::{Array, Element, PhaseVector, StaticLength, from_fn, vector};

/// Dense output of a step of [`Radau`](super::Radau), of the order of the number of its stages.
#[derive(Clone, Copy, Debug)]
pub struct Collocation<T: Element, N: StaticLength, const S: usize> {
    pub(super) time: T,
    pub(super) length: T,
    pub(super) start: PhaseVector<T, N>,
    /// Stages as differences from the start; the last is the end of the step.
    pub(super) changes: StageChanges<T, N, S>,
}

impl<T: Real, N: StaticLength, const S: usize> Collocation<T, N, S>
where
    Const<S>: RadauStages,
{
    /// Change since the start of the step and its derivative, at θ steps after the start.
    pub(super) fn change(&self, theta: f64) -> [PhaseVector<T, N>; 2] {
        let weights: [_; S] = from_fn(|j| basis(<Const<S>>::NODES, j, theta));
        [0, 1].map(|k| combination(&weights.map(|of| of[k]), &self.changes))
    }
}

impl<T: Real, N: StaticLength, const S: usize> Interpolant<T, N> for Collocation<T, N, S>
where
    Const<S>: RadauStages,
{
    fn at(&self, t: T) -> StagePoint<T, N> {
        let [change, slope] = self.change(((t - self.time) / self.length).to_f64());
        let y = zip(&change, &self.start, |change, start| change + start);
        StagePoint { t, y, velocity: vector(Array::from_fn(|i| slope[0][i] / self.length)) }
    }
}
