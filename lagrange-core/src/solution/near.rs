//! Projection of a state near the constraints with a single factorization, at the end of each step.
//!
//! The corrections are those of the [general projection](super::consistent), least in the metric of the mass
//! matrix, but all use the matrix of the given state (simplified Newton iteration: Hairer, Lubich and Wanner,
//! *Geometric Numerical Integration*, IV.4). Corrections of the coordinates follow the constraints on
//! velocities too. Lanes are projected together, but the result of each lane is independent of the others.

#[cfg(test)]
mod tests;

use super::consistent::level::Level;
use crate::number::limits::{ACCUMULATED, CANCELLED, SUM};
use crate::number::{Real, Scalar, sum};
use crate::solution::limits::{ASIDE, CORRECTIONS, FOLLOWED};
use crate::system::{Lagrangian, SolutionOf, State, StateOf};
use crate::vector::{Array, Entrywise, StaticLength, Vector, from_fn, vector, zeros};

/// Strategy of the corrections: when and how often to correct, and whether a correction of the coordinates
/// also changes the velocities.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Corrections<T> {
    /// Correct each level up to three times, until its residual is at most 4 ε of its terms. After an integration
    /// step, one correction usually suffices.
    ToRoundOff,
    /// One correction at the end of an integration step of this length, however small the residual. A
    /// threshold would ignore small residuals of the same sign for many steps in a row, which makes the
    /// energy drift. A correction of the coordinates also changes the velocities.
    OnceAfter(T),
}

impl<T: Scalar> Corrections<T> {
    fn most(self) -> usize {
        match self {
            Self::ToRoundOff => CORRECTIONS,
            Self::OnceAfter(_) => 1,
        }
    }

    /// Tells, lane by lane, whether a correction is needed: zero if not.
    #[inline(always)]
    fn wanted<M: StaticLength>(self, residual: &Vector<T, M>, size: &Vector<T, M>, epsilon: f64) -> T {
        match self {
            Self::ToRoundOff => excess(residual, size, SUM * epsilon),
            Self::OnceAfter(_) => T::constant(1.0),
        }
    }
}

/// Returns the state projected onto the constraints of these levels. The second result is zero, lane by lane,
/// if the projection reached round-off in the precision of `R`.
///
/// `rest` holds the rounding errors of coordinates and velocities, before and after. They are added to the
/// corrections before rounding: most corrections are below a unit of round-off, and alone they would be rounded
/// to one side more often than to the other.
#[inline]
pub(crate) fn project<L: Lagrangian, R: Real>(
    system: &L,
    levels: &[Level],
    corrections: Corrections<L::Scalar>,
    mut state: StateOf<L>,
    rest: &mut [Array<L::Scalar, L::N>; 2],
) -> (StateOf<L>, L::Scalar) {
    let zero = L::Scalar::constant(0.0);
    let (factor, mut doubt) = (system.factor(&state), zero);
    let mut follow = zeros();
    for &level in levels.iter().filter(|level| level.concerns::<L>()) {
        let size = level.magnitude(system, &state);
        let mut rounds = 0..corrections.most();
        // Evaluated in one place, since it is inlined.
        let residual = loop {
            let residual = level.residual(system, &state);
            let wanted = corrections.wanted(&residual, &size, R::EPSILON);
            if wanted == zero || rounds.next().is_none() {
                break residual;
            }
            // An unreliable factorization gives NaN, and so does the residual after it.
            let correction = system.solve_with(&factor, &follow, &residual);
            if let (Level::Position, Corrections::OnceAfter(step)) = (level, corrections) {
                follow = following::<L, R>(system, &state, &correction, step);
            }
            // A lane that has converged keeps its state while other lanes continue.
            let (unknowns, rest) = (level.unknowns(&mut state), &mut rest[level as usize]);
            let x: Array<_, L::N> = (*unknowns).into();
            let moved: Array<_, L::N> = from_fn(|i| exact_sum(x[i], correction.accelerations[i] + rest[i]));
            let chosen = |x: L::Scalar, moved| wanted.select_by_order(zero, x, x, moved);
            *unknowns = vector(from_fn(|i| chosen(x[i], moved[i][0])));
            *rest = from_fn(|i| chosen(rest[i], moved[i][1]));
        };
        doubt = doubt + excess(&residual, &size, CANCELLED * R::EPSILON);
    }
    (state, doubt)
}

/// Impulse by which the velocities follow a correction w = M⁻¹Fᵀμ of the coordinates: Ṁw − Ḟᵀμ + 2 h₂(q̇, w),
/// where h₂ is the part of h that is quadratic in the velocities.
///
/// With this impulse, coordinates and momenta move along the Hamiltonian vector fields of μᵀΦ̇ and of the
/// constraints. These fields are orthogonal, in the symplectic form, to every motion on the constraints
/// (Hairer, Lubich and Wanner, *Geometric Numerical Integration*, VII.1). Corrections to the same side in every
/// step, as for a body at constant distance, then preserve its angular momentum and energy. If the velocities
/// stayed the same, each correction would change both. Forces linear in the velocities, of magnetic fields and
/// of damping, are left out: a strong field would amplify the round-off of coordinates to many units of that of
/// velocities.
///
/// Differences over a small part of the step give the impulse ([`ASIDE`]). Velocities do not follow large corrections, nor
/// those of short steps ([`FOLLOWED`]).
#[inline(always)]
fn following<L: Lagrangian, R: Real>(
    system: &L,
    state: &StateOf<L>,
    correction: &SolutionOf<L>,
    step: L::Scalar,
) -> Vector<L::Scalar, L::N> {
    let number = L::Scalar::constant;
    let size = |x: &Vector<L::Scalar, L::N>| x.iter().fold(number(0.0), |most, x| most.max(x.abs()));
    let (State { t, q, v }, part) = (state, step * number(ASIDE));
    // Scales a unit of round-off to 1/64, so that little is rounded off: the result is linear in the
    // correction.
    let scale = 1.0 / (ACCUMULATED * R::EPSILON);
    let w = correction.accelerations.each(|w| w * number(scale));
    let multipliers = correction.multipliers.each(|mu| mu * number(scale));
    let there = |v| State { t: *t + part, q: q.each_with(&state.v, |q, v| q + v * part), v };
    let at_rest = zeros();
    let back_a_part = w.each(|w| -w * part);
    let slower = v.each_with(&back_a_part, |v, change| v + change);
    let forces = |v, w: &_, multipliers: &_| system.inverse_dynamics(&there(v), w, multipliers);
    let with = forces(slower, &w, &multipliers);
    let [without, of_change, of_none] = [*v, back_a_part, at_rest].map(|v| forces(v, &at_rest, &zeros()));
    let (coordinates, way) = (size(q), step.abs() * size(v));
    let back = number(1.0 / scale) / part;
    let back = size(&w).select_by_order((coordinates + way) * number(FOLLOWED), back, back, number(0.0));
    let back = way.select_by_order(coordinates * number(1.0 / FOLLOWED), number(0.0), number(0.0), back);
    let impulse = |i: usize| ((with[i] - without[i]) - (of_change[i] - of_none[i])) * back;
    // Forces may be NaN at rest, as friction has no direction there. `max` replaces NaN by zero.
    let number_or_zero = |x: L::Scalar| x.max(number(0.0)) - (-x).max(number(0.0));
    vector(from_fn(|i| number_or_zero(impulse(i))))
}

/// Returns a sum and its rounding error (Knuth, *The Art of Computer Programming*, 4.2.2, theorem B).
#[inline(always)]
pub(crate) fn exact_sum<T: Scalar>(x: T, y: T) -> [T; 2] {
    let sum = x + y;
    let added = sum - x;
    [sum, (x - (sum - added)) + (y - added)]
}

/// Compensated sum: x + change, and its rounding error. The old rounding error `rest` is added last: the change may be
/// as large as the sum, and would absorb it.
#[inline(always)]
pub(crate) fn compensated<T: Scalar, N: StaticLength>(
    x: &Array<T, N>,
    change: &Array<T, N>,
    rest: &Array<T, N>,
) -> (Array<T, N>, Array<T, N>) {
    let sums: Array<[T; 2], N> = from_fn(|i| {
        let [sum, left] = exact_sum(x[i], change[i]);
        exact_sum(sum, left + rest[i])
    });
    (sums.map(|[sum, _]| sum), sums.map(|[_, rest]| rest))
}

/// Counts the entries above `part` of their size; NaN if an entry is NaN.
#[inline]
fn excess<T: Scalar, M: StaticLength>(x: &Vector<T, M>, size: &Vector<T, M>, part: f64) -> T {
    let (zero, one) = (T::constant(0.0), T::constant(1.0));
    let excess = |x: T, size: T| x.abs().select_by_order(size * T::constant(part), zero, zero, one);
    sum(M::COUNT, |a| excess(x[a], size[a]))
}
