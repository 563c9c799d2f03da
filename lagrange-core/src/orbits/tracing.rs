//! Members of a family: the first, and each from the one before.

use nalgebra::{DMatrix, DVector};

use super::arc::Arc;
use super::bifurcation::{TestValues, Tests, least_direction};
use super::error::OrbitError;
use super::limits::{BEND, VANISHING};
use super::multipliers::{logarithm, modulus, ratio};
use super::orbit::PeriodicOrbit;
use super::shot::{Chain, Problem, Shot, least_step};
use crate::System;
use crate::error::Error;
use crate::linearized::{DifferentiableMethod, Linearized, Singular};
use crate::number::{Real, Scalar, exceeds, larger, norm, order, power_of_epsilon, unit_of};

/// Where a family starts.
pub(super) struct FamilyStart<L: Linearized> {
    pub(super) problem: Problem<L::Scalar>,
    pub(super) chain: Chain<L>,
    /// Direction in which it leaves the orbit of a bifurcation, itself no member.
    pub(super) direction: Option<DVector<L::Scalar>>,
}

impl<L: Linearized<Scalar: Real>> FamilyStart<L> {
    /// Makes parameter `k` an unknown, in place of another if there is one.
    pub(super) fn choose(&mut self, k: usize) {
        let before = self.problem.parameter.replace(k);
        let value = Scalar::abs(self.chain.system.parameters()[k]);
        self.problem.parameter_unit = unit_of(value);
        let count =
            self.chain.system.linearize(&self.chain.nodes[0], &[]).map_or(0, |near| near.basis.ncols());
        let column = self.problem.parameter_column(count).unwrap_or(count);
        self.direction = self.direction.take().map(|mut direction| match before {
            None => direction.insert_row(column, L::Scalar::constant(0.0)),
            Some(other) if other != k => {
                direction[column] = L::Scalar::constant(0.0);
                direction
            }
            Some(_) => direction,
        });
    }
}

/// A member of a family with what the next is sought from.
pub(super) struct TracedOrbit<L: Linearized> {
    pub(super) shot: Shot<L>,
    pub(super) orbit: PeriodicOrbit<L>,
    pub(super) tangent: DVector<L::Scalar>,
    pub(super) tests: Tests<L::Scalar>,
    /// Rates of the tests along the family.
    pub(super) slopes: TestValues<L::Scalar>,
    /// Largest rate of the argument of a multiplier, in radians a unit of arclength.
    pub(super) turn: L::Scalar,
}

/// A member at an arclength from an earlier one.
pub(super) type AtLength<L> = (<L as System>::Scalar, TracedOrbit<L>);

/// Equations of a family, with the method by which its members are computed.
pub(super) struct Tracer<'m, L: Linearized, D> {
    pub(super) problem: Problem<L::Scalar>,
    pub(super) method: &'m D,
    pub(super) tolerance: L::Scalar,
    /// First step.
    pub(super) step: L::Scalar,
}

impl<L: Linearized<Scalar: Real> + Clone, D: DifferentiableMethod<L> + Clone> Tracer<'_, L, D> {
    /// First member: the orbit itself, or the first along a branch.
    pub(super) fn first(&self, start: FamilyStart<L>, is_backwards: bool) -> Result<TracedOrbit<L>, Error> {
        let sign = L::Scalar::constant(if is_backwards { -1.0 } else { 1.0 });
        if let Some(direction) = start.direction {
            let origin = self.problem.shoot(start.chain, self.method)?;
            let direction = direction * sign;
            let arc = Arc::from(&self.problem, &origin, direction);
            return self.advance(&origin, &arc, self.step).map(|(first, _)| first);
        }
        let (mut shot, iterations) = self.problem.correct(start.chain, self.method, None, self.tolerance)?;
        shot.chain.units = shot.size();
        let shot = self.problem.shoot(shot.chain, self.method)?;
        let mut tangent = only_direction(&shot.jacobian)?;
        let grows = self.problem.turning(&shot, &tangent) > L::Scalar::constant(0.0);
        if grows == is_backwards {
            tangent = -tangent;
        }
        self.traced(shot, tangent, iterations)
    }

    /// The member of a corrected shot.
    pub(super) fn traced(
        &self,
        shot: Shot<L>,
        tangent: DVector<L::Scalar>,
        iterations: usize,
    ) -> Result<TracedOrbit<L>, Error> {
        let orbit = self.problem.orbit(&shot, iterations, self.method, self.tolerance)?;
        if exceeds(orbit.error, L::Scalar::constant(VANISHING)) {
            let (error, period) = (orbit.error.to_f64(), orbit.period.to_f64());
            return Err(OrbitError::Vague { error, period }.into());
        }
        let mut tests = self.problem.tests(&shot, &tangent, (&orbit.monodromy, orbit.error))?;
        let (slopes, turn) = self.slopes(&shot, &tangent, (&orbit, &tests))?;
        tests.displace(&slopes, orbit.error);
        Ok(TracedOrbit { shot, orbit, tangent, tests, slopes, turn })
    }

    /// Rates of the tests, and the largest of the arguments of the multipliers, by a difference along the tangent. The orbit moved
    /// along it is off by the square of the move.
    fn slopes(
        &self,
        shot: &Shot<L>,
        tangent: &DVector<L::Scalar>,
        (orbit, tests): (&PeriodicOrbit<L>, &Tests<L::Scalar>),
    ) -> Result<(TestValues<L::Scalar>, L::Scalar), Error> {
        let move_by = resolution();
        let arc = Arc::from(&self.problem, shot, tangent.clone());
        let moved =
            self.problem.shoot(self.problem.moved_by(shot, &(tangent * move_by), false)?, self.method)?;
        let monodromy = self.problem.once_around(&moved, self.method)?;
        let next = self.problem.tests(&moved, &self.tangent(&moved, &arc)?, (&monodromy, orbit.error))?;
        let rate = |k: usize| Some((next.values[k]? - tests.values[k]?) / move_by);
        let (from, to) = (orbit.monodromy.nontrivial()?, monodromy.nontrivial()?);
        let turns = from.iter().filter_map(|x| {
            let logarithms = to.iter().map(|y| logarithm(ratio(*y, *x)));
            let least = logarithms.min_by(|x, y| order(modulus(*x), modulus(*y)));
            least.map(|least| Scalar::abs(least.im))
        });
        let turn = turns.fold(L::Scalar::constant(0.0), larger) / move_by;
        Ok((core::array::from_fn(rate), turn))
    }

    /// The member at an arclength from an earlier one.
    pub(super) fn member(&self, from: &Shot<L>, arc: &Arc<L::Scalar>) -> Result<TracedOrbit<L>, Error> {
        self.corrected(self.problem.moved_by(from, &(&arc.tangent * arc.length), false)?, arc)
    }

    /// The member at an arclength, from a chain near it.
    pub(super) fn corrected(
        &self,
        predicted: Chain<L>,
        arc: &Arc<L::Scalar>,
    ) -> Result<TracedOrbit<L>, Error> {
        let (mut shot, mut iterations) =
            self.problem.correct(predicted, self.method, Some(arc), self.tolerance)?;
        let units = shot.size();
        if units.differ(shot.chain.units) {
            // In its own units it may not be closed yet, nor an orbit.
            shot.chain.units = units;
            let more;
            (shot, more) = self.problem.correct(shot.chain, self.method, Some(arc), self.tolerance)?;
            iterations += more;
        }
        let tangent = self.tangent(&shot, arc)?;
        self.traced(shot, tangent, iterations)
    }

    /// Direction of the family at a shot near the base of the arc, of length 1.
    pub(super) fn tangent(&self, shot: &Shot<L>, arc: &Arc<L::Scalar>) -> Result<DVector<L::Scalar>, Error> {
        let along = arc.along(&self.problem, shot);
        let mut last = DVector::zeros(shot.jacobian.nrows() + 1);
        last[shot.jacobian.nrows()] = L::Scalar::constant(-1.0);
        let (none, part) = (L::Scalar::constant(0.0), L::Scalar::constant(L::Scalar::EPSILON));
        let tangent = least_step(&self.problem.with_row(shot, &along), &last, none, part)?;
        let length = norm(tangent.as_slice());
        Ok(tangent / length)
    }

    /// The next member, and the step to it.
    pub(super) fn advance(
        &self,
        from: &Shot<L>,
        arc: &Arc<L::Scalar>,
        mut step: L::Scalar,
    ) -> Result<(TracedOrbit<L>, L::Scalar), Error> {
        let bend = L::Scalar::constant(BEND);
        let least_cosine = L::Scalar::constant(1.0) / Scalar::sqrt(L::Scalar::constant(1.0) + bend * bend);
        loop {
            let arc = Arc { length: step, ..arc.clone() };
            let found = self.member(from, &arc);
            let is_short = step * L::Scalar::constant(0.5) < resolution();
            match found {
                Ok(next) => {
                    let turns = arc.cosine(&self.problem, &next.shot, &next.tangent) < least_cosine;
                    let strays = arc.deviation(&self.problem, &next.shot) > step * bend;
                    if !(turns || strays) || is_short {
                        return Ok((next, step));
                    }
                }
                Err(error) if is_short => return Err(error),
                Err(_) => {}
            }
            step *= L::Scalar::constant(0.5);
        }
    }
}

/// Arclength over which the tests are differenced, and to which a family is resolved.
fn resolution<T: Real>() -> T {
    power_of_epsilon(1.0 / 3.0)
}

/// The one direction along which the conditions stay.
fn only_direction<T: Real>(jacobian: &DMatrix<T>) -> Result<DVector<T>, Error> {
    let factors = Singular::of(jacobian).ok_or(Error::EigenvaluesNotFound)?;
    let least = factors.norm() * power_of_epsilon(0.5);
    let freedom = factors.values.iter().filter(|sigma| **sigma <= least).count();
    match freedom {
        1 => least_direction(jacobian),
        freedom => Err(OrbitError::NoFamily { freedom }.into()),
    }
}
