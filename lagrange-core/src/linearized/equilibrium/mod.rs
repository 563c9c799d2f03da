//! Equilibria and steady motions: where the equations of motion hold with q̈ = 0.

mod point;
mod search;
mod steady;
mod weights;

use alloc::{string::String, vec::Vec};
use core::fmt::{self, Debug, Formatter};

use nalgebra::SVector;

use super::Linearized;
use super::argument::Argument;
use crate::error::Error;
use crate::number::Real;
use crate::solution::newton;
use crate::solution::solve::solve;
use crate::system::finite::check_finite;
use crate::system::{Lagrangian, State};
use point::Point;
use search::EquilibriumSearch;

/// An equilibrium, or a steady motion.
#[derive(Clone)]
pub struct Equilibrium<L: Lagrangian<N, M>, const N: usize, const M: usize> {
    /// The system, its parameters as they were found.
    pub system: L,
    /// The state; its time is that of the guess, and so is what was not sought.
    pub state: State<L::Scalar, N>,
    /// The multipliers λ there, with the sign of [`Solution`](crate::Solution): the constraint force on coordinate i is
    /// Σ_α λ_α F_αi. The unit is that of the generalized force by that of F: for Φ = 0 an energy per unit of Φ, for a
    /// velocity constraint a power per unit of F q̇.
    pub multipliers: SVector<L::Scalar, M>,
    /// Steps taken.
    pub iterations: usize,
    undetermined: Vec<String>,
}

impl<L: Lagrangian<N, M>, const N: usize, const M: usize> Equilibrium<L, N, M> {
    /// What was sought and can change, together, and leave it an equilibrium or a steady motion: cyclic coordinates, to
    /// first order, and whatever is more than the equations determine. They are as near to the guess as the others
    /// allow.
    pub fn undetermined(&self) -> &[String] {
        &self.undetermined
    }
}

/// Without the system, which need not have it.
impl<L: Lagrangian<N, M>, const N: usize, const M: usize> Debug for Equilibrium<L, N, M> {
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
pub(super) fn equilibrium<L, const N: usize, const M: usize, const P: usize>(
    system: &L,
    guess: &State<L::Scalar, N>,
    names: &[&str],
) -> Result<Equilibrium<L, N, M>, Error>
where
    L: Linearized<N, M, P, Scalar: Real> + Clone,
{
    check_finite(system, guess)?;
    let unknowns = match names {
        [] => (0..N).map(Argument::Coordinate).collect(),
        names => Argument::named::<L, N, M, P>(names)?,
    };
    let (mut balance, start) = EquilibriumSearch::start(system.clone(), guess, unknowns)?;
    let at_the_guess = start.point.unsteadiness()?;
    let (found, iterations) = newton::find(&mut balance, start)?;
    balance.check_resolved(&found, iterations)?;
    found.point.check_steady(&at_the_guess)?;
    let undetermined = balance.undetermined(&found)?;
    let Point { system, state, multipliers } = found.point;
    // Of dependent constraints the multipliers of least norm; at a pole, where accelerations are undetermined, those found.
    let multipliers = solve(&system, &state).map_or(multipliers, |solution| solution.multipliers);
    Ok(Equilibrium { system, state, multipliers, iterations, undetermined })
}
