//! A branch point by interpolation between members on both sides.
//!
//! Where two families meet, the equations are singular: a corrected orbit is as far from its family as the cube root of their noise,
//! and their null vector is any mixture of both directions. Beside it neither is so.

use alloc::vec::Vec;

use super::correction::Arc;
use super::frame::{flat, shifted};
use super::shot::Chain;
use super::tracing::{AtLength, TracedOrbit, Tracer};
use crate::error::Error;
use crate::linearized::{DifferentiableMethod, Linearized};
use crate::motion::Simulate;
use crate::number::{Real, Scalar, exceeds, norm};
use crate::vector::StaticLength;

/// Distance from a branch point of the members from which it is interpolated, as part of a step. Nearer, their own errors grow; at
/// 5·10⁻³ the ends of a narrow window are found to 10⁻⁹ in place of 3·10⁻¹¹ (`windows_of_mathieus_swing`).
const BESIDE: f64 = 2e-3;

/// Distances tried, each a tenth of the one before.
const TRIES: usize = 4;

/// Part of the slope that the square and the cube of the test may have: what the cubic leaves out is less than its square. Usual are
/// 10⁻⁵; beside a window that is narrower than the distance it is 0.3.
const STRAIGHT: f64 = 1e-3;

impl<L: Linearized<Scalar: Real> + Clone, D: DifferentiableMethod<L> + Clone> Tracer<'_, L, D> {
    /// A branch point from two members on each side, with the direction of its own family; `None` where the test does not pass zero
    /// in a straight line there.
    ///
    /// Cubics through the members give the arclength and the orbit, to the fourth power of the distance, and the mean of their
    /// directions the direction, to the square.
    pub(super) fn centred(
        &self,
        at: &AtLength<L>,
        arc: &Arc<L::Scalar>,
        step: L::Scalar,
    ) -> Result<Option<AtLength<L>>, Error> {
        let mut offset = step * L::Scalar::constant(BESIDE);
        for _ in 0..TRIES {
            let mut beside = Vec::with_capacity(4);
            for k in [-2.0, -1.0, 1.0, 2.0] {
                let length = at.0 + offset * L::Scalar::constant(k);
                beside.push(self.beside((at.0, &at.1), &Arc { length, ..arc.clone() })?);
            }
            let value = |k: usize| beside[k].tests.determinant.unwrap_or(L::Scalar::constant(0.0));
            if let Some(part) = zero_between([value(0), value(1), value(2), value(3)]) {
                return Ok(self.interpolated(&beside, part)?.map(|found| (at.0 + part * offset, found)));
            }
            offset *= L::Scalar::constant(0.1);
        }
        Ok(None)
    }

    /// The member of the family at the zero of the test, of two on each side; `None` if it does not close.
    fn interpolated(
        &self,
        beside: &[TracedOrbit<L>],
        part: L::Scalar,
    ) -> Result<Option<TracedOrbit<L>>, Error> {
        let shot = self.problem.shoot(self.mean(beside, cubic_weights(part))?, self.method)?;
        if exceeds(shot.distance(), self.tolerance) {
            return Ok(None);
        }
        let orbit = self.problem.orbit(&shot, beside[1].orbit.iterations, self.method, self.tolerance)?;
        let along = |k: usize| {
            let tangent = beside[k].tangent.clone();
            Arc::from(&self.problem, &beside[k].shot, tangent).along(&self.problem, &shot)
        };
        let tangent = along(1) + along(2);
        let tangent = &tangent / norm(tangent.as_slice());
        let tests = self.problem.tests(&shot, &tangent, (&orbit.monodromy, orbit.error))?;
        Ok(Some(TracedOrbit { shot, orbit, tangent, tests }))
    }

    /// Weighted mean of members that are near one another.
    fn mean(&self, members: &[TracedOrbit<L>], weights: [L::Scalar; 4]) -> Result<Chain<L>, Error> {
        let zero = L::Scalar::constant(0.0);
        let of = |value: &dyn Fn(&Chain<L>) -> L::Scalar| {
            members
                .iter()
                .zip(weights)
                .fold(zero, |sum, (member, weight)| sum + value(&member.shot.chain) * weight)
        };
        let mut chain = members[0].shot.chain.clone();
        chain.period = of(&|chain| chain.period);
        if let Some(k) = self.problem.parameter {
            chain.system.set_parameter(k, of(&|chain| chain.system.parameters()[k]));
        }
        for (k, node) in chain.nodes.iter_mut().enumerate() {
            let first = flat::<L>(node);
            let moved =
                members.iter().zip(weights).map(|(x, w)| (flat::<L>(&x.shot.chain.nodes[k]) - &first) * w);
            *node = shifted::<L>(node, &moved.sum());
            node.t = of(&|chain| chain.nodes[k].t);
            if const { <L::M>::COUNT > 0 } {
                *node = chain.system.make_consistent(node)?.0;
            }
        }
        Ok(chain)
    }
}

/// Weights of the cubic at `x` through values at −2, −1, 1 and 2.
fn cubic_weights<T: Real>(x: T) -> [T; 4] {
    const AT: [f64; 4] = [-2.0, -1.0, 1.0, 2.0];
    core::array::from_fn(|k| {
        let others = AT.iter().filter(|at| **at != AT[k]);
        others
            .fold(T::constant(1.0), |product, at| product * (x - T::constant(*at)) / T::constant(AT[k] - at))
    })
}

/// Zero between −1 and 1 of the cubic through these values at −2, −1, 1 and 2, if it is nearly straight.
fn zero_between<T: Real>(values: [T; 4]) -> Option<T> {
    let [far_left, left, right, far_right] = values;
    let (zero, six) = (T::constant(0.0), T::constant(6.0));
    let slope = (right - left) * T::constant(0.5);
    let square = (far_right + far_left - right - left) / six;
    let cube = (far_right - far_left - (right - left) * T::constant(2.0)) / (six + six);
    if left * right >= zero
        || exceeds(Scalar::abs(square) + Scalar::abs(cube), T::constant(STRAIGHT) * Scalar::abs(slope))
    {
        return None;
    }
    let cubic =
        |x| values.iter().zip(cubic_weights(x)).fold(zero, |sum, (value, weight)| sum + *value * weight);
    // Each turn gains two digits or more.
    Some((0..10).fold(zero, |x, _| x - cubic(x) / slope))
}
