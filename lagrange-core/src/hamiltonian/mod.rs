//! Hamiltonian form of a system: momenta instead of velocities.

mod legendre;
mod motion;
mod phase;
#[cfg(test)]
mod tests;
mod vector_field;

pub use phase::{PhaseDerivative, PhaseState};
pub use vector_field::HamiltonianVectorField;

use crate::error::Error;
use crate::names::Entry;
use crate::number::Real;
use crate::solution::solve::solve;
use crate::system::finite::check_entries;
use crate::system::{Lagrangian, StateOf};
use crate::vector::{Vector, zeros};
#[cfg(feature = "alloc")]
use crate::{
    motion::{
        Method,
        integration::builder::{MotionBuilder, MotionFrom, Start},
    },
    trajectory::Trajectory,
};
use phase::rate;

/// The Legendre transform, the Hamiltonian and Hamilton's equations with constraints, for every [`Lagrangian`]
/// over `f64` or `f32`.
///
/// The velocity that belongs to (t, q, p) satisfies the constraints, F q̇ + b = 0, and its momenta ∂L/∂q̇
/// differ from p by at most a part Fᵀμ along the constraints. Such a part does no work on any admissible
/// motion. So ∂²L/∂q̇² may be singular if the constraints make the transform regular (unit quaternions,
/// massless coordinates).
///
/// If L is quadratic in q̇ the transform is closed, otherwise it uses Newton's iteration. If L is not convex in
/// q̇, several velocities may have the same momenta. A phase state then stands for the one that the iteration
/// finds from rest; [`legendre_near`](Self::legendre_near) finds others.
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
/// let path = particle.motion_in_momenta(phase).to(10.0)?;
/// assert!((path.end().coordinate("x")? - 6.0).abs() < 1e-12);
/// assert!((path.end().momentum("x")? - 0.75).abs() < 1e-15);
/// # Ok::<(), Error>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no Hamiltonian side",
    label = "not a Lagrangian system over `f64` or `f32`",
    note = "`#[derive(Lagrangian)]` gives it to every struct over `f64` or `f32`: the Legendre transform has to decide, which SIMD lanes and dual numbers cannot"
)]
pub trait Hamiltonian: Lagrangian<Scalar: Real> + Sized {
    /// Returns the phase state of a state, with the momenta p = ∂L/∂q̇.
    fn phase_state(&self, state: &StateOf<Self>) -> PhaseState<Self::Scalar, Self::N> {
        PhaseState { t: state.t, q: state.q, p: self.momentum(state) }
    }

    /// Returns the state of a phase state: the velocities solve the Legendre transform p(t, q, q̇) = p on the
    /// constraints. Newton's iteration starts at q̇ = 0.
    ///
    /// # Errors
    /// [`Error::StateNotFinite`]; [`Error::EquationsNotFinite`]; [`Error::VelocityUndetermined`] if ∂²L/∂q̇² is
    /// singular along the constraints; [`Error::MomentumNotReached`] if Newton's iteration does not converge;
    /// [`Error::Contradictory`] if dependent constraints demand different velocities.
    fn legendre(&self, phase: &PhaseState<Self::Scalar, Self::N>) -> Result<StateOf<Self>, Error> {
        self.legendre_near(phase, &zeros())
    }

    /// Like [`legendre`](Self::legendre), with an initial guess of the velocity: for a Lagrangian that is
    /// singular at rest, or has several velocities with the same momenta.
    ///
    /// # Errors
    /// Those of [`legendre`](Self::legendre).
    fn legendre_near(
        &self,
        phase: &PhaseState<Self::Scalar, Self::N>,
        velocity: &Vector<Self::Scalar, Self::N>,
    ) -> Result<StateOf<Self>, Error> {
        check_entries(self, phase.t, [&phase.q, &phase.p], Entry::Momentum)?;
        legendre::invert(self, phase, &(*velocity).into(), None)
    }

    /// Returns the Hamiltonian H(t, q, p) = p·q̇ − L at the q̇ of [`legendre`](Self::legendre); its value is
    /// the energy.
    ///
    /// # Errors
    /// Those of [`legendre`](Self::legendre).
    fn hamiltonian(&self, phase: &PhaseState<Self::Scalar, Self::N>) -> Result<Self::Scalar, Error> {
        let state = self.legendre(phase)?;
        Ok(phase.p.dot(&state.v) - self.lagrangian(&state))
    }

    /// Returns the rates by Hamilton's equations with constraints: q̇ = ∂H/∂p and ṗ = ∂L/∂q + Q + Fᵀλ, with the
    /// λ of [`solve`](crate::Simulate::solve). Without constraints and forces ṗ = −∂H/∂q.
    ///
    /// # Errors
    /// Those of [`legendre`](Self::legendre) and [`solve`](crate::Simulate::solve).
    fn hamilton_equations(
        &self,
        phase: &PhaseState<Self::Scalar, Self::N>,
    ) -> Result<PhaseDerivative<Self::Scalar, Self::N, Self::M>, Error> {
        let state = self.legendre(phase)?;
        solve(self, &state).map(|solution| rate(self, &state, solution.multipliers))
    }

    /// Integrates Hamilton's equations from a phase state to the time `end`, as
    /// [`integrate`](crate::Simulate::integrate) does for Lagrange's. The method integrates coordinates and
    /// momenta, and controls their errors.
    ///
    /// # Errors
    /// Those of [`integrate`](crate::Simulate::integrate) and [`legendre`](Self::legendre).
    #[cfg(feature = "alloc")]
    fn integrate_hamiltonian<P: Method<Self, HamiltonianVectorField>>(
        &self,
        phase: PhaseState<Self::Scalar, Self::N>,
        end: Self::Scalar,
        method: P,
    ) -> Result<Trajectory<&Self, HamiltonianVectorField>, Error> {
        self.motion_in_momenta(phase).by(method).to(end)
    }

    /// Returns the settings of a motion by Hamilton's equations from a phase state; events and other settings
    /// are those of [`motion`](crate::Simulate::motion). The method integrates coordinates and momenta, and
    /// controls their errors.
    #[cfg(feature = "alloc")]
    fn motion_in_momenta<'w>(
        &self,
        phase: PhaseState<Self::Scalar, Self::N>,
    ) -> MotionFrom<'_, 'w, Self, HamiltonianVectorField> {
        MotionBuilder::new(self, Start::new(self.legendre(&phase)))
    }
}

impl<L: Lagrangian<Scalar: Real>> Hamiltonian for L {}
