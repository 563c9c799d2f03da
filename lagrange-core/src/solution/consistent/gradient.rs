//! Constraints whose gradient vanishes where they hold, as that of cos(a) = 1 does.
//!
//! The equations of motion know a constraint by its first derivatives. Where these are zero it is none, and where they are the
//! round-off of zero it is one that points anywhere.

use core::array::from_fn;

use super::level::Level;
use crate::error::Error;
use crate::names::name;
use crate::number::{Real, Scalar, entries, larger, power_of_epsilon};
use crate::solution::round_off::{SAFETY, neighbours};
use crate::system::{Lagrangian, State};

/// How far next to a state to look for whether a row is zero there, too.
const AROUND: f64 = 1.0 / 1024.0;

/// Fails with the first holonomic constraint that holds at this state, to round-off, and has no gradient there.
pub(crate) fn check<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
) -> Result<(), Error> {
    if !Level::Position.concerns::<L, N, M>() {
        return Ok(());
    }
    let vanishing = vanishing(system, state);
    let is_at_fault = |&a: &usize| holds(system, state, a) && is_felt(system, state, a);
    match (0..M).filter(|&a| vanishing[a]).find(is_at_fault) {
        None => Ok(()),
        Some(a) => Err(Error::NoGradient { constraint: name(&L::CONSTRAINTS, a), time: state.t.to_f64() }),
    }
}

/// Of which holonomic constraints no entry of the gradient is more than what ε^(3/4) of the coordinates makes of it: where what
/// is added to a coordinate is up to 1,000 times larger, round-off of the sum is less. A row that is there is so small only
/// next to a singular pose.
#[inline(never)]
fn vanishing<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
) -> [bool; M] {
    let zero = L::Scalar::constant(0.0);
    let here = Level::Position.jacobian(system, state);
    let mut noise = [[zero; N]; M];
    for nearby in neighbours(state, power_of_epsilon::<L::Scalar>(0.75).to_f64()) {
        let there = system.constraint_jacobian(&nearby);
        for a in 0..M {
            noise[a] = entries(|i| larger(noise[a][i], Scalar::abs(there[(a, i)] - here[a][i])));
        }
    }
    let safety = L::Scalar::constant(SAFETY);
    let is_active = |a: usize| Level::Position.is_active(L::CONSTRAINT_KINDS[a]);
    from_fn(|a| is_active(a) && (0..N).all(|i| Scalar::abs(here[a][i]) <= safety * noise[a][i]))
}

/// Whether the constraint holds within √ε of the coordinates: as its gradient vanishes, it is not known better.
fn holds<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    a: usize,
) -> bool {
    let value = system.constraint_residual(state)[a];
    let off = |nearby| Scalar::abs(system.constraint_residual(&nearby)[a] - value);
    let part = power_of_epsilon::<L::Scalar>(0.5).to_f64();
    let most = neighbours(state, part).map(off).fold(L::Scalar::constant(0.0), larger);
    Scalar::abs(value) <= L::Scalar::constant(SAFETY) * most
}

/// Whether the row is not zero all around, as of a constraint times a parameter that is zero.
fn is_felt<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    a: usize,
) -> bool {
    let aside = State { q: state.q.map(|q| q + L::Scalar::constant(AROUND)), ..*state };
    let is_zero =
        |state| system.constraint_jacobian(&state).row(a).iter().all(|x| *x == L::Scalar::constant(0.0));
    !neighbours(&aside, AROUND).all(is_zero)
}
