//! Accelerations of systems of any number of bodies with constraints.
//!
//! M q̈ = h + Fᵀλ and F q̈ = −γ give (F M⁻¹ Fᵀ) λ = −γ − F M⁻¹ h. Constraints are taken to be independent: where a pivot of F M⁻¹ Fᵀ has
//! lost half of its digits, no accelerations are given, and an error names the constraint. Where it has lost a third, the equations are
//! solved once more for what the accelerations leave of F q̈ + γ, which restores the digits (iterative refinement; Higham, *Accuracy
//! and Stability of Numerical Algorithms*, 12).
//!
//! Constraints between neighbours along an array are eliminated [as a band](band), whose width the compiler knows: five times as fast as
//! those of [any pattern](reduced).

mod band;
mod projection;
mod reduced;
mod rows;

use alloc::vec::Vec;

use nalgebra::{ComplexField, DVector};

use crate::error::Error;
use crate::names::{Row, WrittenName};
use crate::number::{Real, Scalar};
use crate::solution::eliminate::nan_if_ill_conditioned;
use crate::system::{ManyBodies, StateOf};
use crate::vector::scratch::with_scratch;
pub use band::{Band, BandRow, around};
pub(crate) use projection::{check, make_consistent, project};
use reduced::Reduced;
pub use rows::ConstraintRows;
use rows::StatedRow;

/// What a correction M⁻¹ Fᵀ λ makes satisfy the constraints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Correction {
    /// Coordinates, to first order: F δ = −Φ, for holonomic constraints alone.
    Coordinates,
    /// Velocities: F δ = −(F q̇ + b).
    Velocities,
    /// Accelerations: F (q̈ + δ) = −γ.
    Accelerations,
}

impl Correction {
    /// True if a constraint restricts what is corrected: coordinates are restricted by holonomic constraints alone.
    fn concerns<T>(self, row: &StatedRow<T>) -> bool {
        self != Self::Coordinates || row.residual.is_some()
    }

    /// What F δ has to be, where `along` is F times what is corrected.
    fn right<T: Scalar>(self, row: &StatedRow<T>, along: impl FnOnce() -> T) -> T {
        match self {
            Self::Coordinates => row.residual.map_or(T::constant(0.0), |residual| -residual),
            Self::Velocities => -row.rate,
            Self::Accelerations => -(row.bias + along()),
        }
    }
}

/// Corrects a vector for any constraints. Implements [`ManyBodies::correct`].
pub(crate) fn correct<L: ManyBodies>(
    system: &L,
    at: (L::Scalar, &[L::Scalar], &[L::Scalar]),
    target: Correction,
    (x, multipliers): (&mut [L::Scalar], &mut Vec<L::Scalar>),
) -> L::Scalar {
    with_scratch(|reduced: &mut Reduced<L::Scalar>| {
        let ratio = reduced.factor(system, at, target);
        reduced.solve(target, (x, multipliers));
        ratio
    })
}

/// Writes the accelerations of a system with constraints to `a`; NaN where the constraints are not independent.
pub fn write_constrained_accelerations<L: ManyBodies>(
    system: &L,
    t: L::Scalar,
    [q, v]: [&[L::Scalar]; 2],
    a: &mut [L::Scalar],
) {
    with_scratch(|multipliers: &mut Vec<L::Scalar>| accelerate(system, (t, q, v), (a, multipliers)));
}

/// Writes accelerations and multipliers. If a third of the digits is lost, residuals of the accelerations give them back.
fn accelerate<L: ManyBodies>(
    system: &L,
    at: (L::Scalar, &[L::Scalar], &[L::Scalar]),
    (a, multipliers): (&mut [L::Scalar], &mut Vec<L::Scalar>),
) {
    let zero = L::Scalar::constant(0.0);
    system.free_accelerations(at.0, at.1, at.2, a);
    let ratio = system.correct(at, Correction::Accelerations, (a, multipliers));
    if nan_if_ill_conditioned(ratio, L::Scalar::constant(1.0)) == zero {
        return;
    }
    let doubt = doubt(ratio);
    with_scratch(|changes: &mut Vec<L::Scalar>| {
        system.correct(at, Correction::Accelerations, (a, changes));
        multipliers.iter_mut().zip(changes).for_each(|(sum, change)| *sum = *sum + *change + doubt);
        a.iter_mut().for_each(|a| *a = *a + doubt);
    });
}

/// One where a pivot of any sign is more than √ε of the entry that it is what is left of, else zero; NaN for NaN.
#[inline]
pub fn trust<T: Scalar>(pivot: T, whole: T) -> T {
    let [zero, one] = [0.0, 1.0].map(T::constant);
    (pivot * pivot).select_by_order(T::constant(epsilon::<T>()) * whole * whole, zero, zero, one)
}

/// Zero, or NaN where the smallest ratio of a pivot to its diagonal entry is below √ε or not a number.
fn doubt<T: Scalar>(ratio: T) -> T {
    let [zero, nan] = [0.0, f64::NAN].map(T::constant);
    ratio.select_by_order(T::constant(Scalar::sqrt(epsilon::<T>())), nan, nan, zero)
}

/// Relative round-off of a number type.
fn epsilon<T: Scalar>() -> f64 {
    let is_single = T::constant(1.0 + f64::EPSILON) == T::constant(1.0);
    if is_single { f32::EPSILON.into() } else { f64::EPSILON }
}

/// Multipliers at a state, in the order of the constraints.
pub(crate) fn multipliers<L: ManyBodies<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
) -> Result<DVector<L::Scalar>, Error> {
    let (mut a, mut multipliers) = (state.v.clone(), Vec::new());
    accelerate(
        system,
        (state.t, state.q.as_slice(), state.v.as_slice()),
        (a.as_mut_slice(), &mut multipliers),
    );
    let Some(row) = multipliers.iter().position(|multiplier| !multiplier.is_finite()) else {
        return Ok(DVector::from_vec(multipliers));
    };
    let not_finite = Error::EquationsNotFinite { row: name(system, row), time: state.t.to_f64() };
    Err(fault(system, state).unwrap_or(not_finite))
}

/// The constraint because of which a state has no accelerations, if there is one.
pub(crate) fn fault<L: ManyBodies<Scalar: Real>>(system: &L, state: &StateOf<L>) -> Option<Error> {
    let at = (state.t, state.q.as_slice(), state.v.as_slice());
    with_scratch(|reduced: &mut Reduced<L::Scalar>| {
        reduced.factor(system, at, Correction::Accelerations);
        reduced.fault(system, state)
    })
}

impl<T: Real> Reduced<T> {
    /// The constraint that is not finite, or depends on others, at the state for which the matrix was factorized last.
    fn fault<L: ManyBodies<Scalar = T>>(&self, system: &L, state: &StateOf<L>) -> Option<Error> {
        let (time, v) = (state.t.to_f64(), state.v.as_slice());
        if let Some(coordinate) = self.massless() {
            let row = Row::Written(WrittenName::of(|to| system.write_name(coordinate, to)));
            return Some(Error::EquationsNotFinite { row, time });
        }
        for (row, stated) in self.stated.rows.iter().enumerate() {
            let constraint = name(system, row);
            if ![stated.rate, stated.bias, self.stated.along(row, v)].iter().all(|x| x.is_finite()) {
                return Some(Error::EquationsNotFinite { row: constraint, time });
            }
            if self.stated.pattern.slopes(row).all(|slope| self.stated.slopes[slope] == T::constant(0.0)) {
                return Some(Error::NoGradient { constraint, time });
            }
        }
        let dependent = self.dependent(|ratio| doubt(ratio).is_finite());
        dependent.map(|row| Error::Dependent { constraint: name(system, row), time })
    }
}

/// Name of a constraint.
fn name<L: ManyBodies>(system: &L, row: usize) -> Row {
    Row::WrittenConstraint(WrittenName::of(|to| system.write_constraint_name(row, to)))
}
