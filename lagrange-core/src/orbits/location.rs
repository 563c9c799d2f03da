//! Bifurcations between two neighbours of a family.
//!
//! The cubic with the values and slopes of a test at both neighbours has a zero between, or a minimum near zero if two
//! bifurcations may lie between. The member there takes the place of a neighbour, until the zero is found.

use alloc::vec::Vec;

use super::arc::Arc;
use super::bifurcation::{Branch, Test, collide_on_circle};
use super::cubic::{Knot, crossing, lowest};
use super::error::OrbitError;
use super::limits::VANISHING;
use super::orbit::PeriodicOrbit;
use super::tracing::{AtLength, TracedOrbit, Tracer};
use crate::error::Error;
use crate::linearized::{DifferentiableMethod, Linearized};
use crate::number::limits::ITERATIONS;
use crate::number::{Real, Scalar, larger, order, power_of_epsilon, smaller};

/// A bifurcation: its test, the orbit there, and the family that leaves.
pub(super) type Located<L> = (Test, PeriodicOrbit<L>, Option<Branch<L>>);

/// A test at two neighbours of a family, to be followed between them.
struct Stretch<'a, L: Linearized<Scalar: Real>> {
    test: Test,
    /// The member from which arclengths count, and the direction of the family there.
    from: &'a TracedOrbit<L>,
    arc: &'a Arc<L::Scalar>,
    ends: [(L::Scalar, &'a TracedOrbit<L>); 2],
}

/// Neighbours that the search for a zero has reached, the left one with a positive value.
struct ZeroSearch<L: Linearized<Scalar: Real>> {
    left: Knot<L::Scalar>,
    right: Knot<L::Scalar>,
    /// Member with the smallest value so far.
    best: Option<AtLength<L>>,
    /// Magnitude of the value at the last member, and whether it was more than half of the one before.
    last: L::Scalar,
    is_slow: bool,
}

impl<L: Linearized<Scalar: Real>> ZeroSearch<L> {
    fn between([left, right]: [Knot<L::Scalar>; 2]) -> Self {
        let last = larger(left.value, Scalar::abs(right.value));
        Self { left, right, best: None, last, is_slow: false }
    }

    /// Arclength of the next member to compute: where the cubic vanishes, or half-way.
    fn next(&self) -> L::Scalar {
        match self.is_slow {
            false => crossing(self.left, self.right),
            true => (self.left.length + self.right.length) * L::Scalar::constant(0.5),
        }
    }

    /// Puts a member in the place of the neighbour with a value of the same sign.
    fn narrow(&mut self, middle: Knot<L::Scalar>) {
        if middle.value > L::Scalar::constant(0.0) { self.left = middle } else { self.right = middle }
    }

    /// Keeps a member if it is the best; false if the search gains no more by others.
    fn goes_on(&mut self, test: Test, middle: Knot<L::Scalar>, found: TracedOrbit<L>) -> bool {
        let size = Scalar::abs(middle.value);
        self.is_slow = size > self.last * L::Scalar::constant(0.5);
        if self.best.is_none() || size < self.last {
            self.best = Some((middle.length, found));
        }
        self.last = size;
        let is_certain = self.best.as_ref().is_some_and(|(_, at)| at.tests.is_certain(test));
        size != L::Scalar::constant(0.0) && (is_certain || !self.is_slow)
    }
}

impl<L: Linearized<Scalar: Real>> Stretch<'_, L> {
    /// True unless an arclength is that of a known member, to round-off of the positions along the stretch.
    fn is_new(&self, length: L::Scalar, known: &Option<AtLength<L>>) -> bool {
        let resolution = (self.ends[1].0 - self.ends[0].0) * power_of_epsilon(0.75);
        known.as_ref().is_none_or(|(at, _)| Scalar::abs(*at - length) > resolution)
    }

    /// True if the test at a member is zero beside its values at both neighbours, or of unknown sign.
    fn vanishes_at(&self, at: &TracedOrbit<L>) -> bool {
        let size = |at: &TracedOrbit<L>| Scalar::abs(at.tests.value(self.test));
        let smallest = smaller(size(self.ends[0].1), size(self.ends[1].1));
        size(at) <= smallest * L::Scalar::constant(VANISHING) || !at.tests.is_certain(self.test)
    }
}

impl<L: Linearized<Scalar: Real> + Clone, D: DifferentiableMethod<L> + Clone> Tracer<'_, L, D> {
    /// Bifurcations between two arclengths from a member, and those of which the orbit or the family that leaves was not found.
    ///
    /// A fold and a branch point that coincide are one, a pitchfork seen from the family that leaves.
    pub(super) fn between(
        &self,
        from: &TracedOrbit<L>,
        arc: &Arc<L::Scalar>,
        ends: [(L::Scalar, &TracedOrbit<L>); 2],
    ) -> (Vec<Located<L>>, Vec<(Test, Error)>) {
        let (mut found, mut lost) = (Vec::new(), Vec::new());
        for test in ends[0].1.tests.changed(&ends[1].1.tests) {
            match self.zero(&Stretch { test, from, arc, ends }) {
                // Real multipliers collide, or have the product 1, without a torus.
                Ok((_, at)) if test == Test::Torus && !collide_on_circle(&at.orbit.monodromy) => {}
                Ok(at) => found.push((test, at)),
                Err(error) => lost.push((test, error)),
            }
        }
        if let [(Test::Turning, (fold, _)), (Test::Determinant, (branch, _)), ..] = &found[..]
            && Scalar::abs(*fold - *branch) <= (ends[1].0 - ends[0].0) * L::Scalar::constant(VANISHING)
        {
            found.remove(0);
        }
        found.sort_by(|(_, (x, _)), (_, (y, _))| order(*x, *y));
        let mut located = Vec::new();
        for (test, (_, at)) in found {
            match self.problem.branch(test, &at.shot, &at.tangent, self.method) {
                Ok(branch) => located.push((test, at.orbit, branch)),
                Err(error) => lost.push((test, error)),
            }
        }
        (located, lost)
    }

    /// Members between two neighbours at which a test has not the sign that it has at both, by arclength.
    pub(super) fn dips(
        &self,
        from: &TracedOrbit<L>,
        arc: &Arc<L::Scalar>,
        next: (L::Scalar, &TracedOrbit<L>),
    ) -> Result<Vec<AtLength<L>>, Error> {
        let (mut found, start) = (Vec::<AtLength<L>>::new(), (L::Scalar::constant(0.0), from));
        for test in Test::ALL {
            let signs = |at: &TracedOrbit<L>| from.tests.signs(&at.tests, test);
            if signs(next.1) > 0 && found.iter().all(|(_, at)| signs(at) >= 0) {
                found.extend(self.dip(&Stretch { test, from, arc, ends: [start, next] })?);
            }
        }
        found.sort_by(|x, y| order(x.0, y.0));
        Ok(found)
    }

    /// The test at a member of a stretch, with the sign by which it is positive at the first.
    fn knot(&self, stretch: &Stretch<'_, L>, (length, at): (L::Scalar, &TracedOrbit<L>)) -> Knot<L::Scalar> {
        let (zero, test) = (L::Scalar::constant(0.0), stretch.test);
        let is_negative = stretch.ends[0].1.tests.value(test) < zero;
        let sign = L::Scalar::constant(if is_negative { -1.0 } else { 1.0 });
        let rate = stretch.arc.along(&self.problem, &at.shot).dot(&at.tangent) * sign;
        let slope = at.slopes[test as usize].unwrap_or(zero) / rate;
        Knot { length, value: at.tests.value(test) * sign, slope }
    }

    /// A member at which a test has the other sign than at both neighbours; `None` if there seems to be none.
    fn dip(&self, stretch: &Stretch<'_, L>) -> Result<Option<AtLength<L>>, Error> {
        let [mut left, mut right] = stretch.ends.map(|end| self.knot(stretch, end));
        let mut last = None;
        for _ in 0..ITERATIONS {
            let Some(length) = lowest(left, right).filter(|length| stretch.is_new(*length, &last)) else {
                break;
            };
            let found = self.member_of(stretch, length, &last)?;
            let middle = self.knot(stretch, (length, &found));
            if !found.tests.is_certain(stretch.test) {
                break;
            }
            if middle.value < L::Scalar::constant(0.0) {
                return Ok(Some((length, found)));
            }
            if middle.slope < L::Scalar::constant(0.0) {
                left = middle;
            } else {
                right = middle;
            }
            last = Some((length, found));
        }
        Ok(None)
    }

    /// The member at which a test of different signs at both neighbours vanishes.
    fn zero(&self, stretch: &Stretch<'_, L>) -> Result<AtLength<L>, Error> {
        let mut search = ZeroSearch::between(stretch.ends.map(|end| self.knot(stretch, end)));
        for _ in 0..ITERATIONS {
            let length = search.next();
            if !stretch.is_new(length, &search.best) {
                break;
            }
            let found = match self.member_of(stretch, length, &search.best) {
                Err(_) if search.best.is_some() => break,
                found => found?,
            };
            let middle = self.knot(stretch, (length, &found));
            search.narrow(middle);
            if let Some(point) = self.branch_point_between(stretch, &search, (length, &found)) {
                return Ok(point);
            }
            if !search.goes_on(stretch.test, middle, found) {
                break;
            }
        }
        // Across a pole, or a leap to another family, a test changes its sign without a zero.
        search.best.filter(|(_, at)| stretch.vanishes_at(at)).ok_or_else(|| OrbitError::NoZero.into())
    }

    /// A branch point between two neighbours, by Newton's method from a member near it.
    fn branch_point_between(
        &self,
        stretch: &Stretch<'_, L>,
        search: &ZeroSearch<L>,
        (length, near): (L::Scalar, &TracedOrbit<L>),
    ) -> Option<AtLength<L>> {
        if stretch.test != Test::Determinant {
            return None;
        }
        let arc = Arc { length, ..stretch.arc.clone() };
        let point = self.branch_point(near, &arc)?;
        (point.0 >= search.left.length && point.0 <= search.right.length).then_some(point)
    }

    /// The member of a stretch at an arclength, from another that is known.
    fn member_of(
        &self,
        stretch: &Stretch<'_, L>,
        length: L::Scalar,
        known: &Option<AtLength<L>>,
    ) -> Result<TracedOrbit<L>, Error> {
        let arc = Arc { length, ..stretch.arc.clone() };
        match known {
            None => self.member(&stretch.from.shot, &arc),
            Some((at, near)) => self.beside((*at, near), &arc),
        }
    }

    /// The member at an arclength near that of another.
    fn beside(
        &self,
        (length, near): (L::Scalar, &TracedOrbit<L>),
        arc: &Arc<L::Scalar>,
    ) -> Result<TracedOrbit<L>, Error> {
        // Along the arc, and not along the direction of the orbit itself: near a branch point, that is any mixture of the directions of
        // both families.
        let along = arc.along(&self.problem, &near.shot);
        let step = &along * ((arc.length - length) / along.norm_squared());
        self.corrected(self.problem.moved_by(&near.shot, &step, false)?, arc)
    }
}
