//! Bifurcations between two members of a family.

use alloc::vec::Vec;

use super::bifurcation::{Branch, Test, Tests, touches_circle};
use super::correction::Arc;
use super::orbit::PeriodicOrbit;
use super::tracing::{AtLength, TracedOrbit, Tracer};
use crate::error::Error;
use crate::linearized::{DifferentiableMethod, Linearized};
use crate::number::{Real, Scalar, power_of_epsilon};

/// Distance of a fold and a branch point, as part of a step, within which they are one.
const COINCIDENT: f64 = 1e-2;

/// A bifurcation: its test, the orbit there, and the family that leaves.
pub(super) type Located<L> = (Test, PeriodicOrbit<L>, Option<Branch<L>>);

impl<L: Linearized<Scalar: Real> + Clone, D: DifferentiableMethod<L> + Clone> Tracer<'_, L, D> {
    /// The member at an arclength near that of another.
    pub(super) fn beside(
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

    /// Bifurcations between two arclengths from a member, and those of which the orbit or the family that leaves was not found.
    ///
    /// A fold and a branch point that coincide are one, a pitchfork seen from the family that leaves: the orbit is the one
    /// of the fold, since the determinant there is small to the left and right.
    pub(super) fn between(
        &self,
        from: &TracedOrbit<L>,
        arc: &Arc<L::Scalar>,
        [here, next]: [(L::Scalar, Tests<L::Scalar>); 2],
    ) -> (Vec<Located<L>>, Vec<(Test, Error)>) {
        let (mut found, mut lost) = (Vec::new(), Vec::new());
        for test in here.1.changed(&next.1) {
            let at = self.locate(from, arc, [here, next], test).and_then(|at| match test {
                Test::Determinant => Ok(self.centred(&at, arc, next.0 - here.0)?.unwrap_or(at)),
                _ => Ok(at),
            });
            match at {
                // Real multipliers collide, or have the product 1, without a torus.
                Ok((_, at))
                    if test == Test::Torus
                        && !at.orbit.monodromy.nontrivial().is_ok_and(|all| touches_circle(&all)) => {}
                Ok(at) => found.push((test, at)),
                Err(error) => lost.push((test, error)),
            }
        }
        if let [(Test::Turning, (fold, _)), (Test::Determinant, (branch, _)), ..] = &found[..]
            && Scalar::abs(*fold - *branch) <= (next.0 - here.0) * L::Scalar::constant(COINCIDENT)
        {
            found.remove(1);
            found[0].0 = Test::Determinant;
        }
        let mut located = Vec::new();
        for (test, (_, at)) in found {
            match self.problem.branch(test, &at.shot, &at.tangent, self.method) {
                Ok(branch) => located.push((test, at.orbit, branch)),
                Err(error) => lost.push((test, error)),
            }
        }
        (located, lost)
    }

    /// The member at which a test vanishes, between two arclengths from another: regula falsi with the weights of Illinois.
    fn locate(
        &self,
        from: &TracedOrbit<L>,
        arc: &Arc<L::Scalar>,
        ends: [(L::Scalar, Tests<L::Scalar>); 2],
        test: Test,
    ) -> Result<AtLength<L>, Error> {
        const TRIES: usize = 40;
        let mut reason = Error::EigenvaluesNotFound;
        let (zero, half) = (L::Scalar::constant(0.0), L::Scalar::constant(0.5));
        let of = |tests: &Tests<L::Scalar>| tests.value(test).unwrap_or(zero);
        let [mut left, mut right] = ends.map(|(length, tests)| (length, of(&tests)));
        let step = right.0 - left.0;
        let (mut best, mut last) = (None, 0);
        let resolution = step * power_of_epsilon(0.75);
        for _ in 0..TRIES {
            let length = (left.0 * right.1 - right.0 * left.1) / (right.1 - left.1);
            let arc = Arc { length, ..arc.clone() };
            let found = match &best {
                None => self.member(&from.shot, &arc),
                Some((at, near)) => self.beside((*at, near), &arc),
            };
            let found = match found {
                Ok(found) => found,
                Err(error) => {
                    reason = error;
                    break;
                }
            };
            let value = of(&found.tests);
            let moved =
                best.as_ref().map_or(step, |(at, _): &(L::Scalar, TracedOrbit<L>)| Scalar::abs(*at - length));
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
        best.ok_or(reason)
    }
}
