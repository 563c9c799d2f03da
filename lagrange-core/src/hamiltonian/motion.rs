//! A steered motion by Hamilton's equations.

use super::{Hamiltonian, HamiltonianVectorField, PhaseState};
use crate::error::Error;
use crate::motion::{Method, Motion};
use crate::number::Real;
use crate::system::Lagrangian;

impl<L, P, const N: usize, const M: usize> Motion<L, P, N, M, HamiltonianVectorField>
where
    L: Lagrangian<N, M, Scalar: Real>,
    P: Method<L, N, M, HamiltonianVectorField>,
{
    /// A motion by Hamilton's equations from this phase state on: the method adds up and controls coordinates and momenta.
    ///
    /// # Errors
    /// As [`legendre`](Hamiltonian::legendre), and as [`Motion::new`] where it does not start.
    pub fn in_momenta(system: L, phase: PhaseState<L::Scalar, N>, method: P) -> Result<Self, Error> {
        let state = system.legendre(&phase)?;
        Self::begin(system, &state, method)
    }
}
