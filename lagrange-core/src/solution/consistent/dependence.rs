//! Constraints that depend on one another to first order but not to second, as |a| = l, |b| = l and |a − b| =
//! 2l do.
//!
//! A combination Φ = Σ cₐΦₐ of such constraints has no gradient where they hold. If Φ vanishes for all nearby
//! states that satisfy the independent constraints, its second derivatives along the free directions vanish
//! too, and the motion is determined. Otherwise these directions are not free, although every first derivative
//! says so.

use super::level::{Level, Residual, check_level};
use crate::error::Error;
use crate::names::Names;
use crate::number::{Real, Scalar, larger, power_of_epsilon};
use crate::numerics::spread::spread;
use crate::solution::kkt::{Rank, Rows};
use crate::solution::limits::DIRECTIONS;
use crate::system::{Lagrangian, State, StateOf};
use crate::vector::{Array, Entrywise, StaticLength, Vector, zeros};

/// Smallest pivot above which dependence is not tested, ε^(1/4). Rows that are dependent up to the error of a
/// projection have smaller pivots.
pub(crate) fn least_pivot<T: Real>() -> T {
    power_of_epsilon(0.25)
}

/// Fails if a combination of satisfied holonomic constraints has no gradient but second derivatives along free
/// directions. The error names the constraints of the combination.
///
/// Second derivatives are taken along the remainders of the dependent rows, and along other free directions. A remainder is
/// s = H d, where d is the displacement from the states at which the rows are dependent. By Schwarz's inequality the form h
/// along it is at least |H d|²/(d·H d). So s²/(2h) is at most d·H d/2, the value of the combination at displacement d.
#[cold]
#[inline(never)]
pub(crate) fn check<L: Lagrangian<Scalar: Real>>(system: &L, state: &StateOf<L>) -> Result<(), Error> {
    if !Level::Position.concerns::<L>() || check_level(system, Level::Position, state).is_err() {
        return Ok(());
    }
    let residual = Residual::of(system, Level::Position, state);
    let rows =
        Rows::of(&system.mass_matrix(state).into(), &residual.jacobian, Rank::near_dependence(least_pivot()));
    let round_off = residual.negligible();
    let weight = |count: usize, k: usize| L::Scalar::constant(spread(count * (k + 1)));
    let directions = (1..=DIRECTIONS).filter_map(|count| rows.free_direction(|k| weight(count, k)));
    let found = rows.remainders().chain(directions).find_map(|direction| {
        rows.first_order_dependence(&second_derivatives(system, state, direction), &round_off)
    });
    match found {
        None => Ok(()),
        Some(parts) => {
            Err(Error::DependentToFirstOrder { constraints: involved::<L>(&parts), time: state.t.to_f64() })
        }
    }
}

/// Returns the second derivatives of the holonomic constraints along a direction of the coordinates: the part
/// of their bias γ that is even in the velocity, without its value at rest.
fn second_derivatives<L: Lagrangian<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
    direction: Vector<L::Scalar, L::N>,
) -> Array<L::Scalar, L::M> {
    let (zero, half) = (L::Scalar::constant(0.0), L::Scalar::constant(0.5));
    let bias = |v| system.constraint_bias(&State { t: state.t, q: state.q, v });
    let [ahead, back] = [direction, direction.negated()].map(bias);
    let rest = bias(zeros());
    let is_holonomic = |a: usize| Level::Position.is_active(L::CONSTRAINT_KINDS[a]);
    Array::from_fn(|a| if is_holonomic(a) { half * (ahead[a] + back[a]) - rest[a] } else { zero })
}

/// Returns the constraints whose coefficients exceed ε^(1/3) of the largest coefficient.
fn involved<L: Lagrangian<Scalar: Real>>(parts: &Array<L::Scalar, L::M>) -> Names {
    let sizes = parts.map(Scalar::abs);
    let least = sizes.iter().copied().fold(L::Scalar::constant(0.0), larger) * power_of_epsilon(1.0 / 3.0);
    (0..<L::M>::COUNT).filter(|&a| sizes[a] >= least).map(|a| L::CONSTRAINTS[a]).collect()
}
