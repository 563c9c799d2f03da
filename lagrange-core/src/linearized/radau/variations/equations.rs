//! Linearized equations of a step, for the variations of the velocities of all stages at once.
//!
//! With the coordinates δqₖ = Aₖ (δq + h Σⱼ aₖⱼ δvⱼ) + sₖ and velocities δvₖ = Bₖ (δv + h Σⱼ aₖⱼ δq̈ⱼ) + Tₖ δqₖ + rₖ of the
//! stages, where A, B, T, s and r keep them on the constraints, the velocities satisfy S N linear equations. They are
//! factorized: an iteration with the matrices of the step would converge along directions of the step alone.

use alloc::vec::Vec;

use nalgebra::{Const, DMatrix};

use super::super::iteration::zip;
use super::super::memory::RadauMemory;
use super::super::tableau::RadauStages;
use super::stage::{Held, Normals, StageDerivatives};
use crate::derivatives::tangent::Tangent;
use crate::error::Error;
use crate::linearized::Linearized;
use crate::linearized::variation::Variations;
use crate::number::{Real, Scalar, Wide};
use crate::solution::consistent::BOTH;
use crate::solution::solve::solve_near;
use crate::vector::{PhaseVector, StaticLength};

/// Linearized equations of a step.
pub(super) struct StepEquations<'a, T, const S: usize> {
    /// The method's matrix.
    a: &'a [[f64; S]; S],
    h: T,
    stages: Vec<StageDerivatives<T>>,
}

impl<'a, T: Real, const S: usize> StepEquations<'a, T, S>
where
    Const<S>: RadauStages,
{
    /// Evaluates the derivatives at the stages of the last step. `None` if they do not exist.
    pub(super) fn at<L: Linearized<Scalar = T>>(
        system: &L,
        memory: &RadauMemory<L, S>,
        variations: &Variations<L>,
        a: &'a [[f64; S]; S],
    ) -> Result<Option<Self>, Error> {
        let Some((from, step)) = &memory.taken else { return Ok(None) };
        let [positions, velocities] = BOTH.map(|level| Normals::of(system, &memory.chart, level, from.t));
        let (normals, mut stages) = ([positions?, velocities?], Vec::new());
        for (node, change) in <Const<S>>::NODES.iter().zip(&step.changes) {
            let state = from.moved(step.length * T::constant(*node), change);
            let solution = solve_near(system, &state, Some(&from.active), |solution, _| *solution)?;
            let tangent = Tangent::of(system, &state, solution);
            let Some(stage) = StageDerivatives::at(&tangent, variations, &normals)? else { return Ok(None) };
            stages.push(stage);
        }
        Ok(Some(Self { a, h: step.length, stages }))
    }

    /// Entry of the method's matrix times the step length.
    fn weight(&self, k: usize, j: usize) -> T {
        T::constant(self.a[k][j]) * self.h
    }

    /// The sum h Σⱼ aₖⱼ xⱼ, added to `start`.
    fn advanced(&self, k: usize, mut start: DMatrix<T>, x: impl Fn(usize) -> DMatrix<T>) -> DMatrix<T> {
        (0..S).for_each(|j| start += x(j) * self.weight(k, j));
        start
    }

    /// Solves for the variations of the stages; `None` if the equations are singular.
    pub(super) fn solve<L: Linearized<Scalar = T>>(
        &self,
        variations: &Variations<L>,
    ) -> Option<StageVariations<T>> {
        let n = <L::N>::COUNT;
        let [q, v] = [0, 1].map(|half| columns(variations, half));
        // At velocities of zero.
        let coordinates: Vec<_> = self.stages.iter().map(|stage| stage.coordinates(q.clone())).collect();
        let driven = |j: usize| &self.stages[j].accelerations[0] * &coordinates[j] + &self.stages[j].forced;
        let mut right = DMatrix::zeros(S * n, q.ncols());
        for (k, stage) in self.stages.iter().enumerate() {
            let velocities = stage.velocities(self.advanced(k, v.clone(), driven), &coordinates[k]);
            right.rows_mut(k * n, n).copy_from(&velocities);
        }
        if !self.matrix(n).lu().solve_mut(&mut right) || right.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let velocities: Vec<DMatrix<T>> = (0..S).map(|k| right.rows(k * n, n).into_owned()).collect();
        let coordinates = (0..S)
            .map(|k| self.stages[k].coordinates(self.advanced(k, q.clone(), |j| velocities[j].clone())));
        Some(StageVariations(coordinates.zip(velocities.iter().cloned()).map(Into::into).collect()))
    }

    /// Left-hand side of the equations for the velocities.
    fn matrix(&self, n: usize) -> DMatrix<T> {
        let mut matrix = DMatrix::identity(S * n, S * n);
        // ∂q̈/∂q along the constraints.
        let by_q: Vec<_> = self.stages.iter().map(|stage| stage.along(0, &stage.accelerations[0])).collect();
        for (k, stage) in self.stages.iter().enumerate() {
            for i in 0..S {
                let weight = |j: usize| self.weight(k, j) * self.weight(j, i);
                let mut block = &self.stages[i].accelerations[1] * self.weight(k, i);
                by_q.iter().enumerate().for_each(|(j, by_q)| block += by_q * weight(j));
                if let Some(Held { along: [q, v], turn, .. }) = &stage.held {
                    block = v * block + turn * q * self.weight(k, i);
                }
                let mut entries = matrix.view_mut((k * n, i * n), (n, n));
                entries -= block;
            }
        }
        matrix
    }
}

impl<T: Real> StageDerivatives<T> {
    /// Variations of the coordinates, from those that the velocities lead to.
    fn coordinates(&self, moved: DMatrix<T>) -> DMatrix<T> {
        match &self.held {
            None => moved,
            Some(Held { along, shifts, .. }) => &along[0] * moved + &shifts[0],
        }
    }

    /// Variations of the velocities, from those that the accelerations lead to.
    fn velocities(&self, pushed: DMatrix<T>, coordinates: &DMatrix<T>) -> DMatrix<T> {
        match &self.held {
            None => pushed,
            Some(Held { along, shifts, turn }) => &along[1] * pushed + turn * coordinates + &shifts[1],
        }
    }

    /// Derivatives by changes in the tangent plane.
    fn along(&self, half: usize, derivatives: &DMatrix<T>) -> DMatrix<T> {
        match &self.held {
            None => derivatives.clone(),
            Some(Held { along, .. }) => derivatives * &along[half],
        }
    }
}

/// Coordinates and velocities of variations, a column for each.
fn columns<L: Linearized<Scalar: Real>>(variations: &Variations<L>, half: usize) -> DMatrix<L::Scalar> {
    let (n, count) = (<L::N>::COUNT, variations.arguments().len());
    DMatrix::from_fn(n, count, |i, j| variations.entry(j, half * n + i))
}

/// Variations of the coordinates and velocities of each stage.
pub(super) struct StageVariations<T>(Vec<[DMatrix<T>; 2]>);

impl<T: Real> StageVariations<T> {
    /// Variations of a block at a stage.
    pub(super) fn at<N: StaticLength>(&self, stage: usize, block: usize) -> PhaseVector<T::Wide, N> {
        let (lanes, mut y) = (T::Wide::COUNT, PhaseVector::filled(T::Wide::constant(0.0)));
        for (half, columns) in self.0[stage].iter().enumerate() {
            for lane in 0..lanes.min(columns.ncols() - block * lanes) {
                let column = columns.column(block * lanes + lane);
                y[half].iter_mut().zip(&column).for_each(|(wide, x)| wide.put(lane, *x));
            }
        }
        y
    }

    /// How much the variations of one block of lanes change from the `start` of the step to a stage.
    pub(super) fn change<N: StaticLength>(
        &self,
        stage: usize,
        block: usize,
        start: &PhaseVector<T::Wide, N>,
    ) -> PhaseVector<T::Wide, N> {
        zip(&self.at(stage, block), start, |y, start| y - start)
    }
}
