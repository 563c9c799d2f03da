//! Equilibria and steady motions: states that satisfy the equations of motion with q̈ = 0.

mod point;
mod search;
mod steady;
mod weights;

use alloc::{string::String, vec::Vec};
use core::fmt::{self, Debug, Formatter};

use super::Linearized;
use super::argument::Argument;
use crate::error::Error;
use crate::number::Real;
use crate::numerics::newton;
use crate::solution::consistent::gradient::check_parameters;
use crate::solution::solve::solve;
use crate::system::finite::check_finite;
use crate::system::{Lagrangian, StateOf};
use crate::vector::{StaticLength, Vector};
use point::Point;
use search::EquilibriumSearch;

/// An equilibrium, or a steady motion.
#[derive(Clone)]
pub struct Equilibrium<L: Lagrangian> {
    /// The system, with the parameters that were found.
    pub system: L,
    /// The state. Time, and entries that were not among the unknowns, are those of the guess.
    pub state: StateOf<L>,
    /// Multipliers λ, with the sign of [`Solution`](crate::Solution): the constraint force on coordinate i is Σ_α λ_α
    /// F_αi. The unit is that of the generalized force divided by that of F: for Φ = 0 an energy per unit of Φ, for a
    /// velocity constraint a power per unit of F q̇.
    pub multipliers: Vector<L::Scalar, L::M>,
    /// Number of iterations.
    pub iterations: usize,
    undetermined: Vec<String>,
}

impl<L: Lagrangian> Equilibrium<L> {
    /// Names of the unknowns that can change, together and to first order, without leaving the equilibrium or steady
    /// motion: cyclic coordinates, and any unknowns beyond those that the equations determine. Their values are as near
    /// to the guess as the other unknowns allow.
    pub fn undetermined(&self) -> &[String] {
        &self.undetermined
    }
}

/// Leaves out the system, which need not implement `Debug`.
impl<L: Lagrangian> Debug for Equilibrium<L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct(L::NAME)
            .field("state", &self.state)
            .field("multipliers", &self.multipliers)
            .field("iterations", &self.iterations)
            .field("undetermined", &self.undetermined)
            .finish_non_exhaustive()
    }
}

/// See [`Linearized::equilibrium`].
pub(crate) fn equilibrium<L: Linearized<Scalar: Real> + Clone>(
    system: &L,
    guess: &StateOf<L>,
    names: &[&str],
) -> Result<Equilibrium<L>, Error> {
    check_finite(system, guess)?;
    check_parameters(system, guess)?;
    let unknowns = match names {
        [] => (0..<L::N>::COUNT).map(Argument::Coordinate).collect(),
        names => Argument::named::<L>(names)?,
    };
    let (mut balance, start) = EquilibriumSearch::start(system.clone(), guess, unknowns)?;
    let at_the_guess = start.point.unsteadiness()?;
    let (found, iterations) = newton::find(&mut balance, start)?;
    balance.check_resolved(&found, iterations)?;
    found.point.check_steady(&at_the_guess)?;
    let undetermined = balance.undetermined(&found)?;
    let Point { system, state, multipliers } = found.point;
    // For dependent constraints, take the multipliers of least norm. Where accelerations are undetermined, at a pole of
    // the coordinates, keep those of the search.
    let multipliers = solve(&system, &state).map_or(multipliers, |solution| solution.multipliers);
    Ok(Equilibrium { system, state, multipliers, iterations, undetermined })
}
