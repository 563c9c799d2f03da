//! A state next to the constraints, moved onto them by one factor: what a step does at its end.
//!
//! The corrections are those of the [general projection](super::consistent), least in the metric of the mass matrix, but
//! all solve with the matrix of the state as it is given (simplified Newton iteration: Hairer, Lubich and Wanner,
//! *Geometric Numerical Integration*, IV.4), and those of the coordinates follow the constraints on velocities too.
//! Lanes go together, and what becomes of one depends on no other.

use core::array::from_fn;

use nalgebra::SVector;

use super::consistent::Level;
use crate::number::{Real, Scalar, sum, vector};
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
///
/// `rest` is what rounding leaves of coordinates and velocities, before and after. It is rounded with the corrections: most of
/// these are less than a unit of round-off, and alone they are rounded to one side more often than to the other.
#[inline]
pub(crate) fn project<L, R, const N: usize, const M: usize>(
    system: &L,
    levels: &[Level],
    corrections: Corrections,
    mut state: State<L::Scalar, N>,
    rest: &mut [[L::Scalar; N]; 2],
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
            let (unknowns, rest) = (level.unknowns(&mut state), &mut rest[level as usize]);
            let x = (*unknowns).into();
            let (moved, left_over) = compensated(&x, &correction.accelerations.into(), rest);
            let chosen = |x: L::Scalar, moved| left.by_order(zero, x, x, moved);
            *unknowns = vector(from_fn(|i| chosen(x[i], moved[i])));
            *rest = from_fn(|i| chosen(rest[i], left_over[i]));
        };
        doubt = doubt + excess(&residual, &size, 16.0 * R::EPSILON);
    }
    (state, doubt)
}

/// The sum, and what rounding has left of it (Knuth, *The Art of Computer Programming*, 4.2.2, theorem B). What has been left
/// before is added last: the change may be as large as the sum, and would round it off.
#[inline(always)]
pub(crate) fn compensated<T: Scalar, const N: usize>(
    x: &[T; N],
    change: &[T; N],
    rest: &[T; N],
) -> ([T; N], [T; N]) {
    let sums: [[T; 2]; N] = from_fn(|i| {
        let [sum, left] = exact_sum(x[i], change[i]);
        exact_sum(sum, left + rest[i])
    });
    (sums.map(|[sum, _]| sum), sums.map(|[_, rest]| rest))
}

/// A sum as two numbers.
#[inline(always)]
fn exact_sum<T: Scalar>(x: T, y: T) -> [T; 2] {
    let sum = x + y;
    let added = sum - x;
    [sum, (x - (sum - added)) + (y - added)]
}

/// How many of these are more than this part of their size; no number where one is none.
#[inline]
fn excess<T: Scalar, const M: usize>(x: &SVector<T, M>, size: &SVector<T, M>, part: f64) -> T {
    let (zero, one) = (T::constant(0.0), T::constant(1.0));
    let excess = |x: T, size: T| x.abs().by_order(size * T::constant(part), zero, zero, one);
    sum(M, |a| excess(x[a], size[a]))
}
