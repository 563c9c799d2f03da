//! A state next to the constraints, moved onto them by one factor: what a step does at its end.
//!
//! The corrections are those of the [general projection](super::consistent), least in the metric of the mass matrix, but
//! all solve with the matrix of the state as it is given (simplified Newton iteration: Hairer, Lubich and Wanner,
//! *Geometric Numerical Integration*, IV.4), and those of the coordinates follow the constraints on velocities too.
//! Lanes go together, and what becomes of one depends on no other.

#[cfg(test)]
mod tests;

use core::array::from_fn;

use nalgebra::SVector;

use super::consistent::level::Level;
use crate::number::{Real, Scalar, sum, vector};
use crate::system::{Lagrangian, Solution, State};

/// How a state is corrected: when, how often, and whether its velocities follow its coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Corrections<T> {
    /// Where more is left than four units of round-off, at most three. From as far off as the error of a step one leads
    /// there, as a rule.
    ToRoundOff,
    /// One after this step, whatever is left: what is small enough to be let pass is so for many steps in a row, and always
    /// the same, by which energy grows or dies. Velocities follow the coordinates.
    #[cfg_attr(not(feature = "alloc"), expect(dead_code, reason = "of a method that allocates"))]
    OnceAfter(T),
}

impl<T: Scalar> Corrections<T> {
    fn most(self) -> usize {
        match self {
            Self::ToRoundOff => 3,
            Self::OnceAfter(_) => 1,
        }
    }

    /// Whether one is to be made, lane by lane: zero where not.
    #[inline(always)]
    fn wanted<const M: usize>(self, residual: &SVector<T, M>, size: &SVector<T, M>, epsilon: f64) -> T {
        match self {
            Self::ToRoundOff => excess(residual, size, 4.0 * epsilon),
            Self::OnceAfter(_) => T::constant(1.0),
        }
    }
}

/// The state on the constraints of these levels, and a doubt: zero where it is there to round-off, lane by lane, in the
/// precision of `R`.
///
/// `rest` is what rounding leaves of coordinates and velocities, before and after. It is rounded with the corrections: most of
/// these are less than a unit of round-off, and alone they are rounded to one side more often than to the other.
#[inline]
pub(crate) fn project<L, R, const N: usize, const M: usize>(
    system: &L,
    levels: &[Level],
    corrections: Corrections<L::Scalar>,
    mut state: State<L::Scalar, N>,
    rest: &mut [[L::Scalar; N]; 2],
) -> (State<L::Scalar, N>, L::Scalar)
where
    L: Lagrangian<N, M>,
    R: Real,
{
    let zero = L::Scalar::constant(0.0);
    let (factor, mut doubt) = (system.factor(&state), zero);
    let mut follow = vector([zero; N]);
    for &level in levels.iter().filter(|level| level.concerns::<L, N, M>()) {
        let size = level.magnitude(system, &state);
        let mut rounds = 0..corrections.most();
        // Evaluated in one place: it is inlined.
        let residual = loop {
            let residual = level.residual(system, &state);
            let wanted = corrections.wanted(&residual, &size, R::EPSILON);
            if wanted == zero || rounds.next().is_none() {
                break residual;
            }
            // Where the factor cannot be vouched for, that is no number, nor is what is left then.
            let correction = system.solve_with(&factor, &follow, &residual);
            if let (Level::Position, Corrections::OnceAfter(step)) = (level, corrections) {
                follow = following::<L, R, N, M>(system, &state, &correction, step);
            }
            // A lane that is there stays as it is, be the others where they are.
            let (unknowns, rest) = (level.unknowns(&mut state), &mut rest[level as usize]);
            let x: [_; N] = (*unknowns).into();
            let moved: [_; N] = from_fn(|i| exact_sum(x[i], correction.accelerations[i] + rest[i]));
            let chosen = |x: L::Scalar, moved| wanted.select_by_order(zero, x, x, moved);
            *unknowns = vector(from_fn(|i| chosen(x[i], moved[i][0])));
            *rest = from_fn(|i| chosen(rest[i], moved[i][1]));
        };
        doubt = doubt + excess(&residual, &size, 16.0 * R::EPSILON);
    }
    (state, doubt)
}

/// The impulse by which velocities follow a correction w = M⁻¹Fᵀμ of the coordinates: Ṁw − Ḟᵀμ + 2 h₂(q̇, w), where h₂ is the part
/// of h that is quadratic in velocities.
///
/// With it coordinates and momenta move along the Hamiltonian vector fields of μᵀΦ̇ and of the constraints. These fields are
/// orthogonal, in the symplectic form, to every motion on the constraints (Hairer, Lubich and Wanner, *Geometric Numerical Integration*, VII.1): a
/// correction that is made to the same side step by step, as of a body that keeps its distance, leaves its angular momentum
/// and energy as they were. Velocities that stay as they are would lose or gain with each. Forces that are linear in
/// velocities, of magnetic fields and of damping, are left out: a strong field makes of the round-off of coordinates many units
/// of that of velocities.
///
/// Differences over a part of the step give it to a thousandth of itself. Velocities do not follow corrections of more than
/// 1,024 units of round-off, as next to dependent constraints, nor in steps of less than a 16th of the coordinates' size: rates
/// are at most about 3 in a step, so that velocities change by no more than 50 times the part that coordinates do.
#[inline(always)]
fn following<L, R, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    correction: &Solution<L::Scalar, N, M>,
    step: L::Scalar,
) -> SVector<L::Scalar, N>
where
    L: Lagrangian<N, M>,
    R: Real,
{
    let number = L::Scalar::constant;
    let size = |x: &SVector<L::Scalar, N>| x.iter().fold(number(0.0), |most, x| most.max(x.abs()));
    let (State { t, q, v }, part) = (state, step * number(1.0 / 1024.0));
    // A unit of round-off as a 64th, so that little is rounded off: all of this is linear in the correction.
    let scale = 1.0 / (64.0 * R::EPSILON);
    let w = correction.accelerations.map(|w| w * number(scale));
    let multipliers = correction.multipliers.map(|mu| mu * number(scale));
    let there = |v| State { t: *t + part, q: q.zip_map(&state.v, |q, v| q + v * part), v };
    let at_rest = vector([number(0.0); N]);
    let back_a_part = w.map(|w| -w * part);
    let slower = v.zip_map(&back_a_part, |v, change| v + change);
    let forces = |v, w: &_, multipliers: &_| system.inverse_dynamics(&there(v), w, multipliers);
    let with = forces(slower, &w, &multipliers);
    let [without, of_change, of_none] =
        [*v, back_a_part, at_rest].map(|v| forces(v, &at_rest, &vector([number(0.0); M])));
    let (coordinates, way) = (size(q), step.abs() * size(v));
    let back = number(1.0 / scale) / part;
    let back = size(&w).select_by_order((coordinates + way) * number(16.0), back, back, number(0.0));
    let back = way.select_by_order(coordinates * number(1.0 / 16.0), number(0.0), number(0.0), back);
    let impulse = |i: usize| ((with[i] - without[i]) - (of_change[i] - of_none[i])) * back;
    // Forces may be NaN at rest, as friction has no direction there. `max` replaces NaN by zero.
    let number_or_zero = |x: L::Scalar| x.max(number(0.0)) - (-x).max(number(0.0));
    vector(from_fn(|i| number_or_zero(impulse(i))))
}

/// A sum as two numbers: itself, and what rounding has left of it (Knuth, *The Art of Computer Programming*, 4.2.2, theorem B).
#[inline(always)]
pub(crate) fn exact_sum<T: Scalar>(x: T, y: T) -> [T; 2] {
    let sum = x + y;
    let added = sum - x;
    [sum, (x - (sum - added)) + (y - added)]
}

/// How many of these are more than this part of their size; no number where one is none.
#[inline]
fn excess<T: Scalar, const M: usize>(x: &SVector<T, M>, size: &SVector<T, M>, part: f64) -> T {
    let (zero, one) = (T::constant(0.0), T::constant(1.0));
    let excess = |x: T, size: T| x.abs().select_by_order(size * T::constant(part), zero, zero, one);
    sum(M, |a| excess(x[a], size[a]))
}
