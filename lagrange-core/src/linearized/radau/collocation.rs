//! Dense output: the polynomial through the start of a step and its stages.

use nalgebra::Const;

use super::iteration::StageChanges;
use super::tableau::{RadauStages, basis};
use crate::number::Real;
use crate::solution::interpolant::Interpolant;
use crate::solution::vector_field::StagePoint;
use crate::vector::{Array, Element, Length, PhaseVector};

/// Dense output of a step of [`Radau`](super::Radau), of the order of the number of its stages.
#[derive(Clone, Copy, Debug)]
pub struct Collocation<T: Element, N: Length, const S: usize> {
    pub(super) time: T,
    pub(super) length: T,
    pub(super) start: PhaseVector<T, N>,
    /// Stages as differences from the start; the last is the end of the step.
    pub(super) changes: StageChanges<T, N, S>,
}

impl<T: Real, N: Length, const S: usize> Collocation<T, N, S>
where
    Const<S>: RadauStages,
{
    /// Change since the start of the step and its derivative, at θ steps after the start.
    pub(super) fn change(&self, theta: f64) -> [PhaseVector<T, N>; 2] {
        let mut sums = [PhaseVector::filled(T::constant(0.0)); 2];
        for (j, change) in self.changes.iter().enumerate() {
            for (sum, weight) in sums.iter_mut().zip(basis(<Const<S>>::NODES, j, theta)) {
                let weight = T::constant(weight);
                sum.flat_mut().iter_mut().zip(change.flat()).for_each(|(sum, x)| *sum += weight * *x);
            }
        }
        sums
    }
}

impl<T: Real, N: Length, const S: usize> Interpolant<T, N> for Collocation<T, N, S>
where
    Const<S>: RadauStages,
{
    fn at(&self, t: T) -> StagePoint<T, N> {
        let [mut y, slope] = self.change(((t - self.time) / self.length).to_f64());
        y.flat_mut().iter_mut().zip(self.start.flat()).for_each(|(y, start)| *y += *start);
        StagePoint { t, y, velocity: Array::from_fn(|i| slope[0][i] / self.length) }
    }
}
