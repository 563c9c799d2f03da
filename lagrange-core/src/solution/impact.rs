//! Impacts: jumps of the velocities when a constraint is hit.

use core::fmt::{self, Debug, Formatter};
use core::marker::PhantomData;

use nalgebra::{ComplexField, SVector};

use super::consistent::{Level, check_level};
use super::kkt::Rank;
use crate::error::Error;
use crate::number::{Real, Scalar};
use crate::solution::pivot::is_trustworthy;
use crate::solution::solve::solve_in_general;
use crate::system::finite::check_finite;
use crate::system::lookup::index;
use crate::system::{Lagrangian, State};

/// Result of an impact: [`Simulate::impact`](crate::Simulate::impact).
pub struct Impact<L: Lagrangian<N, M>, const N: usize, const M: usize> {
    /// State after the impact.
    pub state: State<L::Scalar, N>,
    /// Impulses Λ of the constraints, in the order written, with the sign of multipliers: the momenta jump by
    /// FᵀΛ.
    pub impulses: SVector<L::Scalar, M>,
    system: PhantomData<fn(&L)>,
}

impl<L: Lagrangian<N, M>, const N: usize, const M: usize> Impact<L, N, M> {
    /// Returns the impulse of the constraint of this name.
    ///
    /// # Errors
    /// [`Error::UnknownName`].
    pub fn impulse(&self, name: &str) -> Result<L::Scalar, Error> {
        Ok(self.impulses[index::<L, N, M>(&L::CONSTRAINTS, "constraint", name)?])
    }
}

/// Implements [`Simulate::impact`](crate::Simulate::impact); `hit` is the index of the constraint.
pub(crate) fn impact<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    hit: usize,
    restitution: L::Scalar,
) -> Result<Impact<L, N, M>, Error> {
    check_finite(system, state)?;
    if !(restitution.is_finite() && restitution >= L::Scalar::constant(0.0)) {
        return Err(Error::Restitution { value: restitution.to_f64() });
    }
    check_level(system, Level::Position, state)?;
    // F (v⁺ − v⁻) cancels the constraint rates before the impact, and reverses the rate of the constraint that
    // is hit.
    let mut rates = system.constraint_rate(state);
    rates[hit] *= L::Scalar::constant(1.0) + restitution;
    let no_force = SVector::from_element(L::Scalar::constant(0.0));
    let jump = system.solve_with(&system.factor(state), &no_force, &rates);
    let jump = match is_trustworthy(&jump) {
        true => jump,
        false => solve_in_general(system, state, (no_force, rates), &[true; M], Rank::on_constraints())?.0,
    };
    let state = State { v: state.v + jump.accelerations, ..*state };
    Ok(Impact { state, impulses: jump.multipliers, system: PhantomData })
}

impl<L: Lagrangian<N, M>, const N: usize, const M: usize> Debug for Impact<L, N, M> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Impact").field("state", &self.state).field("impulses", &self.impulses).finish()
    }
}
