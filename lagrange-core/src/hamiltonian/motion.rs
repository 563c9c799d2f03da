//! A motion advanced step by step by Hamilton's equations.

use super::{Hamiltonian, HamiltonianVectorField, PhaseState};
use crate::error::Error;
use crate::motion::{Method, Motion};
use crate::number::Real;
use crate::system::Lagrangian;

impl<L, P> Motion<L, P, HamiltonianVectorField>
where
    L: Lagrangian<Scalar: Real>,
    P: Method<L, HamiltonianVectorField>,
{
    /// Starts a motion by Hamilton's equations at `phase`: the method integrates coordinates and momenta, and
    /// controls their errors.
    ///
    /// # Errors
    /// Those of [`legendre`](Hamiltonian::legendre), and those of [`Motion::new`] if the motion cannot start.
    pub fn in_momenta(system: L, phase: PhaseState<L::Scalar, L::N>, method: P) -> Result<Self, Error> {
        let state = system.legendre(&phase)?;
        Self::begin(system, &state, method)
    }
}
