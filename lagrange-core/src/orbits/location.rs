//! Bifurcations between two neighbours of a family.
//!
//! The cubic with the values and slopes of a test at both neighbours (Hermite) has a zero between, or a minimum near zero if two
//! bifurcations may lie between. The member there takes the place of a neighbour, until the zero is found.
//!
//! At a branch point the equations of a member are singular. Newton's method finds it by the bordered equations (Govaerts, *Numerical
//! Methods for Bifurcations of Dynamical Equilibria*, 2000), which are regular there.

use alloc::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::arc::Arc;
use super::bifurcation::{Branch, Test, least_direction, least_directions, touches_circle};
use super::error::OrbitError;
use super::orbit::PeriodicOrbit;
use super::shot::Shot;
use super::tracing::{AtLength, TracedOrbit, Tracer};
use crate::error::Error;
use crate::linearized::{DifferentiableMethod, Linearized};
use crate::number::{Real, Scalar, exceeds, larger, order, power_of_epsilon, smaller};

/// Members computed in search of one zero. Five are usual.
const TRIES: usize = 30;

/// Steps of Newton's method to a branch point. Four are usual.
const STEPS: usize = 12;

/// Minimum of a cubic, as part of the values at the ends, above which the test is taken not to reach zero between. Of a pair of
/// multipliers that turns by 90°, through 1 or −1, the cubic errs by 6 % of these values.
const SHALLOW: f64 = 0.5;

/// Largest value of a test at its zero, relative to the smaller of its values at both neighbours. At a zero the search gains a digit or more
/// with each member and ends far below; at a pole or a jump it gains none.
const VANISHING: f64 = 1e-3;

/// Distance of a fold and a branch point, as part of a step, within which they are one.
const COINCIDENT: f64 = 1e-2;

/// A bifurcation: its test, the orbit there, and the family that leaves.
pub(super) type Located<L> = (Test, PeriodicOrbit<L>, Option<Branch<L>>);

/// A test at an arclength, and its slope.
#[derive(Clone, Copy)]
struct Knot<T> {
    length: T,
    value: T,
    slope: T,
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
            match self.approach(test, from, arc, ends) {
                // Real multipliers collide, or have the product 1, without a torus.
                Ok(Some((_, at)))
                    if test == Test::Torus
                        && !at.orbit.monodromy.nontrivial().is_ok_and(|all| touches_circle(&all)) => {}
                Ok(at) => found.extend(at.map(|at| (test, at))),
                Err(error) => lost.push((test, error)),
            }
        }
        if let [(Test::Turning, (fold, _)), (Test::Determinant, (branch, _)), ..] = &found[..]
            && Scalar::abs(*fold - *branch) <= (ends[1].0 - ends[0].0) * L::Scalar::constant(COINCIDENT)
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
                found.extend(self.approach(test, from, arc, [start, next])?);
            }
        }
        found.sort_by(|x, y| order(x.0, y.0));
        Ok(found)
    }

    /// The member between two others at which a test vanishes; if it has the same sign at both, one at which it has the other sign,
    /// `None` if there seems to be none.
    fn approach(
        &self,
        test: Test,
        from: &TracedOrbit<L>,
        arc: &Arc<L::Scalar>,
        ends: [(L::Scalar, &TracedOrbit<L>); 2],
    ) -> Result<Option<AtLength<L>>, Error> {
        let zero = L::Scalar::constant(0.0);
        let sign = L::Scalar::constant(if ends[0].1.tests.value(test) < zero { -1.0 } else { 1.0 });
        let knot = |(length, at): (L::Scalar, &TracedOrbit<L>)| {
            let rate = arc.along(&self.problem, &at.shot).dot(&at.tangent) * sign;
            let slope = at.slopes[test as usize].unwrap_or(zero) / rate;
            Knot { length, value: at.tests.value(test) * sign, slope }
        };
        let [mut left, mut right] = ends.map(knot);
        let (is_dip, step) = (right.value > zero, right.length - left.length);
        let smallest = smaller(Scalar::abs(left.value), Scalar::abs(right.value));
        let mut best: Option<AtLength<L>> = None;
        let (mut least, mut is_slow) = (larger(left.value, Scalar::abs(right.value)), false);
        for _ in 0..TRIES {
            let length = match (is_dip, is_slow) {
                (true, _) => lowest(left, right),
                (false, false) => Some(crossing(left, right)),
                (false, true) => Some((left.length + right.length) * L::Scalar::constant(0.5)),
            };
            let Some(length) = length else { return Ok(None) };
            let arc = Arc { length, ..arc.clone() };
            let found = match &best {
                None => self.member(&from.shot, &arc),
                Some((at, _)) if Scalar::abs(*at - length) <= step * power_of_epsilon(0.75) => break,
                Some((at, near)) => self.beside((*at, near), &arc),
            };
            let found = match found {
                Ok(found) => found,
                Err(_) if best.is_some() && !is_dip => break,
                Err(error) => return Err(error),
            };
            let middle = knot((length, &found));
            if is_dip && !(middle.value > zero && found.tests.is_certain(test)) {
                return Ok(found.tests.is_certain(test).then_some((length, found)));
            }
            if (middle.value > zero && !is_dip) || (is_dip && middle.slope < zero) {
                left = middle;
            } else {
                right = middle;
            }
            if test == Test::Determinant && !is_dip {
                let point = self.branch_point(&found, &arc).ok().flatten();
                if let Some(point) = point.filter(|(at, _)| *at >= left.length && *at <= right.length) {
                    return Ok(Some(point));
                }
            }
            let size = Scalar::abs(middle.value);
            is_slow = size > least * L::Scalar::constant(0.5);
            if best.is_none() || size < least {
                best = Some((length, found));
            }
            if size == zero || (is_slow && !best.as_ref().is_some_and(|(_, at)| at.tests.is_certain(test))) {
                break;
            }
            least = size;
        }
        // Across a pole, or a leap to another family, a test changes its sign without a zero.
        let is_zero = |at: &TracedOrbit<L>| {
            let value = Scalar::abs(at.tests.value(test));
            value <= smallest * L::Scalar::constant(VANISHING) || !at.tests.is_certain(test)
        };
        match best.filter(|_| !is_dip) {
            Some((_, at)) if !is_zero(&at) => Err(OrbitError::NoZero.into()),
            best => Ok(best),
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

    /// The branch point near a member, with the direction of its own family; `None` if Newton's method does not converge to one.
    ///
    /// With the residual F, F(u) + m ψ = 0 defines m on the plane of two directions v; at a branch point m and its derivatives
    /// ψᵀ F′ v vanish. ψ and v are the singular vectors of F′ that vanish there.
    fn branch_point(
        &self,
        near: &TracedOrbit<L>,
        arc: &Arc<L::Scalar>,
    ) -> Result<Option<AtLength<L>>, Error> {
        let (mut shot, half) = (near.shot.clone(), L::Scalar::constant(0.5));
        let mut last: Option<L::Scalar> = None;
        for _ in 0..STEPS {
            let (left, plane) =
                (least_direction(&shot.jacobian.transpose())?, least_directions(&shot.jacobian, 2)?);
            let curvature = self.curvature(&shot, &left, &plane)?;
            let gradient = plane.tr_mul(&shot.jacobian.tr_mul(&left));
            let Some(moved) = curvature.clone().lu().solve(&-gradient) else { return Ok(None) };
            let size = moved.norm();
            if last.is_some_and(|last| size >= last * half) {
                if exceeds(size, power_of_epsilon(0.5)) || exceeds(shot.distance(), self.tolerance) {
                    return Ok(None);
                }
                let along = arc.along(&self.problem, &shot);
                let Some(tangent) = own_direction(&curvature, &plane, &along) else { return Ok(None) };
                let length = arc.length + arc.residual(&self.problem, &shot);
                return Ok(Some((length, self.traced(shot, tangent, near.orbit.iterations)?)));
            }
            last = Some(size);
            let (rows, columns) = shot.jacobian.shape();
            let bordered = DMatrix::from_fn(columns + 1, columns + 1, |i, j| match (i < rows, j < columns) {
                (true, true) => shot.jacobian[(i, j)],
                (true, false) => left[i],
                (false, true) => plane[(j, i - rows)],
                (false, false) => L::Scalar::constant(0.0),
            });
            let right = shot.condensed(&self.problem.conditions.mirror);
            let right =
                DVector::from_fn(columns + 1, |i, _| if i < rows { -right[i] } else { moved[i - rows] });
            let Some(step) = bordered.lu().solve(&right) else { return Ok(None) };
            let step = step.rows(0, columns).into_owned();
            shot = self.problem.shoot(self.problem.moved_by(&shot, &step, true)?, self.method)?;
        }
        Ok(None)
    }

    /// Derivatives of ψᵀ F′ v_j along v_i.
    fn curvature(
        &self,
        shot: &Shot<L>,
        left: &DVector<L::Scalar>,
        plane: &DMatrix<L::Scalar>,
    ) -> Result<DMatrix<L::Scalar>, Error> {
        let move_by: L::Scalar = power_of_epsilon(1.0 / 3.0);
        let mut curvature = DMatrix::zeros(2, 2);
        for i in 0..2 {
            let chain = self.problem.moved_by(shot, &(plane.column(i) * move_by), false)?;
            let moved = self.problem.shoot(chain, self.method)?;
            let change = (moved.jacobian - &shot.jacobian) / move_by;
            curvature.set_column(i, &plane.tr_mul(&change.tr_mul(left)));
        }
        Ok(curvature)
    }
}

/// Direction in a plane, near another, along which a quadratic form vanishes.
fn own_direction<T: Real>(form: &DMatrix<T>, plane: &DMatrix<T>, along: &DVector<T>) -> Option<DVector<T>> {
    let (xx, yy) = (form[(0, 0)], form[(1, 1)]);
    let xy = (form[(0, 1)] + form[(1, 0)]) * T::constant(0.5);
    let square = xy * xy - xx * yy;
    let root = (square > T::constant(0.0)).then(|| Scalar::sqrt(square))?;
    let large = if xy < T::constant(0.0) { xy - root } else { xy + root };
    // Both zeros of xx p² + 2 xy p q + yy q².
    let directions = [[-large, xx], [yy, -large]].map(|[p, q]| plane.column(0) * p + plane.column(1) * q);
    let cosines = directions.map(|x| {
        let length = x.norm();
        (along.dot(&x) / length, x / length)
    });
    let [first, second] = cosines;
    let (cosine, found) = if Scalar::abs(first.0) > Scalar::abs(second.0) { first } else { second };
    Some(if cosine < T::constant(0.0) { -found } else { found })
}

/// Value, slope, half of the second and a sixth of the third derivative of the cubic between two knots, by part of the distance.
fn cubic<T: Real>(left: Knot<T>, right: Knot<T>) -> [T; 4] {
    let span = right.length - left.length;
    let (rise, first, last) = (right.value - left.value, left.slope * span, right.slope * span);
    let (two, three) = (T::constant(2.0), T::constant(3.0));
    [left.value, first, three * rise - two * first - last, first + last - two * rise]
}

/// Where the cubic between two knots has its minimum, if this is far below both.
fn lowest<T: Real>(left: Knot<T>, right: Knot<T>) -> Option<T> {
    let [start, first, square, cube] = cubic(left, right);
    let root = Scalar::sqrt(square * square - T::constant(3.0) * first * cube);
    let part = -first / (square + root);
    let value = start + part * (first + part * (square + part * cube));
    let is_inside = part > T::constant(0.0) && part < T::constant(1.0);
    let is_low = value < T::constant(SHALLOW) * smaller(left.value, right.value);
    (is_inside && is_low).then(|| left.length + part * (right.length - left.length))
}

/// A zero of the cubic between two knots of different signs, the left one positive.
fn crossing<T: Real>(left: Knot<T>, right: Knot<T>) -> T {
    let [start, first, square, cube] = cubic(left, right);
    let (mut low, mut high) = (T::constant(0.0), T::constant(1.0));
    for _ in 0..60 {
        let part = (low + high) * T::constant(0.5);
        let value = start + part * (first + part * (square + part * cube));
        if value > T::constant(0.0) { low = part } else { high = part }
    }
    left.length + (low + high) * T::constant(0.5) * (right.length - left.length)
}
