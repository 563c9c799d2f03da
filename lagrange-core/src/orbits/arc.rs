//! Arclength along a family, and the direction of the family at its base.

use nalgebra::{DMatrix, DVector};

use super::frame::flat;
use super::shot::{Problem, Shot};
use crate::linearized::Linearized;
use crate::number::Real;

/// Point of a family from which the next is sought, at a given arclength.
#[derive(Clone, Debug)]
pub(super) struct Arc<T> {
    /// Direction of the family, of length 1, in the unknowns at the base.
    pub(super) tangent: DVector<T>,
    /// B⁺ at the base, and its start.
    pub(super) dual: DMatrix<T>,
    pub(super) start: DVector<T>,
    pub(super) period: T,
    /// Value of the parameter at the base, and its unit.
    pub(super) parameter: (T, T),
    /// Arclength from the base.
    pub(super) length: T,
}

impl<T: Real> Arc<T> {
    pub(super) fn from<L: Linearized<Scalar = T> + Clone>(
        problem: &Problem<T>,
        shot: &Shot<L>,
        tangent: DVector<T>,
    ) -> Self {
        Self {
            tangent,
            dual: shot.frames[0].dual.clone(),
            start: flat::<L>(&shot.chain.nodes[0]),
            period: shot.chain.period,
            parameter: problem.parameter_of(&shot.chain.system),
            length: T::constant(0.0),
        }
    }

    /// Direction at the base in the unknowns of another shot.
    pub(super) fn along<L: Linearized<Scalar = T> + Clone>(
        &self,
        problem: &Problem<T>,
        shot: &Shot<L>,
    ) -> DVector<T> {
        let count = shot.frames[0].count();
        let components = (self.tangent.rows(0, count).transpose() * &self.dual) * &shot.frames[0].basis;
        let mut along = self.tangent.clone();
        along.rows_mut(0, count).copy_from(&components.transpose());
        if problem.conditions.period_is_free() {
            along[count] *= shot.chain.period / self.period;
        }
        along
    }

    /// Cosine of the angle between the direction at the base and one at another shot, in the units of the base.
    pub(super) fn cosine<L: Linearized<Scalar = T> + Clone>(
        &self,
        problem: &Problem<T>,
        shot: &Shot<L>,
        tangent: &DVector<T>,
    ) -> T {
        let count = shot.frames[0].count();
        let mut here = tangent.clone();
        let components = &self.dual * (&shot.frames[0].basis * tangent.rows(0, count));
        here.rows_mut(0, count).copy_from(&components);
        if problem.conditions.period_is_free() {
            here[count] *= shot.chain.period / self.period;
        }
        self.tangent.dot(&here) / here.norm()
    }

    /// Changes of the unknowns from the base to a shot.
    fn offset<L: Linearized<Scalar = T> + Clone>(&self, problem: &Problem<T>, shot: &Shot<L>) -> DVector<T> {
        let count = shot.frames[0].count();
        let mut offset = DVector::zeros(self.tangent.len());
        let moved = &self.dual * (flat::<L>(&shot.chain.nodes[0]) - &self.start);
        offset.rows_mut(0, count).copy_from(&moved);
        if problem.conditions.period_is_free() {
            offset[count] = shot.chain.period / self.period - T::constant(1.0);
        }
        if let Some(column) = problem.parameter_column(count) {
            offset[column] =
                (problem.parameter_of(&shot.chain.system).0 - self.parameter.0) / self.parameter.1;
        }
        offset
    }

    /// True if a shot is within a step of the base, and has not just left it: on its way back.
    pub(super) fn is_met<L: Linearized<Scalar = T> + Clone>(
        &self,
        problem: &Problem<T>,
        shot: &Shot<L>,
        step: T,
    ) -> bool {
        self.offset(problem, shot).norm() < step && self.residual(problem, shot) <= T::constant(0.0)
    }

    /// Distance of a shot from the point of the tangent at the arclength demanded.
    pub(super) fn deviation<L: Linearized<Scalar = T> + Clone>(
        &self,
        problem: &Problem<T>,
        shot: &Shot<L>,
    ) -> T {
        (self.offset(problem, shot) - &self.tangent * self.length).norm()
    }

    /// Arclength of a shot less the one demanded.
    pub(super) fn residual<L: Linearized<Scalar = T> + Clone>(
        &self,
        problem: &Problem<T>,
        shot: &Shot<L>,
    ) -> T {
        self.tangent.dot(&self.offset(problem, shot)) - self.length
    }
}
