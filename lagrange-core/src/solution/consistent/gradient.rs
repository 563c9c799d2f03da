//! Holonomic constraints whose gradient vanishes where they hold, as for cos(a) = 1.
//!
//! The equations of motion contain only the first derivatives of a constraint. If these vanish, the constraint
//! has no effect; if they are the round-off of zero, it acts in an arbitrary direction. The parameters alone may cancel
//! them, too: across the plane of a linkage that two bases turn by equal angles, one constraint is round-off at every pose.

use super::level::Level;
use crate::error::Error;
use crate::names::{Row, name};
use crate::number::limits::SUM;
use crate::number::{Real, Scalar, larger, power_of_epsilon};
use crate::solution::limits::{ASIDE, MARGIN};
use crate::solution::round_off::neighbours;
use crate::system::{Lagrangian, State, StateOf};
use crate::vector::{Array, Entrywise, StaticLength, from_fn};

/// Fails if a holonomic constraint holds at this state, to round-off, but has no gradient there. The error
/// names the first one.
pub(crate) fn check<L: Lagrangian<Scalar: Real>>(system: &L, state: &StateOf<L>) -> Result<(), Error> {
    check_parameters(system, state)?;
    if !Level::Position.concerns::<L>() {
        return Ok(());
    }
    let vanishing = vanishing(system, state);
    let is_at_fault = |&a: &usize| holds(system, state, a) && is_felt(system, state, a);
    match (0..<L::M>::COUNT).filter(|&a| vanishing[a]).find(is_at_fault) {
        None => Ok(()),
        Some(a) => {
            let constraint = Row::Constraint(name(L::CONSTRAINTS, a));
            Err(Error::NoGradient { constraint, time: state.t.to_f64() })
        }
    }
}

/// Fails if the row of a constraint is nonzero, but within its rounding errors, which the parameters cause. The error
/// names the first one. In 10⁵ random linkages whose planes agree, no entry across the plane exceeded a quarter of the bound.
pub(crate) fn check_parameters<L: Lagrangian<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
) -> Result<(), Error> {
    let (zero, bounds) = (L::Scalar::constant(0.0), system.jacobian_round_off(state));
    if bounds.iter().all(|bound| *bound == zero) {
        return Ok(());
    }
    let (rows, least) = (system.constraint_jacobian(state), L::Scalar::constant(SUM * L::Scalar::EPSILON));
    let is_nothing = |&a: &usize| {
        let entries = || (0..<L::N>::COUNT).map(|i| (Scalar::abs(rows[(a, i)]), least * bounds[(a, i)]));
        entries().all(|(entry, least)| entry <= least) && entries().any(|(entry, _)| entry > zero)
    };
    match (0..<L::M>::COUNT).find(is_nothing) {
        None => Ok(()),
        Some(a) => {
            let constraint = Row::Constraint(name(L::CONSTRAINTS, a));
            Err(Error::NoGradient { constraint, time: state.t.to_f64() })
        }
    }
}

/// Returns true for each holonomic constraint whose gradient is negligible: no entry exceeds [`MARGIN`] times
/// its change when the coordinates change by ε^(3/4). If a constraint adds a number up to 1,000 times larger to
/// a coordinate, the round-off of that sum is still smaller. The gradient of an effective constraint is this
/// small only next to a singular pose.
#[inline(never)]
fn vanishing<L: Lagrangian<Scalar: Real>>(system: &L, state: &StateOf<L>) -> Array<bool, L::M> {
    let zero = L::Scalar::constant(0.0);
    let here = Level::Position.jacobian(system, state);
    let mut noise: Array<Array<_, L::N>, L::M> = Array::filled(Array::filled(zero));
    for nearby in neighbours(state, state, power_of_epsilon::<L::Scalar>(0.75).to_f64()) {
        let there = system.constraint_jacobian(&nearby);
        for a in 0..<L::M>::COUNT {
            noise[a] = Array::from_fn(|i| larger(noise[a][i], Scalar::abs(there[(a, i)] - here[a][i])));
        }
    }
    let safety = L::Scalar::constant(MARGIN);
    let is_active = |a: usize| Level::Position.is_active(L::CONSTRAINT_KINDS[a]);
    from_fn(|a| is_active(a) && (0..<L::N>::COUNT).all(|i| Scalar::abs(here[a][i]) <= safety * noise[a][i]))
}

/// True if the constraint holds to within a change of the coordinates by √ε: where the gradient vanishes,
/// round-off hides smaller differences.
fn holds<L: Lagrangian<Scalar: Real>>(system: &L, state: &StateOf<L>, a: usize) -> bool {
    let value = system.constraint_residual(state)[a];
    let off = |nearby| Scalar::abs(system.constraint_residual(&nearby)[a] - value);
    let part = power_of_epsilon::<L::Scalar>(0.5).to_f64();
    let most = neighbours(state, state, part).map(off).fold(L::Scalar::constant(0.0), larger);
    Scalar::abs(value) <= L::Scalar::constant(MARGIN) * most
}

/// True if the gradient of constraint `a` is nonzero at a nearby state. A constraint multiplied by a zero parameter
/// has no gradient anywhere, and no effect.
fn is_felt<L: Lagrangian<Scalar: Real>>(system: &L, state: &StateOf<L>, a: usize) -> bool {
    let aside = State { q: state.q.each(|q| q + L::Scalar::constant(ASIDE)), ..*state };
    let is_zero =
        |state| system.constraint_jacobian(&state).row(a).iter().all(|x| *x == L::Scalar::constant(0.0));
    !neighbours(&aside, &aside, ASIDE).all(is_zero)
}
