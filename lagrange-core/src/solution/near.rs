//! A state next to the constraints, moved onto them by one factor: what a step does at its end.
//!
//! The corrections are those of the [general projection](super::consistent), least in the metric of the mass matrix, but
//! all solve with the matrix of the state as it is given (simplified Newton iteration: Hairer, Lubich and Wanner,
//! *Geometric Numerical Integration*, IV.4), and those of the coordinates follow the constraints on velocities too.
//! Lanes go together, and what becomes of one depends on no other.

use nalgebra::SVector;

use super::consistent::Level;
use crate::number::{Real, Scalar, sum};
use crate::system::{Lagrangian, State};

/// When a correction is made, and how many at most.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corrections {
    /// Where more is left than this part of the terms' size, in units of round-off.
    beyond: f64,
    most: usize,
}

/// From as far off as the error of a step one correction leads to round-off, as a rule.
pub(crate) const TO_ROUND_OFF: Corrections = Corrections { beyond: 4.0, most: 3 };
/// One whatever is left. What is small enough to be let pass is so for many steps in a row, and always the same: energy then
/// grows or dies as time goes on.
#[cfg(feature = "alloc")]
pub(crate) const ONCE: Corrections = Corrections { beyond: 0.0, most: 1 };

/// The state on the constraints of these levels, and a doubt: zero where it is there to round-off, lane by lane, in the
/// precision of `R`.
#[inline]
pub(crate) fn project<L, R, const N: usize, const M: usize>(
    system: &L,
    levels: &[Level],
    corrections: Corrections,
    mut state: State<L::Scalar, N>,
) -> (State<L::Scalar, N>, L::Scalar)
where
    L: Lagrangian<N, M>,
    R: Real,
{
    let zero = L::Scalar::constant(0.0);
    let (factor, mut doubt) = (system.factor(&state), zero);
    for &level in levels.iter().filter(|level| level.concerns::<L, N, M>()) {
        let size = level.magnitude(system, &state);
        let mut rounds = 0..corrections.most;
        // Evaluated in one place: it is inlined.
        let residual = loop {
            let residual = level.residual(system, &state);
            let left = excess(&residual, &size, corrections.beyond * R::EPSILON);
            if left == zero || rounds.next().is_none() {
                break residual;
            }
            // Where the factor cannot be vouched for, that is no number, nor is what is left then.
            let correction = system.solve_with(&factor, &SVector::from_element(zero), &residual);
            // A lane that is there stays as it is, be the others where they are.
            let unknowns = level.unknowns(&mut state);
            let moved = |x: L::Scalar, change| left.by_order(zero, x, x, x + change);
            *unknowns = unknowns.zip_map(&correction.accelerations, moved);
        };
        doubt = doubt + excess(&residual, &size, 16.0 * R::EPSILON);
    }
    (state, doubt)
}

/// How many of these are more than this part of their size; no number where one is none.
#[inline]
fn excess<T: Scalar, const M: usize>(x: &SVector<T, M>, size: &SVector<T, M>, part: f64) -> T {
    let (zero, one) = (T::constant(0.0), T::constant(1.0));
    let excess = |x: T, size: T| x.abs().by_order(size * T::constant(part), zero, zero, one);
    sum(M, |a| excess(x[a], size[a]))
}
