//! Newton's method with damped least steps (Levenberg and Marquardt) for the conditions on an orbit.
//!
//! The damping is proportional to the residual, so the convergence is quadratic to orbits that fill a family too (Fan and Yuan,
//! *Computing* 74, 2005). The iteration ends when a step no longer halves the residual: at the noise of the method.

use core::cell::RefCell;

use nalgebra::{DMatrix, DVector};

use super::arc::Arc;
use super::error::OrbitError;
use super::frame::flat;
use super::limits::LOST;
use super::shot::{Chain, Problem, Shot, least_step};
use crate::error::Error;
use crate::generic::StaticLength;
use crate::linearized::{DifferentiableMethod, Linearized, Singular};
use crate::number::limits::DAMPING;
use crate::number::{Real, Scalar, larger};
use crate::numerics::newton::{self, Left, Search};

/// Search for a shot that meets the conditions, at an arclength if there is one.
struct OrbitCorrection<'a, L: Linearized<Scalar: Real>, D> {
    problem: &'a Problem<L::Scalar>,
    method: &'a D,
    arc: Option<&'a Arc<L::Scalar>>,
    tolerance: L::Scalar,
    /// Period at the start.
    guess: L::Scalar,
}

/// A shot, and the first damping of the step from it, in units of the residual.
struct DampedShot<L: Linearized> {
    shot: Shot<L>,
    damping: L::Scalar,
}

/// Equations of the step from a shot.
struct CorrectionEquations<T> {
    factors: Singular<T>,
    right: DVector<T>,
    /// Reason why the last trial from the shot failed.
    failure: RefCell<Option<Error>>,
}

impl<L, D> OrbitCorrection<'_, L, D>
where
    L: Linearized<Scalar: Real> + Clone,
    D: DifferentiableMethod<L> + Clone,
{
    /// Length of all residuals.
    fn distance(&self, shot: &Shot<L>) -> L::Scalar {
        let along = self.arc.map_or(L::Scalar::constant(0.0), |arc| arc.residual(self.problem, shot));
        let found = shot.distance();
        Scalar::sqrt(found * found + along * along)
    }

    /// The shot after a damped step.
    fn trial(
        &self,
        from: &Shot<L>,
        equations: &CorrectionEquations<L::Scalar>,
        damping: L::Scalar,
    ) -> Result<Shot<L>, Error> {
        let least = equations.factors.norm() * L::Scalar::constant(L::Scalar::EPSILON);
        let step = equations.factors.step(equations.right.iter().copied(), (least, damping), |_, x| x);
        let chain = self.problem.moved_by(from, &step, true)?;
        // A period that shrinks to nothing closes every motion.
        let ratio = chain.period / self.guess;
        if !(ratio > L::Scalar::constant(1.0 / LOST) && ratio < L::Scalar::constant(LOST)) {
            let (guess, period) = (self.guess.to_f64(), chain.period.to_f64());
            return Err(OrbitError::PeriodLost { guess, period }.into());
        }
        self.problem.shoot(chain, self.method)
    }
}

impl<L, D> Search for OrbitCorrection<'_, L, D>
where
    L: Linearized<Scalar: Real> + Clone,
    D: DifferentiableMethod<L> + Clone,
{
    type Scalar = L::Scalar;
    type Error = Error;
    type Trial = DampedShot<L>;
    type Linear = CorrectionEquations<L::Scalar>;

    fn linearize(&mut self, from: &Self::Trial) -> Result<Self::Linear, Error> {
        let (matrix, right) = self.problem.bordered(&from.shot, self.arc);
        let factors = Singular::of(&matrix).ok_or(Error::EigenvaluesNotFound)?;
        Ok(CorrectionEquations { factors, right, failure: RefCell::new(None) })
    }

    fn left(&self, _: &Self::Linear, trial: &Self::Trial) -> Left<L::Scalar> {
        let distance = self.distance(&trial.shot);
        let is_rounded = distance <= L::Scalar::constant(2.0 * L::Scalar::EPSILON);
        Left { distance, is_rounded, is_negligible: distance <= self.tolerance }
    }

    fn corrected(
        &self,
        equations: &Self::Linear,
        from: &Self::Trial,
        converged: bool,
    ) -> Result<impl Iterator<Item = Self::Trial>, Error> {
        let distance = self.distance(&from.shot);
        let dampings = newton::dampings(from.damping, equations.factors.norm()).take(if converged {
            1
        } else {
            usize::MAX
        });
        Ok(dampings.filter_map(move |[damping, next]| {
            let trial = self.trial(&from.shot, equations, damping * distance);
            let shot = trial.map_err(|error| equations.failure.replace(Some(error))).ok()?;
            Some(DampedShot { shot, damping: next })
        }))
    }

    #[cold]
    fn not_found(&self, equations: &Self::Linear, from: &Self::Trial, steps: usize) -> Error {
        equations.failure.take().unwrap_or_else(|| self.problem.not_closed(&from.shot, steps))
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

    /// Corrects a chain until its gaps stay; returns its shot and the number of steps.
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
        let shot = self.shoot(chain, method)?;
        let mut search = OrbitCorrection { problem: self, method, arc, tolerance, guess: shot.chain.period };
        let (found, steps) = newton::find(&mut search, DampedShot { shot, damping: T::constant(DAMPING) })?;
        Ok((found.shot, steps))
    }

    fn not_closed<L: Linearized<Scalar = T> + Clone>(&self, shot: &Shot<L>, steps: usize) -> Error {
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
