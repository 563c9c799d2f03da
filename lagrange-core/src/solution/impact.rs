//! Impacts: jumps of the velocities when a constraint is hit.

use core::fmt::{self, Debug, Formatter};
use core::marker::PhantomData;

use nalgebra::ComplexField;

use super::consistent::{Level, check_level};
use super::kkt::Rank;
use crate::error::Error;
use crate::names::name;
use crate::number::{Real, Scalar};
use crate::solution::pivot::is_trustworthy;
use crate::solution::solve::solve_in_general;
use crate::system::finite::check_finite;
use crate::system::lookup::index;
use crate::system::{Lagrangian, State, StateOf};
use crate::vector::{Array, Entrywise, Vector, zeros};

/// Result of an impact: [`Simulate::impact`](crate::Simulate::impact).
pub struct Impact<L: Lagrangian> {
    /// State after the impact.
    pub state: StateOf<L>,
    /// Impulses Λ of the constraints, in the order written, with the sign of multipliers: the momenta jump by
    /// FᵀΛ.
    pub impulses: Vector<L::Scalar, L::M>,
    system: PhantomData<fn(&L)>,
}

impl<L: Lagrangian> Impact<L> {
    /// Returns the impulse of the constraint of this name.
    ///
    /// # Errors
    /// [`Error::UnknownName`].
    pub fn impulse(&self, name: &str) -> Result<L::Scalar, Error> {
        Ok(self.impulses[index::<L>(L::CONSTRAINTS, "constraint", name)?])
    }
}

/// Implements [`Simulate::impact`](crate::Simulate::impact); `hit` is the index of the constraint.
pub(crate) fn impact<L: Lagrangian<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
    hit: usize,
    restitution: L::Scalar,
) -> Result<Impact<L>, Error> {
    check_finite(system, state)?;
    if !(restitution.is_finite() && restitution >= L::Scalar::constant(0.0)) {
        let constraint = name(L::CONSTRAINTS, hit);
        return Err(Error::Restitution { constraint, value: restitution.to_f64() });
    }
    check_level(system, Level::Position, state)?;
    // F (v⁺ − v⁻) cancels the constraint rates before the impact, and reverses the rate of the constraint that
    // is hit.
    let mut rates = system.constraint_rate(state);
    rates[hit] *= L::Scalar::constant(1.0) + restitution;
    let no_force = zeros();
    let jump = system.solve_with(&system.factor(state), &no_force, &rates);
    let jump = match is_trustworthy(&jump) {
        true => jump,
        false => {
            solve_in_general(system, state, (no_force, rates), &Array::filled(true), Rank::on_constraints())?
                .0
        }
    };
    let state = State { v: state.v.plus(&jump.accelerations), ..*state };
    Ok(Impact { state, impulses: jump.multipliers, system: PhantomData })
}

impl<L: Lagrangian> Debug for Impact<L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Impact").field("state", &self.state).field("impulses", &self.impulses).finish()
    }
}
