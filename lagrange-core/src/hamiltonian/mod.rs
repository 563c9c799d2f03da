//! The Hamiltonian side of a system: momenta instead of velocities.

mod legendre;
mod motion;
mod phase;
#[cfg(test)]
mod tests;
mod vector_field;

use nalgebra::SVector;

pub use phase::{PhaseDerivative, PhaseState};
pub use vector_field::HamiltonianVectorField;

use crate::error::Error;
#[cfg(feature = "alloc")]
use crate::motion::{
    Method,
    builder::{MotionBuilder, MotionFrom, Start},
};
use crate::names::Entry;
use crate::number::{Real, Scalar};
use crate::system::finite::check_entries;
use crate::system::{Lagrangian, State};
#[cfg(feature = "alloc")]
use crate::trajectory::Trajectory;
use phase::equations;

/// The Legendre transform, the Hamiltonian and Hamilton's equations with constraints: every [`Lagrangian`] over
/// `f64` or `f32` has them.
///
/// The velocity that belongs to (t, q, p) is the one on the constraints, F q̇ + b = 0, whose momenta ∂L/∂q̇ differ from p
/// by no more than a part Fᵀμ along the constraints: such a part does no work on any motion allowed. So
/// ∂²L/∂q̇² may be singular where the constraints make up for it (unit quaternions, massless coordinates). Where L is
/// quadratic in q̇ the transform is closed, elsewhere Newton's iteration. Where L is not convex in q̇ several velocities may have the same
/// momenta: a phase state then stands for the one that the iteration finds from rest, and [`legendre_near`](Self::legendre_near) finds others.
///
/// ```
/// use lagrange_core::prelude::*;
///
/// /// A free relativistic particle; H = √(m²c⁴ + p²c²).
/// #[derive(Lagrangian)]
/// #[coordinates(x)]
/// #[lagrangian(-m*c^2 * sqrt(1 - x_dot^2/c^2))]
/// struct Particle { m: f64, c: f64 }
///
/// let particle = Particle { m: 1.0, c: 1.0 };
/// let phase = PhaseState::new([0.0], [0.75]);
/// assert!((particle.legendre(&phase)?.v[0] - 0.6).abs() < 1e-15);
/// assert!((particle.hamiltonian(&phase)? - 1.25).abs() < 1e-15);
/// # #[cfg(feature = "alloc")] {
/// let path = particle.motion_in_momenta(phase).to(10.0)?;
/// assert!((path.end().coordinate("x")? - 6.0).abs() < 1e-12);
/// assert!((path.end().momentum("x")? - 0.75).abs() < 1e-15);
/// # }
/// # Ok::<(), Error>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no Hamiltonian side",
    label = "not a Lagrangian system over `f64` or `f32`",
    note = "`#[derive(Lagrangian)]` gives it to every struct over `f64` or `f32`: the Legendre transform has to decide, which SIMD lanes and dual numbers cannot"
)]
pub trait Hamiltonian<const N: usize, const M: usize>: Lagrangian<N, M, Scalar: Real> + Sized {
    /// The momenta p = ∂L/∂q̇ of a state.
    fn phase_state(&self, state: &State<Self::Scalar, N>) -> PhaseState<Self::Scalar, N> {
        PhaseState { t: state.t, q: state.q, p: self.momentum(state) }
    }

    /// The velocities of a phase state: the Legendre transform q̇(t, q, p), sought from rest.
    ///
    /// # Errors
    /// [`Error::StateNotFinite`]; [`Error::EquationsNotFinite`]; [`Error::VelocityUndetermined`] where ∂²L/∂q̇² is
    /// singular along the constraints; [`Error::MomentumNotReached`] where Newton's iteration does not get there;
    /// [`Error::Contradictory`] where dependent constraints demand different velocities.
    fn legendre(&self, phase: &PhaseState<Self::Scalar, N>) -> Result<State<Self::Scalar, N>, Error> {
        self.legendre_near(phase, &SVector::from([Self::Scalar::constant(0.0); N]))
    }

    /// The same, sought from this velocity on: for a Lagrangian that is singular at rest, or one with several
    /// velocities to the same momenta.
    ///
    /// # Errors
    /// As [`legendre`](Self::legendre).
    fn legendre_near(
        &self,
        phase: &PhaseState<Self::Scalar, N>,
        velocity: &SVector<Self::Scalar, N>,
    ) -> Result<State<Self::Scalar, N>, Error> {
        check_entries(self, phase.t, [&phase.q, &phase.p], Entry::Momentum)?;
        legendre::invert(self, phase, &(*velocity).into(), None)
    }

    /// The Hamiltonian H(t, q, p) = p·q̇ − L at the q̇ of [`legendre`](Self::legendre); its value is the energy.
    ///
    /// # Errors
    /// As [`legendre`](Self::legendre).
    fn hamiltonian(&self, phase: &PhaseState<Self::Scalar, N>) -> Result<Self::Scalar, Error> {
        let state = self.legendre(phase)?;
        Ok(phase.p.dot(&state.v) - self.lagrangian(&state))
    }

    /// Hamilton's equations with constraints: q̇ = ∂H/∂p and ṗ = ∂L/∂q + Q + Fᵀλ, with the λ of
    /// [`solve`](crate::Simulate::solve). Without constraints and forces ṗ = −∂H/∂q.
    ///
    /// # Errors
    /// As [`legendre`](Self::legendre) and [`solve`](crate::Simulate::solve).
    fn hamilton_equations(
        &self,
        phase: &PhaseState<Self::Scalar, N>,
    ) -> Result<PhaseDerivative<Self::Scalar, N, M>, Error> {
        let state = self.legendre(phase)?;
        equations(self, &state, None).map(|(rate, ..)| rate)
    }

    /// The motion from a phase state to the time `end` by Hamilton's equations: as
    /// [`integrate`](crate::Simulate::integrate), but the method adds up and controls coordinates and momenta.
    ///
    /// # Errors
    /// As [`integrate`](crate::Simulate::integrate) and [`legendre`](Self::legendre).
    #[cfg(feature = "alloc")]
    fn integrate_hamiltonian<P: Method<Self, N, M, HamiltonianVectorField>>(
        &self,
        phase: PhaseState<Self::Scalar, N>,
        end: Self::Scalar,
        method: P,
    ) -> Result<Trajectory<&Self, N, M, HamiltonianVectorField>, Error> {
        self.motion_in_momenta(phase).by(method).to(end)
    }

    /// The settings of a motion by Hamilton's equations from a phase state: events and the rest are chosen as for
    /// [`motion`](crate::Simulate::motion). The method integrates coordinates and momenta, and controls the errors of both.
    #[cfg(feature = "alloc")]
    fn motion_in_momenta<'w>(
        &self,
        phase: PhaseState<Self::Scalar, N>,
    ) -> MotionFrom<'_, 'w, Self, HamiltonianVectorField, N, M> {
        MotionBuilder::new(self, Start::new(self.legendre(&phase)))
    }
}

impl<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize> Hamiltonian<N, M> for L {}
