//! Branch points of a family, at which the equations of a member are singular.
//!
//! Newton's method finds them by the bordered equations (Govaerts, *Numerical Methods for Bifurcations of Dynamical Equilibria*,
//! 2000), which are regular there. With the residual F, F(u) + m ψ = 0 defines m on the plane of two directions v; at a branch point m
//! and its derivatives ψᵀ F′ v vanish. ψ and v are the singular vectors of F′ that vanish there.

use nalgebra::{DMatrix, DVector};

use super::arc::Arc;
use super::bifurcation::{least_direction, least_directions};
use super::shot::Shot;
use super::tracing::{AtLength, TracedOrbit, Tracer};
use crate::error::Error;
use crate::linearized::{DifferentiableMethod, Linearized};
use crate::number::{Real, Scalar, power_of_epsilon};

/// Singular part of the equations at a shot.
struct SingularPart<T> {
    /// ψ.
    left: DVector<T>,
    /// The directions v, as columns.
    plane: DMatrix<T>,
    /// Derivatives of ψᵀ F′ v along v.
    curvature: DMatrix<T>,
    /// Components along v of the step to where ψᵀ F′ v vanishes.
    step: DVector<T>,
}

impl<T: Real> SingularPart<T> {
    /// Newton's step for the bordered equations; `right` is F. `None` if they are singular.
    fn newton_step(&self, jacobian: &DMatrix<T>, right: &DVector<T>) -> Option<DVector<T>> {
        let (rows, columns) = jacobian.shape();
        let bordered = DMatrix::from_fn(columns + 1, columns + 1, |i, j| match (i < rows, j < columns) {
            (true, true) => jacobian[(i, j)],
            (true, false) => self.left[i],
            (false, true) => self.plane[(j, i - rows)],
            (false, false) => T::constant(0.0),
        });
        let demanded = |i: usize| if i < rows { -right[i] } else { self.step[i - rows] };
        let step = bordered.lu().solve(&DVector::from_fn(columns + 1, |i, _| demanded(i)))?;
        Some(step.rows(0, columns).into_owned())
    }
}

impl<L: Linearized<Scalar: Real> + Clone, D: DifferentiableMethod<L> + Clone> Tracer<'_, L, D> {
    /// The branch point near a member, with the direction of its own family; `None` if Newton's method does not converge to one.
    /// The steps end when one is no longer half of the one before: at the noise of the method.
    pub(super) fn branch_point(&self, near: &TracedOrbit<L>, arc: &Arc<L::Scalar>) -> Option<AtLength<L>> {
        let (mut shot, mut last) = (near.shot.clone(), None);
        loop {
            let part = self.singular_part(&shot)?;
            let size = part.step.norm();
            if last.is_some_and(|last| size >= last * L::Scalar::constant(0.5)) {
                let is_point = size <= power_of_epsilon(0.5) && shot.distance() <= self.tolerance;
                return is_point.then(|| self.at_branch_point(shot, &part, near, arc))?;
            }
            last = Some(size);
            let step = part.newton_step(&shot.jacobian, &shot.condensed(&self.problem.conditions.mirror))?;
            shot = self.problem.shoot(self.problem.moved_by(&shot, &step, true).ok()?, self.method).ok()?;
        }
    }

    /// The branch point that Newton's method has reached as a member near another.
    fn at_branch_point(
        &self,
        shot: Shot<L>,
        part: &SingularPart<L::Scalar>,
        near: &TracedOrbit<L>,
        arc: &Arc<L::Scalar>,
    ) -> Option<AtLength<L>> {
        let tangent = own_direction(&part.curvature, &part.plane, &arc.along(&self.problem, &shot))?;
        let length = arc.length + arc.residual(&self.problem, &shot);
        Some((length, self.traced(shot, tangent, near.orbit.iterations).ok()?))
    }

    /// The singular part at a shot; `None` if no step leads to where it vanishes.
    fn singular_part(&self, shot: &Shot<L>) -> Option<SingularPart<L::Scalar>> {
        let left = least_direction(&shot.jacobian.transpose()).ok()?;
        let plane = least_directions(&shot.jacobian, 2).ok()?;
        let curvature = self.curvature(shot, &left, &plane).ok()?;
        let gradient = plane.tr_mul(&shot.jacobian.tr_mul(&left));
        let step = curvature.clone().lu().solve(&-gradient)?;
        Some(SingularPart { left, plane, curvature, step })
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
