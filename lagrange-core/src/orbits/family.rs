//! Families of periodic orbits by continuation in the arclength.

use alloc::boxed::Box;
use alloc::string::{String, ToString};
use core::fmt::{self, Debug, Formatter};

use super::arc::Arc;
use super::bifurcation::{Bifurcation, BifurcationKind, Branch};
use super::error::OrbitError;
use super::limits::{EASY, GROWTH, TURN};
use super::orbit::PeriodicOrbit;
use super::search::OrbitSearch;
use super::shot::Chain;
use super::table::{Family, FamilyEnding};
use super::tracing::{FamilyStart, TracedOrbit, Tracer};
use crate::error::Error;
use crate::linearized::{DifferentiableMethod, Linearized};
use crate::number::{Real, Scalar, larger, smaller};
use crate::system::lookup;

/// Settings of the continuation of a periodic orbit to a family.
///
/// Lengths are relative: of the start in units of the largest coordinate and velocity, of the period to its value, of the
/// parameter to its value where the family starts (to 1, if it is zero).
#[must_use = "`follow` continues the orbit"]
pub struct FamilySearch<'u, L: Linearized, D> {
    method: D,
    tolerance: L::Scalar,
    start: Result<FamilyStart<L>, Error>,
    step: L::Scalar,
    longest: L::Scalar,
    count: usize,
    is_backwards: bool,
    /// Kind of the bifurcation that ends the family.
    last: Option<BifurcationKind>,
    #[allow(clippy::type_complexity, reason = "a predicate")]
    until: Option<Box<dyn FnMut(&PeriodicOrbit<L>) -> bool + 'u>>,
}

impl<L: Linearized<Scalar: Real> + Clone, D: Clone> OrbitSearch<L, D> {
    /// Starts the settings of the family of an orbit that this search has found: in a parameter, or, without one, along the
    /// orbits of a conservative system, which differ in energy and period.
    pub fn family<'u>(&self, orbit: &PeriodicOrbit<L>) -> FamilySearch<'u, L, D> {
        let system = orbit.system.clone();
        let search = Self { system, ..self.clone() };
        let start = search.problem().map(|problem| {
            let nodes = orbit.nodes[..problem.conditions.segments].to_vec();
            let chain = Chain { system: search.system, nodes, period: orbit.period, units: orbit.units };
            FamilyStart { problem, chain, direction: None }
        });
        self.continued(start)
    }

    /// Starts the settings of the family that leaves at a bifurcation, to the one side, or
    /// [backwards](FamilySearch::backwards) to the other. At a period doubling its orbits have twice the period, and need
    /// no symmetry.
    pub fn branch<'u>(&self, bifurcation: &Bifurcation<L>) -> FamilySearch<'u, L, D> {
        let kind = bifurcation.kind;
        let start = bifurcation.branch.clone().ok_or_else(|| OrbitError::NoBranch { kind }.into());
        self.continued(start.map(|Branch { problem, chain, direction }| FamilyStart {
            problem,
            chain,
            direction: Some(direction),
        }))
    }

    fn continued<'u>(&self, start: Result<FamilyStart<L>, Error>) -> FamilySearch<'u, L, D> {
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
    /// Lets a parameter change along the family. A branch has the parameter of the family that it leaves, unless another is
    /// named.
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
        Self { step: length, longest: larger(self.longest, length), ..self }
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

    /// Follows the family (pseudo-arclength continuation: Keller 1977; Doedel, Keller and Kernévez, *International Journal
    /// of Bifurcation and Chaos* 1, 1991). The parameter increases at first, or the energy, unless it is followed
    /// [backwards](Self::backwards).
    ///
    /// Bifurcations are told by functions that change sign from one orbit to the next: the rate of the parameter or energy,
    /// the bordered determinant of the equations, Π(1 − λ), Π(1 + λ) and Π(1 − λλ′) of the multipliers. A change of sign
    /// between two orbits of one curve proves that there is one between. A sign counts only where the value exceeds a bound of its
    /// error: derivatives err by at most ten times the error of the orbit, relative to the norm of the monodromy matrix. The zero is
    /// found by cubics with the values and slopes of the function at two orbits (Hermite), and a branch point by Newton's method for
    /// equations that are regular there.
    ///
    /// Two bifurcations of a kind between neighbours are found if two things hold: the cubic falls below half of the values at both
    /// neighbours, and the function passes zero between them by more than its error. An orbit between the two bifurcations then becomes
    /// a member. Steps are shortened so that no multiplier turns by more than 90° at the rate that it has at the start of the step.
    /// What can still be missed is a window that is narrower, or one beside which the function has further extrema between the two
    /// orbits; and two pairs of multipliers that a symmetry makes equal, which pass ±1 at one orbit: the function then touches zero.
    /// Where a function jumps from one sign to the other, [`Family::lost`] says so.
    ///
    /// The family ends early where no orbit is found, which is no error: see [`Family::ending`].
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
        let (problem, method) = (start.problem.clone(), self.method.clone());
        let name = problem.parameter.map_or_else(|| "energy".into(), |k| String::from(L::PARAMETERS[k]));
        let mut family = Family::begin(name, problem.parameter);
        let tracer = Tracer { problem, method: &method, tolerance: self.tolerance, step: self.step };
        let first = tracer.first(start, self.is_backwards)?;
        family.push(first.orbit.clone());
        let ending = self.trace(&tracer, first, &mut family);
        family.end(ending.unwrap_or_else(|error| FamilyEnding::Stopped(Box::new(error))));
        Ok(family)
    }

    /// Adds members from the first on; returns the reason to end.
    fn trace(
        &mut self,
        tracer: &Tracer<'_, L, D>,
        mut member: TracedOrbit<L>,
        family: &mut Family<L>,
    ) -> Result<FamilyEnding, Error>
    where
        D: DifferentiableMethod<L> + Clone,
    {
        let (problem, mut step) = (&tracer.problem, self.step);
        let first = Arc::from(problem, &member.shot, member.tangent.clone());
        if let Some(ending) = self.ending(&member.orbit, family) {
            return Ok(ending);
        }
        loop {
            let arc = Arc::from(problem, &member.shot, member.tangent.clone());
            step = smaller(step, L::Scalar::constant(TURN) / member.turn);
            let (mut next, taken) = tracer.advance(&member.shot, &arc, step)?;
            next.tests.remember(&member.tests);
            let mut reached = tracer.dips(&member, &arc, (taken, &next))?;
            reached.push((taken, next));
            let mut from = (L::Scalar::constant(0.0), &member);
            for (length, next) in &reached {
                let (found, lost) = tracer.between(&member, &arc, [from, (*length, next)]);
                found.into_iter().for_each(|found| family.push_bifurcation(found));
                lost.into_iter().for_each(|lost| family.push_lost(lost));
                family.push(next.orbit.clone());
                if first.is_met(problem, &next.shot, taken) {
                    return Ok(FamilyEnding::Closed);
                }
                if let Some(ending) = self.ending(&next.orbit, family) {
                    return Ok(ending);
                }
                from = (*length, next);
            }
            if let Some((_, next)) = reached.pop() {
                member = next;
            }
            let is_easy = member.orbit.iterations <= EASY;
            step = if is_easy { smaller(taken * L::Scalar::constant(GROWTH), self.longest) } else { taken };
        }
    }

    /// The reason to end the family with its last orbit.
    fn ending(&mut self, orbit: &PeriodicOrbit<L>, family: &Family<L>) -> Option<FamilyEnding> {
        if self.is_last(orbit, family) {
            return Some(FamilyEnding::Until);
        }
        (family.orbits().len() >= self.count).then_some(FamilyEnding::Count)
    }

    /// True if a condition ends the family.
    fn is_last(&mut self, orbit: &PeriodicOrbit<L>, family: &Family<L>) -> bool {
        self.last.is_some_and(|kind| family.first(kind).is_some())
            || self.until.as_mut().is_some_and(|is_last| is_last(orbit))
    }
}

impl<L: Linearized<Scalar: Real>, D: Debug> Debug for FamilySearch<'_, L, D> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut text = f.debug_struct("FamilySearch");
        text.field("system", &L::NAME.to_string()).field("method", &self.method).finish_non_exhaustive()
    }
}
