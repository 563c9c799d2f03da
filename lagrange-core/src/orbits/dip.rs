//! Two bifurcations of a kind between neighbours of a family: a test passes zero twice, and has the same sign at both.
//!
//! Values and slopes at both neighbours make a cubic (Hermite). Where it has a minimum far below both, the member there is
//! computed, and the search goes on in the part that has the minimum then.

use alloc::vec::Vec;

use super::bifurcation::{Test, Tests};
use super::correction::Arc;
use super::multipliers::{logarithm, ratio};
use super::tracing::{AtLength, TracedOrbit, Tracer};
use crate::error::Error;
use crate::linearized::{DifferentiableMethod, Linearized};
use crate::number::{Real, Scalar, larger, order, power_of_epsilon, smaller};

/// Members computed in search of one minimum. A cubic over half of the interval errs sixteen times less: few are needed.
const TRIES: usize = 12;

/// Minimum of a cubic, as part of the values at the ends, above which the test is taken not to reach zero between. Of a pair of
/// multipliers that turns by 90°, through 1 or −1, the cubic errs by 6 % of these values.
const SHALLOW: f64 = 0.5;

/// Rates of the tests, and of the angles of the multipliers, along a family.
#[derive(Clone, Copy, Debug)]
pub(super) struct TestSlopes<T> {
    tests: Tests<T>,
    /// Largest change of the argument of a multiplier, in radians a unit of arclength.
    pub(super) turn: T,
}

/// A test at an arclength, with the sign that it has at both neighbours, and its slope.
#[derive(Clone, Copy)]
struct Knot<T> {
    length: T,
    value: T,
    slope: T,
}

impl<L: Linearized<Scalar: Real> + Clone, D: DifferentiableMethod<L> + Clone> Tracer<'_, L, D> {
    /// Rates at a member, by a difference along the tangent. The orbit moved along it is off by the square of the move.
    pub(super) fn slopes(&self, at: &TracedOrbit<L>) -> Result<TestSlopes<L::Scalar>, Error> {
        let move_by = smaller(power_of_epsilon(1.0 / 3.0), self.step * L::Scalar::constant(0.01));
        let arc = Arc::from(&self.problem, &at.shot, at.tangent.clone());
        let chain = self.problem.moved_by(&at.shot, &(&at.tangent * move_by), false)?;
        let shot = self.problem.shoot(chain, self.method)?;
        let tangent = self.tangent(&shot, &arc)?;
        let monodromy = self.problem.once_around(&shot, self.method)?;
        let moved = self.problem.tests(&shot, &tangent, (&monodromy, at.orbit.error))?;
        let tests = moved.change_from(&at.tests, L::Scalar::constant(1.0) / move_by);
        let (from, to) = (at.orbit.monodromy.nontrivial()?, monodromy.nontrivial()?);
        let turns = from.iter().filter_map(|x| {
            let logarithms = to.iter().map(|y| logarithm(ratio(*y, *x)));
            let size = |x: &nalgebra::Complex<L::Scalar>| x.re * x.re + x.im * x.im;
            logarithms.min_by(|x, y| order(size(x), size(y))).map(|least| Scalar::abs(least.im))
        });
        let turn = turns.fold(L::Scalar::constant(0.0), larger) / move_by;
        Ok(TestSlopes { tests, turn })
    }

    /// Members between two neighbours at which a test has not the sign that it has at both, by arclength.
    pub(super) fn dips(
        &self,
        (from, slopes): (&TracedOrbit<L>, &TestSlopes<L::Scalar>),
        arc: &Arc<L::Scalar>,
        (step, next, ahead): (L::Scalar, &TracedOrbit<L>, &TestSlopes<L::Scalar>),
    ) -> Result<Vec<AtLength<L>>, Error> {
        let rate = arc.along(&self.problem, &next.shot).dot(&next.tangent);
        let mut found = Vec::new();
        for test in Test::ALL {
            let knot = |length, tests: &Tests<_>, slopes: &TestSlopes<_>, rate| {
                let (value, slope) = (tests.value(test)?, slopes.tests.value(test)?);
                Some(Knot { length, value, slope: slope / rate })
            };
            let (zero, one) = (L::Scalar::constant(0.0), L::Scalar::constant(1.0));
            let ends = knot(zero, &from.tests, slopes, one).zip(knot(step, &next.tests, ahead, rate));
            let Some(ends) = ends.filter(|(left, right)| left.value * right.value > zero) else { continue };
            found.extend(self.dip(test, from, arc, ends)?);
        }
        found.sort_by(|x, y| order(x.0, y.0));
        Ok(found)
    }

    /// A member between two knots at which the test is beyond zero.
    fn dip(
        &self,
        test: Test,
        from: &TracedOrbit<L>,
        arc: &Arc<L::Scalar>,
        (left, right): (Knot<L::Scalar>, Knot<L::Scalar>),
    ) -> Result<Option<AtLength<L>>, Error> {
        let (zero, one) = (L::Scalar::constant(0.0), L::Scalar::constant(1.0));
        let sign = if left.value < zero { -one } else { one };
        let (mut left, mut right) = (left.times(sign), right.times(sign));
        let noise = from.tests.noise * larger(one, larger(left.value, right.value));
        for _ in 0..TRIES {
            let Some(length) = lowest(left, right).filter(|_| smaller(left.value, right.value) > noise)
            else {
                return Ok(None);
            };
            let arc = Arc { length, ..arc.clone() };
            let found = self.member(&from.shot, &arc)?;
            let value = found.tests.value(test).unwrap_or(zero) * sign;
            if value < -noise {
                return Ok(Some((length, found)));
            }
            let rate = arc.along(&self.problem, &found.shot).dot(&found.tangent);
            let slope = self.slopes(&found)?.tests.value(test).unwrap_or(zero) * sign / rate;
            let middle = Knot { length, value, slope };
            if slope < zero { left = middle } else { right = middle }
        }
        Ok(None)
    }
}

impl<T: Real> Knot<T> {
    fn times(self, factor: T) -> Self {
        Self { value: self.value * factor, slope: self.slope * factor, ..self }
    }
}

/// Where the cubic between two knots has its minimum, if this is far below both.
fn lowest<T: Real>(left: Knot<T>, right: Knot<T>) -> Option<T> {
    let span = right.length - left.length;
    let (rise, first, last) = (right.value - left.value, left.slope * span, right.slope * span);
    let (two, three) = (T::constant(2.0), T::constant(3.0));
    let (square, cube) = (three * rise - two * first - last, first + last - two * rise);
    let root = Scalar::sqrt(square * square - three * first * cube);
    let part = -first / (square + root);
    let value = left.value + part * (first + part * (square + part * cube));
    let is_inside = part > T::constant(0.0) && part < T::constant(1.0);
    let is_low = value < T::constant(SHALLOW) * smaller(left.value, right.value);
    (is_inside && is_low).then(|| left.length + part * span)
}
