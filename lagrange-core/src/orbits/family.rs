//! Families of periodic orbits by continuation in the arclength.

use alloc::boxed::Box;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt::{self, Debug, Formatter};

use nalgebra::DVector;

use super::bifurcation::{Bifurcation, BifurcationKind, Branch, Test, Tests, least_direction};
use super::correction::Arc;
use super::error::OrbitError;
use super::orbit::PeriodicOrbit;
use super::search::OrbitSearch;
use super::shot::{Chain, Problem, Shot, least_step};
use super::table::{Family, FamilyEnding};
use crate::error::Error;
use crate::linearized::{DifferentiableMethod, Linearized, Singular};
use crate::number::{Real, Scalar, norm, power_of_epsilon, smaller};
use crate::system::lookup;

/// Least cosine of the angle between neighbours of a family; a step across which it turns more is halved. 20° are small enough that a
/// step does not end on another family that crosses at a right angle.
const TURN: f64 = 0.94;

/// Part of the first step below which a family counts as stuck.
const SHORTEST: f64 = 1e-5;

/// Distance of a fold and a branch point, as part of a step, within which they are one.
const COINCIDENT: f64 = 1e-2;

/// Settings of the continuation of a periodic orbit to a family.
///
/// Lengths are relative: of the start in units of the largest coordinate and velocity, of the period to its value, of the parameter to
/// its value where the family starts (to 1, if it is zero).
#[must_use = "`follow` continues the orbit"]
pub struct FamilySearch<'u, L: Linearized, D> {
    method: D,
    tolerance: L::Scalar,
    start: Result<Start<L>, Error>,
    step: L::Scalar,
    longest: L::Scalar,
    count: usize,
    is_backwards: bool,
    /// Kind of the bifurcation that ends the family.
    last: Option<BifurcationKind>,
    #[allow(clippy::type_complexity, reason = "a predicate")]
    until: Option<Box<dyn FnMut(&PeriodicOrbit<L>) -> bool + 'u>>,
}

/// Where a family starts.
struct Start<L: Linearized> {
    problem: Problem<L::Scalar>,
    chain: Chain<L>,
    /// Direction in which it leaves the orbit of a bifurcation, itself no member.
    direction: Option<DVector<L::Scalar>>,
}

impl<L: Linearized<Scalar: Real>> Start<L> {
    /// Makes parameter `k` an unknown, in place of another if there is one.
    fn choose(&mut self, k: usize) {
        let before = self.problem.parameter.replace(k);
        let value = Scalar::abs(self.chain.system.parameters()[k]);
        self.problem.parameter_unit =
            if value > L::Scalar::constant(0.0) { value } else { L::Scalar::constant(1.0) };
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
struct Member<L: Linearized> {
    shot: Shot<L>,
    orbit: PeriodicOrbit<L>,
    tangent: DVector<L::Scalar>,
    tests: Tests<L::Scalar>,
}

impl<L: Linearized<Scalar: Real> + Clone, D: Clone> OrbitSearch<L, D> {
    /// Starts the settings of the family of an orbit that this search has found: in a parameter, or, without one, along the orbits of
    /// a conservative system, which differ in energy and period.
    pub fn family<'u>(&self, orbit: &PeriodicOrbit<L>) -> FamilySearch<'u, L, D> {
        let system = orbit.system.clone();
        let search = Self { system, ..self.clone() };
        let start = search.problem().map(|problem| {
            let nodes = orbit.nodes[..problem.conditions.segments].to_vec();
            let chain = Chain { system: search.system, nodes, period: orbit.period, units: orbit.units };
            Start { problem, chain, direction: None }
        });
        self.continued(start)
    }

    /// Starts the settings of the family that leaves at a bifurcation, to the one side, or [backwards](FamilySearch::backwards) to the
    /// other. At a period doubling its orbits have twice the period, and need no symmetry.
    pub fn branch<'u>(&self, bifurcation: &Bifurcation<L>) -> FamilySearch<'u, L, D> {
        let kind = bifurcation.kind;
        let start = bifurcation.branch.clone().ok_or_else(|| OrbitError::NoBranch { kind }.into());
        self.continued(start.map(|Branch { problem, chain, direction }| Start {
            problem,
            chain,
            direction: Some(direction),
        }))
    }

    fn continued<'u>(&self, start: Result<Start<L>, Error>) -> FamilySearch<'u, L, D> {
        let (step, longest) = (L::Scalar::constant(0.02), L::Scalar::constant(0.1));
        let (method, tolerance) = (self.method.clone(), self.tolerance);
        FamilySearch {
            method,
            tolerance,
            start,
            step,
            longest,
            count: 100,
            is_backwards: false,
            last: None,
            until: None,
        }
    }
}

impl<'u, L: Linearized<Scalar: Real> + Clone, D> FamilySearch<'u, L, D> {
    /// Lets a parameter change along the family. A branch has the parameter of the family that it leaves, unless another is named.
    pub fn in_parameter(mut self, name: &str) -> Self {
        self.start = self.start.and_then(|mut start| {
            let k = lookup::index::<L>(L::PARAMETERS, "parameter", name)?;
            let value = start.chain.system.parameters()[k];
            if !start.chain.system.set_parameter(k, value) {
                return Err(Error::ParameterFixed { name: L::PARAMETERS[k] });
            }
            start.choose(k);
            Ok(start)
        });
        self
    }

    /// First step along the family, 0.02 unless set; later ones adapt.
    pub fn step(self, length: L::Scalar) -> Self {
        Self { step: length, longest: crate::number::larger(self.longest, length), ..self }
    }

    /// Longest step, 0.1 unless set.
    pub fn longest_step(self, length: L::Scalar) -> Self {
        Self { longest: length, step: smaller(self.step, length), ..self }
    }

    /// Number of orbits, 100 unless set.
    pub fn orbits(self, count: usize) -> Self {
        Self { count, ..self }
    }

    /// Follows the family to the other side.
    pub fn backwards(self) -> Self {
        Self { is_backwards: !self.is_backwards, ..self }
    }

    /// Ends the family with the first orbit of which this is true.
    pub fn until(self, is_last: impl FnMut(&PeriodicOrbit<L>) -> bool + 'u) -> Self {
        Self { until: Some(Box::new(is_last)), ..self }
    }

    /// Ends the family behind its first bifurcation of this kind.
    pub fn until_first(self, kind: BifurcationKind) -> Self {
        Self { last: Some(kind), ..self }
    }

    /// Follows the family (pseudo-arclength continuation: Keller 1977; Doedel, Keller and Kernévez, *International Journal of Bifurcation
    /// and Chaos* 1, 1991). The parameter increases at first, or the energy, unless it is followed [backwards](Self::backwards).
    ///
    /// Bifurcations are told by functions that change sign from one orbit to the next: the rate of the parameter or energy, the
    /// bordered determinant of the equations, Π(1 − λ), Π(1 + λ) and Π(1 − λλ′) of the multipliers. A change of sign proves that
    /// there is one between; two of a kind between neighbours are not seen. Each is found by regula falsi on the arclength, to
    /// round-off of the function. The family ends early where no orbit is found, which is no error: see
    /// [`Family::ending`].
    ///
    /// # Errors
    /// Those of [`OrbitSearch::find`] at the first orbit; [`Error::Orbit`] if the orbit is isolated, or one of a family of more
    /// dimensions; [`Error::UnknownName`] and [`Error::ParameterFixed`].
    pub fn follow(mut self) -> Result<Family<L>, Error>
    where
        D: DifferentiableMethod<L> + Clone,
    {
        for (name, value) in [("step of a family", self.step), ("longest step of a family", self.longest)] {
            if !(value.to_f64() > 0.0 && value.to_f64().is_finite()) {
                return Err(Error::Setting { name, value: value.to_f64() });
            }
        }
        let start = core::mem::replace(&mut self.start, Err(OrbitError::NoPeriod.into()))?;
        let problem = start.problem.clone();
        let name = problem.parameter.map_or_else(|| "energy".into(), |k| String::from(L::PARAMETERS[k]));
        let mut member = self.first(&problem, start)?;
        let mut family = Family::begin(name, problem.parameter);
        let mut step = self.step;
        family.push(member.orbit.clone());
        let first = Arc::from(&problem, &member.shot, member.tangent.clone());
        while family.orbits().len() < self.count {
            if self.until.as_mut().is_some_and(|is_last| is_last(&member.orbit)) {
                family.end(FamilyEnding::Until);
                return Ok(family);
            }
            let arc = Arc::from(&problem, &member.shot, member.tangent.clone());
            let (next, taken) = match self.advance(&problem, &member, &arc, step) {
                Ok(found) => found,
                Err(error) => {
                    family.end(FamilyEnding::Stopped(Box::new(error)));
                    return Ok(family);
                }
            };
            for found in self.between(&problem, &member, &arc, (taken, next.tests)) {
                family.push_bifurcation(found);
            }
            let is_easy = next.orbit.iterations <= 6;
            step = if is_easy { smaller(taken * L::Scalar::constant(1.3), self.longest) } else { taken };
            member = next;
            family.push(member.orbit.clone());
            if self.last.is_some_and(|kind| family.first(kind).is_some()) {
                family.end(FamilyEnding::Until);
                return Ok(family);
            }
            if family.orbits().len() > 4 && first.is_met(&problem, &member.shot, taken) {
                family.end(FamilyEnding::Closed);
                return Ok(family);
            }
        }
        let is_last = self.until.as_mut().is_some_and(|is_last| is_last(&member.orbit));
        family.end(if is_last { FamilyEnding::Until } else { FamilyEnding::Count });
        Ok(family)
    }

    /// First member: the orbit itself, or the first along a branch.
    fn first(&self, problem: &Problem<L::Scalar>, start: Start<L>) -> Result<Member<L>, Error>
    where
        D: DifferentiableMethod<L> + Clone,
    {
        let sign = L::Scalar::constant(if self.is_backwards { -1.0 } else { 1.0 });
        if let Some(direction) = start.direction {
            let origin = problem.shoot(start.chain, &self.method)?;
            let direction = direction * sign;
            let arc = Arc { length: self.step, ..Arc::from(problem, &origin, direction.clone()) };
            return self.member(problem, &origin, &arc);
        }
        let (mut shot, iterations) = problem.correct(start.chain, &self.method, None, self.tolerance)?;
        shot.chain.units = shot.size();
        let shot = problem.shoot(shot.chain, &self.method)?;
        let mut tangent = only_direction(&shot.jacobian)?;
        let orbit = problem.orbit(&shot, iterations, &self.method, self.tolerance)?;
        let mut tests = problem.tests(&shot, &tangent, &orbit)?;
        let grows = self.grows(problem, &shot, &tangent, &orbit)?;
        if grows == self.is_backwards {
            tangent = -tangent;
            tests = problem.tests(&shot, &tangent, &orbit)?;
        }
        Ok(Member { shot, orbit, tangent, tests })
    }

    /// True if the parameter, or the energy, grows in this direction.
    fn grows(
        &self,
        problem: &Problem<L::Scalar>,
        shot: &Shot<L>,
        tangent: &DVector<L::Scalar>,
        orbit: &PeriodicOrbit<L>,
    ) -> Result<bool, Error> {
        if let Some(column) = problem.parameter_column(shot.frames[0].count()) {
            return Ok(tangent[column] > L::Scalar::constant(0.0));
        }
        let little = tangent * (self.step * L::Scalar::constant(1e-3));
        let moved = problem.moved_by(shot, &little, false)?;
        Ok(moved.system.energy(&moved.nodes[0]) > orbit.energy())
    }

    /// The member at an arclength from an earlier one.
    fn member(
        &self,
        problem: &Problem<L::Scalar>,
        from: &Shot<L>,
        arc: &Arc<L::Scalar>,
    ) -> Result<Member<L>, Error>
    where
        D: DifferentiableMethod<L> + Clone,
    {
        self.corrected(problem, problem.moved_by(from, &(&arc.tangent * arc.length), false)?, arc)
    }

    /// The member at an arclength, from a chain near it.
    fn corrected(
        &self,
        problem: &Problem<L::Scalar>,
        predicted: Chain<L>,
        arc: &Arc<L::Scalar>,
    ) -> Result<Member<L>, Error>
    where
        D: DifferentiableMethod<L> + Clone,
    {
        let (mut shot, iterations) = problem.correct(predicted, &self.method, Some(arc), self.tolerance)?;
        let units = shot.size();
        if units.differ(shot.chain.units) {
            shot.chain.units = units;
            shot = problem.shoot(shot.chain, &self.method)?;
        }
        let along = arc.along(problem, &shot);
        let mut last = DVector::zeros(shot.jacobian.nrows() + 1);
        last[shot.jacobian.nrows()] = L::Scalar::constant(-1.0);
        let (none, part) = (L::Scalar::constant(0.0), L::Scalar::constant(L::Scalar::EPSILON));
        let tangent = least_step(&problem.with_row(&shot, &along), &last, none, part)?;
        let length = norm(tangent.as_slice());
        let tangent = tangent / length;
        let orbit = problem.orbit(&shot, iterations, &self.method, self.tolerance)?;
        let tests = problem.tests(&shot, &tangent, &orbit)?;
        Ok(Member { shot, orbit, tangent, tests })
    }

    /// The next member, and the step to it.
    fn advance(
        &self,
        problem: &Problem<L::Scalar>,
        from: &Member<L>,
        arc: &Arc<L::Scalar>,
        mut step: L::Scalar,
    ) -> Result<(Member<L>, L::Scalar), Error>
    where
        D: DifferentiableMethod<L> + Clone,
    {
        let shortest = self.step * L::Scalar::constant(SHORTEST);
        loop {
            let found = self.member(problem, &from.shot, &Arc { length: step, ..arc.clone() });
            let is_short = step * L::Scalar::constant(0.5) < shortest;
            match found {
                Ok(next) => {
                    if arc.cosine(problem, &next.shot, &next.tangent) >= L::Scalar::constant(TURN) || is_short
                    {
                        return Ok((next, step));
                    }
                }
                Err(error) if is_short => return Err(error),
                Err(_) => {}
            }
            step *= L::Scalar::constant(0.5);
        }
    }

    /// The member at an arclength near that of another.
    fn beside(
        &self,
        problem: &Problem<L::Scalar>,
        (length, near): (L::Scalar, &Member<L>),
        arc: &Arc<L::Scalar>,
    ) -> Result<Member<L>, Error>
    where
        D: DifferentiableMethod<L> + Clone,
    {
        let rate = arc.along(problem, &near.shot).dot(&near.tangent);
        let step = &near.tangent * ((arc.length - length) / rate);
        self.corrected(problem, problem.moved_by(&near.shot, &step, false)?, arc)
    }

    /// Bifurcations between a member and the next.
    ///
    /// A fold and a branch point that coincide are one, a pitchfork seen from the family that leaves: the orbit is the one of the fold,
    /// since the determinant there is small to the left and right.
    fn between(
        &self,
        problem: &Problem<L::Scalar>,
        from: &Member<L>,
        arc: &Arc<L::Scalar>,
        next: (L::Scalar, Tests<L::Scalar>),
    ) -> Vec<(Test, PeriodicOrbit<L>, Option<Branch<L>>)>
    where
        D: DifferentiableMethod<L> + Clone,
    {
        let located = |test: Test| Some((test, self.locate(problem, from, arc, next, test).ok()?));
        let mut found: Vec<_> = from.tests.changed(&next.1).into_iter().filter_map(located).collect();
        if let [(Test::Turning, (fold, _)), (Test::Determinant, (branch, _)), ..] = &found[..] {
            if Scalar::abs(*fold - *branch) <= next.0 * L::Scalar::constant(COINCIDENT) {
                found.remove(1);
                found[0].0 = Test::Determinant;
            }
        }
        let with_branch = |(test, (_, at)): (Test, (L::Scalar, Member<L>))| {
            let branch = problem.branch(test, &at.shot, &at.tangent, &self.method).ok()?;
            Some((test, at.orbit, branch))
        };
        found.into_iter().filter_map(with_branch).collect()
    }

    /// The member at which a test vanishes, between one and the next: regula falsi with the weights of Illinois.
    fn locate(
        &self,
        problem: &Problem<L::Scalar>,
        from: &Member<L>,
        arc: &Arc<L::Scalar>,
        (step, tests): (L::Scalar, Tests<L::Scalar>),
        test: Test,
    ) -> Result<(L::Scalar, Member<L>), Error>
    where
        D: DifferentiableMethod<L> + Clone,
    {
        const TRIES: usize = 40;
        let (zero, half) = (L::Scalar::constant(0.0), L::Scalar::constant(0.5));
        let of = |tests: &Tests<L::Scalar>| tests.value(test).unwrap_or(zero);
        let (mut left, mut right) = ((zero, of(&from.tests)), (step, of(&tests)));
        let (mut best, mut last) = (None, 0);
        let resolution = step * power_of_epsilon(0.75);
        for _ in 0..TRIES {
            let length = (left.0 * right.1 - right.0 * left.1) / (right.1 - left.1);
            let arc = Arc { length, ..arc.clone() };
            let found = match &best {
                None => self.member(problem, &from.shot, &arc),
                Some((at, near)) => self.beside(problem, (*at, near), &arc),
            };
            let Ok(found) = found else { break };
            let value = of(&found.tests);
            let moved =
                best.as_ref().map_or(step, |(at, _): &(L::Scalar, Member<L>)| Scalar::abs(*at - length));
            best = Some((length, found));
            if value == zero || moved <= resolution {
                break;
            }
            if value * left.1 > zero {
                left = (length, value);
                right.1 *= if last == 1 { half } else { L::Scalar::constant(1.0) };
                last = 1;
            } else {
                right = (length, value);
                left.1 *= if last == 2 { half } else { L::Scalar::constant(1.0) };
                last = 2;
            }
        }
        best.ok_or(Error::EigenvaluesNotFound)
    }
}

/// The one direction along which the conditions stay.
fn only_direction<T: Real>(jacobian: &nalgebra::DMatrix<T>) -> Result<DVector<T>, Error> {
    let factors = Singular::of(jacobian).ok_or(Error::EigenvaluesNotFound)?;
    let least = factors.norm() * power_of_epsilon(0.5);
    let freedom = factors.values.iter().filter(|sigma| **sigma <= least).count();
    match freedom {
        1 => least_direction(jacobian),
        freedom => Err(OrbitError::NoFamily { freedom }.into()),
    }
}

impl<L: Linearized<Scalar: Real>, D: Debug> Debug for FamilySearch<'_, L, D> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut text = f.debug_struct("FamilySearch");
        text.field("system", &L::NAME.to_string()).field("method", &self.method).finish_non_exhaustive()
    }
}
