//! Newton's method with damped least steps (Levenberg and Marquardt) for the conditions on an orbit.
//!
//! The damping is proportional to the residual, so the convergence is quadratic to orbits that fill a family too (Fan and Yuan,
//! *Computing* 74, 2005). The iteration ends when a step no longer halves the residual: at the noise of the method.

use nalgebra::{DMatrix, DVector};

use super::error::OrbitError;
use super::frame::flat;
use super::shot::{Chain, Problem, Shot, least_step};
use crate::error::Error;
use crate::linearized::{DifferentiableMethod, Linearized};
use crate::number::{Real, Scalar, larger};
use crate::vector::StaticLength;

/// Steps allowed. Ten are usual; a search that takes more has left the neighbourhood of its guess.
const STEPS: usize = 50;

/// Dampings tried at a step, each ten times the one before.
const DAMPINGS: usize = 10;

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

impl<T: Real> Problem<T> {
    /// Conditions of a shot with those of the arclength, and their derivatives.
    fn bordered<L: Linearized<Scalar = T> + Clone>(
        &self,
        shot: &Shot<L>,
        arc: Option<&Arc<T>>,
    ) -> (DMatrix<T>, DVector<T>) {
        let right = shot.condensed(&self.conditions.mirror);
        let Some(arc) = arc else { return (shot.jacobian.clone(), right) };
        (self.with_row(shot, &arc.along(self, shot)), right.push(arc.residual(self, shot)))
    }

    /// The derivatives with one row more.
    pub(super) fn with_row<L: Linearized<Scalar = T>>(&self, shot: &Shot<L>, row: &DVector<T>) -> DMatrix<T> {
        let rows = shot.jacobian.nrows();
        let mut bordered = shot.jacobian.clone().insert_row(rows, T::constant(0.0));
        bordered.row_mut(rows).copy_from(&row.transpose());
        bordered
    }

    /// Corrects a chain until its gaps stay.
    pub(super) fn correct<L, D>(
        &self,
        chain: Chain<L>,
        method: &D,
        arc: Option<&Arc<T>>,
        tolerance: T,
    ) -> Result<(Shot<L>, usize), Error>
    where
        L: Linearized<Scalar = T> + Clone,
        D: DifferentiableMethod<L> + Clone,
    {
        let distance = |shot: &Shot<L>| {
            let along = arc.map_or(T::constant(0.0), |arc| arc.residual(self, shot));
            let found = shot.distance();
            Scalar::sqrt(found * found + along * along)
        };
        let mut shot = self.shoot(chain, method)?;
        let (mut damping, span) = (T::constant(1e-3), shot.chain.period);
        for step in 0..STEPS {
            let before = distance(&shot);
            if before <= T::constant(2.0 * T::EPSILON) {
                return Ok((shot, step));
            }
            let (matrix, right) = self.bordered(&shot, arc);
            let is_small = before <= tolerance;
            let mut failure = None;
            // A residual that may be noise is not worth more than one try.
            let next = (0..if is_small { 1 } else { DAMPINGS }).find_map(|_| {
                let trial = self.trial(&shot, &matrix, &right, damping * before, method, span);
                match trial {
                    Ok(next) if distance(&next) < before => Some(next),
                    other => {
                        failure = other.err().or(failure.take());
                        damping *= T::constant(10.0);
                        None
                    }
                }
            });
            damping = larger(damping * T::constant(0.1), T::constant(1e-6));
            match next {
                Some(next) => {
                    let stands = distance(&next) > T::constant(0.5) * before;
                    shot = next;
                    if is_small && stands {
                        return Ok((shot, step + 1));
                    }
                }
                None if is_small => return Ok((shot, step)),
                None => return Err(failure.unwrap_or_else(|| self.not_closed(&shot, step))),
            }
        }
        if distance(&shot) <= tolerance { Ok((shot, STEPS)) } else { Err(self.not_closed(&shot, STEPS)) }
    }

    fn trial<L, D>(
        &self,
        shot: &Shot<L>,
        matrix: &DMatrix<T>,
        right: &DVector<T>,
        damping: T,
        method: &D,
        span: T,
    ) -> Result<Shot<L>, Error>
    where
        L: Linearized<Scalar = T> + Clone,
        D: DifferentiableMethod<L> + Clone,
    {
        let step = least_step(matrix, right, damping, T::constant(T::EPSILON))?;
        let chain = self.moved_by(shot, &step, true)?;
        // A period that shrinks to nothing closes every motion.
        let ratio = chain.period / span;
        if !(ratio > T::constant(0.1) && ratio < T::constant(10.0)) {
            return Err(OrbitError::PeriodLost { guess: span.to_f64(), period: chain.period.to_f64() }.into());
        }
        self.shoot(chain, method)
    }

    pub(super) fn not_closed<L: Linearized<Scalar = T> + Clone>(
        &self,
        shot: &Shot<L>,
        steps: usize,
    ) -> Error {
        if self.conditions.energy.is_some() && !self.is_conservative {
            return OrbitError::EnergyChanges { is_driven: false }.into();
        }
        let (entry, gap) = shot.worst(&self.conditions);
        OrbitError::NotClosed {
            entry,
            gap: gap.to_f64(),
            iterations: steps,
            start: (0..2 * <L::N>::COUNT)
                .map(|i| {
                    let value = flat::<L>(&shot.chain.nodes[0])[i];
                    alloc::format!("{} = {:?}", crate::system::entry::<L>(i), value.to_f64())
                })
                .collect(),
            period: shot.chain.period.to_f64(),
        }
        .into()
    }

    /// Estimate of the distance from a true orbit: the largest change of a node, or of the period, by a step that would
    /// remove the gaps and the errors of the method.
    pub(super) fn error_of<L, D>(&self, shot: &Shot<L>, method: &D) -> Result<T, Error>
    where
        L: Linearized<Scalar = T> + Clone,
        D: DifferentiableMethod<L> + Clone,
    {
        let mut gaps = shot.gaps.clone();
        let mut closing = shot.closing.clone();
        for (k, segment) in shot.segments.iter().enumerate() {
            let trip = segment.round_trip(&shot.chain.system, &shot.chain.nodes[k], method.clone())?;
            let at_the_end = &segment.by_state * trip;
            match gaps.get_mut(k) {
                Some(gap) => *gap += &shot.frames[k + 1].dual * at_the_end,
                None => {
                    let components = &shot.frames[0].dual * at_the_end;
                    let mut rows = closing.rows_mut(0, components.len());
                    rows += components;
                }
            }
        }
        let offsets = shot.offsets_of(&gaps);
        let right = closing + shot.folded(&offsets[offsets.len() - 1], &self.conditions.mirror);
        let step =
            least_step(&shot.jacobian, &right, T::constant(0.0), crate::number::power_of_epsilon(0.5))?;
        let moves = offsets.iter().zip(&shot.spread).map(|(offset, spread)| (spread * &step + offset).amax());
        let moved = moves.fold(T::constant(0.0), larger);
        let count = shot.frames[0].count();
        let later =
            if self.conditions.period_is_free() { Scalar::abs(step[count]) } else { T::constant(0.0) };
        Ok(larger(moved, later))
    }
}
