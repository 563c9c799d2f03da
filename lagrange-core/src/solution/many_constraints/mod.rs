//! Accelerations of systems of any number of bodies with constraints.
//!
//! M q̈ = h + Fᵀλ and F q̈ = −γ give (F M⁻¹ Fᵀ) λ = −γ − F M⁻¹ h. Constraints are taken to be independent: where a pivot of F M⁻¹ Fᵀ has
//! lost half of its digits, no accelerations are given, and an error names the constraint. A step of iterative refinement, with
//! residuals F q̈ + γ of the accelerations found, gives the lost digits back (Higham, *Accuracy and Stability of Numerical
//! Algorithms*, 12).

mod projection;
mod reduced;
mod rows;

use nalgebra::{ComplexField, DVector};

use crate::error::Error;
use crate::names::{Row, WrittenName};
use crate::number::limits::HALF_THE_DIGITS;
use crate::number::{Real, Scalar};
use crate::system::{ManyBodies, StateOf};
use crate::vector::scratch::with_scratch;
pub(crate) use projection::{check, make_consistent, project};
use reduced::Reduced;
pub use rows::ConstraintRows;

/// Writes the accelerations of a system with constraints to `a`; NaN where the constraints are not independent.
pub fn write_constrained_accelerations<L: ManyBodies>(
    system: &L,
    t: L::Scalar,
    [q, v]: [&[L::Scalar]; 2],
    a: &mut [L::Scalar],
) {
    with_scratch(|reduced: &mut Reduced<L::Scalar>| reduced.accelerate(system, (t, q, v), a));
}

impl<T: Scalar> Reduced<T> {
    /// Writes the accelerations to `a`, and leaves the multipliers.
    fn accelerate<L: ManyBodies<Scalar = T>>(&mut self, system: &L, (t, q, v): (T, &[T], &[T]), a: &mut [T]) {
        system.free_accelerations(t, q, v, a);
        let doubt = doubt(self.factor(system, (t, q, v), false));
        self.correct(a);
        let found = core::mem::take(&mut self.multipliers);
        self.multipliers.extend_from_slice(&found);
        self.correct(a);
        let mut sum = found;
        for (sum, change) in sum.iter_mut().zip(&self.multipliers) {
            *sum = *sum + *change + doubt;
        }
        self.multipliers = sum;
        a.iter_mut().for_each(|a| *a = *a + doubt);
    }

    /// Adds M⁻¹ Fᵀ λ to `a` so that F a = −γ, and leaves λ.
    fn correct(&mut self, a: &mut [T]) {
        for row in 0..self.stated.rows.len() {
            self.multipliers[row] = -(self.stated.rows[row].bias + self.along(row, a));
        }
        self.solve(a);
    }
}

/// Zero, or NaN where the smallest ratio of a pivot to its diagonal entry is below √ε or not a number.
fn doubt<T: Scalar>(ratio: T) -> T {
    let [zero, nan] = [0.0, f64::NAN].map(T::constant);
    let is_single = T::constant(1.0 + f64::EPSILON) == T::constant(1.0);
    let bound = if is_single { f64::from(f32::EPSILON).sqrt() } else { HALF_THE_DIGITS };
    ratio.select_by_order(T::constant(bound), nan, nan, zero)
}

/// Multipliers at a state, in the order of the constraints.
pub(crate) fn multipliers<L: ManyBodies<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
) -> Result<DVector<L::Scalar>, Error> {
    let (t, q, v) = (state.t, state.q.as_slice(), state.v.as_slice());
    let mut a = state.v.clone();
    with_scratch(|reduced: &mut Reduced<L::Scalar>| {
        reduced.accelerate(system, (t, q, v), a.as_mut_slice());
        let is_wrong = |x: &L::Scalar| !x.is_finite();
        let Some(row) = reduced.multipliers.iter().position(is_wrong) else {
            return Ok(DVector::from_column_slice(&reduced.multipliers));
        };
        let not_finite = Error::EquationsNotFinite { row: name(system, row), time: t.to_f64() };
        Err(reduced.fault(system, state).unwrap_or(not_finite))
    })
}

/// The constraint because of which a state has no accelerations, if there is one.
pub(crate) fn fault<L: ManyBodies<Scalar: Real>>(system: &L, state: &StateOf<L>) -> Option<Error> {
    let at = (state.t, state.q.as_slice(), state.v.as_slice());
    with_scratch(|reduced: &mut Reduced<L::Scalar>| {
        reduced.factor(system, at, false);
        reduced.fault(system, state)
    })
}

impl<T: Real> Reduced<T> {
    /// The constraint that is not finite, or depends on others, at the state for which the matrix was factorized last.
    fn fault<L: ManyBodies<Scalar = T>>(&self, system: &L, state: &StateOf<L>) -> Option<Error> {
        let (time, v) = (state.t.to_f64(), state.v.as_slice());
        for (row, stated) in self.stated.rows.iter().enumerate() {
            let constraint = name(system, row);
            if ![stated.rate, stated.bias, self.along(row, v)].iter().all(|x| x.is_finite()) {
                return Some(Error::EquationsNotFinite { row: constraint, time });
            }
            if self.stated.pattern.slopes(row).all(|slope| self.stated.slopes[slope] == T::constant(0.0)) {
                return Some(Error::NoGradient { constraint, time });
            }
        }
        let weakest = self.weakest().filter(|(_, ratio)| !doubt(*ratio).is_finite());
        weakest.map(|(row, _)| Error::Dependent { constraint: name(system, row), time })
    }
}

/// Name of a constraint.
fn name<L: ManyBodies>(system: &L, row: usize) -> Row {
    Row::WrittenConstraint(WrittenName::of(|to| system.write_constraint_name(row, to)))
}
